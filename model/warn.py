"""Warnings for users."""

import sys
import warnings
from typing import Any

import numpy as np


class DivergedWarning(UserWarning):
    """A chain diverged, and averages over time include its growth."""


class DivergedError(RuntimeError):
    """A chain diverged before anything was measured; ``result`` has its status and times."""

    result: Any


def warn_user(message: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the line outside of the package that led here."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back and str(frame.f_globals.get("__name__")).startswith("crazybilliards"):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)


def warn_if_diverged(result: Any, what: str, over_time: bool = False) -> None:
    """Warn of a result of a chain that diverged, unless what is read of it is ``over_time``."""
    status = np.asarray(result.attrs.get("status", result.get("status")))
    if (status == "diverged").any() and not over_time:
        end = result.attrs.get("end_time")  # of a single chain
        at = "see the status" if end is None else f"after t = {end:g}"
        warn_user(
            f"{what}: a chain diverged ({at}), and averages over time include its growth",
            DivergedWarning,
        )
