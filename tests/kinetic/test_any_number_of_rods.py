"""Theories hold all rods, symmetrically, and the gap of a single rod does not matter."""

import numpy as np
import pytest
from all_rods import require_all_rods
from every_solver import SOLVERS, Given

from crazybilliards.kinetic import compressed, displaced, force_balance, hydrodynamics, steady_state
from crazybilliards.kinetic.gas.descriptions import _elastic_share
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result

CHAINS = [
    *(Chain(size=1, gap=100.0), Chain(size=3, mass=0.1), Chain(size=7, gap=0.4, radius=2.0)),
    Chain(size=25, gap=3.0, amplitude=10.0, damping=0.1, radius=0.2, mass=5.0),
    Chain(size=40, gap=1e-3, amplitude=0.1, stiffness=0.03, damping=20.0),
]
# The flow of points is too fast in these.
AT_REST = [Chain(size=15, gap=20.0), Chain(size=40, gap=1.0, amplitude=10, spring="quadratic")]
TAKEN = dict.fromkeys(("force_balance", "compressed", "steady_state"), CHAINS + AT_REST)
TAKEN |= {"hydrodynamics, label": CHAINS, "hydrodynamics, eulerian": CHAINS[1:3]}


def scaled(chain, stretch):
    """Return what the solvers are given, at the scales of the chain."""
    s, W = chain.thermal_length, chain.free_velocity_width
    extent = 1.5 * chain.anchors[-1] + s
    return Given(
        start=compressed(chain.replace(restitution=1.0), stretch),
        # Three times the free one around the ends of the chain.
        variance=lambda x: W**2 * (1 + 2 * np.minimum(np.abs(x) / extent, 1) ** 2),
        number=3 * W**2,
        stretch=stretch,
        times={"duration": s / W, "every": s / W},
    )


@pytest.mark.compiled
@pytest.mark.parametrize("name", [name for name in SOLVERS if name.startswith(tuple(TAKEN))])
def test_all_rods_are_held(name):
    solver, kind = SOLVERS[name], next(kind for kind in TAKEN if name.startswith(kind))
    for chain in TAKEN[kind]:
        changed = chain.replace(**solver.needs)
        require_all_rods(solver.solve(changed, scaled(changed, stretch=0.7)), chain.size)


def test_one_rod_has_no_gap():
    """It has no neighbour to be apart from."""
    for spring in ("linear", "quadratic"):
        chain = Chain(size=1, spring=spring)
        apart = chain.replace(gap=20.0)
        for solve in (force_balance, steady_state):
            np.testing.assert_array_equal(solve(apart).density, solve(chain).density)
    start = displaced(Chain(size=1), 1.0).drop_attrs()
    options = {"duration": 1.0, "every": 1.0, "progress": False}
    one, other = (hydrodynamics(Chain(size=1, gap=gap), start, **options) for gap in (0.0, 20.0))
    np.testing.assert_array_equal(one.mean_displacement, other.mean_displacement)
    np.testing.assert_array_equal(one.density, other.density)


def test_the_ends_of_a_long_chain_with_a_gap_are_those_of_a_shorter_one(monkeypatch):
    chain = Chain(size=60, restitution=0.8, gap=2.0)
    whole = steady_state(chain, correlations=False)
    monkeypatch.setattr("crazybilliards.kinetic.gas.descriptions._MOST", 40)
    _elastic_share.cache_clear()
    of_ends = steady_state(chain, correlations=False)
    _elastic_share.cache_clear()
    for name in ("velocity_width", "displacement_width", "density"):
        np.testing.assert_allclose(of_ends[name], whole[name], rtol=1e-9, atol=1e-9, err_msg=name)


def test_a_result_without_all_rods_is_refused():
    chain, x = Chain(size=10), np.array([-1.0, 1.0])
    density = ("x", np.array([0.0, 0.0]))
    for most in (9.9999, 10.0001, np.nan):
        values = {"density": density, "label": ("x", np.array([0.0, most]))}
        with pytest.raises(ValueError, match="of the chain's 10 rods"):
            result(chain, values, coordinates={"x": x}, source="theory", method={})
