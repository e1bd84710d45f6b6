"""Fingerprints of source code show whether the current code computed a stored result.

The version of the package cannot show this, because it does not change when the code is edited
between two releases. A fingerprint is a hash of the source files themselves. A release has the
same fingerprint on every machine, so its results stay valid everywhere.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable


def fingerprint_of(sources: Iterable[Traversable], *others: str) -> str:
    """Return a hash of the content of files, in any order, and of further text."""
    hashed = hashlib.sha256("\0".join(others).encode())
    contents = (
        (each.name.encode(), hashlib.sha256(each.read_bytes()).digest()) for each in sources
    )
    for name, content in sorted(contents):
        hashed.update(name + content)
    return hashed.hexdigest()


@cache
def room_fingerprint(*rooms: str) -> str:
    """Return the fingerprint of all modules of some rooms, e.g. ``"model"`` and ``"particles"``.

    It has 20 hexadecimal digits. A process computes it once, in some milliseconds.
    """
    sources = (each for room in rooms for each in _sources(files(f"crazybilliards.{room}")))
    return fingerprint_of(sources)[:20]


def _sources(folder: Traversable) -> Iterator[Traversable]:
    """Yield modules and tables in a folder, which may lie in a zip archive."""
    for each in folder.iterdir():
        if each.is_dir():
            yield from _sources(each)
        elif each.name.endswith((".py", ".csv")):  # measured errors stand in tables
            yield each
