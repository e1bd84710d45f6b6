"""Options that several commands have; those of a chain come from the class that declares them."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import typer

from crazybilliards.model.parameters import Parameters

Output = Annotated[
    Path | None,
    typer.Option("--output", "-o", help="Folder for files; without it nothing is written."),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object, numbers in full.")]
Seed = Annotated[int, typer.Option(help="Seed of the random numbers.")]
Threads = Annotated[int | None, typer.Option(help="Threads to simulate in; default: one per core.")]
Processes = Annotated[
    int | None, typer.Option(help="Processes to compute in; default: one per core.")
]


def with_chain_options(*without: str, **defaults: Any) -> Callable[[Any], Callable[..., None]]:
    """Give a command, in the place of its argument ``chain``, one option for each parameter.

    ``without``: parameters that the command chooses itself; ``defaults``: values of others.
    """

    def decorated(command: Callable[..., None]) -> Callable[..., None]:
        options = [each for each in _options(defaults) if each.name not in without]

        def with_options(**given: Any) -> None:
            from crazybilliards.model import Chain

            chain = Chain(**{each.name: given.pop(each.name) for each in options})
            command(chain=chain, **given)

        command.__annotations__.pop("chain")  # its class is not loaded yet
        _, *others = inspect.signature(command, eval_str=True).parameters.values()
        others = [each.replace(kind=inspect.Parameter.KEYWORD_ONLY) for each in others]
        with_options.__signature__ = inspect.Signature(options + others)  # type: ignore[attr-defined]
        with_options.__annotations__ = {each.name: each.annotation for each in options + others}
        with_options.__doc__, with_options.__name__ = command.__doc__, command.__name__
        return with_options

    return decorated


def _options(defaults: dict[str, Any]) -> list[inspect.Parameter]:
    kinds = get_type_hints(Parameters) | {"spring": str}
    return [
        inspect.Parameter(
            each.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=defaults.get(each.name, each.default),
            annotation=Annotated[
                kinds[each.name],
                typer.Option(help=f"{each.metadata['meaning']} [{each.metadata['unit'] or '1'}]."),
            ],
        )
        for each in fields(Parameters)
    ]


def numbers(name: str, text: str, kind: Callable[[str], Any] = float) -> list[Any]:
    """Read numbers separated by commas."""
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError:
        raise ValueError(f"{name} takes numbers separated by commas, got {text!r}") from None
