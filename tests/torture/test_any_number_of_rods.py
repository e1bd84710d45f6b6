"""Every theory holds all rods, symmetrically, wherever in the parameter space the chain lies."""

import math

import numpy as np
import pytest
from all_rods import require_all_rods
from every_solver import SOLVERS, Given
from exploration import explored
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.kinetic import compressed
from crazybilliards.model import Chain

EXAMPLES = 12
FEW = 5  # of what takes seconds

# A shock makes rounding errors grow, and a mesh of finite elements has small ripples.
ROUGHLY = 1e-4


def decades(low, high):
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


@st.composite
def chains(draw, most=1000):
    """Chains of any size; their lengths are in units of a thermal length from 0.01 to 100."""
    return Chain(
        size=draw(st.integers(1, most)),
        gap=draw(st.just(0.0) | decades(-3, 3)),
        amplitude=draw(decades(-2, 2)),
        damping=draw(decades(-2, 2)),
        stiffness=draw(decades(-2, 2)),
        radius=draw(decades(-1, 1)),
        mass=draw(decades(-1, 1)),
        spring=draw(st.sampled_from(["linear", "quadratic"])),
    )


@st.composite
def scaled_chains(draw, restitutions=(1.0,)):
    """Chains whose thermal length and velocity width are 1, small enough for grids and meshes."""
    damping = draw(decades(-1, 1))
    return Chain(
        size=draw(st.integers(1, 8)),
        gap=draw(st.just(0.0) | decades(-2, 0.5)),
        radius=draw(decades(-1, 0.3)),
        damping=damping,
        amplitude=math.sqrt(2 * damping),
        mass=1.0,
        spring=draw(st.sampled_from(["linear", "quadratic"])),
        restitution=draw(st.sampled_from(restitutions)),
    )


NEAR_ONE = scaled_chains(restitutions=[0.9, 1.0, 1.02])
AT_REST, MOVED, FLOWING = st.just(1.0), st.floats(0.2, 5.0), st.floats(0.5, 2.0)
# chains, stretches of the start, number of examples, how alike both sides must be, by solvers.
EXPLORED = {
    ("force_balance",): (chains(), AT_REST, EXAMPLES, 1e-6),
    tuple(name for name in SOLVERS if name.startswith("force_balance, ")): (
        *(chains(200), AT_REST, EXAMPLES, 1e-6),
    ),
    ("equilibrium",): (chains(100), AT_REST, EXAMPLES, 1e-6),
    ("displaced",): (chains(), MOVED, EXAMPLES, None),
    ("compressed",): (chains(), MOVED, EXAMPLES, 1e-6),
    tuple(name for name in SOLVERS if name.startswith("hydrodynamics, label")): (
        *(chains(100), FLOWING, FEW, 1e-6),
    ),
    tuple(name for name in SOLVERS if name.startswith("hydrodynamics, eulerian")): (
        *(scaled_chains(), FLOWING, FEW, ROUGHLY),
    ),
    ("steady_state", "steady_state, mean field"): (NEAR_ONE, AT_REST, EXAMPLES, 1e-6),
}


def scaled(chain, stretch):
    """Return what the solvers are given, at the scales of the chain."""
    s, W = chain.thermal_length, chain.free_velocity_width
    extent = 1.5 * chain.anchors[-1] + s
    return Given(
        start=compressed(chain.replace(restitution=1.0), stretch),
        # Three times the free one around the ends of the chain.
        variance=lambda x: W**2 * (1 + 2 * np.minimum(np.abs(x) / extent, 1) ** 2),
        number=3 * W**2,
        length=stretch * s,
        stretch=stretch,
        times={"duration": s / W, "every": s / W},
    )


@pytest.mark.parametrize(
    ("name", "explored_by"), [(name, each) for names, each in EXPLORED.items() for name in names]
)
def test_all_rods_are_held(name, explored_by):
    drawn, stretches, examples, alike = explored_by
    solver = SOLVERS[name]

    @explored(examples)
    @given(drawn.map(lambda chain: chain.replace(**solver.needs)), stretches)
    def require(chain, stretch):
        theory = solver.solve(chain, scaled(chain, stretch))
        if alike is None:  # the state is moved to one side
            ends = theory.label.values[[0, -1]]
            np.testing.assert_allclose(ends, [0, chain.size], atol=1e-9 * chain.size)
        else:
            require_all_rods(theory, chain.size, alike)
        if "rods" in theory:
            np.testing.assert_allclose(theory.rods, chain.size, rtol=1e-9)

    require()
