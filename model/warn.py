"""Warnings for users."""

from __future__ import annotations

import sys
import warnings


def warn_user(message: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the line outside of the package that led here."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back and str(frame.f_globals.get("__name__")).startswith("crazybilliards"):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)
