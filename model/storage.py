"""Saving and loading results: NetCDF files, written atomically and checked when read; locks.

A file is an ordinary NetCDF-4 file followed by a trailer with the SHA-256 of everything before
it (NetCDF readers ignore what follows the data). :func:`load` compares the two before any NetCDF
library sees the bytes, so a damaged or truncated file can never give a wrong result. The sweeps of
version 0.5 and before are classic NetCDF, which is read, too.

By a lock one process at a time keeps a checkpoint or fills a folder. The operating system frees it
when the process ends, however it ends (package filelock).
"""

import errno
import hashlib
import io
import os
import secrets
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np
import xarray as xr
from filelock import FileLock, Timeout

from crazybilliards.model.checks import check_path, require_memory, shown
from crazybilliards.model.process import interrupts_deferred
from crazybilliards.model.vocabulary import check_result
from crazybilliards.model.warn import warn_if_diverged

_CLASSIC, _NETCDF_4 = b"CDF", b"\x89HDF"  # the first bytes of a file
_MARK = b"\ncrazybilliards-1 sha256 "
_TRAILER = len(_MARK) + 64 + 1  # hexadecimal digest and a newline
_LIBRARY = Lock()  # two threads that call the NetCDF library at the same time end the process
_MOST_COMPRESSED = 2000  # times; more than the 1032 of deflate, as a dimension is an array, too


def save(result: xr.Dataset | xr.DataTree, path: str | os.PathLike[str]) -> Path:
    """Write a result, or a tree of them, to a NetCDF file; return its path; warn if one diverged.

    The file appears under its name only when it is complete: an interrupted or failed write leaves
    a former file as it was. Missing folders are made. A symbolic link stays: its file is written.

    Raises
    ------
    ValueError
        If the path does not end in ``.nc``.
    OSError
        If the file cannot be written (no room, no permission).
    """
    path = check_path("path", path)
    if path.suffix != ".nc":
        raise ValueError(f"results are NetCDF files: the name must end in .nc, got {str(path)!r}")
    check_result(result, xr.Dataset | xr.DataTree)
    write_sealed(path, netcdf(result))
    warn_if_diverged(result, str(path))
    return path


def load(path: str | os.PathLike[str]) -> xr.Dataset | Any:
    """Read a result that :func:`save` wrote, all of it into memory, and nothing from other files.

    It is an ``xarray.Dataset``, or an ``xarray.DataTree``, which type checkers take for anything.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is damaged, truncated, too large, or was not written by :func:`save`.
    """
    file = check_path("path", path)
    if file.is_dir():
        raise ValueError(f"{file}: a folder, not a file; load_sweep reads the folder of a sweep")
    return _load(file)


def load_attributes(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read only the attributes of a result that :func:`save` wrote; raises as :func:`load`.

    This is faster than :func:`load`, and the whole file is still checked.
    """
    return dict(_load(check_path("path", path), whole=False).attrs)


def _load(file: Path, whole: bool = True) -> xr.Dataset | xr.DataTree:
    content = read_sealed(file)
    try:
        if content.startswith(_CLASSIC):
            with xr.open_dataset(io.BytesIO(content), engine="scipy") as old:
                old.load()
            # Classic NetCDF has no integers beyond 32 bits, which get their 64 back.
            narrow = [name for name, each in old.variables.items() if each.dtype == np.int32]
            return old.assign({name: old.variables[name].astype(np.int64) for name in narrow})
        with _LIBRARY, interrupts_deferred():
            _require_own_arrays(content)
            if not whole:
                import netCDF4

                with netCDF4.Dataset("attributes", memory=content) as opened:
                    return xr.Dataset(attrs=opened.__dict__)
            with xr.open_datatree(content, engine="netcdf4") as tree:
                for node in tree.subtree:  # tree.load() leaves out variables named like a group
                    node.dataset.load()
    # The libraries may raise anything for a file with a valid checksum that is not NetCDF.
    except Exception as error:
        raise ValueError(f"{file}: not a result, though sealed: {shown(str(error))}") from error
    return tree if tree.children else tree.to_dataset()


def _require_own_arrays(content: bytes) -> None:
    """Raise a ValueError unless an HDF5 file is a tree of arrays that lie in it."""
    import h5py  # takes as long as numpy, and many runs read no file

    links: list[tuple[str, object]] = []
    declared = 0
    with h5py.File(io.BytesIO(content)) as file:
        file.visititems_links(lambda *link: links.append(link))
        for name, link in links:
            # A group that is in itself has two links, and following a link may open another file.
            if not isinstance(link, h5py.HardLink) or h5py.h5o.get_info(file[name].id).rc != 1:
                raise ValueError(f"{name} is a link")
            if isinstance(array := file[name], h5py.Dataset):
                if array.external or array.is_virtual:
                    raise ValueError(f"{name} lies in another file")
                declared += array.nbytes
        if declared > _MOST_COMPRESSED * len(content):
            raise ValueError(f"it is too short for the {declared:.3g} bytes of its arrays")
        require_memory("it", declared)


def netcdf(result: xr.Dataset | xr.DataTree) -> bytes:
    """Return a result as the content of a NetCDF-4 file."""
    dask = sys.modules.get("dask")
    # A worker of a dask cluster would ask the scheduler for a lock, which knows none of bytes.
    threads = dask.config.set(scheduler="threads") if dask else nullcontext()
    with _LIBRARY, interrupts_deferred(), threads:
        content = result.to_netcdf(engine="netcdf4")
    # HDF5 leaves unused room behind the end, whose address stands in its first block.
    end = int.from_bytes(content[28:36], "little") if content[8] in (2, 3) else None
    return bytes(content[:end])


def write_sealed(path: Path, content: bytes) -> None:
    """Write ``content`` and its checksum atomically."""
    write_atomically(path, content + _MARK + hashlib.sha256(content).hexdigest().encode() + b"\n")


def read_sealed(path: Path) -> bytes:
    """Return the content that :func:`write_sealed` wrote; ValueError if it was changed since."""
    if path.exists() and not path.is_file():
        raise ValueError(f"{path}: a folder or a device, not a file")
    require_memory(f"{path}", 2.0 * path.stat().st_size)
    raw = path.read_bytes()
    content, trailer = raw[:-_TRAILER], raw[-_TRAILER:]
    if not trailer.startswith(_MARK):
        saved = "truncated, or not a file that crazybilliards saved"
        if raw.startswith((_CLASSIC, _NETCDF_4)):
            saved += ": without the checksum of crazybilliards.save; xarray.open_dataset reads it"
        raise ValueError(f"{path}: {saved}")
    if trailer[len(_MARK) : -1] != hashlib.sha256(content).hexdigest().encode():
        raise ValueError(f"{path}: damaged, its content does not match its checksum")
    return content


def write_atomically(path: Path, content: bytes | None) -> None:
    """Write ``content`` beside ``path``, then rename: readers see the old file or the new one.

    Of a symbolic link the file that it names is written. None: only try whether it can be written.
    The unfinished file has a name that no other write has. Only a kill leaves it behind. An OSError
    names ``path``.
    """
    target = Path(os.path.realpath(path))
    unfinished = _hidden_beside(path, f"{secrets.token_hex(4)}.part")
    try:
        if target.is_symlink() or (target.exists() and not target.is_file()):
            raise OSError(errno.EISDIR, "a folder, a device or a link to itself, not a file")
        make_folder(target.parent)
        try:
            with open(unfinished, "xb") as file:
                file.write(content or b"")
                file.flush()
                os.fsync(file.fileno())
            if content is not None:
                os.replace(unfinished, target)
        finally:
            unfinished.unlink(missing_ok=True)
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error


def _hidden_beside(path: Path, ending: str) -> Path:
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
    file = path / ".lock" if path.is_dir() else _hidden_beside(path, "lock")
    file.touch()  # filelock would wait where no file can be made
    try:
        with FileLock(file, timeout=0.1, poll_interval=0.01):
            try:
                yield
            finally:
                with suppress(PermissionError):  # on Windows, where filelock removes it
                    file.unlink(missing_ok=True)
    except Timeout as error:
        raise BlockingIOError(
            errno.EAGAIN,
            f"in use by another process, which holds {file.name}; wait until it has ended",
            str(path),
        ) from error


def make_folder(path: Path) -> None:
    """Make a folder and its parents, unless they exist."""
    try:
        Path(os.path.realpath(path)).mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(path)) from error
