"""Draw the four rooms: run it, and it writes architecture.svg beside itself."""

from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.patches import FancyBboxPatch

# name: (left, bottom, width, height, colour, what is in it)
ROOMS = {
    "comparison": (
        0.0,
        5.6,
        10.0,
        1.9,
        "#F6DDEB",
        "densities as the paper bins them, fits, deviations, overlays\n"
        "the paper's figures, sweeps, the command line",
    ),
    "particles": (
        0.0,
        2.8,
        4.75,
        1.9,
        "#D5E8F5",
        "collision operators, time stepping\nobservers, replicas, checkpoints",
    ),
    "kinetic": (
        5.25,
        2.8,
        4.75,
        1.9,
        "#FBE8C3",
        "exact equilibrium, force balance\nhydrodynamics, kinetic equation",
    ),
    "model": (
        0.0,
        0.0,
        10.0,
        1.9,
        "#D4EFE6",
        "the chain and its scales, the reduced coordinate\n"
        "the vocabulary of results, checked files",
    ),
}
# from, to, where along the line
ARROWS = (
    ("comparison", "particles", 2.4),
    ("comparison", "kinetic", 7.6),
    ("comparison", "model", 5.0),
    ("particles", "model", 2.4),
    ("kinetic", "model", 7.6),
)


def draw() -> plt.Figure:
    """Return the figure."""
    figure, ax = plt.subplots(figsize=(7, 5.2))
    ax.set(xlim=(-0.1, 10.1), ylim=(-0.1, 7.6))
    ax.axis("off")
    for name, (left, bottom, width, height, colour, text) in ROOMS.items():
        box = FancyBboxPatch(
            (left + 0.1, bottom + 0.1),
            width - 0.2,
            height - 0.2,
            boxstyle="round,pad=0.1",
            facecolor=colour,
            edgecolor="0.35",
        )
        ax.add_patch(box)
        middle = left + width / 2
        ax.text(middle, bottom + height - 0.5, name, ha="center", va="center", size=14, weight=600)
        ax.text(middle, bottom + 0.72, text, ha="center", va="center", size=10, linespacing=1.4)
    for upper, lower, x in ARROWS:
        top, bottom = ROOMS[upper][1], ROOMS[lower][1] + ROOMS[lower][3]
        style = {"arrowstyle": "-|>", "color": "0.35", "linewidth": 1.5, "shrinkA": 0, "shrinkB": 1}
        ax.annotate("", (x, bottom), (x, top), arrowprops=style)
    return figure


if __name__ == "__main__":
    # The same picture every time: no date, no random names.
    plt.rcParams.update({"svg.hashsalt": "crazybilliards", "figure.constrained_layout.use": True})
    draw().savefig(Path(__file__).with_suffix(".svg"), metadata={"Date": None}, facecolor="white")
