"""Fingerprints of source code: they tell whether a stored thing was made by the code of today.

The version of the package does not tell it: between two releases it stays the same whatever is
edited. A fingerprint is a hash of the source files themselves. An installed release has the same
one wherever it is installed, so what it has computed stays valid.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]


def fingerprint_of(sources: Iterable[Path], *others: str) -> str:
    """Return a hash of the content of files, in any order, and of further text."""
    hashed = hashlib.sha256("\0".join(others).encode())
    for content in sorted(_content(source) for source in sources):
        hashed.update(content)
    return hashed.hexdigest()


@cache
def room_fingerprint(*rooms: str) -> str:
    """Return the fingerprint of all modules of some rooms, ``"model"`` and ``"particles"`` say.

    20 hexadecimal digits; computed once in a process, in some milliseconds.
    """
    return fingerprint_of(file for room in rooms for file in (_PACKAGE / room).rglob("*.py"))[:20]


def _content(source: Path) -> bytes:
    """Return the name and the hash of a file."""
    return source.name.encode() + hashlib.sha256(source.read_bytes()).digest()
