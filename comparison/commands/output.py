"""What the commands share: reading lists of numbers, folders, figures, and the exit status.

Standard library and typer only up here, so that ``--help`` answers at once.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from matplotlib.figure import Figure

INTERRUPTED = 130


def numbers(name: str, text: str) -> list[float]:
    """Read numbers separated by commas."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError as error:
        from crazybilliards.model.checks import shown

        message = f"{name} takes numbers separated by commas, got {shown(text)}"
        raise ValueError(message) from error


def check_folder(path: Path) -> None:
    """Raise, before any work, if ``path`` cannot become or is not a folder to write to."""
    existing = next(each for each in (path, *path.absolute().parents) if each.exists())
    if not existing.is_dir():
        raise ValueError(f"output must be a folder, but {existing} is a file")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise ValueError(f"output: no permission to write to {existing}")


def write_figures(folder: Path, suffix: str, **figures: Figure) -> None:
    """Write pictures, none of them half, and say so."""
    from io import BytesIO

    from crazybilliards.model.storage import write_atomically

    for name, figure in figures.items():
        picture = BytesIO()
        figure.savefig(picture, format="png", dpi=150)
        path = folder / f"{name}{suffix}.png"
        write_atomically(path, picture.getvalue())
        print(f"wrote {path}")


def exit_unless_completed(status: str) -> None:
    """End the command with the status that tells a shell what happened."""
    if status == "interrupted":
        raise typer.Exit(INTERRUPTED)
    if status != "completed":
        raise typer.Exit(1)
