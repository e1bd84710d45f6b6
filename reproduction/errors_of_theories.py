"""Drawing errors of W_v against the restitution, on axes that show small and large ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes

from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.model import Chain

_LINEAR = 2.0  # per cent; the axis is linear up to there, and logarithmic beyond
_LABELLED = (-50, -20, -10, -5, -2, 0, 2, 5)
# Even steps in the linear part, decades beyond: they show where the axis changes.
_UNLABELLED = (-40, -30, *range(-9, -2), *np.arange(-1.5, 2, 0.5), 3, 4, 6, 7)
_TICKS = (0, 0.5, 0.75, 0.9, 0.98, 1)
_DRIVEN = 0.14  # where e > 1 stands, beyond the break of the axis
_MARKERS_OF_DRIVEN = {30: "x", 60: "+", 100: "*"}
_DRIVEN_COLOUR = "0.45"
_LEFT = -1.13  # end of the axis


class Error(NamedTuple):
    """Errors of W_v of one chain, and the standard errors of its simulation, in per cent."""

    chain: Chain
    centre: float
    border: float
    centre_error: float
    border_error: float
    held_out: bool

    @property
    def driven(self) -> bool:
        """Whether collisions add energy."""
        return self.chain.restitution > 1

    @property
    def place(self) -> float:
        """Where its restitution stands on the axis, which is linear in sqrt(1 - e)."""
        return _DRIVEN if self.driven else -float(np.sqrt(1 - self.chain.restitution))


def draw_errors(ax: Axes, errors: Sequence[Error], which: str, sizes: Sequence[int]) -> None:
    """Draw the errors in the ``"centre"`` or at the ``"border"``.

    A line for each of the sizes, and one symbol for chains held out, whatever their size.
    """
    of_sizes = {
        f"$L = {size}$": [
            each
            for each in errors
            if each.chain.size == size and not each.driven and not each.held_out
        ]
        for size in sizes
    }
    held_out = [each for each in errors if each.held_out]
    for number, (label, found) in enumerate([*of_sizes.items(), ("held out", held_out)]):
        shown = sorted(found, key=lambda each: each.place)
        if not shown:
            continue
        draw_points(
            ax,
            [each.place for each in shown],
            [getattr(each, which) for each in shown],
            [getattr(each, f"{which}_error") for each in shown],
            number=number,
            label=label,
            markerfacecolor=COLOURS[number] if found is held_out else "none",
            linestyle="none" if found is held_out else "-",
            linewidth=0.8,
        )
    for each in (each for each in errors if each.driven):
        value, error = getattr(each, which), getattr(each, f"{which}_error")
        chain = each.chain
        ax.errorbar(
            each.place,
            value,
            error,
            marker=_MARKERS_OF_DRIVEN[chain.size],
            markersize=5,
            label=rf"$L = {chain.size}$, $\gamma = {chain.damping:g}$",
            color=_DRIVEN_COLOUR,
            markerfacecolor="none",
            linestyle="none",
        )
    _finish(ax)


def _finish(ax: Axes) -> None:
    """Give a panel its axes, and mark where they change."""
    ax.axhspan(-_LINEAR, _LINEAR, color="0.93", zorder=0)
    ax.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    ax.set_yscale("symlog", linthresh=_LINEAR)
    ax.set_yticks(_LABELLED)
    ax.set_yticks(_UNLABELLED, minor=True)
    ax.yaxis.set_major_formatter(lambda value, _: f"{value:+g}" if value else "0")
    ax.yaxis.set_minor_formatter("")
    ax.set_ylim(-60, 8)
    for y, scale in ((4, "log."), (0, "linear"), (-11, "logarithmic")):
        ax.text(_LEFT + 0.035, y, scale, rotation="vertical", va="center", color="0.4")
    ax.set_xticks(
        [*(-np.sqrt(1 - np.array(_TICKS))), _DRIVEN], [*(f"{e:g}" for e in _TICKS), "1.05"]
    )
    ax.set_xlim(_LEFT, 1.5 * _DRIVEN)
    for y in (0, 1):
        ax.text(
            _DRIVEN / 2,
            y,
            "//",
            transform=ax.get_xaxis_transform(),
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0},
            ha="center",
            va="center",
        )
