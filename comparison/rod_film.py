"""Films of rods: every rod in its place and in the colour of its velocity, collisions flash.

The background is drawn once, and only what moves is drawn in every picture. A film of 250 pictures
therefore takes some seconds.
"""

from __future__ import annotations

import errno
import math
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import CenteredNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from crazybilliards.comparison.encoding import (
    PICTURES_A_SECOND,
    Picture,
    Player,
    encoded,
    kind_of_film,
)
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.arrays import Array
from crazybilliards.model.calls import public
from crazybilliards.model.checks import check_path, check_real
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.storage import make_folder, write_atomically
from crazybilliards.particles import simulate

_LONGEST = 120.0  # s
_FINER = 4  # snapshots for one picture, of a chain that is simulated
_FADING = 0.7  # of a flash, from one picture to the next
_FAINT = 0.1  # a flash that is not shown any more
_BEYOND = 0.01  # share of the velocities beyond the ends of the colours
_GROUND = -0.95  # where the anchors are; a rod reaches from -0.5 to 0.5
_STAR, _SMALLEST_STAR = 120.0, 4.0  # square points
_SIZE = 9.6, 2.4  # inches of 100 dots; the encoder needs even numbers of dots
_LOOK: Any = {"font.size": 12} | {f"axes.spines.{side}": False for side in ("left", "top", "right")}
_COLOURS, _SPRING = "PuOr", "#777777"  # told apart with any colour vision


@public
def film(
    run: xr.Dataset | Chain,
    path: str | os.PathLike[str] | None = None,
    *,
    seconds: float = 10.0,
    duration: float | None = None,
    springs: bool = False,
    progress: bool = True,
) -> Path | Player:
    """Film the rods of a run, or of a chain that is simulated for it.

    Every rod is drawn in its place, 2R long (a pixel if that is more), in the colour of its
    velocity. A star flashes where two rods met since the last picture: where they approached in one
    snapshot and separate in the next, and a straight flight would have led them through one
    another. The time between snapshots should therefore be shorter than that between two collisions
    of a rod; of several meetings between two snapshots one star is seen.

    Parameters
    ----------
    run
        A result with snapshots, e.g. ``simulate(chain, observe="snapshots", duration=20,
        every=0.02)``, of which the first replica is shown. Or a chain: ``duration`` of its steady
        state is simulated.
    path
        The file, whose name ends in ``.mp4``, ``.gif`` or ``.html``. None: a player for a notebook.
        An mp4 needs ffmpeg, which ``pip install 'crazybilliards[film]'`` brings. A page and a
        player hold an mp4, or without ffmpeg a gif.
    seconds
        Length of the film, up to 120. It is shorter if there are fewer snapshots than its 25
        pictures a second.
    duration
        Time to simulate, of a chain [T]; None: 20. A result has its own.
    springs
        Also draw the anchors, and a line from each to its rod.
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
    duration = check_real("duration", 20.0 if duration is None else duration, positive=True)
    seconds = check_real("seconds", seconds, positive=True)
    if seconds > _LONGEST:
        raise ValueError(f"seconds must be at most {_LONGEST:g}, got {seconds:g}")
    pictures = max(round(PICTURES_A_SECOND * seconds), 1)
    if file is not None:
        _require_place(file)
    if isinstance(run, Chain):
        run = _short_run(run, duration, pictures, progress)
    motion = _motion(run, pictures)
    drawn = _pictures(motion, springs)
    shown = progress_bar(progress, drawn, desc="film", total=motion.time.size, leave=False)
    with plt.rc_context(_LOOK):
        content = encoded(iter(shown), kind)
    if file is None:
        return Player(content, kind)
    if suffix == ".html":
        content = Player(content, kind).page(f"{motion.chain.size} rods").encode()
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


class _Motion(NamedTuple):
    """What the pictures show, each over (picture, rod or pair of neighbours)."""

    chain: Chain
    time: Array
    x: Array
    v: Array
    flash: Array  # 1 where two rods have just met, then fading
    anchors: Array  # over rod


def _motion(run: xr.Dataset, pictures: int) -> _Motion:
    """Read the snapshots, and choose those that are shown."""
    if not {"position", "velocity"} <= set(run) or {"time", "particle"} - set(run.position.dims):
        raise ValueError(
            "run has no snapshots in time, which simulate(chain, observe='snapshots') records; it "
            f"has {', '.join(map(str, run)) or 'nothing'} and is {run.attrs.get('status')}"
        )
    chain = chain_of(run)
    chain.require_known("film")
    run = run.isel(replica=0) if "replica" in run.dims else run
    rods = run.dropna("time", subset=["velocity"]).transpose("time", "particle", ...)
    time, x, v = rods.time.values, rods.position.values, rods.velocity.values
    if time.size == 0:
        raise ValueError("run has no snapshot in which all velocities are known")
    chosen = np.unique(np.linspace(0, time.size - 1, pictures).round().astype(int))
    number = rods.particle.values.astype(int)
    neighbours = np.diff(number) == 1
    flash = np.zeros((chosen.size, x.shape[1] - 1))
    for now in range(1, chosen.size):
        since = slice(chosen[now - 1], chosen[now] + 1)
        just = _met(chain, time[since], x[since], v[since]).any(axis=0) & neighbours
        flash[now] = np.where(just, 1.0, _FADING * flash[now - 1])
    flash[flash < _FAINT] = 0.0
    return _Motion(chain, time[chosen], x[chosen], v[chosen], flash, chain.anchors[number - 1])


def _met(chain: Chain, time: Array, x: Array, v: Array) -> NDArray[np.bool_]:
    """Return which neighbours turned round between snapshots where a straight flight crosses.

    Noise makes either sign alone see a tenth too many.
    """
    gap, apart = np.diff(x) - 2 * chain.radius, np.diff(v)
    step = np.diff(time)[:, np.newaxis]
    crossed = (gap[:-1] + apart[:-1] * step < 0) | (gap[1:] - apart[1:] * step < 0)
    return crossed & (apart[:-1] < 0) & (apart[1:] > 0)


def _pictures(motion: _Motion, springs: bool) -> Iterator[Picture]:
    """Draw one picture after the other on the same background."""
    figure = Figure(figsize=_SIZE, dpi=100, layout="constrained")
    canvas, ax = FigureCanvasAgg(figure), figure.subplots()
    rods = PolyCollection([], cmap=_COLOURS, edgecolor="black")
    fastest = float(np.quantile(np.abs(motion.v), 1 - _BEYOND)) or 1.0
    rods.set_norm(CenteredNorm(halfrange=fastest))
    lines = LineCollection([], color=_SPRING, linewidth=1)
    stars = ax.scatter([], [], marker="*", color=plt.rcParams["text.color"])
    clock = ax.text(0.0, 1.04, "", transform=ax.transAxes)
    _furnish(ax, motion, springs)
    figure.colorbar(rods, ax=ax, label="velocity $v$ [R/T]", pad=0.01, extend="both")
    moving = [ax.add_collection(lines), ax.add_collection(rods), stars, clock]
    for each in moving:
        each.set_animated(True)
    canvas.draw()
    R, low, high = motion.chain.radius, -0.5, 0.5
    dots = float(np.ptp(ax.transData.transform([(0, 0), (2 * R, 0)])[:, 0]))
    broad = 0.72 * dots  # of a rod, in points
    half = R * max(1.0, 1 / dots)  # a thinner rod would not be seen
    rods.set_linewidth(min(0.5, broad / 20))
    star = min(_STAR, max(broad**2, _SMALLEST_STAR))
    background = canvas.copy_from_bbox(figure.bbox)
    digits = _digits(motion.time)
    for time, x, v, flash in zip(motion.time, motion.x, motion.v, motion.flash, strict=True):
        sides = x[:, np.newaxis] + half * np.array([-1, 1, 1, -1])
        heights = np.broadcast_to([low, low, high, high], sides.shape)
        rods.set_verts(list(np.stack([sides, heights], axis=-1)))
        rods.set_array(v)
        if springs:
            ends = np.stack([motion.anchors, x], axis=-1)
            levels = np.broadcast_to([_GROUND, low], ends.shape)
            lines.set_segments(list(np.stack([ends, levels], axis=-1)))
        stars.set_offsets(np.column_stack([x[:-1] + R, np.full(x.size - 1, 0.75)]))
        stars.set_sizes(star * flash)
        clock.set_text(f"t = {time:.{digits}f} T")
        canvas.restore_region(background)
        for each in moving:
            ax.draw_artist(each)
        yield np.array(canvas.buffer_rgba())


def _digits(time: Array) -> int:
    """Return the decimals of the clock, in which successive pictures differ."""
    step = float(np.ptp(time)) / max(time.size - 1, 1)
    return max(2, math.ceil(-math.log10(step))) if step > 0 else 2


def _furnish(ax: Axes, motion: _Motion, springs: bool) -> None:
    """Set what does not move: the axes, the anchors, the meaning of a star."""
    R = motion.chain.radius
    seen = np.concatenate([motion.x.ravel(), motion.anchors if springs else []])
    ax.set(xlim=(seen.min() - 2 * R, seen.max() + 2 * R), ylim=(-1.1, 1.0), yticks=[])
    ax.set_xlabel("position $x$ [R]")
    ax.text(1.0, 1.04, "\N{BLACK STAR}: two rods have met", ha="right", transform=ax.transAxes)
    if springs:
        ax.plot(motion.anchors, np.full(motion.anchors.size, _GROUND), "^", color=_SPRING, ms=5)
