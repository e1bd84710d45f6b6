"""Every theory holds all rods, symmetrically, wherever in the parameter space the chain lies."""

import math

import numpy as np
from all_rods import require_all_rods
from exploration import explored
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.kinetic import (
    compressed,
    displaced,
    equilibrium,
    force_balance,
    hydrodynamics,
    phase_space,
    relax_phase_space,
    two_clumps,
)
from crazybilliards.model import Chain

EXAMPLES = 12
FEW = 5  # of what takes seconds

# A shock makes rounding errors grow, and a mesh of finite elements has small ripples.
ROUGHLY = 1e-4


def decades(low, high):
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


@st.composite
def chains(draw, most=1000, linear=False):
    """Chains of any size; their lengths are in units of a thermal length from 0.01 to 100."""
    return Chain(
        size=draw(st.integers(1, most)),
        gap=draw(st.just(0.0) | decades(-3, 3)),
        amplitude=draw(decades(-2, 2)),
        damping=draw(decades(-2, 2)),
        stiffness=draw(decades(-2, 2)),
        radius=draw(decades(-1, 1)),
        mass=draw(decades(-1, 1)),
        spring="linear" if linear else draw(st.sampled_from(["linear", "quadratic"])),
    )


def warm(chain):
    """Return a velocity variance that is three times the free one around the ends of the chain."""
    free, extent = chain.free_velocity_width**2, 1.5 * chain.anchors[-1] + chain.thermal_length
    return lambda x: free * (1 + 2 * np.minimum(np.abs(x) / extent, 1) ** 2)


def soft(chain):
    """Return a displacement that holds the rods together more weakly than labels do."""
    return lambda x: 0.3 * np.asarray(x)


@explored(EXAMPLES)
@given(chains())
def test_force_balance(chain):
    require_all_rods(force_balance(chain), chain.size)


@explored(EXAMPLES)
@given(chains(most=200, linear=True))
def test_force_balance_with_a_velocity_variance(chain):
    require_all_rods(force_balance(chain, velocity_variance=warm(chain)), chain.size)
    number = 3 * chain.free_velocity_width**2
    require_all_rods(force_balance(chain, velocity_variance=number), chain.size)


@explored(EXAMPLES)
@given(chains(most=200))
def test_force_balance_with_a_displacement(chain):
    require_all_rods(force_balance(chain, soft(chain)), chain.size)


@explored(EXAMPLES)
@given(chains(most=50))
def test_force_balance_with_both(chain):
    require_all_rods(force_balance(chain, soft(chain), warm(chain)), chain.size)


@explored(EXAMPLES)
@given(chains(most=100))
def test_equilibrium(chain):
    require_all_rods(equilibrium(chain), chain.size)


@explored(EXAMPLES)
@given(chains(), st.floats(0.2, 5.0))
def test_starts(chain, factor):
    require_all_rods(compressed(chain, factor), chain.size)
    require_all_rods(two_clumps(chain, factor * chain.thermal_length, 1.0), chain.size)
    moved = displaced(chain, factor * chain.thermal_length)
    np.testing.assert_allclose(moved.label.values[[0, -1]], [0, chain.size], atol=1e-9 * chain.size)


@explored(FEW)
@given(chains(most=100), st.sampled_from([None, "evolving"]), st.floats(0.5, 2.0))
def test_hydrodynamics_on_labels(chain, fluid, factor):
    duration = chain.thermal_length / chain.free_velocity_width
    flow = hydrodynamics(
        chain,
        compressed(chain, factor),
        duration,
        every=duration,
        velocity_variance=fluid,
        progress=False,
    )
    require_all_rods(flow, chain.size)
    np.testing.assert_allclose(flow.rods, chain.size, rtol=1e-9)


@st.composite
def scaled_chains(draw):
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
    )


@explored(FEW)
@given(scaled_chains(), st.sampled_from([None, "evolving"]), st.floats(0.5, 2.0))
def test_hydrodynamics_on_positions(chain, fluid, factor):
    start = compressed(chain, factor)
    options = {"every": 1.0, "velocity_variance": fluid, "frame": "eulerian", "progress": False}
    flow = hydrodynamics(chain, start, 1.0, **options)
    require_all_rods(flow, chain.size, ROUGHLY)
    np.testing.assert_allclose(flow.rods, chain.size, rtol=1e-9)


@explored(EXAMPLES)
@given(scaled_chains(), st.sampled_from([0.9, 1.0, 1.02]))
def test_kinetic_equation(chain, restitution):
    chain = chain.replace(restitution=restitution)
    require_all_rods(phase_space(chain, cells=12), chain.size)


@explored(FEW)
@given(scaled_chains(), st.sampled_from([0.9, 1.0, 1.02]), st.floats(0.8, 1.2))
def test_kinetic_equation_in_time(chain, restitution, factor):
    start = compressed(chain, factor)
    chain = chain.replace(restitution=restitution)
    flow = relax_phase_space(chain, start, 1.0, every=1.0, cells=8, progress=False)
    require_all_rods(flow, chain.size, ROUGHLY)
    np.testing.assert_allclose(flow.rods, chain.size, rtol=1e-9)
