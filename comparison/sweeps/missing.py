"""The missing cases of a sweep in a folder, and the order of their computation.

A sweep may have a million cases. Only two numbers of each case are kept. The case itself is made
again when it is computed.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from crazybilliards.comparison.sweeps.case import Case, OutdatedError
from crazybilliards.comparison.sweeps.grid import Sweep
from crazybilliards.model.calls import warn_user
from crazybilliards.model.progress import progress_bar
from crazybilliards.particles import ShortRunWarning

_Item = TypeVar("_Item")


@dataclass(frozen=True)
class Cases:
    """Checked cases, all different.

    Attributes
    ----------
    source
        The sweep or collection that the cases come from.
    work
        The particle steps of each, shape (cases,).
    """

    source: Sweep | list[Case]
    work: NDArray[np.float64]

    def __len__(self) -> int:
        return self.work.size

    def __getitem__(self, number: int) -> Case:
        return self.source.case(number) if isinstance(self.source, Sweep) else self.source[number]


@dataclass(frozen=True)
class Missing:
    """The cases that have no valid file in a folder, the longest first.

    Attributes
    ----------
    cases
        All cases.
    numbers
        The numbers of the missing ones.
    folder
        The folder.
    damaged
        Descriptions of the damaged files.
    outdated
        Number of files that other source code computed.
    """

    cases: Cases
    numbers: NDArray[np.int64]
    folder: Path
    damaged: list[str]
    outdated: int

    @property
    def work(self) -> float:
        """Particle steps of all of them."""
        return float(self.cases.work[self.numbers].sum())

    def __len__(self) -> int:
        return self.numbers.size

    def __iter__(self) -> Iterator[Case]:
        return (self.cases[number] for number in self.numbers.tolist())

    def report(self) -> None:
        """Print on standard error which existing files are replaced, and why."""
        for problem in self.damaged:
            print(f"crazybilliards: {problem}; computing it anew", file=sys.stderr)
        if self.outdated:
            print(
                f"crazybilliards: other source code of crazybilliards computed {self.outdated} "
                f"cases in {self.folder}; computing them anew (keep_old=True or --keep-old: take "
                "them as they are)",
                file=sys.stderr,
            )


def check_cases(cases: Iterable[Case], *, progress: bool = True) -> Cases:
    """Check every case of a sweep, and leave out repeated ones.

    Raises
    ------
    ValueError
        For the first case that is wrong.
    """
    if isinstance(cases, Sweep):
        return Cases(cases, _check_sweep(cases, progress))
    source = list(dict.fromkeys(cases))
    return Cases(source, np.array([case.work for case in source], dtype=float))


def _check_sweep(sweep: Sweep, progress: bool) -> NDArray[np.float64]:
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
    bar = _bar(replace(sweep, grid=chains), f"checking {len(sweep)} cases", progress)
    work, short = [], []
    for case in bar:
        work.append(case.work)
        short += [case.too_short] if case.too_short else []
    if short:
        many = f"{len(short)} of {len(work)} cases; the first: " if len(work) > 1 else ""
        warn_user(many + short[0], ShortRunWarning)
    sizes = [*map(len, chains.values())]
    return np.broadcast_to(np.array(work).reshape(sizes), [*map(len, sweep.grid.values())]).ravel()


def find_missing(
    cases: Cases, folder: Path, *, keep_old: bool = False, progress: bool = True
) -> Missing:
    """Return the cases that have no valid file in ``folder``.

    A file is valid if it is undamaged, holds the case, and was computed by the current source code
    (or, with ``keep_old``, by other source code).
    """
    numbers = np.arange(len(cases))
    damaged: list[str] = []
    outdated = 0
    if any(folder.glob("*.nc")):
        missing = []
        for number in _bar(numbers.tolist(), f"checking {len(cases)} cases", progress):
            try:
                cases[number].check_file(folder, keep_old=keep_old)
            except OutdatedError:
                outdated += 1
            except ValueError as error:
                damaged.append(str(error))
            except FileNotFoundError:
                pass
            else:
                continue
            missing.append(number)
        numbers = np.array(missing, dtype=np.int64)
    longest_first = np.argsort(-cases.work[numbers], kind="stable")
    return Missing(cases, numbers[longest_first], folder, damaged, outdated)


def _bar(items: Iterable[_Item], title: str, progress: bool) -> Iterable[_Item]:
    """Show the progress of a loop that takes longer than a second."""
    return progress_bar(progress, items, desc=title, unit="", delay=1)
