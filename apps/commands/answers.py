"""What a command answers on standard output: lines and tables for people, or one JSON object."""

from __future__ import annotations

import inspect
import json
import math
from collections.abc import Callable, Mapping, Sequence
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.options import in_its_place

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_ANY_WIDTH = 10_000
_COLUMNS = {"velocity_width": "W_v", "mean_displacement": "<dx>", "displacement_width": "W_x"}
_SAID_ELSEWHERE = {*_COLUMNS, "central_velocity_width", "density_block"}
_IN_THE_MIDDLE = {"particle", "contact", "x", "velocity_bin"}  # of other dimensions the first value
# Facts that --json prints; None if text is printed.
_facts: ContextVar[dict[str, Any] | None] = ContextVar("facts", default=None)
_Json = Annotated[
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

    parameters = [
        *inspect.signature(command, eval_str=True).parameters.values(),
        inspect.Parameter(
            "as_json", inspect.Parameter.KEYWORD_ONLY, default=False, annotation=_Json
        ),
    ]
    return in_its_place(with_option, command, parameters)


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
    return float(value) if math.isfinite(value) else None


def table_of(
    columns: Mapping[str, tuple[str, Callable[[Any], str]]],
    rows: Sequence[Mapping[str, Any]],
    *,
    caption: str,
    fact: str = "",
    title: str | None = None,
) -> None:
    """Print rows as a table; or note all that they hold, as the fact of this name.

    ``columns`` has the heading of each printed value and what shows it, ``str`` for words, by its
    name in the rows. What is missing or NaN is "-", and a standard error NAME_error is added to
    NAME if ``number`` shows it. No line of the first column is broken.
    """
    from rich.table import Table

    if fact:
        note(**{fact: list(rows)})
    table = Table(title=title, caption=caption)
    for heading, show in columns.values():
        justify: Any = "left" if show is str else "right"
        table.add_column(heading, justify=justify, no_wrap=not table.columns)
    for row in rows:
        table.add_row(*(_cell(row, name, show) for name, (_, show) in columns.items()))
    if rows:
        print_table(table)


def percent(share: float) -> str:
    """Return a share in per cent, without the sign."""
    return f"{100 * share:.2f}"


def number(value: float) -> str:
    """Return a number, which in a table has its standard error beside it."""
    return f"{value:.4g}"


def _cell(row: Mapping[str, Any], name: str, show: Callable[[Any], str]) -> str:
    value, error = row.get(name), row.get(f"{name}_error", math.nan)
    if value is None or value != value:  # NaN
        return "-"
    return show(value) + (f" +- {error:.1g}" if show is number and not math.isnan(error) else "")


def answer_rods(result: xr.Dataset, title: str, caption: str) -> None:
    """Print widths and displacements of some rods, with their standard errors if there are any."""
    from crazybilliards.model.vocabulary import unit_of

    units = {name: unit_of(result[name]) for name in _COLUMNS if name in result}
    columns = {name: (f"{_COLUMNS[name]} [{unit}]", number) for name, unit in units.items()}
    L = result.sizes["particle"]
    some = {i - 1 for i in (1, 2, L // 10, L // 4, L // 2) if 1 <= i <= L}
    kept = [each for name in units for each in (name, f"{name}_error") if each in result]
    rows = [{name: result[name][i].item() for name in ("particle", *kept)} for i in sorted(some)]
    note(units=units)
    columns = {"particle": ("particle", "{:d}".format)} | columns
    table_of(columns, rows, fact="rods", title=title, caption=caption)


def answer_measured(result: xr.Dataset, *, ensemble: bool) -> None:
    """Print one value of everything that was measured; with ``--json`` all of them."""
    from crazybilliards.comparison.coverage import smooth
    from crazybilliards.model.vocabulary import unit_of

    if _facts.get() is not None:
        note(observed=result.to_dict())
        return
    rows = []
    for name in result.data_vars:
        if name in _SAID_ELSEWHERE or str(name).endswith("_error") or not result[name].size:
            continue
        source = smooth(result) if name == "density" else result
        kept = [each for each in (name, f"{name}_error") if each in source]
        chosen, at = _one_value(source[kept], ensemble)
        error = float(chosen.get(f"{name}_error", math.nan))
        row = {"name": name, "at": at, "value": float(chosen[name]), "value_error": error}
        rows.append(row | {"unit": unit_of(result[name])})
    table_of(
        {
            "name": ("measured", str),
            "at": ("at", str),
            "value": ("value", number),
            "unit": ("unit", str),
        },
        rows,
        title="What was measured, one value of each",
        caption="+-: one standard error. --output keeps all values, --json prints them. The "
        "density is smoothed as in the paper.",
    )


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
