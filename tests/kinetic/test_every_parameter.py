"""No theory ignores a parameter of the chain silently, and no simulation does either.

For every theory and every field of ``Chain``: with that field changed the result changes, or the
call is refused with a ValueError, or the pair stands in ``MEANINGLESS`` with the reason. The fields
are read from the class, and another value of each follows from its declaration.
"""

from dataclasses import dataclass, field, fields
from functools import cache

import numpy as np
import pytest
from other_values import other_values
from scipy.interpolate import CubicSpline

from crazybilliards.comparison.theories import THEORIES as STATIONARY
from crazybilliards.kinetic import (
    breathing_cloud,
    critical_damping,
    critical_restitution,
    critical_size,
    displaced,
    equilibrium_states,
    force_balance,
    hydrodynamics,
    phase_space,
    relax_phase_space,
)
from crazybilliards.kinetic.kinetic_equation import criticality
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_real
from crazybilliards.particles import simulate, simulate_limit

CHAIN = Chain(size=4)
DRIVEN = Chain(size=4, restitution=1.1)
LONGER = Chain(size=10)
# A start and profiles that do not depend on the chain, so that they cannot hide what it ignores.
START = displaced(CHAIN, 0.3)[["density", "label", "flow_velocity", "velocity_variance"]]
START = START.drop_attrs()


def variance(x):
    return 0.1 + 0.02 * np.exp(-(np.asarray(x) ** 2))


def displacement(x):
    return 0.3 * np.asarray(x)


# Of the largest value: what meshes that depend on the chain may change.
_SAME = 5e-3
X = np.linspace(-5, 5, 41)

# For every field a value that CHAIN and DRIVEN do not have.
# Few rods, a restitution that driven chains can take too, an amplitude for which cells of the same
# number in thermal lengths resolve the same.
OTHER = other_values(size=5, restitution=1.2, amplitude=1.3)


def flow(frame, velocity_variance=None, displacement=None):
    def solve(chain):
        return hydrodynamics(
            chain,
            START,
            1.0,
            every=1.0,
            frame=frame,
            velocity_variance=velocity_variance,
            displacement=displacement,
            cells=160,
            progress=False,
        )

    return solve


# Every stationary theory that there is, then other calls.
THEORIES = {name: theory.solve for name, theory in STATIONARY.items()} | {
    "equilibrium_states": lambda chain: equilibrium_states(chain, 2),
    "force_balance, displacement": lambda chain: force_balance(chain, displacement),
    "force_balance, variance": lambda chain: force_balance(chain, velocity_variance=variance),
    "force_balance, number": lambda chain: force_balance(chain, velocity_variance=0.1),
    "force_balance, both": lambda chain: force_balance(chain, displacement, variance),
    "label isothermal": flow("label"),
    "label evolving": flow("label", "evolving"),
    "label number": flow("label", 0.1),
    "eulerian isothermal": flow("eulerian"),
    "eulerian evolving": flow("eulerian", "evolving"),
    "eulerian number": flow("eulerian", 0.1),
    "eulerian variance": flow("eulerian", variance),
    "eulerian displacement": flow("eulerian", None, displacement),
    "breathing_cloud": lambda chain: breathing_cloud(chain, 1.0, every=1.0, stretch=0.5),
    "phase_space": lambda chain: phase_space(chain, cells=8),
    "relax_phase_space": lambda chain: relax_phase_space(
        chain, START, 0.5, every=0.5, cells=6, progress=False
    ),
    "critical_size": critical_size,
    "critical_restitution": critical_restitution,
    "critical_damping": critical_damping,
    "simulate": lambda chain: simulate(
        chain,
        duration=70.0,
        warmup=1.0,
        time_step=0.1,
        every=1.0,
        observe=("widths", "density"),
        progress=False,
    ),
    "simulate_limit": lambda chain: simulate_limit(
        chain, accuracy=0.1, warmup=1.0, observe=("widths", "density"), progress=False
    ),
}

_GIVEN = "W^2 is given, and a steady state depends on noise and damping through it alone"
_GIVEN_NOISE = "W^2 is given, and it is all that the noise does"
_GIVEN_LOSS = "W^2 is given, and it is all that the restitution does"
_GIVEN_ANCHORS = "the displacement is given, and with it where the anchors are"
_SCALE_FREE = "without noise the equation has no scale of its own, see critical_size"
_POINTS = "rods are points in the reduced coordinate, and only the displacements are given out"

# (theories, field): why the result cannot depend on the field.
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
        (theory, name): reason
        for theory in ("label number", "eulerian number", "eulerian variance")
        for name, reason in {"restitution": _GIVEN_LOSS, "amplitude": _GIVEN_NOISE}.items()
    },
    **{
        (theory, name): _SCALE_FREE
        for theory in ("critical_size", "critical_restitution", "critical_damping")
        for name in ("amplitude", "gap", "radius")
    },
    ("critical_size", "size"): "it is what is computed",
    ("critical_restitution", "restitution"): "it is what is computed",
    ("critical_damping", "damping"): "it is what is computed",
    ("breathing_cloud", "radius"): _POINTS,
}


@pytest.fixture(autouse=True)
def _coarse(monkeypatch):
    """Take a drag short of the critical one: what it depends on is the same."""
    monkeypatch.setattr(criticality, "_critical_drag", drag)


@cache
def drag(damping):
    return float(criticality.drag_at_noise(damping, (0.85,), cells=12)[0]), 0.0


@cache
def solved(theory, chain):
    """Return the numbers that a theory gives, or None where it refuses the chain."""
    try:
        result = THEORIES[theory](chain)
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


def start_chain(theory):
    if theory.startswith("correlated"):
        return LONGER
    return DRIVEN if theory.startswith("critical") else CHAIN


def differ(one, other):
    return any(
        one[name].shape != other[name].shape
        or np.abs(one[name] - other[name]).max() > _SAME * np.abs(one[name]).max()
        for name in one
    )


def test_every_field_has_another_value():
    for each in fields(Chain):
        for chain in (CHAIN, DRIVEN, LONGER):
            assert getattr(chain, each.name) != OTHER[each.name]
            chain.replace(**{each.name: OTHER[each.name]})


@pytest.mark.compiled
@pytest.mark.parametrize("name", [field.name for field in fields(Chain)])
@pytest.mark.parametrize("theory", THEORIES)
def test_a_parameter_changes_the_result_or_is_refused(theory, name):
    chain = start_chain(theory)
    before, after = (solved(theory, each) for each in (chain, chain.replace(**{name: OTHER[name]})))
    assert before is not None, "the theory must take the chain it starts from"
    if (theory, name) in MEANINGLESS:
        assert after is not None
        assert not differ(before, after), "no longer meaningless: take it off the list"
    else:
        assert after is None or differ(before, after), f"{name} is ignored"


@dataclass(frozen=True, kw_only=True)
class Tilted(Chain):
    """A chain with a parameter that no theory knows."""

    tilt: float = field(default=0.0, metadata={"check": check_real})


@pytest.mark.parametrize("theory", [theory for theory in THEORIES if theory != "simulate"])
def test_a_parameter_that_no_theory_knows_is_refused(theory):
    parameters = start_chain(theory).parameters()
    with pytest.raises(ValueError, match="does not know the chain's tilt: it must be 0"):
        THEORIES[theory](Tilted(**parameters, tilt=1.0))
