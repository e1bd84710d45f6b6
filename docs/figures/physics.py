"""Draw the pictures of the physics pages: a collision, isotonic regression, a breathing cloud.

Run it to write collision.svg, isotonic.svg and breathing.svg beside it.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import isotonic_regression

from crazybilliards.comparison.drawing import COLOURS, entitle, house_style, panels
from crazybilliards.kinetic import breathing_cloud
from crazybilliards.model import Chain

HERE = Path(__file__).parent
RADIUS = 1.0
FREE = np.array([0.4, 2.6, 1.8, 1.6, 3.4])  # positions of five points after a free flight
FIRST, SECOND = COLOURS[0], COLOURS[4]


def collision() -> Figure:
    """Draw one elastic collision of rods, of points, and of points that exchange their names."""
    meeting, times = 1.0, np.linspace(0, 2, 3)
    before = np.stack([0.4 + 1.6 * (times - meeting), 0.4 - 0.5 * (times - meeting)])
    points = np.where(times > meeting, before[::-1], before)  # the velocities are exchanged
    figure, axes = panels(1, 3, height=2.5, sharey=True)
    for y, shift, colour in zip(points, (-RADIUS, RADIUS), (FIRST, SECOND), strict=True):
        centre = y + shift
        axes[0].fill_betweenx(
            times, centre - RADIUS, centre + RADIUS, color=colour, alpha=0.25, linewidth=0
        )
        axes[0].plot(centre, times, color=colour)
        axes[1].plot(y, times, color=colour)
    for y, colour in zip(before, (FIRST, SECOND), strict=True):
        axes[2].plot(y, times, color=colour)
    titles = ("two rods", "two points that bounce", "the points, relabelled")
    for ax, title, name in zip(axes, titles, ("x", "y", "y"), strict=True):
        entitle(ax, title)
        ax.set(xlabel=f"position ${name}$", xticks=[], yticks=[])
    axes[0].set_ylabel("time")
    return figure


def isotonic() -> Figure:
    """Draw how neighbours in the wrong order are pooled, until five points are in order."""
    stages = (
        ("free positions", FREE),
        ("2 and 3 are pooled", _pooled(1, 3)),
        ("4 joins the block", _pooled(1, 4)),
    )
    assert np.allclose(stages[-1][1], isotonic_regression(FREE).x)
    figure, axes = panels(1, 3, sharey=True)
    number = np.arange(1, FREE.size + 1)
    for ax, (title, z) in zip(axes, stages, strict=True):
        ax.plot(number, FREE, "x", color="black")
        for value in np.unique(z):
            block = number[z == value]
            ends = [block[0] - 0.2, block[-1] + 0.2]
            ax.plot(ends, [value, value], color=FIRST, linewidth=2, zorder=0)
            ax.plot(block, np.full(block.size, value), "o", color=FIRST, zorder=0)
        for i in np.flatnonzero(z[1:] < z[:-1]):
            ax.plot(number[i : i + 2], z[i : i + 2], color=SECOND, linestyle="--", zorder=0)
        entitle(ax, title)
        ax.set(xlabel="point $i$", xticks=number)
    axes[0].set_ylabel("position")
    return figure


def _pooled(start: int, stop: int) -> np.ndarray:
    z = FREE.copy()
    z[start:stop] = FREE[start:stop].mean()
    return z


def breathing() -> Figure:
    """Draw the mean positions of a compressed cloud of 20 points, its width and temperature."""
    chain = Chain(size=20)
    s, period = chain.thermal_length, 2 * np.pi * np.sqrt(chain.mass / chain.stiffness)
    cloud = breathing_cloud(chain, duration=3 * period, stretch=0.3)
    time = cloud.time / period
    figure, (left, right) = panels(1, 2, height=2.5)
    left.plot(time, cloud.mean_displacement / s, color=FIRST, linewidth=0.8)
    left.set(xlabel=r"time $\omega_0 t/2\pi$", ylabel="mean positions $y_i/s$")
    right.plot(time, cloud.cloud_width / s, color=FIRST, label=r"width $\sigma/s$")
    local_width = np.sqrt(cloud.velocity_variance) / chain.free_velocity_width
    right.plot(time, local_width, color=SECOND, label="velocity width, relative")
    right.axhline(1, color="0.6", linewidth=0.8, zorder=0)
    right.set(xlabel=r"time $\omega_0 t/2\pi$", ylim=(0, None))
    right.legend()
    for ax in (left, right):
        ax.margins(x=0)
    return figure


if __name__ == "__main__":
    with house_style():
        for draw in (collision, isotonic, breathing):
            # Without the date it is the same file every time.
            draw().savefig(HERE / f"{draw.__name__}.svg", metadata={"Date": None})
