"""What the commands share: their folder, files, pictures and tables, what they print, their end."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure
    from rich.table import Table

INTERRUPTED = 130
_ANY_WIDTH = 10_000
_SYMBOLS = {"velocity_width": "W_v", "mean_displacement": "<dx>", "displacement_width": "W_x"}


@contextmanager
def writing_to(output: Path | None, *names: str) -> Iterator[None]:
    """Make a folder for files and hold it against others; raise OSErrors before any work."""
    if output is None:
        yield
        return
    from crazybilliards.model.storage import locked, make_folder, write_atomically

    made = [folder for folder in (output, *output.resolve().parents) if not folder.exists()]
    make_folder(output)
    try:
        with locked(output):
            for name in names:
                write_atomically(output / name, None)
            yield
    finally:
        for folder in made:  # in which nothing was written
            with suppress(OSError):
                folder.rmdir()


def picture(draw: Callable[..., Figure], *arguments: Any) -> Callable[[Path], None]:
    """Return a function that draws a picture and writes it to a file, whole or not at all."""

    def write(path: Path) -> None:
        from crazybilliards.comparison.drawing import as_file, house_style
        from crazybilliards.model.storage import write_atomically

        with house_style():
            content = as_file(draw(*arguments))
        write_atomically(path, content)

    return write


def conclude(
    result: xr.Dataset | xr.DataTree,
    output: Path | None,
    name: str,
    pictures: Mapping[str, Callable[[Path], object]],
    as_json: bool,
    facts: Mapping[str, Any],
    *text: str | Table,
) -> None:
    """Write files, print the text or, as JSON, the facts, and end with the status for a shell.

    The result is written to the file ``name`` of the folder ``output``, and then the pictures by
    what writes each. Names get the status unless the result is completed. If one cannot be written
    the others are, everything is printed, and then the first error is raised.
    """
    from crazybilliards.model.storage import netcdf, write_sealed

    # Not by save(), which would warn once more of a chain that diverged.
    files = {name: lambda path: write_sealed(path, netcdf(result))} | dict(pictures)
    status, written, errors = result.attrs["status"], [], list[Exception]()
    suffix = "" if status == "completed" else f"-{status}"
    try:
        for file, write in files.items() if output else ():
            path = Path(output or "", file)
            path = path.with_stem(path.stem + suffix)
            try:
                write(path)
                written.append(str(path))
            except Exception as error:
                errors.append(error)
    finally:
        lines = [f"wrote {path}" for path in written]
        if output is None:
            lines.append("Nothing was written; --output FOLDER keeps it.")
        answer(as_json, {"status": status, "written": written} | dict(facts), *text, *lines)
    for first in errors:
        raise first
    if status != "completed":
        raise typer.Exit(INTERRUPTED if status == "interrupted" else 1)


def answer(as_json: bool, facts: Mapping[str, Any], *text: str | Table) -> None:
    """Print the text or, as JSON, the facts."""
    if as_json:
        print(json.dumps(_plain(facts), indent=1))
        return
    from rich.console import Console

    console = Console(markup=False, highlight=False)  # [R] is a unit, not a style
    any_width = console.options.update(max_width=_ANY_WIDTH)
    for part in text:
        if isinstance(part, str):
            print(part)
            continue
        needed = console.measure(part, options=any_width).maximum
        part.width = needed if needed > console.width else None  # no number is cut off
        console.print(part, crop=False)


def complain(message: str) -> None:
    """Print a line on standard error."""
    print(f"crazybilliards: {' '.join(message.split())}", file=sys.stderr)


def _plain(value: Any) -> Any:
    """Return what JSON can hold; it has no number that is not finite."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    value = value.item() if hasattr(value, "item") else value  # of numpy
    return None if isinstance(value, float) and not math.isfinite(value) else value


def table(
    columns: Mapping[str, str], rows: Sequence[Mapping[Any, Any]], caption: str | None = None
) -> Table:
    """Return a table of values of rows, whose columns have the headings ``{name: heading}``.

    What is missing or NaN is "-". Under a heading that ends in [%] the values are shares, in [se]
    they get one decimal. Other numbers have their standard errors NAME_error beside them.
    """
    from rich import box
    from rich.table import Table

    shown = Table(
        box=box.SIMPLE,
        padding=(0, 1, 0, 0),
        show_edge=False,
        pad_edge=False,
        caption=caption,
        caption_justify="left",
    )
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
    return table(
        {
            "name": "measured",
            "over": "over",
            "mean": "mean",
            "least": "smallest",
            "most": "largest",
            "unit": "unit",
        },
        rows,
    )


def _unit(values: xr.DataArray) -> str:
    from crazybilliards.model.vocabulary import unit_of

    return unit_of(values)
