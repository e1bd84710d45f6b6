"""Saving and loading results: NetCDF files, written atomically and checked when read.

A file is an ordinary NetCDF file followed by a trailer with the SHA-256 of everything before
it (NetCDF readers ignore what follows the data). :func:`load` compares the two before any
NetCDF library sees the bytes, so a damaged or truncated file can never give a wrong result.

Files are NetCDF-4. The sweeps of version 0.5 and before are classic NetCDF, which is read, too.
"""

from __future__ import annotations

import errno
import hashlib
import io
import os
import secrets
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray as xr

from crazybilliards.model.checks import check_path

_CLASSIC, _NETCDF_4 = b"CDF", b"\x89HDF"  # the first bytes of a file
_MARK = b"\ncrazybilliards-1 sha256 "
_TRAILER = len(_MARK) + 64 + 1  # hexadecimal digest and a newline


def save(result: xr.Dataset | xr.DataTree, path: str | os.PathLike[str]) -> Path:
    """Write a result, or a tree of results, to a NetCDF file; return its path.

    The file appears under its name only when it is complete: an interrupted or failed write
    leaves a former file as it was. Missing folders are made.

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
    write_sealed(path, netcdf(result))
    return path


def load(path: str | os.PathLike[str]) -> xr.Dataset | xr.DataTree:
    """Read a result that :func:`save` wrote, all of it into memory.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is damaged, truncated, or was not written by :func:`save`.
    """
    file = check_path("path", path)
    if file.is_dir():
        raise ValueError(f"{file}: a folder, not a file; load_sweep reads the folder of a sweep")
    content = read_sealed(file)
    try:
        if content.startswith(_CLASSIC):
            return _load_classic(content)
        tree = xr.open_datatree(io.BytesIO(content), engine="h5netcdf").load()
    # The libraries may raise anything for a file with a valid checksum that is not NetCDF.
    except Exception as error:
        raise ValueError(f"{path}: not a result, though crazybilliards wrote it") from error
    tree.close()
    return tree if tree.children else tree.to_dataset()


def load_attributes(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read only the attributes of a result that :func:`save` wrote; raises as :func:`load`.

    This is faster than :func:`load`, and the whole file is still checked.
    """
    content = read_sealed(check_path("path", path))
    try:
        if content.startswith(_CLASSIC):
            return dict(_load_classic(content).attrs)
        with h5py.File(io.BytesIO(content)) as file:
            return dict(file.attrs)
    except Exception as error:
        raise ValueError(f"{path}: not a result, though crazybilliards wrote it") from error


def netcdf(result: xr.Dataset | xr.DataTree) -> bytes:
    """Return a result as the content of a NetCDF-4 file."""
    dask = sys.modules.get("dask")
    # A worker of a dask cluster would ask the scheduler for a lock, which knows none of bytes.
    with dask.config.set(scheduler="threads") if dask else nullcontext():
        return bytes(result.to_netcdf(engine="h5netcdf"))


def _load_classic(content: bytes) -> xr.Dataset:
    """Return a result; classic NetCDF has no integers beyond 32 bits, which get their 64 back."""
    with xr.open_dataset(io.BytesIO(content), engine="scipy") as file:
        result = file.load()
    narrow = [name for name, values in result.variables.items() if values.dtype == np.int32]
    return result.assign({name: result.variables[name].astype(np.int64) for name in narrow})


def write_sealed(path: Path, content: bytes) -> None:
    """Write ``content`` and its checksum atomically."""
    digest = hashlib.sha256(content).hexdigest().encode()
    write_atomically(path, content + _MARK + digest + b"\n")


def read_sealed(path: Path) -> bytes:
    """Return the content that :func:`write_sealed` wrote; ValueError if it was changed since."""
    if path.exists() and not path.is_file():
        raise ValueError(f"{path}: a folder or a device, not a file")
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


def write_atomically(path: Path, content: bytes) -> None:
    """Write ``content`` beside ``path``, then rename: readers see the old file or the new one.

    The unfinished file has a name that no other write has, and is removed if writing fails. A kill
    leaves it behind.

    Raises
    ------
    OSError
        If it cannot be written, naming ``path``; a former file stays as it was.
    """
    unfinished = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        make_folder(path.parent)
        try:
            with open(unfinished, "xb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            os.replace(unfinished, path)
        except BaseException:
            unfinished.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error


def make_folder(path: Path) -> None:
    """Make a folder and its parents, unless they exist."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(path)) from error
