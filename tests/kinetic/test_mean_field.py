"""The mean field: independent points, to first order exactly, at rest in time, as particles."""

import numpy as np
import pytest
from independent_points import rods_of_independent_points
from scipy.special import ndtr

from crazybilliards.kinetic import force_balance, hydrodynamics, steady_state
from crazybilliards.kinetic.exact.places import exchangeable
from crazybilliards.kinetic.gas.closure import Closure
from crazybilliards.model import Chain


def mean_field(chain):
    """Return mean places of the rods, and T about the centre of mass, in units of the free rod."""
    found, L = steady_state(chain, correlations=False), chain.size
    W_v = found.velocity_width.values / chain.free_velocity_width
    return found.mean_displacement.values / chain.thermal_length, (W_v**2 - 1 / L) / (1 - 1 / L)


@pytest.mark.parametrize("size", [2, 3, 30])
def test_to_first_order_all_rods_lose_what_their_pairs_lose(size):
    """A pair meets at the rate <|w|> int p^2 dy and loses (1 - e^2)/2 w^2, from Gaussians.

    It is exact, as the centre of mass keeps its share. Mutations: a = 1 - 1/L, E(e) of e^2.
    """
    chain = Chain(size=size, restitution=1 - 1e-3 / size)
    pair = (1 - chain.restitution**2) / 2 * (8 / np.sqrt(np.pi)) / (2 * np.sqrt(np.pi))
    lost = pair * (size - 1) / 2 / (2 * chain.relative_damping)
    _, T = mean_field(chain)
    W_v2 = (1 - 1 / size) * T + 1 / size
    assert np.mean(1 - W_v2) == pytest.approx(lost, rel=2e-3)


@pytest.mark.compiled
@pytest.mark.parametrize(("size", "restitution"), [(6, 0.5), (20, 0.9)])
def test_it_is_where_the_gas_in_time_comes_to_rest(size, restitution, monkeypatch):
    """In time the centre of mass is not apart: a = 1 - 1/L. Mutation: no 3 in the conductivity."""
    monkeypatch.setattr(Closure, "strength", lambda _, T: np.full(T.size, 1 - 1 / size))
    chain = Chain(size=size, restitution=restitution)
    start, how = force_balance(chain.replace(restitution=1)), {"every": 30.0, "progress": False}
    flow = hydrodynamics(chain, start, 30, velocity_variance="evolving", cells=100, **how)
    end, law = flow.isel(time=-1), exchangeable(size)
    label = size * ndtr(law.places)
    expected = law.mean(np.interp(label, end.label, end.velocity_variance))
    _, T = mean_field(chain)
    np.testing.assert_allclose(T * chain.free_velocity_width**2, expected, rtol=0.01)
    energy = chain.mass / 2 * chain.free_velocity_width**2 * T.sum()
    assert energy == pytest.approx(float(end.kinetic_energy), rel=2e-3)


@pytest.mark.validate
def test_it_is_that_of_simulated_independent_points():
    chain = Chain(size=20, restitution=0.7)
    place, T, error = rods_of_independent_points(
        20, 0.7, chain.relative_damping, number=4000, duration=100, warmup=20, seed=1
    )
    found, own = mean_field(chain)
    off, error = np.sqrt(own / T) - 1, error / T / 2
    assert error.max() < 0.01
    assert (np.abs(off) < 5 * error + 0.03)[2:-2].all()
    assert abs(off[0]) < 5 * error[0] + 0.06
    np.testing.assert_allclose(found, place, atol=0.02)


def test_a_strongly_damped_driven_chain_has_a_state():
    """On the way to it forces are not balanced to the last digit. Mutation: an error where not."""
    chain = Chain(size=100, restitution=1.05, damping=10)
    assert (steady_state(chain).velocity_width > chain.free_velocity_width).all()


def test_few_rods_and_driven_ones_have_it_always():
    """One rod meets nobody, and the centre of mass is as warm as if alone."""
    alone = Chain(size=1, restitution=0.2)
    assert steady_state(alone).velocity_width.item() == pytest.approx(alone.free_velocity_width)
    for chain in (Chain(size=3, restitution=0.2), Chain(size=30, restitution=1.03)):
        found, same = steady_state(chain), steady_state(chain, correlations=False)
        np.testing.assert_array_equal(found.velocity_width, same.velocity_width)
        assert "mean field" in found.attrs["provenance"]
        hotter = chain.restitution > 1
        assert np.isfinite(same.attrs["border_model_error"]) == hotter
        assert ((found.velocity_width > chain.free_velocity_width) == hotter).all()
