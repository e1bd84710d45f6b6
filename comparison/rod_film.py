"""Films of rods: every rod in its place and in the colour of its velocity, collisions flash.

The background is drawn once, and only what moves is drawn in every picture. A film of 250 pictures
therefore takes some seconds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
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

from crazybilliards.comparison.drawing import DIRECTIONS
from crazybilliards.comparison.encoding import Picture
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.arrays import Array
from crazybilliards.model.parameters import WALLS_AND_MASSES

_FADING = 0.7  # of a flash, from one picture to the next
_FAINT = 0.1  # a flash that is not shown any more
_BEYOND = 0.01  # share of the velocities beyond the ends of the colours
_GROUND = -0.95  # where the anchors are
_TALL, _LOW = 0.5, 0.25  # how far a rod reaches up and down, and one of the smaller mass
_BAR, _SMALLEST_BAR = 120.0, 4.0  # square points of the square that a bar crosses
_SIZE = 9.6, 2.4  # inches of 100 dots; the encoder needs even numbers of dots
_LOOK: Any = {"font.size": 12} | {f"axes.spines.{side}": False for side in ("left", "top", "right")}
_SPRING = "#777777"


class Motion(NamedTuple):
    """What the pictures show, each over (picture, rod or pair of neighbours)."""

    chain: Chain
    time: Array
    x: Array
    v: Array
    flash: Array  # 1 where two rods have just met, then fading
    anchors: Array  # over rod
    height: Array  # over rod


def motion_of(run: xr.Dataset, pictures: int) -> Motion:
    """Read the snapshots, and choose those that are shown."""
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
    number = rods.particle.values.astype(int)
    neighbours = np.diff(number) == 1
    flash = np.zeros((chosen.size, x.shape[1] - 1))
    for now in range(1, chosen.size):
        since = slice(chosen[now - 1], chosen[now] + 1)
        just = _met(chain, time[since], x[since], v[since]).any(axis=0) & neighbours
        flash[now] = np.where(just, 1.0, _FADING * flash[now - 1])
    flash[flash < _FAINT] = 0.0
    height = np.where(chain.rod_masses < chain.rod_masses.max(), _LOW, _TALL)
    of_rods = chain.anchors[number - 1], height[number - 1]
    return Motion(chain, time[chosen], x[chosen], v[chosen], flash, *of_rods)


def _met(chain: Chain, time: Array, x: Array, v: Array) -> NDArray[np.bool_]:
    """Return which neighbours turned round between snapshots where a straight flight crosses.

    Noise makes either sign alone see a tenth too many.
    """
    gap, apart = np.diff(x) - 2 * chain.radius, np.diff(v)
    step = np.diff(time)[:, np.newaxis]
    crossed = (gap[:-1] + apart[:-1] * step < 0) | (gap[1:] - apart[1:] * step < 0)
    return crossed & (apart[:-1] < 0) & (apart[1:] > 0)


def rod_pictures(motion: Motion, springs: bool) -> Iterator[Picture]:
    """Draw one picture after the other; with the anchors, and the springs as lines, if wanted."""
    with plt.rc_context(_LOOK):
        yield from _pictures(motion, springs)


def _pictures(motion: Motion, springs: bool) -> Iterator[Picture]:
    """Draw what moves, in one picture after the other, on the same background."""
    figure = Figure(figsize=_SIZE, dpi=100, layout="constrained")
    canvas, ax = FigureCanvasAgg(figure), figure.subplots()
    rods = PolyCollection([], cmap=DIRECTIONS, edgecolor="black")
    fastest = float(np.quantile(np.abs(motion.v), 1 - _BEYOND)) or 1.0
    rods.set_norm(CenteredNorm(halfrange=fastest))
    lines = LineCollection([], color=_SPRING, linewidth=1)
    bars = ax.scatter([], [], marker="_", linewidths=3, color=plt.rcParams["text.color"])
    clock = ax.text(0.0, 1.04, "", transform=ax.transAxes)
    _furnish(ax, motion, springs)
    figure.colorbar(rods, ax=ax, label="velocity $v$ [R/T]", pad=0.01, extend="both")
    moving = [ax.add_collection(lines), ax.add_collection(rods), bars, clock]
    for each in moving:
        each.set_animated(True)
    canvas.draw()
    R = motion.chain.radius
    dots = float(np.ptp(ax.transData.transform([(0, 0), (2 * R, 0)])[:, 0]))
    broad = 0.72 * dots  # of a rod, in points
    half = R * max(1.0, 1 / dots)  # a thinner rod would not be seen
    rods.set_linewidth(min(0.5, broad / 20))
    bar = min(_BAR, max(broad**2, _SMALLEST_BAR))
    background = canvas.copy_from_bbox(figure.bbox)
    digits = _digits(motion.time)
    for time, x, v, flash in zip(motion.time, motion.x, motion.v, motion.flash, strict=True):
        sides = x[:, np.newaxis] + half * np.array([-1, 1, 1, -1])
        heights = np.multiply.outer(motion.height, [-1, -1, 1, 1])
        rods.set_verts(list(np.stack([sides, heights], axis=-1)))
        rods.set_array(v)
        if springs:
            ends = np.stack([motion.anchors, x], axis=-1)
            levels = np.stack([np.full(x.size, _GROUND), -motion.height], axis=-1)
            lines.set_segments(list(np.stack([ends, levels], axis=-1)))
        bars.set_offsets(np.column_stack([x[:-1] + R, np.full(x.size - 1, 0.75)]))
        bars.set_sizes(bar * flash)
        clock.set_text(f"t = {time:.{digits}f} T")
        canvas.restore_region(background)
        for each in moving:
            ax.draw_artist(each)
        yield np.array(canvas.buffer_rgba())


def _digits(time: Array) -> int:
    """Return the decimals of the clock, in which successive pictures differ."""
    step = float(np.ptp(time)) / max(time.size - 1, 1)
    return max(2, math.ceil(-math.log10(step))) if step > 0 else 2


def _furnish(ax: Axes, motion: Motion, springs: bool) -> None:
    """Set what does not move: the axes, the walls, the anchors, what bars and heights mean."""
    R, ratio = motion.chain.radius, motion.chain.mass_ratio
    walls = np.array([-0.5, 0.5] if motion.chain.box else []) * motion.chain.box
    seen = np.concatenate([motion.x.ravel(), motion.anchors if springs else [], walls])
    ax.set(xlim=(seen.min() - 2 * R, seen.max() + 2 * R), ylim=(-1.1, 1.0), yticks=[])
    ax.set_xlabel("position $x$ [R]")
    ax.text(1.0, 1.04, "\N{BLACK RECTANGLE}: two rods have met", ha="right", transform=ax.transAxes)
    if ratio != 1:
        text = f"tall rods: {max(ratio, 1 / ratio):.3g} times the mass of low ones"
        ax.text(0.5, 1.04, text, ha="center", transform=ax.transAxes)
    for wall, beyond in zip(walls, (-1, 1), strict=False):
        ax.axvspan(wall, wall + beyond * R, color=_SPRING)
    if springs:
        ax.plot(motion.anchors, np.full(motion.anchors.size, _GROUND), "^", color=_SPRING, ms=5)
