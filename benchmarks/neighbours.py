"""How far neighbours remember, and every ingredient of the correlated theory, measured.

    python benchmarks/neighbours.py FOLDER FIGURES

Prints docs/tables/correlation_lengths.csv and draws ``neighbours.png`` and ``ingredients.png`` into
FIGURES. Results are kept in FOLDER, so that a second run only draws. Takes a quarter of an hour on
one core.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
import xarray as xr
from ingredients import draw_ingredients
from kept import kept_or_made
from matplotlib.axes import Axes

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import entitle, house_style, legend_above, panels
from crazybilliards.kinetic import correlated_phase_space
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.chain import middle_tenth
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import Covariances
from crazybilliards.particles.scales import default_time_step

RESTITUTIONS = (0.95, 0.9, 0.75, 0.5, 0.0)
SIZES = (30, 100, 300, 1000)
DURATIONS = {30: 8000.0, 100: 6000.0, 300: 3000.0, 1000: 1000.0, 3000: 300.0}
SHOWN = 100  # rods, of the chains whose covariances are drawn
CLOSER = (Chain(size=100, restitution=0.75), Chain(size=30, restitution=0.5))
CLOSER_DURATION = 12_000.0
FINER = 4  # than the default time step, for what collisions exchange
CELLS = 22


def named(chain: Chain) -> str:
    return f"L{chain.size}_e{chain.restitution:g}"


def measured(chain: Chain, folder: Path) -> xr.Dataset:
    """Return widths, covariances and modes of a chain."""
    furthest = chain.size // 2 if chain.size == SHOWN else 1

    def make() -> xr.Dataset:
        return simulate(
            chain,
            duration=DURATIONS[chain.size],
            every=0.5,
            seed=3,
            observe=("widths", Covariances(separations=furthest), "modes"),
            threads=1,
            progress=False,
        ).drop_vars(["gap_covariance", "gap_covariance_error"])

    return kept_or_made(folder / f"run_{named(chain)}.nc", make)


def measured_closely(chain: Chain, folder: Path) -> xr.Dataset:
    """Return everything that the theory has, collisions included, at a short time step."""

    def make() -> xr.Dataset:
        return simulate(
            chain,
            duration=CLOSER_DURATION,
            time_step=default_time_step(chain) / FINER,
            every=0.5,
            seed=5,
            observe=("widths", Covariances(separations=1), "modes", "impacts"),
            threads=1,
            progress=False,
        )

    return kept_or_made(folder / f"closely_{named(chain)}.nc", make)


def solved(chain: Chain, folder: Path) -> xr.Dataset:
    """Return the theory, on a mesh on which widths are right to a few per mille."""

    def make() -> xr.Dataset:
        return correlated_phase_space(chain, cells=CELLS).drop_vars("phase_space_density")

    return kept_or_made(folder / f"theory_{named(chain)}.nc", make)


def length_of(result: xr.Dataset) -> float:
    """Return the correlation length xi in rods, from the spectrum of the velocities.

    Correlations exp(-r/xi) have the spectrum S = S_inf + (S_0 - S_inf)/(1 + (k xi)^2) with
    k = pi q/L; here xi is 1/k where a spectrum lies halfway between S_0, which is that of the
    centre of mass, and its shortest waves.
    """
    chain, spectrum = chain_of(result), result.mode_velocity_variance.values
    wave = np.pi * result.mode.values / chain.size
    short = spectrum[-max(3, spectrum.size // 10) :].mean()
    whole = chain.free_velocity_width**2
    below = (spectrum[1:] - short) / (whole - short)
    first = int(np.argmax(below < 0.5)) + 1
    if first == 1:  # between the centre of mass and the first mode
        shares, waves = (below[0], 1.0), (wave[1], 0.0)
    else:
        shares, waves = below[[first - 1, first - 2]], wave[[first, first - 1]]
    return float(1 / np.interp(0.5, shares, waves))


def spread_of(run: xr.Dataset) -> float:
    """Return the standard error of the length: that under independent errors of all modes."""
    generator = np.random.default_rng(0)
    noise = (
        generator.normal(size=(100, run.sizes["mode"])) * run.mode_velocity_variance_error.values
    )
    drawn = [run.assign(mode_velocity_variance=run.mode_velocity_variance + each) for each in noise]
    return float(np.std([length_of(each) for each in drawn]))


def in_the_centre(result: xr.Dataset) -> tuple[float, float]:
    """Return <v_i v_i+1>/T at the contacts of the middle tenth, and its error."""
    own = result.velocity_width.values**2
    own = (own[1:] + own[:-1]) / 2
    middle = middle_tenth(own.size)
    share = float(result.neighbour_covariance.values[middle].mean() / own[middle].mean())
    if "neighbour_covariance_error" not in result:
        return share, 0.0
    # Neighbouring contacts err together.
    errors = result.neighbour_covariance_error.values[middle]
    return share, float(errors.mean() / own[middle].mean())


def tabulate(folder: Path) -> dict[tuple[float, int], tuple[xr.Dataset, xr.Dataset]]:
    """Print the table, and return simulation and theory of every chain."""
    found: dict[tuple[float, int], tuple[xr.Dataset, xr.Dataset]] = {}
    print(
        'e,L,"xi, simulation","xi, theory","h_c/T centre, simulation","h_c/T centre, theory",'
        '"W^2/<v^2>, simulation"'
    )
    for e in RESTITUTIONS:
        for size in SIZES:
            chain = Chain(size=size, restitution=e)
            run = measured(chain, folder)
            theory = solved(chain, folder)
            found[e, size] = run, theory
            shared, error = in_the_centre(run)
            together = chain.free_velocity_width**2 / float((run.velocity_width**2).mean())
            print(
                f"{e:g},{size},{length_of(run):.1f} ± {spread_of(run):.1f},"
                f"{length_of(theory):.1f},{shared:.3f} ± {error:.3f},"
                f"{in_the_centre(theory)[0]:.3f},{together:.2f}",
                flush=True,
            )
    return found


def draw_lengths(
    found: dict[tuple[float, int], tuple[xr.Dataset, xr.Dataset]], figure: Path
) -> None:
    with house_style():
        drawing, axes = panels(1, 3, height=2.6)
        for number, e in enumerate(RESTITUTIONS):
            how = {"color": COLOURS[number], "marker": SYMBOLS[number], "markerfacecolor": "none"}
            runs = {size: found[e, size][0] for size in SIZES}
            theories = {size: found[e, size][1] for size in SIZES}
            for ax, value, error in (
                (axes[0], length_of, spread_of),
                (
                    axes[1],
                    lambda each: in_the_centre(each)[0],
                    lambda each: in_the_centre(each)[1],
                ),
            ):
                ax.errorbar(
                    list(runs),
                    [value(run) for run in runs.values()],
                    [error(run) for run in runs.values()],
                    linestyle="none",
                    label=f"$e = {e:g}$",
                    **how,
                )
                ax.plot(
                    list(theories),
                    [value(each) for each in theories.values()],
                    color=COLOURS[number],
                )
            _draw_covariances(axes[2], runs[SHOWN], how)
        for ax in axes[:2]:
            ax.set(xscale="log", xlabel="rods $L$")
            ax.set_xticks(SIZES, [f"{size}" for size in SIZES])
        axes[0].set(yscale="log", ylabel=r"correlation length $\xi$ [rods]")
        axes[1].set(ylim=(0, 1), ylabel=r"$\langle v_i v_{i+1}\rangle/T$, centre")
        axes[2].set(ylim=(0, 0.75), xlabel="separation $r$ [rods]")
        axes[2].set(ylabel=r"$\langle v_i v_{i+r}\rangle/T$, centre")
        entitle(axes[2], f"$L = {SHOWN}$")
        legend_above(drawing, axes[0], "symbols: simulation, lines: theory")
        drawing.savefig(figure)


def _draw_covariances(ax: Axes, run: xr.Dataset, how: dict[str, object]) -> None:
    """Draw covariances of rods at equal distances from the centre, over their temperatures."""
    size = run.sizes["particle"]
    separations = np.unique(np.geomspace(1, size // 2, 14).astype(int))
    values, errors = [], []
    for r in separations:
        first = np.arange((size - r) // 2 - size // 20, (size - r) // 2 + size // 20 + 1)
        widths = run.velocity_width.values
        temperature = (widths[first] * widths[first + r]).mean()
        values.append(run.velocity_covariance.values[first, r].mean() / temperature)
        # Neighbouring pairs err together.
        errors.append(run.velocity_covariance_error.values[first, r].mean() / temperature)
    ax.errorbar(separations, values, errors, linestyle="none", **how)


def main(folder: Path, figures: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    closely = [(chain, measured_closely(chain, folder), solved(chain, folder)) for chain in CLOSER]
    draw_ingredients(closely, figures / "ingredients.png")
    draw_lengths(tabulate(folder), figures / "neighbours.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
