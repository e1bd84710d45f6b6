"""Locks: one process at a time keeps a checkpoint or fills a folder.

The operating system holds a lock on an open file and frees it when the process ends, however it
ends. A dead process therefore blocks nobody. A kill leaves a small lock file, which the next run
takes over. On NFS the server frees the locks of a lost node. The package filelock takes the locks,
on Unix and on Windows. Some file systems have no locks. There two processes may do the same work
twice, but every file is still complete.
"""

from __future__ import annotations

import errno
import os
import platform
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

# Errors of file systems without locks.
_NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP}
# If the former holder removes the lock file at that moment, the next attempt makes a new one [s].
_PATIENCE, _BETWEEN = 0.1, 0.01


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold the lock of a file, or of an existing folder, within the ``with`` block.

    Raises
    ------
    BlockingIOError
        If another process, or another thread of this one, holds the lock.
    OSError
        If the lock file cannot be written.
    """
    file = path / ".lock" if path.is_dir() else path.with_name(f".{path.name}.lock")
    lock = FileLock(
        file,
        timeout=_PATIENCE,
        poll_interval=_BETWEEN,
        fallback_to_soft=False,
        on_acquired=lambda descriptor: _sign(descriptor, file),
    )
    try:
        held = lock.acquire()
    except Timeout as error:
        message = f"in use by {_owner(file)}; wait until it has ended, or take another name"
        raise BlockingIOError(errno.EAGAIN, message, str(path)) from error
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise
        file.unlink(missing_ok=True)
        yield
        return
    with held:
        try:
            yield
        finally:
            _remove_held(file)


def _sign(descriptor: int, file: Path) -> None:
    """Write the owner into the lock file. This also shows that the disk has room."""
    try:
        os.ftruncate(descriptor, 0)
        # On Windows the first byte is locked and no other process can read it.
        os.write(descriptor, f"\nprocess {os.getpid()} on {platform.node()}".encode())
    except OSError as error:
        _remove_held(file)
        raise OSError(error.errno, error.strerror, str(file)) from error


def _owner(file: Path) -> str:
    try:
        with file.open("rb", buffering=0) as content:
            content.seek(1)
            return content.read().decode(errors="replace") or "another process"
    except OSError:
        return "another process"  # it has just ended


def _remove_held(file: Path) -> None:
    """Remove a lock file while its lock is held, so that nobody can have taken it over."""
    if sys.platform != "win32":  # there filelock removes it after closing the file
        file.unlink(missing_ok=True)
