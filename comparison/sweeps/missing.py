"""The cases of a sweep, checked, and those of them that a folder lacks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from crazybilliards.comparison.sweeps.case import Case, OutdatedError
from crazybilliards.comparison.sweeps.grid import Sweep
from crazybilliards.model.arrays import Array
from crazybilliards.model.calls import warn_user
from crazybilliards.model.checks import shown
from crazybilliards.model.progress import progress_bar
from crazybilliards.particles import ShortRunWarning


@dataclass(frozen=True)
class Cases:
    """Checked cases, all different. A sweep may have a million: each is made when it is needed."""

    source: Sweep | list[Case]  # that they come from
    numbers: NDArray[np.int64]  # in the source, shape (cases,)
    work: Array  # particle steps of each, shape (cases,)
    replaced: Sequence[str] = ()  # what to say of the files that their results replace

    def __len__(self) -> int:
        return self.work.size

    def __iter__(self) -> Iterator[Case]:
        made = self.source.case if isinstance(self.source, Sweep) else self.source.__getitem__
        return map(made, self.numbers.tolist())


def check_cases(cases: Iterable[Case], *, progress: bool = True) -> Cases:
    """Check every case of a sweep, and leave out repeated ones.

    A ValueError is that of the first case that is wrong.
    """
    source: Sweep | list[Case]
    if isinstance(cases, Sweep):
        source, work = cases, _check_sweep(cases, progress)
    else:
        given = list(cases) if isinstance(cases, Iterable) else [None]
        if not all(isinstance(each, Case) for each in given):
            raise ValueError(f"cases must be a Sweep or a list of Case, got {shown(cases)}")
        source = list(dict.fromkeys(given))
        work = np.array([case.work for case in source], dtype=float)
    return Cases(source, np.arange(work.size), work)


def _check_sweep(sweep: Sweep, progress: bool) -> Array:
    """Check every case of a grid and return its particle steps.

    The check of a seed does not depend on the other parameters, and the computing time does not
    depend on the seed. All seeds are therefore checked with one chain, all chains with one seed.
    """
    chains = dict(sweep.grid)
    if "seed" in chains:
        first = {name: values[:1] for name, values in chains.items()}
        for _ in replace(sweep, grid=first | {"seed": chains["seed"]}):
            pass
        chains["seed"] = first["seed"]
    work, short = [], []
    for case in _bar(replace(sweep, grid=chains), f"checking {len(sweep)} cases", progress):
        work.append(case.work)
        short += [case.too_short] if case.too_short else []
    warn_of_short_runs(short, len(work))
    sizes = [*map(len, chains.values())]
    return np.broadcast_to(np.array(work).reshape(sizes), [*map(len, sweep.grid.values())]).ravel()


def warn_of_short_runs(short: Sequence[str], number: int) -> None:
    """Warn of the simulations, of ``number`` cases, that are too short, and say in what."""
    if short:
        many = f"{len(short)} of {number} cases; the first: " if number > 1 else ""
        warn_user(many + short[0], ShortRunWarning)


def find_missing(
    cases: Cases, folder: Path, *, keep_old: bool = False, progress: bool = True
) -> Cases:
    """Return the cases that have no valid file in ``folder``, the shortest first.

    A sweep that is stopped then has results. The order costs little: with the work of the figures
    of the paper 2 % of the time in two processes and 17 % in eight.

    A file is valid if it is undamaged, holds the case, and was computed by the current source code
    (or, with ``keep_old``, by other source code).
    """
    is_missing, outdated = np.ones(len(cases), dtype=bool), 0
    replaced: list[str] = []
    if any(folder.glob("*.nc")):
        for place, case in enumerate(_bar(cases, f"checking {len(cases)} cases", progress)):
            try:
                case.check_file(folder, keep_old=keep_old)
            except OutdatedError:
                outdated += 1
            except ValueError as error:
                replaced.append(f"{error}; computing it anew")
            except FileNotFoundError:
                pass
            else:
                is_missing[place] = False
    if outdated:
        replaced.append(
            f"other source code of crazybilliards computed {outdated} cases in {folder}; "
            "computing them anew (keep_old=True or --keep-old: take them as they are)"
        )
    numbers, work = cases.numbers[is_missing], cases.work[is_missing]
    shortest_first = np.argsort(work, kind="stable")
    return Cases(cases.source, numbers[shortest_first], work[shortest_first], replaced)


def _bar(cases: Sweep | Cases, title: str, progress: bool) -> Iterable[Case]:
    """Show the progress of a loop that takes longer than a second."""
    return progress_bar(progress, cases, desc=title, unit="", delay=1)
