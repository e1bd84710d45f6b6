"""Options that several commands have; those of a chain come from the class that declares them."""

import inspect
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any, get_type_hints

from typer import Option

from crazybilliards.model.checks import check_path
from crazybilliards.model.parameters import Parameters


def at_home(output: Path | None) -> Path | None:
    """Return a folder, in which ``~`` is the home folder: shells leave it in ``--output=~/x``."""
    return None if output is None else check_path("output", output)


_HELP = "Folder for files; without it nothing is written."
Output = Annotated[Path | None, Option("--output", "-o", callback=at_home, help=_HELP)]
Json = Annotated[
    bool, Option("--json", help="Print one JSON object instead of text, numbers in full.")
]
Seed = Annotated[int, Option(help="Seed of the random numbers.")]
Threads = Annotated[int | None, Option(help="Threads to simulate in; default: one per core.")]
Processes = Annotated[int | None, Option(help="Processes to compute in; default: one per core.")]


def chain_options(*without: str, **defaults: Any) -> Callable[[Any], Callable[..., None]]:
    """Give a command, in the place of its argument ``chain``, one option for each parameter.

    ``without``: parameters that the command chooses itself; ``defaults``: values of others.
    """
    kinds, parameters = get_type_hints(Parameters), []
    for field in fields(Parameters):
        if field.name in without:
            continue
        unit = field.metadata["unit"]
        text = field.metadata["meaning"] + (f" [{unit}]." if unit else ".")
        parameters.append(
            inspect.Parameter(
                field.name,
                inspect.Parameter.KEYWORD_ONLY,
                default=defaults.get(field.name, field.default),
                annotation=Annotated[kinds[field.name], Option(help=text)],
            )
        )

    def decorated(command: Callable[..., None]) -> Callable[..., None]:

        def with_options(**values: Any) -> None:
            from crazybilliards.model import Chain

            chain = Chain(**{option.name: values.pop(option.name) for option in parameters})
            command(chain=chain, **values)

        command.__annotations__.pop("chain")  # its class is not loaded yet
        _, *others = inspect.signature(command, eval_str=True).parameters.values()
        signature = inspect.Signature(parameters + others)
        with_options.__signature__ = signature  # type: ignore[attr-defined]
        with_options.__annotations__ = {
            option.name: option.annotation for option in signature.parameters.values()
        }
        with_options.__doc__, with_options.__name__ = command.__doc__, command.__name__
        return with_options

    return decorated


def numbers(name: str, text: str, kind: Callable[[str], Any] = float) -> list[Any]:
    """Read numbers separated by commas."""
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError:
        raise ValueError(f"{name} takes numbers separated by commas, got {text!r}") from None
