"""Locks: one process at a time writes a file, keeps a checkpoint or fills a folder.

The operating system holds a lock on an open file and frees it when the process ends, however it
dies: nobody waits for a dead one. What a kill leaves is a small file that the next run takes
over; on NFS the server frees what a lost node held. The package filelock takes these locks, on
Unix and on Windows. Some file systems have none. There work goes on without: files are whole all
the same, only two processes may then do the same work twice.
"""

from __future__ import annotations

import errno
import os
import platform
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout, lock_descriptor

# What the system answers where it cannot lock.
_NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP}
# A lock whose file its former holder removes just then is made anew, at the next attempt [s].
_PATIENCE, _BETWEEN = 0.1, 0.01


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold the lock of a file, or of a folder that exists, against all other processes meanwhile.

    Raises
    ------
    BlockingIOError
        If another process, or another thread of this one, holds it.
    OSError
        If nothing can be written there.
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


def open_locked(path: Path) -> int | None:
    """Open a file to write, made if missing, and lock it; None where there are no locks.

    A file that is renamed while its writer holds the lock cannot be a ``FileLock``. That would
    take the renamed file, which whoever waited finds open, for a lock still to be had; here it is
    told by its name. Windows does not rename open files, so it has no such locks.

    Raises
    ------
    BlockingIOError
        If another process holds it.
    OSError
        If it cannot be opened.
    """
    if sys.platform == "win32":
        return None
    while True:
        # A foreign link of that name must not lead to another file.
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o666)
        try:
            free = lock_descriptor(descriptor, blocking=False)
        except OSError:
            path.unlink(missing_ok=True)
            os.close(descriptor)
            return None
        if free and _is_named(descriptor, path):
            return descriptor
        os.close(descriptor)
        if not free:
            raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN), str(path))
        # Its holder renamed or removed it just then.


def _is_named(descriptor: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), path.lstat())
    except FileNotFoundError:
        return False


def _sign(descriptor: int, file: Path) -> None:
    """Write into the lock whose it is; shows as well that there is room to write."""
    try:
        os.ftruncate(descriptor, 0)
        # Nobody else can read the first byte on Windows, which is the one that is locked.
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
        return "another process"  # which has just ended


def _remove_held(file: Path) -> None:
    """Remove a lock that is held, so that nobody can have taken it over."""
    if sys.platform != "win32":  # where filelock does it, after the file is closed
        file.unlink(missing_ok=True)
