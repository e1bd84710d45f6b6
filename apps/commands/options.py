"""Options that several commands have; those of a chain come from the class that declares them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection
from dataclasses import Field, fields
from pathlib import Path
from typing import Annotated, Any, Literal, get_origin, get_type_hints

import typer

from crazybilliards.model.checks import check_path
from crazybilliards.model.parameters import Parameters

OUTPUT = ("--output", "-o")
Threads = Annotated[int | None, typer.Option(help="Threads to simulate in; default: one per core.")]
Processes = Annotated[
    int | None, typer.Option(help="Processes to compute in; default: one per core.")
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        help="Compute on the dask cluster with this scheduler, tcp://HOST:PORT say; "
        "local: on a cluster that is started on this machine."
    ),
]
KeepOld = Annotated[
    bool,
    typer.Option(
        "--keep-old",
        help="Take results that other source code of crazybilliards computed as they are.",
    ),
]


def path_option(help: str, metavar: str = "FOLDER", names: tuple[str, ...] = OUTPUT) -> Any:
    """Return the declaration of an option that takes the name of a folder, or of a file."""
    return typer.Option(*names, help=help, parser=_path, metavar=metavar)


def _path(text: str) -> Path:
    if not str(text):
        raise typer.BadParameter("an empty name; the current folder is .")
    return check_path("output", text)


def with_chain_options(
    *, without: Collection[str] = (), **defaults: Any
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command, in the place of its argument ``chain``, one option for each parameter.

    Parameters
    ----------
    without
        Parameters that the command chooses itself; its chain has their defaults.
    defaults
        Values of parameters that this command starts from instead of Chain's.
    """
    options = [_option(each, defaults) for each in fields(Parameters) if each.name not in without]

    def decorated(command: Callable[..., None]) -> Callable[..., None]:
        def with_options(**given: Any) -> None:
            from crazybilliards.model import Chain

            chain = Chain(**{option.name: given.pop(option.name) for option in options})
            command(chain=chain, **given)

        # Chain itself is not loaded yet, so its name in an annotation has no meaning here.
        command.__annotations__.pop("chain", None)
        signature = inspect.signature(command, eval_str=True)
        parameters: list[inspect.Parameter] = []
        for name, each in signature.parameters.items():
            parameters += options if name == "chain" else [each]
        return in_its_place(with_options, command, parameters)

    return decorated


def in_its_place(
    wrapper: Callable[..., None], command: Callable[..., None], parameters: list[inspect.Parameter]
) -> Callable[..., None]:
    """Return the wrapper of a command, with these parameters, as typer reads it."""
    wrapper.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    wrapper.__annotations__ = {each.name: each.annotation for each in parameters}
    wrapper.__doc__ = command.__doc__
    return wrapper


def _option(field: Field[Any], defaults: dict[str, Any]) -> inspect.Parameter:
    kind = get_type_hints(Parameters)[field.name]
    if get_origin(kind) is Literal:
        kind = str  # Chain checks it, in the words that it uses everywhere
    unit = field.metadata["unit"]
    text = field.metadata["meaning"] + (f" [{unit}]." if unit else ".")
    return inspect.Parameter(
        field.name,
        inspect.Parameter.POSITIONAL_OR_KEYWORD,
        default=defaults.get(field.name, field.default),
        annotation=Annotated[kind, typer.Option(help=text)],
    )
