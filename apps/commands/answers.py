"""What a command answers on standard output: lines and tables for people, or one JSON object."""

from __future__ import annotations

import inspect
import json
import math
from collections.abc import Callable, Iterable
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_ANY_WIDTH = 10_000
_COLUMNS = {"velocity_width": "W_v", "mean_displacement": "<dx>", "displacement_width": "W_x"}
_SAID_ELSEWHERE = {*_COLUMNS, "central_velocity_width", "density_block"}
_IN_THE_MIDDLE = {"particle", "contact", "x", "velocity_bin"}  # of other dimensions the first value
# Facts that --json prints; None if text is printed.
_facts: ContextVar[dict[str, Any] | None] = ContextVar("facts", default=None)
_Option = Annotated[
    bool, typer.Option("--json", help="Print one JSON object instead of text, numbers in full.")
]


def with_json(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the option ``--json``: it then prints the facts that it noted."""

    def with_option(*, as_json: bool = False, **given: Any) -> None:
        before = _facts.set({} if as_json else None)
        try:
            command(**given)
        finally:
            if facts := _facts.get():
                print(json.dumps(_plain(facts), indent=1))
            _facts.reset(before)

    signature = inspect.signature(command, eval_str=True)
    option = inspect.Parameter(
        "as_json", inspect.Parameter.KEYWORD_ONLY, default=False, annotation=_Option
    )
    parameters = [*signature.parameters.values(), option]
    with_option.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    with_option.__annotations__ = {each.name: each.annotation for each in parameters}
    with_option.__doc__ = command.__doc__
    return with_option


def note(**facts: Any) -> None:
    """Keep what machines want to know: tables of plain values."""
    noted = _facts.get()
    if noted is not None:
        noted |= facts


def say(text: str) -> None:
    """Print a line for people."""
    if _facts.get() is None:
        print(text)


def wrote(path: Path) -> None:
    """Say, or note, that a file was written."""
    say(f"wrote {path}")
    noted = _facts.get()
    if noted is not None:
        noted.setdefault("written", []).append(str(path))


def _plain(value: Any) -> Any:
    """Return what JSON can hold; it has no number that is not finite."""
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if hasattr(value, "item"):  # of numpy
        value = value.item()
    if value is None or isinstance(value, str | bool | int):
        return value
    number = float(value)
    return number if math.isfinite(number) else None


def empty_table(
    words: Iterable[str], numbers: Iterable[str], *, caption: str, title: str | None = None
) -> Table:
    """Return a table with columns of words, then of numbers, by their headings."""
    from rich.table import Table

    table = Table(*words, title=title, caption=caption)
    for heading in numbers:
        table.add_column(heading, justify="right")
    return table


def answer_rods(result: xr.Dataset, title: str, caption: str) -> None:
    """Print widths and displacements of some rods, with their standard errors if there are any."""
    from crazybilliards.model.vocabulary import unit_of

    columns = {name: text for name, text in _COLUMNS.items() if name in result}
    units = {name: unit_of(result[name]) for name in columns}
    headings = [f"{text} [{units[name]}]" for name, text in columns.items()]
    table = empty_table([], ["particle", *headings], title=title, caption=caption)
    L, noted = result.sizes["particle"], []
    for i in sorted({1, 2, max(L // 10, 1), max(L // 4, 1), max(L // 2, 1)} & set(range(1, L + 1))):
        rod = result.isel(particle=i - 1)
        table.add_row(str(rod.particle.item()), *(_measured(rod, name) for name in columns))
        errors = [f"{name}_error" for name in columns if f"{name}_error" in rod]
        noted.append({name: rod[name].item() for name in ("particle", *columns, *errors)})
    note(rods=noted, units=units)
    print_table(table)


def answer_measured(result: xr.Dataset, *, ensemble: bool) -> None:
    """Print one value of everything that was measured; with ``--json`` all of them."""
    from crazybilliards.comparison.coverage import smooth
    from crazybilliards.model.vocabulary import unit_of

    if _facts.get() is not None:
        note(observed=result.to_dict())
        return
    table = empty_table(
        ["measured", "at"],
        ["value", "unit"],
        title="What was measured, one value of each",
        caption="+-: one standard error. --output keeps all values, --json prints them. The "
        "density is smoothed as in the paper.",
    )
    table.columns[0].no_wrap = True
    for name in result.data_vars:
        if name in _SAID_ELSEWHERE or str(name).endswith("_error") or not result[name].size:
            continue
        source = smooth(result) if name == "density" else result
        kept = [each for each in (name, f"{name}_error") if each in source]
        chosen, at = _one_value(source[kept], ensemble)
        table.add_row(str(name), at, _measured(chosen, str(name)), unit_of(result[name]))
    if table.row_count:
        print_table(table)


def _one_value(result: xr.Dataset, ensemble: bool) -> tuple[xr.Dataset, str]:
    """Return what is in the middle, or the mean over the time, and the words for that."""
    words = []
    for name, size in result.sizes.items():
        if name == "time" and not ensemble:
            # Snapshots are correlated: the error of one is not that of their mean.
            kept = [each for each in result.data_vars if not str(each).endswith("_error")]
            result = result[kept].mean(name, keep_attrs=True)
            words.append("mean over time")
            continue
        place = -1 if name == "time" else (size - 1) // 2 if name in _IN_THE_MIDDLE else 0
        at = result[name][place].item() if name in result.coords else place + 1
        words.append(f"{str(name).replace('_', ' ')} {at:.4g}")
        result = result.isel({name: place})
    return result, ", ".join(words)


def _measured(rod: xr.Dataset, name: str) -> str:
    value, error = f"{float(rod[name]):.4g}", float(rod.get(f"{name}_error", math.nan))
    return value if math.isnan(error) else f"{value} +- {error:.1g}"


def print_table(table: Table) -> None:
    """Print a table without cutting a number: headings wrap, and lines get as long as they must.

    Its title and its caption may be wider than the table.
    """
    from rich.cells import cell_len
    from rich.console import Console

    if _facts.get() is not None:
        return
    console = Console(markup=False)  # [sigma] is a unit, not a style
    title, caption, table.title, table.caption = table.title, table.caption, None, None
    wide = console.options.update(max_width=_ANY_WIDTH)
    width = console.width
    if console.measure(table, options=wide).maximum > console.width:
        for column in table.columns:
            if column.justify == "right":
                words = [*map(str, column.cells), *str(column.header).split()]
                column.width = max(map(cell_len, words))
        console.width = max(console.width, console.measure(table, options=wide).minimum)
    for part in (title, table, caption):
        if part is not None:
            console.print(part, width=width if isinstance(part, str) else None, highlight=False)
