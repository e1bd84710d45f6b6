"""What the commands share: folders, figures, tables, and how they end."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

INTERRUPTED = 130
_STATUS = {"completed": 0, "interrupted": INTERRUPTED, "diverged": 1}


@contextmanager
def writing_to(output: Path | None) -> Iterator[None]:
    """Hold a folder, which is made, against other processes; refuse it before any work."""
    if output is None:
        yield
        return
    from crazybilliards.model.locks import locked
    from crazybilliards.model.storage import make_folder

    found = next(each for each in (output, *output.absolute().parents) if os.path.lexists(each))
    if not found.is_dir():
        raise ValueError(f"output must be a folder, but {found} is none")
    if not os.access(found, os.W_OK | os.X_OK):
        raise ValueError(f"output: no permission to write to {found}")
    made = [each for each in (output, *output.absolute().parents) if not each.exists()]
    make_folder(output)
    try:
        with locked(output):
            yield
    finally:
        for each in made:  # a folder in which nothing was written
            with suppress(OSError):
                each.rmdir()


def keep(
    result: xr.Dataset | xr.DataTree,
    output: Path | None,
    name: str,
    drawings: Mapping[str, Callable[[], Figure]] | None = None,
) -> list[str]:
    """Write NAME.nc, then pictures, into a folder, if there is one; return their names."""
    if output is None:
        return []
    from crazybilliards.model import save

    status = result.attrs["status"]
    suffix = "" if status == "completed" else f"-{status}"
    written = [str(save(result, output / f"{name}{suffix}.nc"))]
    for picture, draw in (drawings or {}).items():
        written.append(_write_figure(draw, output / f"{picture}{suffix}.png"))
    return written


def _write_figure(draw: Callable[[], Figure], path: Path) -> str:
    from io import BytesIO

    from crazybilliards.comparison.layout import house_style
    from crazybilliards.model.storage import write_atomically

    picture = BytesIO()
    with house_style():
        draw().savefig(picture, format="png")
    write_atomically(path, picture.getvalue())
    return str(path)


def table(rows: Sequence[Mapping[str, Any]], columns: Mapping[str, str]) -> str:
    """Return rows as a table, ``{name: heading}``; NAME_error stands beside NAME, "-" for NaN."""
    import pandas as pd

    shown = [{head: _cell(row, name) for name, head in columns.items()} for row in rows]
    return str(pd.DataFrame(shown).to_string(index=False))


def _cell(row: Mapping[str, Any], name: str) -> str:
    value, error = row.get(name), row.get(f"{name}_error", math.nan)
    if value is None or value != value:
        return "-"
    if isinstance(value, str):
        return value
    return f"{value:.4g}" + ("" if math.isnan(error) else f" +- {error:.1g}")


def rods_table(result: xr.Dataset) -> str:
    """Return widths and displacements of some rods, with their standard errors if there are any."""
    from crazybilliards.model.vocabulary import unit_of

    symbols = {"velocity_width": "W_v", "mean_displacement": "<dx>", "displacement_width": "W_x"}
    columns = {
        name: f"{symbol} [{unit_of(result[name])}]"
        for name, symbol in symbols.items()
        if name in result
    }
    L = result.sizes["particle"]
    kept = [each for name in columns for each in (name, f"{name}_error") if each in result]
    rows = [
        {name: result[name][i - 1].item() for name in ("particle", *kept)}
        for i in sorted({1, 2, L // 10, L // 4, L // 2} & {*range(1, L + 1)})
    ]
    return table(rows, {"particle": "particle"} | columns)


def end(
    facts: Mapping[str, Any], as_json: bool, *text: str, status: str = "completed", why: str = ""
) -> None:
    """Print the text or, as JSON, the facts; end the command with the status for a shell."""
    print(json.dumps(_plain(facts), indent=1) if as_json else "\n".join(filter(None, text)))
    if why:
        print(f"crazybilliards: {why}", file=sys.stderr)
    if _STATUS[status]:
        raise typer.Exit(_STATUS[status])


def written_lines(written: Sequence[str]) -> str:
    """Return a line for each file that was written, or how to have them."""
    return "\n".join(map("wrote {}".format, written)) or "Nothing was written; --output FOLDER does."


def _plain(value: Any) -> Any:
    """Return what JSON can hold; it has no number that is not finite."""
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    value = value.item() if hasattr(value, "item") else value  # of numpy
    return None if isinstance(value, float) and not math.isfinite(value) else value
