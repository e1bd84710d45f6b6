"""Films of rods, of a run or of a chain, and of the densities of a relaxation.

matplotlib draws them (``FuncAnimation``) and writes them, as mp4, gif or a page with buttons.
"""

from __future__ import annotations

import math
import os
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib import animation
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import CenteredNorm
from numpy.typing import NDArray

from crazybilliards.comparison.drawing import DIRECTIONS
from crazybilliards.comparison.side_by_side.relaxation_figures import relaxation_animation
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.arrays import Array
from crazybilliards.model.checks import check_path, check_real
from crazybilliards.model.parameters import WALLS_AND_MASSES
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.storage import write_atomically
from crazybilliards.particles import simulate

_A_SECOND = 25  # pictures
_FINER = 4  # snapshots for one picture, of a chain that is simulated
_FADING = 0.7  # of a flash, from one picture to the next
_GROUND, _TALL, _LOW = -0.95, 0.5, 0.25  # heights of the anchors and of the two kinds of rods
_LOOK: Any = {"font.size": 12} | {f"axes.spines.{side}": False for side in ("left", "top", "right")}
_GREY = "#777777"


class Player:
    """A film in HTML, which a notebook shows; ``html`` is the text."""

    def __init__(self, html: str) -> None:
        self.html = html

    def _repr_html_(self) -> str:
        return self.html


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

    Every rod is drawn in its place, 2R long, in the colour of its velocity: orange moves to the
    right, blue to the left. A bar flashes where two rods met since the last picture: where they
    approached in one snapshot and separate in the next, and a straight flight would have led them
    through one another. The walls of a box are drawn, and of two masses the heavier rods are
    taller. A relaxation is shown by its smoothed densities, of the simulation and of all theories.

    Parameters
    ----------
    run
        A result with snapshots, e.g. ``simulate(chain, observe="snapshots", duration=20,
        every=0.02)``, of which the first replica is shown. Or what ``compare_relaxation`` returns.
        Or a chain: ``duration`` of its steady state is simulated.
    path
        The file, whose name ends in ``.mp4``, ``.gif`` or ``.html``. None: a player for a notebook.
        An mp4 needs ffmpeg, which ``pip install 'crazybilliards[film]'`` brings.
    seconds
        Length of the film at 25 pictures a second; it is shorter if there are fewer snapshots.
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
    if suffix == ".mp4" and not _has_ffmpeg():
        raise ValueError(
            "a film as mp4 needs ffmpeg, which was not found: pip install 'crazybilliards[film]' "
            "brings it, and a name that ends in .gif or .html needs none"
        )
    if duration is not None and not isinstance(run, Chain):
        raise ValueError("duration is that of a chain to simulate, and this result has its own")
    pictures = max(round(_A_SECOND * check_real("seconds", seconds, positive=True)), 1)
    if isinstance(run, Chain):
        duration = check_real("duration", 20.0 if duration is None else duration, positive=True)
        every = duration / (_FINER * pictures)
        run = simulate(
            run, duration=duration, every=every, observe="snapshots", progress=progress
        ).pipe(lambda each: each.assign_coords(time=each.time - each.time[0]))
        if run.attrs["status"] == "diverged":
            raise ValueError("run: this chain has no steady state to film: its simulation diverged")
    draw = relaxation_animation if isinstance(run, xr.DataTree) else _rod_animation
    with plt.rc_context(_LOOK):
        moving, number = draw(run, pictures, *([springs] if draw is _rod_animation else []))
        with progress_bar(progress, desc="film", total=number, leave=False) as bar:
            content = written(moving, suffix, lambda *_: bar.update())
    plt.close(moving._fig)
    if file is None:
        return Player(content.decode())
    write_atomically(file, content)
    return file


def written(moving: animation.Animation, suffix: str, drawn: Any = None) -> bytes:
    """Return an animation as the content of a file whose name has this ending."""
    writer: animation.AbstractMovieWriter
    if suffix == ".mp4":
        writer = animation.FFMpegWriter(_A_SECOND, "h264", extra_args=["-pix_fmt", "yuv420p"])
    elif suffix == ".gif":
        writer = animation.PillowWriter(_A_SECOND)
    else:
        writer = animation.HTMLWriter(_A_SECOND, embed_frames=True, default_mode="loop")
    with tempfile.TemporaryDirectory() as scratch:
        moving.save(f"{scratch}/film{suffix}", writer, dpi=100, progress_callback=drawn)
        return Path(scratch, f"film{suffix}").read_bytes()


def _has_ffmpeg() -> bool:
    if find_spec("imageio_ffmpeg"):
        import imageio_ffmpeg

        plt.rcParams["animation.ffmpeg_path"] = imageio_ffmpeg.get_ffmpeg_exe()
    return animation.FFMpegWriter.isAvailable()


def _rod_animation(
    run: xr.Dataset, pictures: int, springs: bool
) -> tuple[animation.FuncAnimation, int]:
    """Return the film of a run with snapshots, and its number of pictures."""
    if not {"position", "velocity"} <= set(run) or {"time", "particle"} - set(run.position.dims):
        raise ValueError(
            "run has no snapshots in time, which simulate(chain, observe='snapshots') records; it "
            f"has {', '.join(map(str, run)) or 'nothing'} and is {run.attrs.get('status')}"
        )
    chain = chain_of(run)
    chain.require_known("film", WALLS_AND_MASSES)
    run = run.isel(replica=0) if "replica" in run.dims else run
    rods = run.dropna("time", subset=["velocity"]).transpose("time", "particle", ...)
    time, x, v = rods.time.values, rods.position.values, rods.velocity.values
    if time.size == 0:
        raise ValueError("run has no snapshot in which all velocities are known")
    chosen = np.unique(np.linspace(0, time.size - 1, pictures).round().astype(int))
    number = rods.particle.values.astype(int) - 1
    flash = _flashes(_met(chain, time, x, v) & (np.diff(number) == 1), chosen)
    anchors = chain.anchors[number] if springs else np.empty(0)
    tall = np.where(chain.rod_masses < chain.rod_masses.max(), _LOW, _TALL)[number]

    figure, ax = plt.subplots(figsize=(9.6, 2.4), layout="constrained")
    fastest = float(np.quantile(np.abs(v), 0.99)) or 1.0
    bodies = PolyCollection([], cmap=DIRECTIONS, edgecolor="black", linewidth=0.4)
    bodies.set_norm(CenteredNorm(halfrange=fastest))
    lines = ax.add_collection(LineCollection([], color=_GREY, linewidth=1))
    ax.add_collection(bodies)
    bars = ax.scatter([], [], marker="_", linewidths=3, color=plt.rcParams["text.color"])
    clock = ax.text(0.0, 1.04, "", transform=ax.transAxes)
    R, width = chain.radius, _furnish(ax, chain, x, anchors)
    figure.colorbar(bodies, ax=ax, label="velocity $v$ [R/T]", pad=0.01, extend="both")
    half = max(R, width / 1500)  # a thinner rod would not be seen
    digits = max(2, math.ceil(-math.log10(np.ptp(time) / time.size or 1.0)))

    def show(picture: int) -> None:
        now = chosen[picture]
        sides = x[now][:, np.newaxis] + half * np.array([-1, 1, 1, -1])
        heights = np.multiply.outer(tall, [-1, -1, 1, 1])
        bodies.set_verts(list(np.stack([sides, heights], axis=-1)))
        bodies.set_array(v[now])
        if springs:
            levels = np.stack([np.full(number.size, _GROUND), -tall], axis=-1)
            ends = np.stack([anchors, x[now]], axis=-1)
            lines.set_segments(list(np.stack([ends, levels], axis=-1)))
        bars.set_offsets(np.column_stack([x[now][:-1] + R, np.full(number.size - 1, 0.75)]))
        bars.set_sizes(120 * flash[picture])
        clock.set_text(f"t = {time[now]:.{digits}f} T")
        if picture:  # after the first picture nothing moves
            figure.set_layout_engine("none")

    return animation.FuncAnimation(figure, show, chosen.size, repeat=False), chosen.size


def _met(chain: Chain, time: Array, x: Array, v: Array) -> NDArray[np.bool_]:
    """Return which neighbours turned round between snapshots where a straight flight crosses.

    Noise makes either sign alone see a tenth too many.
    """
    gap, apart = np.diff(x) - 2 * chain.radius, np.diff(v)
    step = np.diff(time)[:, np.newaxis]
    crossed = (gap[:-1] + apart[:-1] * step < 0) | (gap[1:] - apart[1:] * step < 0)
    return crossed & (apart[:-1] < 0) & (apart[1:] > 0)


def _flashes(met: NDArray[np.bool_], chosen: NDArray[np.int64]) -> Array:
    """Return 1 where two rods met since the last picture, and less in each later one."""
    flash = np.zeros((chosen.size, met.shape[1]))
    for now in range(1, chosen.size):
        just = met[chosen[now - 1] : chosen[now]].any(axis=0)
        flash[now] = np.where(just, 1.0, _FADING * flash[now - 1])
    return flash


def _furnish(ax: Axes, chain: Chain, x: Array, anchors: Array) -> float:
    """Draw what does not move, the axes, walls and anchors, and return how much is seen [R]."""
    R, ratio = chain.radius, chain.mass_ratio
    walls = [-chain.box / 2, chain.box / 2] if chain.box else []
    seen = np.concatenate([x.ravel(), anchors, walls])
    ax.set(xlim=(seen.min() - 2 * R, seen.max() + 2 * R), ylim=(-1.1, 1.0), yticks=[])
    ax.set_xlabel("position $x$ [R]")
    ax.text(1.0, 1.04, "\N{BLACK RECTANGLE}: two rods have met", ha="right", transform=ax.transAxes)
    if ratio != 1:
        text = f"tall rods: {max(ratio, 1 / ratio):.3g} times the mass of low ones"
        ax.text(0.5, 1.04, text, ha="center", transform=ax.transAxes)
    for wall in walls:
        ax.axvspan(wall, wall + math.copysign(R, wall), color=_GREY)
    ax.plot(anchors, np.full(anchors.size, _GROUND), "^", color=_GREY, markersize=5)
    return float(np.ptp(seen))
