"""The control groups of this process: what Linux, a container or a batch job leaves it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path


def limiting_groups(root: Path) -> Iterator[Path]:
    """Yield the group of this process and all around it, whose limits hold as well.

    ``root`` is ``/``, and another folder in tests. Groups of version 1, which systems before 2022
    have, are not read.
    """
    try:
        lines = (root / "proc/self/cgroup").read_text().splitlines()
    except OSError:
        return  # not Linux
    top = root / "sys/fs/cgroup"
    for path in [line.removeprefix("0::/") for line in lines if line.startswith("0::/")]:
        # In a container the path may be that of the host, of which only the top exists here.
        yield from (
            each for each in (top / path, *(top / path).parents) if each.is_relative_to(top)
        )
