"""Figure 1: the model."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from crazybilliards.comparison.drawing import COLOURS, panels
from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.study import Results, Study

_DISPLACEMENTS = (-1.3, -0.4, 0.5, 0.3)
_CEILING = 2.7  # height of the anchors


def _draw(results: Results) -> Figure:
    chain = Chain(size=len(_DISPLACEMENTS), gap=1.6)
    figure, [ax] = panels(1, 1, height=1.45)
    for i, (anchor, shift) in enumerate(zip(chain.anchors, _DISPLACEMENTS, strict=True), start=1):
        _draw_spring(ax, anchor, anchor + shift)
        ax.add_patch(Circle((anchor + shift, 0), chain.radius, facecolor="0.93", edgecolor="black"))
        ax.plot([anchor - 0.35, anchor + 0.35], [_CEILING] * 2, color=COLOURS[4], linewidth=2)
        ax.text(anchor, _CEILING + 0.5, rf"$x_{i}^0$", ha="center", color=COLOURS[4])
        ax.text(anchor + shift, 0, rf"$x_{i}$", ha="center", va="center")
    first, second, third, last = chain.anchors
    for start, end, text in (
        (second, third, r"$2R + g$"),
        (first + _DISPLACEMENTS[0], first, r"$\Delta x_1$"),
    ):
        _draw_arrow(ax, start, end, -1.5, lw=0.9, shrinkA=0, shrinkB=0)
        ax.text((start + end) / 2, -2.25, text, ha="center")
    shaken = last + _DISPLACEMENTS[3]
    _draw_arrow(ax, shaken + 1.1, shaken + 2.3, 0, color=COLOURS[0])
    ax.text(shaken + 1.2, 0.5, r"$A\,\xi_4(t)$", color=COLOURS[0])
    ax.axhline(-chain.radius, color="0.6", linewidth=0.8, zorder=0)
    ax.set(xlim=(first - 3, last + 3.4), ylim=(-2.4, 4.1), aspect="equal")
    ax.set_axis_off()
    return figure


def _draw_spring(ax: Axes, anchor: float, centre: float) -> None:
    """Draw a spring of 14 turns from its anchor, above, down to the rod."""
    along = np.concatenate([[0, 0.15], np.linspace(0.15, 0.85, 14), [0.85, 1]])
    zigzag = np.concatenate([[0, 0], np.tile([-0.2, 0.2], 7), [0, 0]])
    x = anchor + (centre - anchor) * along + zigzag
    ax.plot(x, _CEILING - (_CEILING - 1) * along, color="0.35", linewidth=0.9)


def _draw_arrow(ax: Axes, start: float, end: float, height: float, **look: Any) -> None:
    look |= {"arrowstyle": "<->"}
    ax.annotate("", xy=(start, height), xytext=(end, height), arrowprops=look)


MODEL = Study(
    number=1,
    name="model",
    title="The model",
    caption="Rods of radius R, each tied by a damped spring to its own anchor and driven by white "
    "noise of its own. Neighbouring anchors are 2R + g apart. Drawn by code, not to scale.",
    draw=_draw,
)
