"""Figure 15: kinetic energy of flippers in time: exponential growth, finite-time singularity."""

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, panels
from crazybilliards.kinetic.gas.criticality import weak_damping_growth_rate
from crazybilliards.model import Array, Chain
from crazybilliards.reproduction.claims.study import Results, Runs, Study, effort
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, around, at_choices
from crazybilliards.reproduction.fits import fit_growth, fit_singularity

_SOURCE = "section Anti-Dissipation, non_linear_vs_linear"
_FEW = effort((4,), (6,))
_BEGINNINGS = 100.0, 250.0  # of two spans in which collisions are counted; the first is from 1e3 on
_SPAN = 50.0
_GROWING = 1e3  # energy beyond which noise no longer matters [M R^2/t_0^2]
_HALF_WAY = 150.0  # where the rate of linear springs is measured up to, and again from [t_0]
# And beyond which damping matters little: how far beyond, the exponent depends on.
_SINGULAR = (1e5, 1e6, 1e7, 1e8)
_ENERGY = r"kinetic energy $E$ [M R$^2$/$t_0^2$]"


def _from_rest(chain: Chain, duration: float, time_step: float) -> Runs:
    return Runs(
        chain.spring,
        chain,
        effort((6,), (24,)),
        {"warmup": 0.0, "observe": ["energy"], "duration": duration, "time_step": time_step},
    )


def _at_steps(*runs: Runs) -> dict[str, tuple[Runs, ...]]:
    """Return runs of one time step, and those at a quarter of it, by the names of the steps."""
    step = runs[0].settings["time_step"] / 4
    return {"": runs, f"dt = {step:g}": tuple(one.at_step(step, _FEW) for one in runs)}


_LINEAR = _from_rest(Chain(size=100, restitution=1.01, damping=0.4), 300.0, 0.02)
# This spring stiffens as it is stretched: the step is short enough for the last moments.
_QUADRATIC = _from_rest(_LINEAR.chain.replace(spring="quadratic"), 100.0, 0.002)
_COUNTED = [
    replace(
        _LINEAR,
        name=f"collisions from {begin:g}",
        effort=_FEW,
        settings={"warmup": begin, "duration": _SPAN, "time_step": 0.02, "observe": ["collisions"]},
    )
    for begin in _BEGINNINGS
]
_NEEDS = (_at_steps(_LINEAR), _at_steps(_QUADRATIC), _at_steps(*_COUNTED))


def _late(run: xr.Dataset, beyond: float) -> tuple[Array, Array]:
    """Return times and energies from the first one above ``beyond``."""
    late = run.isel(time=slice(int(np.argmax(run.kinetic_energy.values > beyond)), None))
    return late.time.values, late.kinetic_energy.values


def _rates(run: xr.Dataset) -> list[float]:
    """Return the growth rates up to the half and from there on."""
    time, energy = _late(run, _GROWING)
    halves = time <= _HALF_WAY, time > _HALF_WAY
    return [fit_growth(time[half], energy[half]).rate for half in halves]


def _singularity(run: xr.Dataset, beyond: float) -> tuple[float, float]:
    """Return exponent and t_c [t_0] of the fit from an energy on."""
    fit = fit_singularity(*_late(run, beyond))
    return fit.exponent, fit.time


def _change(both: list[Estimate]) -> Estimate:
    """Return the difference of two over the first one."""
    early, late = both
    return late.minus(early).times(1 / early.value)


def _frequency_claim(results: Results) -> Claim:
    def frequency(run: xr.Dataset) -> float:
        return float(run.collision_rate.values[:-1].mean())  # the last rod has no right neighbour

    steps = {
        step: [runs.estimate(results, frequency) for runs in counted]
        for step, counted in _at_steps(*_COUNTED).items()
    }
    (early, late), (begin, then) = steps[""], _BEGINNINGS
    return Claim(
        "linear springs: the collision frequency C_f is about constant",
        f"collisions of a contact per t_0: {early} from t = {begin:g} to {begin + _SPAN:g} t_0 and "
        f"{late} from {then:g} to {then + _SPAN:g} t_0, while the energy grows; the second less "
        "the first, over the first:",
        **at_choices(steps, _change),
        within=around(0.0, 0.1),
        source="section Anti-Dissipation",
        ours="the spans of time",
    )


def _growth_claim(results: Results) -> Claim:
    steps = {step: runs.estimates(results, _rates) for step, [runs] in _at_steps(_LINEAR).items()}
    early, late = steps[""]
    return Claim(
        "linear springs: exponential growth",
        f"rate {early} per t_0 from E = {_GROWING:.0e} to t = {_HALF_WAY:g} t_0, and {late} from "
        f"there to {_LINEAR.settings['duration']:g} t_0; the second less the first, over the "
        "first:",
        **at_choices(steps, _change),
        within=around(0.0, 0.1),
        source=_SOURCE,
    )


def _singularity_claim(results: Results) -> Claim:
    # Exponents and t_c of fits from each of these energies on.
    steps = {
        step: [runs.estimates(results, partial(_singularity, beyond=each)) for each in _SINGULAR]
        for step, [runs] in _at_steps(_QUADRATIC).items()
    }
    exponents, (time, *_) = zip(*steps[""], strict=True)
    listed = ", ".join(f"{e:.0e}: {found}" for e, found in zip(_SINGULAR, exponents, strict=True))
    diverged = [run.attrs["status"] == "diverged" for run in _QUADRATIC.members(results)]
    return Claim(
        "quadratic springs: divergence in finite time, a power law of t_c - t",
        f"{sum(diverged)} of {len(diverged)} runs diverged, t_c = {time} t_0; exponent of E "
        f"by the least energy fitted: {listed}; middle and half the spread, with the error",
        **at_choices(steps, _middle),
        source=f"{_SOURCE}, inset",
    )


def _middle(fits: list[list[Estimate]]) -> Estimate:
    """Return the middle of the exponents; half their spread, where it begins, is an error too."""
    exponents = [exponent for exponent, _ in fits]
    low, high = min(exponents).value, max(exponents).value
    error = max(exponent.error for exponent in exponents)
    return Estimate((low + high) / 2, math.hypot((high - low) / 2, error))


def _draw(results: Results) -> Figure:
    figure, (left, right) = panels(1, 2, height=2.6)
    for number, runs in enumerate((_LINEAR, _QUADRATIC)):
        for run in runs.members(results):
            left.semilogy(run.time, run.kinetic_energy, f"C{number}", linewidth=0.6, alpha=0.7)
        left.plot([], [], f"C{number}", label=f"{runs.name} springs")
    rate, t = weak_damping_growth_rate(_LINEAR.chain), np.array([40.0, _HALF_WAY])
    members = _LINEAR.members(results)
    anchor = np.mean([np.interp(90, run.time, run.kinetic_energy) for run in members])
    label = rf"theory: $\exp({rate:.3f}\,t/t_0)$"
    left.semilogy(t, anchor * np.exp(rate * (t - 90)), "k--", label=label)
    left.set(xlabel="time $t$ [$t_0$]", ylabel=_ENERGY, xlim=(0, _HALF_WAY), ylim=(1, 1e8))
    left.legend()
    look: Any = {"linestyle": "none", "marker": ".", "markersize": 2, "color": COLOURS[1]}
    for run in _QUADRATIC.members(results):
        until = _singularity(run, _SINGULAR[0])[1] - run.time.values
        right.loglog(until[until > 0], run.kinetic_energy.values[until > 0], **look, alpha=0.6)
    right.plot([], [], **look, alpha=0.6, label="quadratic springs")
    span = np.array([0.6, 6.0])
    right.loglog(span, 3e7 * span**-6.0, "k--", label="slope $-6$")
    right.set(xlabel="time left $t_c - t$ [$t_0$]", ylabel=_ENERGY, ylim=(1, 1e12))
    right.legend()
    return figure


ENERGY = Study(
    number=15,
    name="energy",
    title="Kinetic energy of flippers in time",
    caption="L = 100, e = 1.01, gamma = 0.4, from rest. (a) Every line is a run, cut off at 1e8 "
    "and at t = 150. Dashed: the growth rate of a balance between damping and one collision "
    "of every pair in half a period. (b) The runs with quadratic springs against the time left "
    "until their t_c, fitted from E = 1e5 on.",
    needs=[runs for steps in _NEEDS for both in steps.values() for runs in both],
    claims=lambda results: [
        _frequency_claim(results),
        _growth_claim(results),
        _singularity_claim(results),
    ],
    draw=_draw,
)
