"""Tables of numbers for people."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_SYMBOLS = {"velocity_width": "W_v", "mean_displacement": "<dx>", "displacement_width": "W_x"}


def table(
    columns: Mapping[str, str], rows: Sequence[Mapping[Any, Any]], caption: str | None = None
) -> Table:
    """Return a table of values of rows, whose columns have the headings ``{name: heading}``.

    What is missing or NaN is "-". Under a heading that ends in [%] the values are shares, in [se]
    they get one decimal. Other numbers have their standard errors NAME_error beside them.
    """
    from rich import box
    from rich.table import Table

    shown = Table(box=box.SIMPLE, padding=(0, 1, 0, 0), show_edge=False, pad_edge=False)
    shown.caption, shown.caption_justify = caption, "left"
    for name, heading in columns.items():
        words = any(isinstance(row.get(name), str) for row in rows)
        shown.add_column(heading, justify="left" if words else "right", no_wrap=True)
    for row in rows:
        shown.add_row(*(_cell(row, name, heading) for name, heading in columns.items()))
    return shown


def _cell(row: Mapping[Any, Any], name: str, heading: str) -> str:
    value, error = row.get(name), row.get(f"{name}_error", math.nan)
    if value is None or value != value:  # NaN
        return "-"
    if isinstance(value, str):
        return value
    if heading.endswith("[%]"):
        return f"{100 * value:.2f}"
    if heading.endswith("[se]"):
        return f"{value:.1f}"
    return f"{value:.4g}" + ("" if math.isnan(error) else f" +- {error:.1g}")


def rods_table(result: xr.Dataset) -> Table:
    """Return widths and displacements of some rods, with standard errors if there are any."""
    columns = {"particle": "particle"} | {
        name: f"{symbol} [{_unit(result[name])}]"
        for name, symbol in _SYMBOLS.items()
        if name in result
    }
    size = result.sizes["particle"]
    some = sorted({i - 1 for i in (1, 2, size // 10, size // 4, size // 2) if 1 <= i <= size})
    names = [name for name in (*columns, *(f"{name}_error" for name in columns)) if name in result]
    rows = [{name: result[name][i].item() for name in names} for i in some]
    return table(columns, rows, "+-: one standard error." if len(names) > len(columns) else None)


def measured_table(result: xr.Dataset) -> Table:
    """Return an overview of everything that was measured, without the standard errors."""
    rows = [
        {"name": name, "over": ", ".join(map(str, values.dims)), "unit": _unit(values)}
        | {"mean": float(values.mean()), "least": float(values.min()), "most": float(values.max())}
        for name, values in result.data_vars.items()
        if values.size and not str(name).endswith("_error")
    ]
    columns = {"name": "measured", "over": "over", "mean": "mean", "least": "smallest"}
    return table(columns | {"most": "largest", "unit": "unit"}, rows)


def _unit(values: xr.DataArray) -> str:
    from crazybilliards.model.vocabulary import unit_of

    return unit_of(values)
