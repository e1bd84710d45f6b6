"""Locks: one process at a time keeps a checkpoint or fills a folder.

The operating system frees a lock when the process ends, however it ends (package filelock).
"""

import errno
import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout


def hidden_beside(path: Path, ending: str) -> Path:
    """Return a name beside a file, of a link the file that it names; a hash if that is long."""
    path = Path(os.path.realpath(path))
    long = len(os.fsencode(path.name)) > 120  # bytes; an encrypted disk takes 143, others 255
    name = hashlib.sha256(os.fsencode(path.name)).hexdigest() if long else path.name
    return path.with_name(f".{name}.{ending}")


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold the lock of a file, or of an existing folder, within the ``with`` block.

    Raises a BlockingIOError if another process, or another thread of this one, holds the lock.
    """
    file = path / ".lock" if path.is_dir() else hidden_beside(path, "lock")
    file.touch()  # filelock would wait where no file can be made
    try:
        with FileLock(file, timeout=0.1, poll_interval=0.01):
            try:
                yield
            finally:
                with suppress(PermissionError):  # on Windows, where filelock removes it
                    file.unlink(missing_ok=True)
    except Timeout as error:
        message = f"in use by another process, which holds {file.name}; wait until it has ended"
        raise BlockingIOError(errno.EAGAIN, message, str(path)) from error
