"""Draw how far neighbours remember, from docs/tables/correlation_lengths.csv.

Run it to write neighbours.png beside it. ``python -m studies.neighbours`` computes the table.
"""

from pathlib import Path

import pandas as pd
from small_files import save

from crazybilliards.comparison.drawing import (
    COLOURS,
    draw_points,
    house_style,
    legend_above,
    panels,
)

TABLE = Path(__file__).parents[1] / "tables/correlation_lengths.csv"


def main() -> None:
    """Write the picture."""
    table = pd.read_csv(TABLE)
    figure, axes = panels(1, 2, height=2.6)
    for number, (e, rows) in enumerate(table.groupby("e", sort=False)):
        for ax, quantity in zip(axes, ("xi", "h_c/T centre"), strict=True):
            measured = rows[f"{quantity}, simulation"].str.split(" ± ", expand=True).astype(float)
            values, errors = measured.to_numpy().T
            draw_points(ax, rows["L"], values, errors, number=number, label=f"$e = {e:g}$")
            ax.plot(rows["L"], rows[f"{quantity}, theory"], color=COLOURS[number])
    for ax in axes:
        ax.plot([], [], color="0.4", label="gas")
        ax.set(xscale="log", xlabel="rods $L$")
        ax.set_xticks(rows["L"], [f"{size}" for size in rows["L"]])
        ax.xaxis.set_minor_formatter("")
    axes[0].set(yscale="log", ylabel=r"correlation length $\xi$ [rods]")
    axes[1].set(ylim=(0, 1), ylabel=r"$\langle v_i v_{i+1}\rangle/T$, centre")
    legend_above(figure, axes[0])
    save(figure, "neighbours.png")


if __name__ == "__main__":
    with house_style():
        main()
