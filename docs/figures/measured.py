"""Draw the densities of dissipative chains over the force balance with their measured widths.

Run it to write measured.png beside it, and to print how far the densities are apart. It simulates
three chains, which takes ten seconds.
"""

from small_files import save

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.distances import deviation
from crazybilliards.comparison.drawing import entitle, house_style, legend_above, overlay, panels
from crazybilliards.kinetic import force_balance
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

RESTITUTIONS = (0.5, 0.75, 0.95)


def main() -> None:
    """Write the picture."""
    with house_style():
        figure, axes = panels(1, len(RESTITUTIONS), height=2.4, sharex=True, sharey=True)
        for ax, e in zip(axes, RESTITUTIONS, strict=True):
            chain = Chain(size=100, amplitude=30.0, restitution=e)
            run = simulate(chain, duration=2000.0, replicas=2, threads=1)
            densities = {
                "force balance, measured $W_v$": force_balance(chain, velocity_variance=run),
                "force balance, free $W$": force_balance(chain.replace(restitution=1.0)),
                "simulation": run,
            }
            densities = {name: smooth(each) for name, each in densities.items()}
            for name, each in list(densities.items())[:-1]:
                print(f"e = {e:g}, {name}: {deviation(each, densities['simulation'])}")
            overlay(densities, ax=ax, style={"simulation": {"color": "black"}})
            entitle(ax, f"$e = {e:g}$")
            ax.set_xlim(-180, 180)
            ax.label_outer()
        legend_above(figure, axes[0])
        save(figure, "measured.png")


if __name__ == "__main__":
    main()
