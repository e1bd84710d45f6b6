"""Films of rods, of a run or of a chain, and of the densities of a relaxation: mp4, gif or page."""

import math
import os
import tempfile
from base64 import b64encode
from collections.abc import Callable, Iterable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import animation, rcParams
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import CenteredNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from crazybilliards.comparison.curves import axis_label, unit_label
from crazybilliards.comparison.drawing import DIRECTIONS, TWO_COLUMNS, house_style
from crazybilliards.comparison.side_by_side.relaxation_figures import relaxation_film
from crazybilliards.model import WALLS_AND_MASSES, Array, Chain, chain_of
from crazybilliards.model.checks import check_path, check_real
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.storage import write_atomically
from crazybilliards.particles import simulate

_A_SECOND = 25  # pictures
_FINER = 4  # snapshots for one picture, of a chain that is simulated
_FADING = 0.7  # of a flash, from one picture to the next
_GROUND, _TALL, _LOW = -0.95, 0.5, 0.25  # heights of the anchors and of the two kinds of rods
_GREY = "#777777"
_WRITERS: dict[str, tuple[Callable[..., animation.AbstractMovieWriter], dict[str, Any]]] = {
    ".mp4": (animation.FFMpegWriter, {"codec": "h264"}),
    ".gif": (animation.PillowWriter, {}),
    # All pictures are in a page, however large it is.
    ".html": (
        animation.HTMLWriter,
        {"embed_frames": True, "embed_limit": math.inf, "default_mode": "loop"},
    ),
}


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
    through one another. Of two masses the heavier rods are taller. A relaxation is shown by its
    smoothed densities, of the simulation and of all theories.

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
        Length of the film, about, with up to 25 pictures a second. A film of rods always has 25,
        and is shorter if there are fewer snapshots.
    duration
        Time to simulate, of a chain [t_0]; None: 20.
    springs
        Also draw the anchors, and a line from each to its rod; not of a relaxation.
    progress
        Show a progress bar, on a terminal or in a notebook, elsewhere a line every half minute.

    Returns
    -------
    pathlib.Path or Player
        Where the film was written, or the player.

    Raises
    ------
    ValueError
        Before any work: for a result without snapshots, another name, an mp4 without ffmpeg.
        For a chain whose simulation diverges, because it has no steady state.
    OSError
        If the file cannot be written, before any work.
    subprocess.CalledProcessError
        If ffmpeg fails.
    """
    file = None if path is None else check_path("path", path)
    suffix = ".html" if file is None else file.suffix
    if suffix not in _WRITERS:
        raise ValueError(f"path must end in .mp4, .gif or .html, got {file}")
    if suffix == ".mp4" and not has_ffmpeg():
        raise ValueError(
            "a film as mp4 needs ffmpeg, which was not found: pip install 'crazybilliards[film]' "
            "brings it, and a name that ends in .gif or .html needs none"
        )
    if duration is not None and not isinstance(run, Chain):
        raise ValueError("duration is that of a chain to simulate, and this result has its own")
    seconds = check_real("seconds", seconds, positive=True)
    pictures = max(round(_A_SECOND * seconds), 1)
    if file is not None:
        write_atomically(file, None)
    if isinstance(run, Chain):
        duration = check_real("duration", 20.0 if duration is None else duration, positive=True)
        run = _short_run(run, duration, pictures, progress)
    with house_style():
        if isinstance(run, xr.DataTree):
            figure, show, number = relaxation_film(run, pictures)
            a_second = max(round(number / seconds), 1)
        else:
            figure, show, number = _rod_film(run, pictures, springs)
            a_second = _A_SECOND
        shown = progress_bar(progress, range(number), desc="film", leave=False)
        content = _content(figure, show, shown, suffix, a_second)
    if file is None:
        return Player(content.decode())
    write_atomically(file, content)
    return file


def _short_run(chain: Chain, duration: float, pictures: int, progress: bool) -> xr.Dataset:
    """Simulate a chain with snapshots that are close enough to see collisions in them."""
    every = duration / (_FINER * pictures)
    run = simulate(chain, duration=duration, every=every, observe="snapshots", progress=progress)
    if run.attrs["status"] == "interrupted":
        raise KeyboardInterrupt
    if run.attrs["status"] == "diverged":
        raise ValueError("run: this chain has no steady state to film: its simulation diverged")
    return run.assign_coords(time=run.time - run.time[0])


def _content(
    figure: Figure, show: Callable[[int], None], pictures: Iterable[int], suffix: str, a_second: int
) -> bytes:
    """Return the content of a film with this ending, whose ``pictures`` ``show`` draws.

    A page holds an mp4, which is small, and without ffmpeg all pictures, with buttons.
    """
    if suffix == ".html" and has_ffmpeg():
        video = b64encode(_content(figure, show, pictures, ".mp4", a_second)).decode()
        return (
            f'<video controls loop autoplay muted src="data:video/mp4;base64,{video}"></video>\n'
        ).encode()
    kind, how = _WRITERS[suffix]
    writer = kind(a_second, **how)
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch, f"film{suffix}")
        with writer.saving(figure, str(file), None):
            for picture in pictures:
                show(picture)
                writer.grab_frame()
                figure.set_layout_engine("none")  # what is around them stays where it is
        return file.read_bytes()


def has_ffmpeg() -> bool:
    """Return whether there is an ffmpeg; without another one matplotlib is told our extra's."""
    if not animation.FFMpegWriter.isAvailable() and find_spec("imageio_ffmpeg"):
        rcParams["animation.ffmpeg_path"] = import_module("imageio_ffmpeg").get_ffmpeg_exe()
    return animation.FFMpegWriter.isAvailable()


def _snapshots(run: xr.Dataset) -> xr.Dataset:
    """Return the snapshots of one replica, over time and particle, with known velocities."""
    if not {"position", "velocity"} <= set(run) or {"time", "particle"} - set(run.position.dims):
        raise ValueError(
            "run has no snapshots in time, which simulate(chain, observe='snapshots') records; it "
            f"has {', '.join(map(str, run)) or 'nothing'} and is {run.attrs.get('status')}"
        )
    run = run.isel(replica=0) if "replica" in run.dims else run
    rods = run.dropna("time", subset=["velocity"]).transpose("time", "particle", ...)
    if rods.time.size == 0:
        raise ValueError("run has no snapshot in which all velocities are known")
    return rods


def _rod_film(
    run: xr.Dataset, pictures: int, springs: bool
) -> tuple[Figure, Callable[[int], None], int]:
    """Return a figure of rods, what draws a picture of the film into it, and their number."""
    chain, rods = chain_of(run), _snapshots(run)
    chain.require_known("film", WALLS_AND_MASSES)
    time, x, v = rods.time.values, rods.position.values, rods.velocity.values
    chosen = np.unique(np.linspace(0, time.size - 1, pictures).round().astype(int))
    number = rods.particle.values.astype(int) - 1
    flash = _flashes(_met(chain, time, x, v) & (np.diff(number) == 1), chosen)
    anchors = chain.anchors[number] if springs else np.empty(0)
    tall = np.where(chain.rod_masses < chain.rod_masses.max(), _LOW, _TALL)[number]

    figure = Figure(figsize=(TWO_COLUMNS, 1.8), dpi=120)
    ax = figure.subplots()
    ax.set_xlabel(axis_label(rods.position))
    width = _furnish(ax, chain, x, anchors)
    fastest = float(np.quantile(np.abs(v), 0.99)) or 1.0
    norm = CenteredNorm(halfrange=fastest)
    bodies = PolyCollection([], cmap=DIRECTIONS, norm=norm, edgecolor="black", linewidth=0.4)
    lines = LineCollection([], color=_GREY, linewidth=1)
    ax.add_collection(lines)
    ax.add_collection(bodies)
    bars = ax.scatter([], [], marker="_", linewidths=3, color="black")
    figure.colorbar(bodies, ax=ax, label=axis_label(rods.velocity), pad=0.01, extend="both")
    clock, unit = ax.text(0.0, 1.04, "", transform=ax.transAxes), unit_label(rods.time)
    digits = max(2, math.ceil(-math.log10(np.ptp(time) / time.size or 1.0)))
    half = max(chain.radius, width / 1500)  # a thinner rod would not be seen

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
        met = x[now][:-1] + chain.radius
        bars.set_offsets(np.column_stack([met, np.full(met.size, 0.75)]))
        bars.set_sizes(120 * flash[picture])
        clock.set_text(f"t = {time[now]:.{digits}f} {unit}")

    return figure, show, chosen.size


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
    ax.spines[["left", "top", "right"]].set_visible(False)
    ax.tick_params(top=False)
    ax.text(1.0, 1.04, "\N{BLACK RECTANGLE}: two rods have met", ha="right", transform=ax.transAxes)
    if ratio != 1:
        text = f"tall rods: {max(ratio, 1 / ratio):.3g} times the mass of low ones"
        ax.text(0.5, 1.04, text, ha="center", transform=ax.transAxes)
    for wall in walls:
        ax.axvspan(wall, wall + math.copysign(R, wall), color=_GREY)
    ax.plot(anchors, np.full(anchors.size, _GROUND), "^", color=_GREY, markersize=5)
    return float(np.ptp(seen))
