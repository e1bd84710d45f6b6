"""The fingerprint of source code shows whether the current code computed a stored result.

The version of the package cannot show this, because it does not change when the code is edited
between two releases. A release has the same fingerprint on every machine.
"""

import hashlib
from functools import cache
from pathlib import Path

_ROOT = Path(__file__).parents[1]


@cache
def room_fingerprint(*rooms: str) -> str:
    """Return 20 digits of a hash of all modules and tables of rooms, ``"model"`` for example."""
    hashed = hashlib.sha256()
    files = (each for room in rooms for each in (_ROOT / room).rglob("*.*"))
    kept = (each for each in files if "/." not in each.relative_to(_ROOT).as_posix())  # not hidden
    for file in sorted(each for each in kept if each.suffix in (".py", ".csv")):
        hashed.update(file.name.encode() + hashlib.sha256(file.read_bytes()).digest())
    return hashed.hexdigest()[:20]
