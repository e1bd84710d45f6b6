"""Locks: one process at a time keeps a checkpoint or fills a folder.

The operating system frees a lock when the process ends, however it ends (package filelock).
"""

from __future__ import annotations

import errno
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold the lock of a file, or of an existing folder, within the ``with`` block.

    Raises a BlockingIOError if another process, or another thread of this one, holds the lock.
    """
    file = path / ".lock" if path.is_dir() else path.with_name(f".{path.name}.lock")
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
