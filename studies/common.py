"""What studies share: results that are kept in a folder, options, and how tables are written."""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import house_style
from crazybilliards.comparison.sweeps import Case, process_pool, run_cases
from crazybilliards.model import Chain

Results = Mapping[str, xr.Dataset]
Table = Iterable[Sequence[object]]


def options(description: str | None, **defaults: object) -> argparse.Namespace:
    """Read ``--name value`` for each of the defaults; one that is a list takes several values.

    An option whose default is a type has to be given, without its name; a folder is made before any
    work. One whose default is False takes no value.
    """
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for name, default in defaults.items():
        if isinstance(default, type):
            kind = _made if default is Path else default
            parser.add_argument(name, type=kind, metavar=name.upper())
        elif isinstance(default, list):
            parser.add_argument(f"--{name}", type=type(default[0]), nargs="*", default=default)
        elif default is False:
            parser.add_argument(f"--{name.replace('_', '-')}", action="store_true")
        else:
            parser.add_argument(f"--{name}", type=type(default), default=default)
    return parser.parse_args()


def _made(name: str) -> Path:
    """Return a folder, made if it is missing."""
    folder = Path(name)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise argparse.ArgumentTypeError(f"no folder can be made there: {error}") from error
    return folder


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
        path = folder / f"{name}.csv"
        with path.open("w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(table)
        print(f"wrote {path}")
    if draw is not None:
        save_picture(folder / f"{Path(sys.argv[0]).stem}.png", draw, results)


def save_picture(path: Path, draw: Callable[[Any], Figure], of: Any) -> None:
    """Draw ``of`` in the style of the documentation."""
    mpl.use("Agg")
    with house_style():
        draw(of).savefig(path)


def print_table(rows: Table) -> None:
    """Print rows as CSV, each one when it is there; the first one has the heads."""
    writer = csv.writer(sys.stdout, lineterminator="\n")
    for row in rows:
        writer.writerow(row)
        sys.stdout.flush()


def percents(values: Iterable[float], errors: Iterable[float]) -> list[str]:
    """Return deviations in per cent with their signs and standard errors."""
    return [f"{d:+.2f} ± {s:.2f}" for d, s in zip(values, errors, strict=True)]


def damped(chain: Chain, damping: float) -> Chain:
    """Return a chain with this Gamma = gamma s/(m W), a power of gamma: W and s depend on it."""
    own = chain.damping * chain.thermal_length / (chain.mass * chain.free_velocity_width)
    power = 1.5 - 1 / chain.potential_exponent
    return chain.replace(damping=chain.damping * (damping / own) ** (1 / power))
