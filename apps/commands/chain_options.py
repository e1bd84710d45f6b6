"""The parameters of a chain as options of a command, made from the class that declares them.

Standard library and typer only up here, so that ``--help`` answers at once.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection
from dataclasses import Field, fields
from typing import Annotated, Any, Literal, get_origin, get_type_hints

import typer

from crazybilliards.model.parameters import Parameters


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
        with_options.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
        with_options.__annotations__ = {each.name: each.annotation for each in parameters}
        with_options.__doc__ = command.__doc__
        return with_options

    return decorated


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
