"""Draw the errors of the displacement widths in the theory with pair correlations.

Run it to write correlated_displacements.png beside it, from docs/tables/displacement_widths.csv.
The picture names the digest of its table, so that a test finds a picture of an older one.
"""

import hashlib
from pathlib import Path

import pandas as pd

from crazybilliards.comparison.drawing import draw_points
from crazybilliards.comparison.layout import house_style, panels

TABLE = Path(__file__).parents[1] / "tables" / "displacement_widths.csv"
AXES = {
    "e": ("restitution $e$", "linear", (0, 0.25, 0.5, 0.75, 1)),
    "Gamma": (r"damping $\Gamma = \gamma/\sqrt{km}$", "log", (0.25, 0.5, 1)),
    "L": ("number of rods $L$", "log", (25, 50, 100, 200)),
}
LABELS = {"before": "with $h$", "now": "with $h'$"}


def main() -> None:
    """Write the picture."""
    table = pd.read_csv(TABLE)
    with house_style():
        figure, axes = panels(1, 3, height=2.7)
        for ax, (column, (axis, scale, ticks)) in zip(axes, AXES.items(), strict=True):
            for number, (name, label) in enumerate(LABELS.items()):
                errors = table[f"{name}, %"].abs()
                draw_points(
                    ax, table[column], errors, table["its error, %"], number=number, label=label
                )
            ax.set(xlabel=axis, xscale=scale, ylim=(0, 22))
            ax.minorticks_off()
            ax.set_xticks(ticks, [f"{each:g}" for each in ticks])
            ax.set_yticks(range(0, 21, 5))
        axes[0].set_ylabel("largest error of $W_x$ [%]")
        axes[0].legend()
        digest = hashlib.sha256(TABLE.read_text(encoding="utf-8").encode()).hexdigest()
        figure.savefig(Path(__file__).with_suffix(".png"), metadata={"Source": digest})


if __name__ == "__main__":
    main()
