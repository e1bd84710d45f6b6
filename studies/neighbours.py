"""How many rods move together? Correlation lengths and covariances of velocities, to 3000 rods.

    python -m studies.neighbours FOLDER

Simulations have the default time step. The theory is ``steady_state``, up to 1000 rods. The first
table has five restitutions. The other two have quantities in the centre at e = 0, and the slopes of
their logarithms: roots of temperatures over W, the force over k s, the correlation length. Takes an
hour on one core. ``docs/figures/neighbours.py`` draws the first table.
"""

from __future__ import annotations

import math
from itertools import pairwise, product

import numpy as np
import xarray as xr

from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.reproduction.claims.verdicts import Estimate
from studies.common import Results, Table, carry_out

RESTITUTIONS = (0.95, 0.9, 0.75, 0.5, 0.0)
DURATIONS = {30: 8000.0, 100: 6000.0, 300: 3000.0, 1000: 1000.0}
LONGEST, ITS_DURATION = 3000, 300.0  # at e = 0, in simulations only
SPECTRA = 100  # drawn at random, for the error of the correlation length
HEADS = ["L", "$W_v/W$", r"$\sqrt{\Theta}/W$", r"$\sqrt{h_c}/W$", "$P/ks$", r"$\xi$"]


def cases() -> dict[str, Case]:
    found = {}
    chains = [(e, *of_size) for e, of_size in product(RESTITUTIONS, DURATIONS.items())]
    for e, size, duration in [*chains, (0.0, LONGEST, ITS_DURATION)]:
        chain, observe = Chain(size=size, restitution=e), ["widths", "covariances", "modes"]
        settings = {"duration": duration, "every": 0.5, "observe": observe}
        found[f"rods {e} {size}"] = Case("simulate", chain, settings)
        if size != LONGEST:
            found[f"theory {e} {size}"] = Case("steady_state", chain, {})
    return found


def by_place(results: Results) -> list[dict[tuple[float, int], xr.Dataset]]:
    """Return the simulations and the theories by restitution and length."""
    places = list(product(RESTITUTIONS, (*DURATIONS, LONGEST)))
    return [
        {(e, size): results[name] for e, size in places if (name := f"{of} {e} {size}") in results}
        for of in ("rods", "theory")
    ]


def correlation_length(result: xr.Dataset) -> Estimate:
    """Return the correlation length xi in rods, from the spectrum of the velocities.

    Correlations exp(-r/xi) have the spectrum S = S_inf + (S_0 - S_inf)/(1 + (k xi)^2) with
    k = pi q/L; here xi is 1/k where a spectrum lies halfway between S_0, which is that of the
    centre of mass, and its shortest waves. Its standard error, 0 in theory, is that under
    independent errors of all modes.
    """
    spectrum = result.mode_velocity_variance.values
    length = length_of(result, spectrum)
    if "mode_velocity_variance_error" not in result:
        return Estimate(length, 0.0)
    noise = np.random.default_rng(0).normal(size=(SPECTRA, spectrum.size))
    noise *= result.mode_velocity_variance_error.values
    return Estimate(length, float(np.std([length_of(result, spectrum + each) for each in noise])))


def length_of(result: xr.Dataset, spectrum: np.ndarray) -> float:
    chain = chain_of(result)
    wave = np.pi * result.mode.values / chain.size
    short = spectrum[-max(3, spectrum.size // 10) :].mean()
    shares = (spectrum - short) / (chain.free_velocity_width**2 - short)
    shares[0] = 1.0  # the centre of mass is mode 0
    first = int(np.argmax(shares[1:] < 0.5)) + 1
    between = [first, first - 1]
    return float(1 / np.interp(0.5, shares[between], wave[between]))


def errors_of(result: xr.Dataset, name: str) -> np.ndarray:
    """Return the standard errors of a profile, which are 0 in theory. Neighbours err together."""
    return result.get(f"{name}_error", 0 * result[name]).values


def covariance(result: xr.Dataset) -> Estimate:
    """Return <v_i v_i+1>/T at the contacts of the middle tenth."""
    own, name = result.velocity_width.values**2, "neighbour_covariance"
    own = (own[1:] + own[:-1]) / 2
    middle = middle_tenth(own.size)
    both = (values[middle].mean() for values in (result[name].values, errors_of(result, name)))
    return Estimate(*(float(each / own[middle].mean()) for each in both))


def root(result: xr.Dataset, name: str, power: int) -> Estimate:
    """Return the root of the mean of values to a power over the middle tenth, over W."""
    values, width = result[name].values, chain_of(result).free_velocity_width
    middle = middle_tenth(values.size)  # of L rods, or of L - 1 contacts
    value = float(np.sqrt((values[middle] ** power).mean()))
    errors = power * errors_of(result, name)[middle] * values[middle] ** (power - 1)
    return Estimate(value / width, float(errors.mean() / (2 * value)) / width)


def force(result: xr.Dataset) -> Estimate:
    """Return the force in the centre, which balances the springs of half of the chain."""
    chain = chain_of(result)
    half, unit = chain.size // 2, chain.thermal_length
    displaced = result.mean_displacement.values / unit
    value = float(displaced[::-1][:half].sum() - displaced[:half].sum()) / 2
    errors = errors_of(result, "mean_displacement") / unit
    return Estimate(value, float(errors[:half].sum()) / math.sqrt(2))


def quantities(result: xr.Dataset) -> list[Estimate]:
    powers = {"velocity_width": 2, "relative_temperature": 1, "neighbour_covariance": 1}
    roots = [root(result, *each) for each in powers.items()]
    return [*roots, force(result), correlation_length(result)]


def printed(value: float, error: float) -> str:
    """Return a number, and its error unless it is exact."""
    return f"{value:.4g} ± {error:.2g}" if error else f"{value:.4g}"


def along_lengths(found: dict[int, xr.Dataset], last: str, column: dict[int, str]) -> Table:
    """Return quantities and one more column, then the slopes of their logarithms."""
    rows, values = [[*HEADS, last]], {size: quantities(each) for size, each in found.items()}
    for size, row in values.items():
        rows.append([f"{size}", *(printed(*each) for each in row), column[size]])
    for small, large in pairwise(values):
        span, slopes = math.log(large / small), []
        for one, other in zip(values[small], values[large], strict=True):
            error = math.hypot(one.error / one.value, other.error / other.value) / span
            slopes.append(printed(round(math.log(other.value / one.value) / span, 3), error))
        rows.append([f"{small} → {large}", *slopes, ""])
    return rows


def guess(run: xr.Dataset) -> str:
    """Return what the correlation length would be if collisions took all energy."""
    return f"{math.sqrt(2 / 3) * force(run).value / chain_of(run).relative_damping:.1f}"


def tables(results: Results) -> dict[str, Table]:
    sources = "simulation", "theory"
    names = [f"{of}, {which}" for of in ("xi", "h_c/T centre") for which in sources]
    rows = [["e", "L", *names, "W^2/<v^2>, simulation"]]
    runs, theories = by_place(results)
    for (e, size), theory in theories.items():
        run = runs[e, size]
        length, shared = correlation_length(run), covariance(run)
        together = chain_of(run).free_velocity_width ** 2 / float((run.velocity_width**2).mean())
        expected = f"{correlation_length(theory).value:.1f}"
        lengths = [f"{length.value:.1f} ± {length.error:.1f}", expected]
        shares = [f"{shared.value:.3f} ± {shared.error:.3f}", f"{covariance(theory).value:.3f}"]
        rows.append([f"{e:g}", f"{size}", *lengths, *shares, f"{together:.2f}"])
    sticky, sticky_theories = (
        {size: each for (e, size), each in found.items() if e == 0} for found in (runs, theories)
    )
    guesses = {size: guess(run) for size, run in sticky.items()}
    fits = {size: fit_border_power_law(each) for size, each in sticky_theories.items()}
    powers = {size: f"{fit.exponent:.3f} ± {fit.exponent_error:.3f}" for size, fit in fits.items()}
    return {
        "correlation_lengths": rows,
        "long_chains_simulation": along_lengths(sticky, r"$\sqrt{2/3}\,P/\Gamma$", guesses),
        "long_chains_theory": along_lengths(sticky_theories, r"$\nu$", powers),
    }


if __name__ == "__main__":
    carry_out(__doc__, cases(), tables)
