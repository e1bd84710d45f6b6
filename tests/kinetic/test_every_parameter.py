"""No theory ignores a parameter of the chain silently, and no simulation does either.

For every solver and every field of ``Chain``: with that field changed the result changes, or the
call is refused with a ValueError, or ``MEANINGLESS`` says why not. The fields
are read from the class, and another value of each follows from its declaration.
"""

import json
from dataclasses import dataclass, field, fields
from functools import cache

import numpy as np
import pytest
from described_runs import a_run
from every_solver import SOLVERS, Given
from other_values import narrow_box, other_values
from scipy.interpolate import CubicSpline

import crazybilliards as cb
from crazybilliards.kinetic import displaced, force_balance
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain
from crazybilliards.model import chain as model_chain
from crazybilliards.model.checks import check_real
from crazybilliards.particles import dynamics, given_start, relaxation_time, scales, simulate, start
from crazybilliards.particles.laws import law
from crazybilliards.particles.observers import OBSERVERS, Observer

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
_SAME = 5e-3  # of the largest value: what meshes that depend on the chain may change
X = np.linspace(-5, 5, 41)

# A value that no chain here has. Driven chains can take the restitution, cells the amplitude.
OTHER = other_values(size=5, restitution=1.2, amplitude=1.3, wall_restitution=0.5)

# Where W^2 is given, it is all that noise and restitution do, and damping in a steady state.
_GIVEN_HEAT = {"restitution", "amplitude"}
# What the result of a solver cannot depend on.
MEANINGLESS = {
    **dict.fromkeys(
        ("force_balance, variance", "force_balance, number"),
        _GIVEN_HEAT | {"damping", "wall_restitution"},
    ),
    "force_balance, both": _GIVEN_HEAT | {"damping", "wall_restitution", "gap"},
    # The density depends on T = m W^2 = A^2/(2 gamma) alone; where the anchors are is given.
    "force_balance, displacement": {"gap", "mass", "mass_ratio"},
    "hydrodynamics, label, number": _GIVEN_HEAT,
    "hydrodynamics, eulerian, number": _GIVEN_HEAT,
    "hydrodynamics, eulerian, variance": _GIVEN_HEAT,
    # Without noise the equation has no scale of its own, and the size is what is computed.
    "critical_size": {"amplitude", "gap", "radius", "size"},
    # Rods are points in the reduced coordinate, and only the displacements are given out.
    "breathing_cloud": {"radius"},
    # It is the state at restitution 1 that is moved.
    "displaced": {"restitution"},
    "compressed": {"restitution"},
}


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


def changed(chain, name):
    """Return a chain that a solver may start from, and it with another value of the field."""
    box = narrow_box(chain.size, chain.radius)
    if name == "wall_restitution":  # which is that of walls
        chain = chain.replace(box=box)
    return chain, chain.replace(**{name: box if name == "box" else OTHER[name]})


def differ(one, other):
    return any(
        one[name].shape != other[name].shape
        or np.abs(one[name] - other[name]).max() > _SAME * np.abs(one[name]).max()
        for name in one
    )


def test_every_public_solver_is_called():
    names = {name.split(",")[0] for name in SOLVERS}
    public = {*cb.kinetic.__all__} - {"UnmeasuredWarning"}
    assert names == public | {"simulate"}


@pytest.mark.compiled
@pytest.mark.parametrize("name", [field.name for field in fields(Chain)])
@pytest.mark.parametrize("solver", SOLVERS)
def test_a_parameter_changes_the_result_or_is_refused(solver, name):
    before, after = (solved(solver, each) for each in changed(start_chain(solver), name))
    without = name == "wall_restitution" and after is None  # walls
    assert without or before is not None, "the solver must take the chain it starts from"
    if name in MEANINGLESS.get(solver, ()):
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


# All that has a ``knows`` of its own and is asked in every run, with what it says of itself.
READERS = {dynamics: "springs, damping and noise", scales: "time scales", start: "a start"}


@pytest.fixture
def all_know(monkeypatch):
    """Let everything but observers and theories know the parameter."""
    monkeypatch.setattr(law, "knows", {each: {"tilt", "box"} for each in OPERATORS})
    for reader in READERS:
        monkeypatch.setattr(reader, "knows", {"tilt", "box"})


# What chooses each operator of collisions.
OPERATORS = {
    law.SORT: {"spring": "quadratic"},
    law.ISOTONIC: {"restitution": 0.0},
    law.EVENTS: {"restitution": 0.8},
    law.CONTACTS: {"method": "contact-dynamics"},
    law.EXACT: {},
}


def tilted_run(operator=law.EVENTS, tilt=1.0, **settings):
    what = OPERATORS[operator].copy()
    how = {"method": what.pop("method", "event-driven"), "duration": 100, "progress": False}
    return simulate(Tilted(size=3, tilt=tilt, **what), **how | settings)


@pytest.mark.parametrize("operator", OPERATORS)
def test_an_operator_takes_what_it_knows_itself(operator, all_know, monkeypatch):
    monkeypatch.setattr(law, "knows", {operator: {"tilt"}})
    run, known = tilted_run(operator), tilted_run(operator, tilt=0)
    assert (run.attrs["flight"] == "exact") == (operator == law.EXACT)
    assert json.loads(run.attrs["provenance"])["chain"]["tilt"] == 1
    assert np.isnan(run.attrs["time_step_error"])
    assert np.isnan(known.attrs["time_step_error"]) == (operator == law.CONTACTS)


@pytest.mark.parametrize("operator", OPERATORS)
def test_an_operator_that_does_not_know_a_parameter_is_not_taken(operator, all_know):
    del law.knows[operator]
    if operator in (law.EVENTS, law.CONTACTS):  # there is no other one
        said = f"{law.NAMES[operator]}. does not know the chain's tilt"
        with pytest.raises(ValueError, match=said):
            tilted_run(operator)
    else:
        assert tilted_run(operator).attrs["flight"] == "in steps"


@pytest.mark.parametrize("reader", READERS)
def test_a_run_asks_each_that_reads_the_chain(reader, all_know, monkeypatch):
    monkeypatch.setattr(reader, "knows", set())
    with pytest.raises(ValueError, match=f"{READERS[reader]}.* does not know the chain's tilt"):
        tilted_run()
    if reader is dynamics:  # exact flight takes no steps
        assert tilted_run(law.EXACT).attrs["flight"] == "exact"


@pytest.mark.parametrize("name", OBSERVERS)
def test_an_observer_refuses_what_it_does_not_know_unless_it_only_averages(
    name, all_know, monkeypatch
):
    box = narrow_box(3, 1.0) if OBSERVERS[name].meets_walls else 0.0
    chain = Tilted(size=3, restitution=0.8, tilt=1.0, box=box)
    assert Observer.reads_chain, "an observer of one's own refuses it as well"
    a_run(chain, observe="widths")
    if not OBSERVERS[name].reads_chain:
        a_run(chain, observe=name)
        return
    with pytest.raises(ValueError, match=f"observe: '{name}'.* does not know the chain's tilt"):
        a_run(chain, observe=["widths", name])
    monkeypatch.setattr(OBSERVERS[name], "knows", {"tilt", "box"})
    a_run(chain, observe=name)


def test_what_is_asked_outside_of_a_run_refuses_it():
    chain = Tilted(size=3, tilt=1.0)
    with pytest.raises(ValueError, match="relaxation_time does not know the chain's tilt"):
        relaxation_time(chain)
    with pytest.raises(ValueError, match="a start does not know the chain's tilt"):
        given_start(chain, chain.anchors)
    require_chain(chain, "a theory", knows={"tilt"})
    with pytest.raises(ValueError, match="another theory does not know the chain's tilt"):
        require_chain(chain, "another theory", knows={"push"})


def test_what_reads_the_chain_of_a_result_refuses_a_field_that_not_all_know(monkeypatch):
    chain = Chain(size=3, gap=0.5)
    how = {"average": "ensemble", "observe": "snapshots", "progress": False}
    run, theory = simulate(chain, duration=1, **how), force_balance(chain)
    monkeypatch.setattr(model_chain, "KNOWN", model_chain.KNOWN - {"gap"})
    for reader, result in ((cb.film, run), (cb.rod_by_rod, theory)):
        with pytest.raises(ValueError, match=f"{reader.__name__} does not know the chain's gap"):
            reader(result)
