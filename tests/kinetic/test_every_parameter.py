"""No theory ignores a parameter of the chain silently, and no simulation does either.

For every solver and every field of ``Chain``: with that field changed the result changes, or the
call is refused with a ValueError, or the pair stands in ``MEANINGLESS`` with the reason. The fields
are read from the class, and another value of each follows from its declaration.
"""

import json
from dataclasses import dataclass, field, fields
from functools import cache

import numpy as np
import pytest
from every_solver import SOLVERS, Given
from other_values import other_values
from scipy.interpolate import CubicSpline

import crazybilliards.kinetic
from crazybilliards.kinetic import displaced
from crazybilliards.kinetic.kinetic_equation import criticality
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_real
from crazybilliards.particles import Widths, dynamics, simulate
from crazybilliards.particles.laws import law

CHAIN = Chain(size=4)
START = displaced(CHAIN, 0.3)[["density", "label", "flow_velocity", "velocity_variance"]]
# Nothing that is given depends on the chain, so that it cannot hide what a solver ignores.
GIVEN = Given(
    start=START.drop_attrs(),
    variance=lambda x: 0.1 + 0.02 * np.exp(-(np.asarray(x) ** 2)),
    number=0.1,
    times={"duration": 1.0, "every": 1.0},
    fluid={"cells": 160},
    run={"duration": 70.0, "time_step": 0.1, "every": 1.0},
)
# Of the largest value: what meshes that depend on the chain may change.
_SAME = 5e-3
X = np.linspace(-5, 5, 41)

# For every field a value that no chain here has.
# Few rods, a restitution that driven chains can take too, an amplitude for which cells of the same
# number in thermal lengths resolve the same.
OTHER = other_values(size=5, restitution=1.2, amplitude=1.3)


_GIVEN = "W^2 is given, and a steady state depends on noise and damping through it alone"
_GIVEN_NOISE = "W^2 is given, and it is all that the noise does"
_GIVEN_LOSS = "W^2 is given, and it is all that the restitution does"
_GIVEN_ANCHORS = "the displacement is given, and with it where the anchors are"
_SCALE_FREE = "without noise the equation has no scale of its own, see critical_size"
_STARTS = "it is the state at restitution 1 that is moved"
_POINTS = "rods are points in the reduced coordinate, and only the displacements are given out"

# (solver, field): why the result cannot depend on the field.
MEANINGLESS = {
    **{
        (f"force_balance, {kind}", name): reason
        for kind in ("variance", "number", "both")
        for name, reason in {
            "restitution": _GIVEN_LOSS,
            "amplitude": _GIVEN,
            "damping": _GIVEN,
        }.items()
    },
    ("force_balance, displacement", "gap"): _GIVEN_ANCHORS,
    ("force_balance, displacement", "mass"): "the density depends on m W^2 = A^2/(2 gamma) alone",
    ("force_balance, both", "gap"): _GIVEN_ANCHORS,
    **{
        (solver, name): reason
        for solver in (
            "hydrodynamics, label, number",
            "hydrodynamics, eulerian, number",
            "hydrodynamics, eulerian, variance",
        )
        for name, reason in {"restitution": _GIVEN_LOSS, "amplitude": _GIVEN_NOISE}.items()
    },
    **{("critical_size", name): _SCALE_FREE for name in ("amplitude", "gap", "radius")},
    ("critical_size", "size"): "it is what is computed",
    ("breathing_cloud", "radius"): _POINTS,
    **{(start, "restitution"): _STARTS for start in ("displaced", "compressed")},
}


@pytest.fixture(autouse=True)
def _coarse(monkeypatch):
    """Take a drag short of the critical one: what it depends on is the same."""
    monkeypatch.setattr(criticality, "_critical_drag", drag)


@cache
def drag(damping):
    return float(criticality.drag_at_noise(damping, (0.85,), cells=12)[0]), 0.0


@cache
def solved(solver, chain):
    """Return the numbers that a solver gives, or None where it refuses the chain."""
    try:
        result = SOLVERS[solver].solve(chain, GIVEN)
    except ValueError:
        return None
    if isinstance(result, tuple):
        return {"value": np.array(result.value)}
    # How far from rest a fluid is, in units of the chain: it would hide what else is ignored.
    result = result.drop_vars("unsteadiness", errors="ignore")
    # The error of a density is unknown where no rod came.
    names = [str(name) for name in result.data_vars if not str(name).endswith("density_error")]
    return {name: on_common_positions(result[name]) for name in names}


def on_common_positions(values):
    """Put a variable over x onto positions that do not change with the chain, as grids do."""
    if "x" not in values.dims:
        return values.values
    spline = CubicSpline(values.x, values.transpose("x", ...).values)
    return np.where(np.abs(X) < values.x.max().item(), spline(X).T, 0.0)


def start_chain(solver):
    return CHAIN.replace(**SOLVERS[solver].needs)


def differ(one, other):
    return any(
        one[name].shape != other[name].shape
        or np.abs(one[name] - other[name]).max() > _SAME * np.abs(one[name]).max()
        for name in one
    )


def test_every_public_solver_is_called():
    names = {name.split(",")[0] for name in SOLVERS}
    public = {*crazybilliards.kinetic.__all__} - {"UnmeasuredWarning"}
    assert names == public | {"simulate", "simulate_limit"}


def test_every_field_has_another_value():
    for chain in {start_chain(solver) for solver in SOLVERS}:
        for each in fields(Chain):
            assert getattr(chain, each.name) != OTHER[each.name]
            chain.replace(**{each.name: OTHER[each.name]})


@pytest.mark.compiled
@pytest.mark.parametrize("name", [field.name for field in fields(Chain)])
@pytest.mark.parametrize("solver", SOLVERS)
def test_a_parameter_changes_the_result_or_is_refused(solver, name):
    chain = start_chain(solver)
    before, after = (solved(solver, each) for each in (chain, chain.replace(**{name: OTHER[name]})))
    assert before is not None, "the solver must take the chain it starts from"
    if (solver, name) in MEANINGLESS:
        assert after is not None
        assert not differ(before, after), "no longer meaningless: take it off the list"
    else:
        assert after is None or differ(before, after), f"{name} is ignored"


@dataclass(frozen=True, kw_only=True)
class Tilted(Chain):
    """A chain with a parameter that nobody knows."""

    tilt: float = field(default=0.0, metadata={"check": check_real})


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_parameter_that_nobody_knows_is_refused(solver):
    parameters = start_chain(solver).parameters()
    with pytest.raises(ValueError, match="does not know the chain's tilt: it must be 0"):
        SOLVERS[solver].solve(Tilted(**parameters, tilt=1.0), GIVEN)


class Slopes(Widths):
    """An observer that reads it."""

    knows = frozenset({"tilt"})


# What chooses each operator of collisions.
OPERATORS = {
    law.SORT: {"spring": "quadratic"},
    law.ISOTONIC: {"restitution": 0.0},
    law.EVENTS: {"restitution": 0.8},
    law.CONTACTS: {"method": "contact-dynamics"},
    law.EXACT: {},
}


def tilted_run(operator, tilt=1.0, **settings):
    what = OPERATORS[operator].copy()
    how = {"method": what.pop("method", "event-driven"), "duration": 100, "progress": False}
    return simulate(Tilted(size=3, tilt=tilt, **what), **how | settings)


@pytest.mark.parametrize("operator", OPERATORS)
def test_an_operator_takes_what_it_knows_itself(operator, monkeypatch):
    others = {each: {"tilt"} for each in OPERATORS if each != operator}
    monkeypatch.setattr(law, "knows", others)
    with pytest.raises(ValueError, match=f"{law.NAMES[operator]}. does not know the chain's tilt"):
        tilted_run(operator)
    known = tilted_run(operator, tilt=0)
    monkeypatch.setattr(law, "knows", {operator: {"tilt"}})
    run = tilted_run(operator)
    assert json.loads(run.attrs["provenance"])["chain"]["tilt"] == 1
    assert np.isnan(run.attrs["time_step_error"])
    assert np.isnan(known.attrs["time_step_error"]) == (operator == law.CONTACTS)


def test_exact_flight_takes_no_steps_that_know_a_parameter(monkeypatch):
    monkeypatch.setattr(dynamics, "knows", {"tilt"})
    with pytest.raises(ValueError, match=r"exact flight. does not know the chain's tilt"):
        tilted_run(law.EXACT)
    assert np.isnan(tilted_run(law.EVENTS).attrs["time_step_error"])


def test_a_simulation_takes_what_an_observer_reads():
    run = tilted_run(law.EVENTS, observe=["density", Slopes()])
    assert np.isfinite(run.attrs["time_step_error"])
