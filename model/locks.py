"""Locks: one process at a time writes a file, keeps a checkpoint or fills a folder.

The operating system holds a lock (flock) on an open file and frees it when the process ends,
however it dies: nobody waits for a dead one. What a kill leaves is a small file that the next run
takes over; on NFS the server frees what a lost node held. Windows and some file systems have no
such locks. There work goes on without: files are whole all the same, only two processes may then
do the same work twice.
"""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

if sys.platform != "win32":
    import fcntl


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
    lock = path / ".lock" if path.is_dir() else path.with_name(f".{path.name}.lock")
    try:
        descriptor = open_locked(lock)
    except BlockingIOError as error:
        message = f"in use by {_owner(lock)}; wait until it has ended, or take another name"
        raise BlockingIOError(error.errno, message, str(path)) from error
    if descriptor is None:
        yield
        return
    try:
        _sign(descriptor, lock)
        yield
    finally:
        lock.unlink(missing_ok=True)  # still held: nobody can have taken it over
        os.close(descriptor)


def open_locked(path: Path) -> int | None:
    """Open a file to write, made if missing, and lock it; None where there are no locks.

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
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(descriptor)
            raise
        except OSError:
            path.unlink(missing_ok=True)
            os.close(descriptor)
            return None
        if _is_named(descriptor, path):
            return descriptor
        os.close(descriptor)  # its holder renamed or removed it just then


def _is_named(descriptor: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), path.lstat())
    except FileNotFoundError:
        return False


def _owner(lock: Path) -> str:
    try:
        return lock.read_text(errors="replace") or "another process"
    except FileNotFoundError:
        return "another process"  # which has just ended


def _sign(descriptor: int, lock: Path) -> None:
    """Write into the lock whose it is; shows as well that there is room to write."""
    try:
        os.ftruncate(descriptor, 0)
        os.write(descriptor, f"process {os.getpid()} on {platform.node()}".encode())
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(lock)) from error
