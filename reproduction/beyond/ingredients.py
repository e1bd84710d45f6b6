"""Every ingredient of the theory with pair correlations, beside its measured counterpart.

Simulations have a quarter of the default time step, for what collisions exchange.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain, chain_of
from crazybilliards.particles.scales import default_time_step
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, Study
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, positive_claim, small_claim
from crazybilliards.reproduction.correlated_rods import CELLS

_AGREE, _FAIL = Chain(size=100, restitution=0.75), Chain(size=30, restitution=0.5)
_DURATION = {"quick": 400.0, "full": 12_000.0}
_FINER = 4  # than the default time step
_LIMIT = 0.05  # within which the first chain's ingredients agree
_MODES = 3  # panel of the spectrum
_FORCE, _BEFORE = r"force $P\ [k s]$", r"before a collision: $\sqrt{\Theta_c}/W$"

Drawn = tuple[np.ndarray, np.ndarray, np.ndarray]  # coordinate, values and errors


def cases(quality: Quality) -> Cases:
    """Two chains: simulation and theory."""
    cases: Cases = {}
    for chain in (_AGREE, _FAIL):
        settings = {
            "duration": _DURATION[quality],
            "time_step": default_time_step(chain) / _FINER,
            "every": 0.5,
            "observe": ["widths", "covariances", "modes", "impacts"],
        }
        cases[f"rods {chain.size}"] = Case("simulate", chain, settings)
        cases[f"theory {chain.size}"] = Case(
            "correlated_phase_space", chain, {"cells": CELLS[quality]}
        )
    return cases


def _ingredients(run: xr.Dataset) -> dict[str, Drawn]:
    """Return what is drawn of a result, in free units.

    The last is the root of ``contact_temperature``, for which the theory has K F sqrt(Theta).
    """
    chain = chain_of(run)
    square = chain.free_velocity_width**2
    found = run.assign(
        temperature=run.velocity_width**2,
        before=np.sqrt(np.pi) / 2 / (1 - chain.restitution) * run.contact_loss / run.contact_force,
    )
    if "contact_temperature" in run:
        found["temperature_error"] = 2 * run.velocity_width * run.velocity_width_error
        found["before_error"] = run.contact_temperature_error / 2 / found.before
    # The error drawn of Theta/T is that of Theta alone.
    own = found.temperature.values
    drawn = {
        "$T/W^2$": ("temperature", square),
        r"$\Theta/T$": ("relative_temperature", (own[1:] + own[:-1]) / 2),
        r"$h_c = \langle v_i v_{i+1}\rangle/W^2$": ("neighbour_covariance", square),
        r"$\langle|v_q|^2\rangle/W^2$": ("mode_velocity_variance", square),
        _FORCE: ("contact_force", chain.stiffness * chain.thermal_length),
        _BEFORE: ("before", chain.free_velocity_width),
    }
    places = {
        "particle": (found.particle - 0.5) / chain.size,
        "contact": found.contact / chain.size,
        "mode": found.mode,
    }
    return {
        label: (
            places[str(found[name].dims[0])].values,
            found[name].values / unit,
            found.get(f"{name}_error", 0 * found[name]).values / unit,
        )
        for label, (name, unit) in drawn.items()
    }


def _central_excess(results: Results, chain: Chain, quantity: str) -> Estimate:
    """Return theory over simulation, less 1, at the contact in the centre."""
    (_, values, errors), (_, theory, _) = (
        _ingredients(results[f"{kind} {chain.size}"])[quantity] for kind in ("rods", "theory")
    )
    middle = chain.size // 2 - 1
    ratio = theory[middle] / values[middle]
    return Estimate(float(ratio - 1), float(ratio * errors[middle] / values[middle]))


def claims(results: Results) -> list[Claim]:
    """Check: force and speed before a collision are right at e = 0.75, and not at 0.5."""
    quantity = "theory over simulation, less 1, in the centre:"
    found = [
        small_claim(
            f"the theory's {words} is right, L = {_AGREE.size}, e = {_AGREE.restitution:g}",
            quantity,
            _central_excess(results, _AGREE, name),
            _LIMIT,
        )
        for name, words in ((_FORCE, "force"), (_BEFORE, "speed before a collision"))
    ]
    force, before = (_central_excess(results, _FAIL, name) for name in (_FORCE, _BEFORE))
    where = f"L = {_FAIL.size}, e = {_FAIL.restitution:g}"
    return [
        *found,
        positive_claim(
            f"the theory's force is too small, {where}",
            f"minus {quantity}",
            force._replace(value=-force.value),
        ),
        positive_claim(
            f"the theory's speed before a collision is too large, {where}", quantity, before
        ),
    ]


def draw(results: Results) -> Figure:
    """Draw six panels of chains, their simulations and their theories."""
    figure, axes = panels(2, 3, height=2.3)
    for number, chain in enumerate((_AGREE, _FAIL)):
        runs, lines = (_ingredients(results[f"{kind} {chain.size}"]) for kind in ("rods", "theory"))
        for ax, (name, found) in zip(axes, runs.items(), strict=True):
            last = len(found[0]) - 1
            shown = np.linspace(0, last, 30).astype(int)
            if ax is axes[_MODES]:  # mode 0 is exact, and beyond a logarithmic axis
                shown = np.unique(np.geomspace(1, last, 24).astype(int))
            place, values, errors = (each[shown] for each in found)
            label = f"$L = {chain.size}$, $e = {chain.restitution:g}$"
            draw_points(ax, place, values, errors, number=number, label=label)
            place, values, _ = lines[name]
            first = int(ax is axes[_MODES])
            ax.plot(place[first:], values[first:], color=COLOURS[number])
            ax.set(xlabel="label $l/L$", ylabel=name)
    for ax in axes:
        ax.set_ylim(bottom=0)
    axes[_MODES].set(xlabel="mode $q$", xlim=(0.8, None), ylim=(0.02, 1))
    axes[_MODES].set(xscale="log", yscale="log")
    legend_above(figure, axes[0], "symbols: simulation, lines: theory")
    return figure


STUDY = Study(
    name="ingredients",
    title="Every ingredient of the theory with pair correlations",
    caption="Two chains, simulated at a quarter of the default time step. Symbols: simulation, "
    "with standard errors. Lines: theory. (a) Temperature. (b) Relative temperature of neighbours. "
    "(c) Their covariance. (d) Spectrum of the velocities. (e) Force. (f) A speed: "
    "sqrt(pi)/(4 (1 - e)) times the loss over the force of each contact, in the simulation "
    "sqrt(Theta_c) = (sqrt(pi)/4) <w^2>/<w> of the speeds w at which rods meet.",
    cases=cases,
    draw=draw,
    claims=claims,
)
