"""The pair correlations' ingredients: what is exact about each of them."""

import numpy as np
import pytest
from scipy.integrate import dblquad

from crazybilliards.kinetic.correlations.closure import Closure, background, implied
from crazybilliards.kinetic.correlations.one_rod import OneRod
from crazybilliards.kinetic.correlations.pair_covariance import (
    Background,
    PairCovariance,
    Problem,
    dissipation,
    linear_response,
    solve_pairs,
)
from crazybilliards.kinetic.gas.cells import at_distance, make_cells
from crazybilliards.kinetic.gas.collision_moments import moments_of_collisions
from crazybilliards.kinetic.gas.contact_speeds import contact_speed
from crazybilliards.kinetic.gas.fixed_point import NoFixedPointError, find_fixed_point
from crazybilliards.model import Chain


def gaussian(v, u):
    return np.exp(-(v**2 + u**2) / 2) / (2 * np.pi)


def by_quadrature(restitution, psi, phi):
    share = (1 - restitution) / 2

    def made(v, u):
        w = v - u
        change = psi(v - share * w) * phi(u + share * w) - psi(v) * phi(u)
        return abs(w) * change * gaussian(v, u)

    above = dblquad(made, -9, 9, -9, lambda v: v, epsabs=1e-9)[0]
    return above + dblquad(made, -9, 9, lambda v: v, 9, epsabs=1e-9)[0]


def first(v):
    return v


def second(v):
    return v**2 - 1


def third(v):
    return v**3 - 3 * v


@pytest.mark.parametrize("restitution", [0.5, 0.9])
def test_collision_moments_are_the_integrals(restitution):
    found = moments_of_collisions(restitution)
    for name, psi, phi in (
        ("energy", first, first),
        ("temperature", second, second),
        ("velocity_heat", first, third),
        ("heat", third, third),
    ):
        assert getattr(found, name) == pytest.approx(by_quadrature(restitution, psi, phi), abs=1e-7)
    share = (1 - restitution) / 2

    def lost(v, u):
        change = third(v - share * (v - u)) - third(v)
        return -abs(v - u) * change * (third(v) + third(u)) / 6 * gaussian(v, u)

    decay = sum(
        dblquad(lost, -9, 9, *sides, epsabs=1e-9)[0] for sides in ((-9, lambda v: v), (first, 9))
    )
    assert found.decay == pytest.approx(decay, abs=1e-7)
    assert set(moments_of_collisions(1.0)) == {0.0}


@pytest.mark.parametrize("size", [10, 130, 131, 300, 1000])
def test_cells_hold_all_rods(size):
    cells = make_cells(size)
    assert cells.rods.sum() == pytest.approx(size)
    assert (cells.rods > 0.5).all()
    np.testing.assert_allclose(cells.rods, cells.rods[::-1], rtol=1e-12)
    np.testing.assert_allclose(cells.centres + cells.centres[::-1], size)
    np.testing.assert_allclose(np.diff(cells.centres), cells.distances)
    if size <= 130:
        np.testing.assert_allclose(cells.rods, 1)


@pytest.mark.parametrize("size", [20, 400])
def test_covariances_are_continued_linearly_to_a_short_distance(size):
    cells = make_cells(size, most=100)
    apart = np.abs(cells.centres[:, None] - cells.centres)
    middle = (cells.centres[:, None] + cells.centres) / 2
    covariance = 3 - 0.01 * apart + 0.002 * middle + 7 * np.eye(cells.rods.size)
    found = at_distance(covariance, cells.centres, cells.contacts, 1.0)
    np.testing.assert_allclose(found, 3 - 0.01 + 0.002 * cells.contacts, rtol=2e-3)
    # What neighbours have beyond that, from their own last collision, is left out as well.
    contact = np.full(cells.contacts.size, 5.0)
    spiked = covariance + np.diag(contact, 1) + np.diag(contact, -1)
    found = at_distance(spiked, cells.centres, cells.contacts, 1.0, nearest=2)
    np.testing.assert_allclose(found, 3 - 0.01 + 0.002 * cells.contacts, rtol=2e-3)


def a_gas(size, restitution):
    """Return a problem, one rod and no pair correlations, for the closure."""
    one = np.ones(size - 1)
    rod = OneRod(0.3 * one, 7 * one, 0.05 * one, 7 * 0.3**0.5 * one)
    nothing = np.zeros((size, size))
    contacts = np.zeros((size - 1, size - 1))
    problem = Problem.of(Chain(size=size, restitution=restitution))
    return problem, rod, PairCovariance(nothing, nothing, contacts, contacts, contacts)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9])
def test_a_collision_takes_its_share_of_the_force(restitution):
    """Lambda = (1 - e) P <w^2>/<w>, by sampling the pairs that meet: Gaussians, slower by K."""
    problem, rod, _ = a_gas(12, restitution)
    shared = Closure.independent(problem.cells)._replace(shared=np.full(11, 0.2))
    loss = dissipation(problem, background(problem, rod, shared))
    rng = np.random.default_rng(2)
    # Of approaching neighbours.
    w = np.abs(rng.normal(size=400_000)) * np.sqrt(2 * 0.3 * 0.8) * contact_speed(restitution)
    rate = 2 * rod.force[0] / (1 + restitution) / (w * w).mean()  # they meet in proportion to w
    taken = rate * (w * (1 - restitution**2) * w**2 / 2)
    assert abs(taken.mean() - loss[0]) < 5 * taken.std() / np.sqrt(w.size)


def test_uncorrelated_rods_collide_as_in_the_kinetic_equation():
    """Without correlations the factor is that of L - 1 partners that meet more slowly by K."""
    for restitution in (0.99, 0.9):
        problem, rod, none = a_gas(12, restitution)
        state = background(problem, rod, Closure.independent(problem.cells))
        factor = np.exp(implied(problem, rod, state, none).log_factor)
        expected = (1 - 1 / 12) * 2 / (1 + restitution) * contact_speed(restitution)
        np.testing.assert_allclose(factor, expected, rtol=1e-12)


def test_the_closure_of_known_covariances():
    """Clustering to second order, and the bounds of an iteration."""
    problem, rod, none = a_gas(12, 0.5)
    last = np.diag(np.full(11, 0.02), 1) + np.diag(np.full(11, 0.02), -1)  # their own collision's
    pairs = none._replace(
        velocity=none.velocity + 0.06 + last,
        displacement=none.displacement + 0.02,
        gap_temperature=none.gap_temperature + 0.3,
        temperature=none.temperature + 0.2,
    )
    start = Closure.independent(problem.cells)._replace(collective=np.full(11, 0.02))
    found = implied(problem, rod, background(problem, rod, start), pairs)
    np.testing.assert_allclose(found.shared, 0.07 / 0.32)  # half of the neighbours leave
    np.testing.assert_allclose(found.collective, 0.02)
    np.testing.assert_allclose(found.factors(problem).noise(0.1), 0.98)
    # The same fluctuations, a hundred times smaller: their mean is that of second order.
    size, (nodes, weights) = 1e-2, np.polynomial.hermite_e.hermegauss(8)
    spread = np.linalg.cholesky(size**2 * np.array([[0.5, 0.3], [0.3, 0.2]]))
    gap, temperature = 1 + np.tensordot(spread, np.meshgrid(nodes, nodes), 1)
    weights = np.outer(weights, weights) / (2 * np.pi)
    ratio = (weights * temperature**1.5 / gap).sum() / (weights * temperature / gap).sum()
    expected = np.exp(found.log_clustering)
    np.testing.assert_allclose(1 + (ratio - 1) / size**2, expected, atol=1e-3)
    assert found.is_possible
    assert not found._replace(shared=found.shared + 0.9).is_possible
    np.testing.assert_array_equal(Closure.unpacked(found.packed()).shared, found.shared)


def some_problem(size, restitution=0.7, damping=0.3):
    """Return a problem of 60 cells at most, and what its pairs fluctuate about."""
    chain, cells = Chain(size=size, restitution=restitution), make_cells(size, most=60)
    problem = Problem(chain, cells, moments_of_collisions(restitution), damping)
    place = 2 * cells.contacts / size - 1
    density = 40 * (1 - 0.8 * place**2)
    temperature = 0.1 + 0.3 * place**2
    return problem, Background(
        density=density,
        gap=1.1 / density,
        temperature=temperature,
        pressure=1.2 * density * temperature,
        strength=1.3 + 0.1 * place**2,
        shared=0.05 + 0.03 * place**2,
    )


@pytest.mark.parametrize("size", [11, 60, 200])
def test_the_centre_of_mass_gets_what_collisions_take(size):
    """It is an oscillator of its own, which collisions cannot cool."""
    problem, state = some_problem(size)
    pairs, N = solve_pairs(problem, state), problem.cells.rods
    fed = problem.cells.distances @ dissipation(problem, state)
    edges = np.concatenate([[state.shared[0]], state.shared, [state.shared[-1]]])
    held = 2 * 0.3 * (N @ ((edges[1:] + edges[:-1]) / 2))
    assert N @ pairs.velocity @ N == pytest.approx((fed + held) / (2 * 0.3), rel=1e-9)
    assert N @ pairs.displacement @ N == pytest.approx(N @ pairs.velocity @ N, rel=1e-9)


@pytest.mark.parametrize("size", [11, 60])
def test_covariances_are_stationary_symmetric_and_possible(size):
    problem, state = some_problem(size)
    response, cells = linear_response(problem, state), problem.cells
    h, M, Q = response.stationary(), response.generator, response.noise
    np.testing.assert_allclose(M @ h + h @ M.T, -Q, atol=1e-9 * np.abs(M @ h).max())
    assert response.largest_growth() < 0
    pairs = solve_pairs(problem, state)
    for each in (pairs.velocity, pairs.displacement, pairs.gap, pairs.temperature):
        np.testing.assert_allclose(each, each.T, atol=1e-9 * np.abs(each).max())
        np.testing.assert_allclose(each, each[::-1, ::-1], atol=1e-9 * np.abs(each).max())
    local = np.interp(cells.centres, cells.contacts, state.temperature) / cells.rods
    assert np.linalg.eigvalsh(pairs.velocity + np.diag(local)).min() > 0


def test_a_collision_correlates_the_two_that_meet():
    """Not each with itself: beside the diagonal stands what a contact takes, one half each."""
    problem, state = some_problem(30)
    state, cells = state._replace(shared=0 * state.shared), problem.cells
    response = linear_response(problem, state)
    warmth = np.sqrt(np.interp(cells.centres, cells.contacts, state.temperature))
    noise = response.noise[30:60, 30:60] * np.outer(warmth, warmth)
    taken = dissipation(problem, state)
    assert noise.sum() == pytest.approx(taken.sum(), rel=0.02)
    np.testing.assert_array_equal(np.diag(noise), 0)
    assert np.diag(noise, 1).sum() == pytest.approx(noise.sum() / 2)


def test_free_rods_keep_what_they_have():
    """Without damping and collisions waves neither grow nor decay."""
    rates = np.linalg.eigvals(linear_response(*some_problem(40, 1.0, damping=0.0)).generator)
    assert np.abs(rates.real).max() < 1e-6 * np.abs(rates.imag).max()


def test_free_rods_are_compressed_adiabatically():
    """In one dimension Theta g^2 stays: a gap that grows cools twice as fast."""
    size, n, Theta = 20, 50.0, 0.3
    one = np.ones(size - 1)
    state = Background(n * one, one / n, Theta * one, n * Theta * one, one, 0 * one)
    problem = Problem.of(Chain(size=size))._replace(damping=0.0)
    generator = linear_response(problem, state).generator
    fields = np.zeros(4 * size - 3)
    fields[size : 2 * size] = np.arange(size) / np.sqrt(Theta)  # V, in units of sqrt(Theta)
    change = (generator @ fields)[2 * size : 3 * size - 1]  # of Theta, in units of Theta
    np.testing.assert_allclose(change, -2 * n, rtol=1e-12)


def test_elastic_rods_are_not_correlated():
    problem, state = some_problem(40, restitution=1.0)
    for each in solve_pairs(problem, state._replace(shared=0 * state.shared)):
        np.testing.assert_array_equal(each, 0)


def test_the_fixed_point_is_found_or_refused():
    matrix = np.array([[0.5, -0.9], [0.8, -1.4]])  # a plain iteration would grow
    found = find_fixed_point(lambda x: matrix @ x + 1, np.zeros(2), 1e-10, 40)
    np.testing.assert_allclose(found.x, np.linalg.solve(np.eye(2) - matrix, [1, 1]), rtol=1e-8)
    assert found.residual < 1e-10
    with pytest.raises(NoFixedPointError, match="no agreement after 5 iterations"):
        find_fixed_point(lambda x: x + 1, np.zeros(2), 1e-3, 5)


def test_the_fixed_point_goes_back_from_where_there_is_nothing():
    def image(x):
        if x > 0.55:
            raise ValueError("nothing here")
        return 2 * x**2 + 0.1

    found = find_fixed_point(image, np.zeros(1), 1e-8, 40)
    np.testing.assert_allclose(found.x, (1 - np.sqrt(0.2)) / 4, atol=1e-7)
    with pytest.raises(ValueError, match="nothing here"):
        find_fixed_point(image, np.ones(1), 1e-8, 40)
