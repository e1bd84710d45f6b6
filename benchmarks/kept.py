"""Results that are computed once and kept in files."""

from collections.abc import Callable
from pathlib import Path

import xarray as xr

from crazybilliards.model import load, save


def kept_or_made(path: Path, make: Callable[[], xr.Dataset]) -> xr.Dataset:
    """Return the result in a file, or make it and write the file.

    Exits as :func:`complete` does if the result is incomplete; there is no file then.
    """
    if not path.exists():
        save(complete(make()), path)
    return load(path)


def complete(result: xr.Dataset) -> xr.Dataset:
    """Return a result, or exit with a message if it was interrupted or has diverged.

    Such a run has larger errors than the tables say, and nobody would see that in its file.
    """
    status = result.attrs.get("status", "completed")
    if status != "completed":
        raise SystemExit(
            f"{status}: the unfinished result is not kept; start again, from the checkpoint if "
            "there is one"
        )
    return result
