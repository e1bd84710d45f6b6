"""Films of rods, of a run or of a chain, and of the densities of a relaxation."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import xarray as xr

from crazybilliards.comparison.encoding import PICTURES_A_SECOND, Player, encoded, kind_of_film
from crazybilliards.comparison.rod_film import motion_of, rod_pictures
from crazybilliards.comparison.side_by_side.relaxation_figures import relaxation_pictures, title
from crazybilliards.model import Chain
from crazybilliards.model.calls import public
from crazybilliards.model.checks import check_path, check_real
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.storage import make_folder, write_atomically
from crazybilliards.particles import simulate

_LONGEST = 120.0  # s
_FINER = 4  # snapshots for one picture, of a chain that is simulated


@public
def film(
    run: xr.Dataset | xr.DataTree | Chain,
    path: str | os.PathLike[str] | None = None,
    *,
    seconds: float = 10.0,
    duration: float | None = None,
    springs: bool = False,
    progress: bool = True,
) -> Path | Player:
    """Film the rods of a run, or of a chain that is simulated for it, or a relaxation.

    Every rod is drawn in its place, 2R long (a pixel if that is more), in the colour of its
    velocity: orange moves to the right, blue to the left. A bar flashes where two rods met since
    the last picture: where they approached in one snapshot and separate in the next, and a straight
    flight would have led them through one another. The time between snapshots should therefore be
    shorter than that between two collisions of a rod; of several meetings between two snapshots one
    bar is seen. The walls of a box are drawn, and of two masses the heavier rods are taller.

    A relaxation is shown by its smoothed densities, of the simulation and of all theories.

    Parameters
    ----------
    run
        A result with snapshots, e.g. ``simulate(chain, observe="snapshots", duration=20,
        every=0.02)``, of which the first replica is shown. Or what ``compare_relaxation`` returns.
        Or a chain: ``duration`` of its steady state is simulated.
    path
        The file, whose name ends in ``.mp4``, ``.gif`` or ``.html``. None: a player for a notebook.
        An mp4 needs ffmpeg, which ``pip install 'crazybilliards[film]'`` brings. A page and a
        player hold an mp4, or without ffmpeg a gif.
    seconds
        Length of the film, up to 120, with up to 25 pictures a second. A film of rods is shorter if
        there are fewer snapshots, because it always has 25.
    duration
        Time to simulate, of a chain [T]; None: 20. A result has its own.
    springs
        Also draw the anchors, and a line from each to its rod; not of a relaxation.
    progress
        Show a progress bar, on a terminal or in a notebook.

    Returns
    -------
    pathlib.Path or Player
        Where the film was written; or the player, which a notebook shows.

    Raises
    ------
    ValueError
        Before any work: for a result without snapshots, another name, an mp4 without ffmpeg.
        For a chain whose simulation diverges, because it has no steady state.
    OSError
        If the file cannot be written. A former one stays as it was.
    """
    file = None if path is None else check_path("path", path)
    suffix = ".html" if file is None else file.suffix
    if suffix not in (".mp4", ".gif", ".html"):
        raise ValueError(f"path must end in .mp4, .gif or .html, got {file}")
    kind = kind_of_film(suffix)
    if duration is not None and not isinstance(run, Chain):
        raise ValueError(
            "duration is that of a chain to simulate, and this result has its own; "
            "run.isel(time=slice(...)) is a part of it, and seconds the length of the film"
        )
    if springs and isinstance(run, xr.DataTree):
        raise ValueError("springs are drawn of rods, and this relaxation is shown by its densities")
    duration = check_real("duration", 20.0 if duration is None else duration, positive=True)
    seconds = check_real("seconds", seconds, positive=True)
    if seconds > _LONGEST:
        raise ValueError(f"seconds must be at most {_LONGEST:g}, got {seconds:g}")
    pictures = max(round(PICTURES_A_SECOND * seconds), 1)
    if file is not None:
        _require_place(file)
    if isinstance(run, Chain):
        run = _short_run(run, duration, pictures, progress)
    if isinstance(run, xr.DataTree):
        drawn, number = relaxation_pictures(run, pictures)
        heading, a_second = title(run), number / seconds
    else:
        motion = motion_of(run, pictures)
        drawn, number = rod_pictures(motion, springs), motion.time.size
        heading, a_second = f"{motion.chain.size} rods", PICTURES_A_SECOND
    shown = progress_bar(progress, drawn, desc="film", total=number, leave=False)
    content = encoded(iter(shown), kind, a_second)
    if file is None:
        return Player(content, kind)
    if suffix == ".html":
        content = Player(content, kind).page(heading).encode()
    write_atomically(file, content)
    return file


def _short_run(chain: Chain, duration: float, pictures: int, progress: bool) -> xr.Dataset:
    """Simulate a chain with snapshots that are close enough to see collisions in them."""
    run = simulate(
        chain,
        duration=duration,
        every=duration / (_FINER * pictures),
        observe="snapshots",
        progress=progress,
    )
    if run.attrs["status"] == "interrupted":
        raise KeyboardInterrupt
    if run.attrs["status"] == "diverged":
        raise ValueError(
            "run: this chain has no steady state to film: its simulation diverged at "
            f"t = {run.attrs['end_time']:.4g} T"
        )
    return run.assign_coords(time=run.time - run.time[0])


def _require_place(file: Path) -> None:
    """Raise an OSError unless the file can be written, before the work for it."""
    make_folder(file.parent)
    problem = errno.EISDIR if file.is_dir() else errno.EACCES
    if file.is_dir() or not os.access(file.parent, os.W_OK | os.X_OK):
        raise OSError(problem, os.strerror(problem), str(file))
