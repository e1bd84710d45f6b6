"""Fluctuations of the gas and the closure that follows from them: what is exact about each."""

import numpy as np
import pytest

from crazybilliards.kinetic.gas.cells import make_cells
from crazybilliards.kinetic.gas.closure import contact_speed, implied
from crazybilliards.kinetic.gas.fluctuations import (
    Background,
    PairCovariance,
    covariances,
    linear_response,
)
from crazybilliards.kinetic.gas.mean_state import Medium
from crazybilliards.model import Chain

DAMPING = 0.3


def of_chain(size, restitution=0.7, damping=DAMPING, **changes):
    """Return the medium of a chain, and its cells, 60 at most."""
    chain = Chain(size=size, restitution=restitution, **changes)
    cells = make_cells(size, most=60, walled=chain.box > 0)
    return Medium.of(chain)._replace(damping=damping), cells


def some_state(size, restitution=0.7, damping=DAMPING, **changes):
    """Return what pairs fluctuate about, which varies along the chain."""
    medium, cells = of_chain(size, restitution, damping, **changes)
    place = 2 * cells.all_labels / size - 1
    density = 40 * (1 - 0.8 * place**2)
    temperature = 0.1 + 0.3 * place**2
    return Background(
        medium,
        cells,
        density=density,
        gap=1.1 / density,
        temperature=temperature,
        pressure=1.2 * density * temperature,
        strength=1.3 + 0.1 * place**2,
        shared=0.05 + 0.03 * place**2,
        collective=0 * place,
        stiffness=np.ones(cells.rods.size),
    )


def uniform_state(size, restitution, damping=DAMPING, **changes):
    """Return a state with the same everywhere, as Gaussian neighbours have it."""
    medium, cells = of_chain(size, restitution, damping, **changes)
    one, n, Theta = np.ones(cells.all_labels.size), 50.0, 0.3
    strength = 2 / (1 + restitution) * contact_speed(restitution) * one
    stiffness = np.full(size, medium.stiffness)
    fields = n * one, one / n, Theta * one, n * Theta * one, strength, 0 * one, 0 * one, stiffness
    return Background(medium, cells, *fields)


@pytest.mark.parametrize("size", [11, 60, 200])
def test_the_centre_of_mass_gets_what_collisions_take(size):
    """It is an oscillator of its own, which collisions cannot cool."""
    state = some_state(size)
    pairs = covariances(state, linear_response(state))
    N, shared = state.cells.rods, state.shared
    fed = state.cells.distances @ state.loss
    at_ends = np.concatenate([shared[:1], shared, shared[-1:]])
    held = 2 * DAMPING * (N @ ((at_ends[1:] + at_ends[:-1]) / 2))
    assert N @ pairs.velocity @ N == pytest.approx((fed + held) / (2 * DAMPING), rel=1e-9)
    assert N @ pairs.displacement @ N == pytest.approx(N @ pairs.velocity @ N, rel=1e-9)


@pytest.mark.parametrize("changes", [{"size": 11}, {"size": 60}, {"size": 20, "box": 50}])
def test_covariances_are_stationary_symmetric_and_possible(changes):
    state = some_state(**changes)
    response = linear_response(state)
    h, M, Q = response.stationary(), response.generator, response.noise
    np.testing.assert_allclose(M @ h + h @ M.T, -Q, atol=1e-9 * np.abs(M @ h).max())
    assert response.largest_growth() < 0
    pairs = covariances(state, response)
    for each in (pairs.velocity, pairs.displacement, pairs.gap, pairs.temperature):
        np.testing.assert_allclose(each, each.T, atol=1e-9 * np.abs(each).max())
        np.testing.assert_allclose(each, each[::-1, ::-1], atol=1e-9 * np.abs(each).max())
    labels = state.cells.all_labels
    local = np.interp(state.cells.centres, labels, state.temperature) / state.cells.rods
    assert np.linalg.eigvalsh(pairs.velocity + np.diag(local)).min() > 0


def test_a_collision_correlates_the_two_that_meet():
    """Not each with itself: beside the diagonal stands what a contact takes, one half each."""
    state = uniform_state(30, 0.7)
    noise = linear_response(state).noise[30:60, 30:60]
    np.testing.assert_array_equal(np.diag(noise), 0)
    np.testing.assert_allclose(np.diag(noise, 1), state.loss / 2)
    np.testing.assert_allclose(np.diag(noise, -1), state.loss / 2)


@pytest.mark.parametrize("changes", [{}, {"box": 100, "stiffness": 0}])
def test_free_rods_keep_what_they_have(changes):
    """Without damping and collisions waves neither grow nor decay."""
    state = some_state(40, 1.0, damping=0.0, **changes)
    rates = np.linalg.eigvals(linear_response(state).generator)
    assert np.abs(rates.real).max() < 1e-6 * np.abs(rates.imag).max()


def test_free_rods_are_compressed_adiabatically():
    """In one dimension Theta g^2 stays: a gap that grows cools twice as fast."""
    state = uniform_state(20, 1.0, damping=0.0)
    _, V, Th, q = state.parts
    fields = np.zeros(q.stop)
    fields[V] = np.arange(20)
    change = (linear_response(state).generator @ fields)[Th]
    np.testing.assert_allclose(change, -2 * state.pressure, rtol=1e-12)


def test_a_gas_between_walls_has_the_waves_of_one_that_is_its_own_mirror_image():
    """A wall is a neighbour that does not move: waves sin(pi q i/(L + 1)), one equation each."""
    size, q = 12, 3
    state = uniform_state(size, 0.7, box=40, stiffness=0)
    i, contact = np.arange(1, size + 1), np.arange(size + 1) + 0.5
    shapes = np.sin(np.pi * q * i / (size + 1)), np.cos(np.pi * q * contact / (size + 1))
    fields = np.zeros((state.parts[3].stop, 4))
    for column, place in enumerate(state.parts):
        fields[place, column] = shapes[column == 2]
    change = linear_response(state).generator @ fields
    within = np.linalg.lstsq(fields, change, rcond=None)[0]
    np.testing.assert_allclose(fields @ within, change, atol=1e-9 * np.abs(change).max())


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9])
def test_a_collision_takes_its_share_of_the_force(restitution):
    """Lambda = (1 - e) P <w^2>/<w>, by sampling the pairs that meet: Gaussians, slower by K."""
    state = uniform_state(12, restitution)
    loss = state.loss[0]
    rng = np.random.default_rng(2)
    # Of approaching neighbours.
    w = np.abs(rng.normal(size=400_000)) * np.sqrt(2 * 0.3) * contact_speed(restitution)
    rate = 2 * state.pressure[0] / (1 + restitution) / (w * w).mean()  # they meet like w
    taken = rate * (w * (1 - restitution**2) * w**2 / 2)
    assert abs(taken.mean() - loss) < 5 * taken.std() / np.sqrt(w.size)


def test_the_closure_of_known_covariances():
    """Clustering to second order, half of what the last collision left, and K h_uu."""
    state = uniform_state(12, 0.5)
    state = state._replace(stiffness=np.full(12, 1.5), shared=np.full(11, 0.02))
    none, last = np.zeros((12, 12)), np.diag(np.full(11, 0.02), 1)
    pairs = PairCovariance(
        state.cells,
        velocity=none + 0.06 + last + last.T,
        displacement=none + 0.02,
        gap=none[1:, 1:],
        gap_temperature=none[1:, 1:] + 0.3,
        temperature=none[1:, 1:] + 0.2,
    )
    found = implied(state, pairs)
    np.testing.assert_allclose(found.shared, 0.07 / 0.32)  # half of the neighbours leave
    np.testing.assert_allclose(found.collective, 0.03)  # mutation: h without k_i
    # The same fluctuations, a hundred times smaller: their mean is that of second order.
    size, (nodes, weights) = 1e-2, np.polynomial.hermite_e.hermegauss(8)
    spread = np.linalg.cholesky(size**2 * np.array([[0.5, 0.3], [0.3, 0.2]]))
    gap, temperature = 1 + np.tensordot(spread, np.meshgrid(nodes, nodes), 1)
    weights = np.outer(weights, weights) / (2 * np.pi)
    ratio = (weights * temperature**1.5 / gap).sum() / (weights * temperature / gap).sum()
    expected = np.exp(found.log_strength) * 1.5 / 2 / contact_speed(0.5)
    np.testing.assert_allclose(1 + (ratio - 1) / size**2, expected, atol=1e-3)
    assert found.is_possible
    assert not found._replace(shared=found.shared + 0.9).is_possible
