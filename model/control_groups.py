"""The control groups of this process: what Linux, a container or a batch job leaves it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path


def limiting_groups(root: Path, controller: str) -> Iterator[tuple[Path, int]]:
    """Yield the groups with a controller, ``"memory"`` or ``"cpu"``, and their version, 1 or 2.

    The group of this process and all around it, whose limits hold as well. ``root`` is ``/``, and
    another folder in tests.
    """
    try:
        lines = (root / "proc/self/cgroup").read_text().splitlines()
    except OSError:
        return  # not Linux
    for line in lines:  # number:controllers:path, with number 0 and no controllers in version 2
        _, controllers, path = line.split(":", 2)
        if controllers == "":
            top, version = root / "sys/fs/cgroup", 2
        elif controller in controllers.split(","):
            top, version = root / "sys/fs/cgroup" / controller, 1
        else:
            continue
        group = top / path.lstrip("/")
        # In a container the path may be that of the host, of which only the top exists here.
        yield from ((each, version) for each in (group, *group.parents) if each.is_relative_to(top))
