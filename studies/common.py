"""What studies share: results that are kept in a folder, options, and how numbers are written."""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import matplotlib as mpl
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.layout import house_style
from crazybilliards.comparison.sweeps import Case, process_pool, run_cases

Results = Mapping[str, xr.Dataset]
Table = Sequence[Sequence[object]]


def options(description: str | None, **defaults: object) -> argparse.Namespace:
    """Read ``--name value`` for each of the defaults; one that is a list takes several values.

    An option whose default is a type has to be given, without its name.
    """
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for name, default in defaults.items():
        if isinstance(default, type):
            parser.add_argument(name, type=default, metavar=name.upper())
        elif isinstance(default, list):
            parser.add_argument(f"--{name}", type=type(default[0]), nargs="*", default=default)
        else:
            parser.add_argument(f"--{name}", type=type(default), default=default)
    return parser.parse_args()


def carry_out(
    description: str | None,
    cases: Mapping[str, Case],
    tables: Callable[[Results], Mapping[str, Table]],
    draw: Callable[[Results], Figure] | None = None,
) -> None:
    """Compute the cases that FOLDER lacks, on all cores; write tables and the picture there.

    ``tables`` returns tables by the names of their files, and ``draw`` the picture, both from the
    results by the names of their cases.
    """
    folder = options(description, folder=Path).folder
    with process_pool() as workers:
        failed = run_cases(cases.values(), folder / "cases", workers)
    for case, reason in failed.items():
        raise SystemExit(f"{len(failed)} cases failed, the first, {case.title}: {reason}")
    results = {name: case.load(folder / "cases") for name, case in cases.items()}
    for name, table in tables(results).items():
        write_table(folder / f"{name}.csv", table)
    if draw is not None:
        mpl.use("Agg")
        with house_style():
            draw(results).savefig(folder / f"{Path(sys.argv[0]).stem}.png")


def write_table(path: Path, table: Table) -> None:
    """Write rows, the first one with the heads of the columns."""
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(table)
    print(f"wrote {path}")


def print_row(*cells: object) -> None:
    """Print a row of a table in Markdown."""
    print(f"| {' | '.join(map(str, cells))} |", flush=True)


def print_heads(*heads: str) -> None:
    """Print the heads of a table in Markdown."""
    print_row(*heads)
    print("|---" * len(heads) + "|")


def percents(values: Iterable[float], errors: Iterable[float]) -> list[str]:
    """Return deviations in per cent with their signs and standard errors."""
    return [f"{d:+.2f} ± {s:.2f}" for d, s in zip(values, errors, strict=True)]
