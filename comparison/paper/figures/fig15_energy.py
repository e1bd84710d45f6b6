"""Figure 15: kinetic energy of flippers in time: exponential growth, finite-time singularity."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from crazybilliards.comparison.claims.repetition import estimate, members, repeated
from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim, Estimate, positive_claim, small_claim
from crazybilliards.comparison.drawing import COLOURS
from crazybilliards.comparison.fits import fit_growth, fit_singularity
from crazybilliards.comparison.layout import panels
from crazybilliards.kinetic.kinetic_equation.weak_damping import weak_damping_growth_rate
from crazybilliards.model import Chain

_CHAINS = {
    spring: Chain(size=100, restitution=1.01, damping=0.4, spring=spring)
    for spring in ("linear", "quadratic")
}
_SOURCE = "section Anti-Dissipation, non_linear_vs_linear"
_NUMBER = {"quick": 6, "full": 24}
# The quadratic spring stiffens as it is stretched: the step is short enough for the last moments.
_SETTINGS = {
    "linear": {"duration": 150.0, "time_step": 0.02},
    "quadratic": {"duration": 100.0, "time_step": 0.002},
}
_GROWING = 1e3  # energy beyond which noise no longer matters [M R^2/T^2]
_ENERGY = r"kinetic energy $E$ [M R$^2$/T$^2$]"
_SINGULAR = 1e5  # and beyond which damping matters little


def cases(quality: Quality) -> Cases:
    """L = 100, e = 1.01, gamma = 0.4, both springs, from rest."""
    cases: Cases = {}
    for spring, chain in _CHAINS.items():
        settings = _SETTINGS[spring]
        cases |= repeated(
            spring, chain, _NUMBER[quality], warmup=0.0, observe=["energy"], **settings
        )
    return cases


def _late(run: xr.Dataset, beyond: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return times and energies from the first one above ``beyond``."""
    energy = run.kinetic_energy.values
    begin = int(np.argmax(energy > beyond))
    return run.time.values[begin:], energy[begin:]


def claims(results: Results) -> list[Claim]:
    """Check: exponential growth for linear springs, a singularity for quadratic ones."""
    rate = estimate(results, "linear", lambda run: fit_growth(*_late(run, _GROWING)).rate)
    expected = weak_damping_growth_rate(_CHAINS["linear"])
    bend = estimate(results, "linear", _late_rate).minus(rate)
    exponent = estimate(
        results, "quadratic", lambda run: fit_singularity(*_late(run, _SINGULAR)).exponent
    )
    time = estimate(results, "quadratic", lambda run: fit_singularity(*_late(run, _SINGULAR)).time)
    all_of_them = members(results, "quadratic")
    diverged = sum(run.attrs["status"] == "diverged" for run in all_of_them)
    return [
        small_claim(
            "linear springs: exponential growth",
            f"rate {rate} per T; rate of the second half less that of the whole, over the rate:",
            Estimate(bend.value / rate.value, bend.error / rate.value),
            0.1,
            source=_SOURCE,
            theory=f"(e^2 - 1) L sqrt(k/m)/(2 pi) - gamma/m = {expected:.4f} per T",
        ),
        positive_claim(
            "quadratic springs: divergence in finite time, a power law of t_c - t",
            f"{diverged} of {len(all_of_them)} runs diverged, t_c = {time} T; exponent of E",
            exponent,
            source=f"{_SOURCE}, inset",
            theory="6 without damping if the rods share the energy (frequency ~ E^(1/6), so "
            "dE/dt ~ E^(7/6)); less, as it gathers on ever fewer rods",
        ),
    ]


def _late_rate(run: xr.Dataset) -> float:
    time, energy = _late(run, _GROWING)
    half = time.size // 2
    return fit_growth(time[half:], energy[half:]).rate


def draw(results: Results) -> Figure:
    """Draw E(t) of all runs, and the quadratic ones against t_c - t."""
    figure, (left, right) = panels(1, 2, height=2.6)
    for number, spring in enumerate(_CHAINS):
        for k, run in enumerate(members(results, spring)):
            left.semilogy(
                run.time,
                run.kinetic_energy,
                color=COLOURS[number],
                linewidth=0.6,
                alpha=0.7,
                label=f"{spring} springs" if k == 0 else None,
            )
    rate = weak_damping_growth_rate(_CHAINS["linear"])
    t = np.array([40.0, 150.0])
    anchor = np.mean(
        [np.interp(90, run.time, run.kinetic_energy) for run in members(results, "linear")]
    )
    left.semilogy(
        t,
        anchor * np.exp(rate * (t - 90)),
        "k--",
        label=rf"theory: $\exp({rate:.3f}\,t/$T$)$",
    )
    left.set(xlabel="time $t$ [T]", ylabel=_ENERGY, ylim=(1, 1e8))
    left.legend()
    _draw_singularity(right, members(results, "quadratic"))
    return figure


def _draw_singularity(ax: Axes, quadratic: list[xr.Dataset]) -> None:
    for k, run in enumerate(quadratic):
        fit = fit_singularity(*_late(run, _SINGULAR))
        left = fit.time - run.time.values
        before = left > 0
        ax.loglog(
            left[before],
            run.kinetic_energy.values[before],
            ".",
            markersize=2,
            color=COLOURS[1],
            alpha=0.6,
            label="quadratic springs" if k == 0 else None,
        )
    span = np.array([0.6, 6.0])
    ax.loglog(span, 3e7 * span**-6.0, "k--", label="slope $-6$")
    ax.set(xlabel="time left $t_c - t$ [T]", ylabel=_ENERGY, ylim=(1, 1e12))
    ax.legend()


FIGURE = PaperFigure(
    number=15,
    name="energy",
    title="Kinetic energy of flippers in time",
    caption="L = 100, e = 1.01, gamma = 0.4, from rest. (a) Every line is a run, cut off at 1e8. "
    "Dashed: the growth rate of a balance between damping and one collision of every pair in half "
    "a period. (b) The runs with quadratic springs against the time left until their t_c, fitted.",
    cases=cases,
    draw=draw,
    claims=claims,
)
