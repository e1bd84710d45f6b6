"""The exact equilibrium: order statistics, sums over a mesh, its samples."""

import math

import numpy as np
import pytest
from scipy.special import betainc
from scipy.stats import beta, gennorm

from crazybilliards.kinetic import equilibrium, equilibrium_states
from crazybilliards.kinetic.exact.gibbs_measure import recursion_of
from crazybilliards.model import Chain


def in_a_box(room, **parameters):
    """Return a chain whose reduced coordinates have this room."""
    chain = Chain(**parameters)
    return chain.replace(box=room + 2 * chain.radius * chain.size)


def free_displacement(chain):
    """Distribution of one rod's displacement without collisions: exp(-U/T)."""
    n = chain.potential_exponent
    return gennorm(n, scale=n ** (1 / n) * chain.thermal_length)


@pytest.mark.parametrize(
    ("size", "amplitude", "spring"),
    [(1, 1, "quadratic"), (2, 0.1, "linear"), (20, 3, "linear"), (20, 100, "quadratic")],
)
def test_without_gap_displacements_are_order_statistics(size, amplitude, spring):
    chain = Chain(size=size, spring=spring, amplitude=amplitude)
    exact, free, i = equilibrium(chain), free_displacement(chain), np.arange(1, size + 1)
    law = beta(i, size + 1 - i)
    d = np.linspace(*free.ppf([1e-14, 1 - 1e-14]), 20_001)[:, None]
    p = law.pdf(free.cdf(d)) * free.pdf(d) * (d[1] - d[0])
    mean = (d * p).sum(axis=0)
    np.testing.assert_allclose(exact.mean_displacement, mean, atol=1e-5 * chain.thermal_length)
    width = np.sqrt(((d - mean) ** 2 * p).sum(axis=0))
    np.testing.assert_allclose(exact.displacement_width, width, rtol=1e-5)
    y = exact.x.values[:, None] - 2 * chain.radius * chain.rank
    label = betainc(i, size + 1 - i, free.cdf(y)).sum(axis=1)
    np.testing.assert_allclose(exact.label, label, atol=2e-6)
    density = (law.pdf(free.cdf(y)) * free.pdf(y)).sum(axis=1)
    np.testing.assert_allclose(exact.density, density, atol=1e-5 * density.max())


@pytest.mark.parametrize(("size", "gap"), [(1, 0.0), (5, 0.7), (200, 0.0)])
def test_without_springs_rods_have_beta_laws_and_the_pressure_of_points(size, gap):
    chain = in_a_box(30.0, size=size, gap=gap, stiffness=0, mass_ratio=3, radius=0.5)
    exact, i = equilibrium(chain), np.arange(1, size + 1)
    law = beta(i, size + 1 - i, loc=-15, scale=30)
    y = exact.mean_displacement + chain.reduced_anchors
    np.testing.assert_allclose(y, law.mean(), atol=1e-6)
    np.testing.assert_allclose(exact.displacement_width, law.std(), rtol=5e-6)
    np.testing.assert_allclose(exact.wall_force, size * chain.temperature / 30, rtol=1e-6)
    np.testing.assert_allclose(exact.velocity_width**2 * chain.rod_masses, chain.temperature)
    x = exact.x.values[:, None] - 2 * chain.radius * chain.rank
    np.testing.assert_allclose(exact.label, law.cdf(x).sum(axis=1), atol=1e-4 * size)
    assert exact.residual < 1e-6


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
def test_without_gap_the_pressure_is_that_of_independent_rods(spring):
    chain = in_a_box(3.0, size=20, spring=spring, amplitude=3)
    free = free_displacement(chain)
    at_wall = free.pdf(1.5) / (free.cdf(1.5) - free.cdf(-1.5))
    pressure = chain.size * chain.temperature * at_wall
    np.testing.assert_allclose(equilibrium(chain).wall_force, pressure, rtol=1e-7)


@pytest.mark.parametrize(("amplitude", "spring"), [(0.7, "quadratic"), (4.0, "linear")])
def test_three_rods_with_a_gap_against_a_sum_over_a_mesh(amplitude, spring):
    chain = in_a_box(2.0, size=3, gap=0.6, spring=spring, amplitude=amplitude)
    y, weight = np.polynomial.legendre.leggauss(60)
    one, two, three = np.meshgrid(y, y, y, indexing="ij")
    # Each ordered place is a place in the unit cube: y_1 < y_2 < y_3.
    third = three
    second = -1 + (third + 1) * (two + 1) / 2
    first = -1 + (second + 1) * (one + 1) / 2
    stretch = (third + 1) / 2 * (second + 1) / 2
    places = np.stack([first, second, third])
    energy = chain.potential(np.moveaxis(places, 0, -1) - chain.reduced_anchors).sum(axis=-1)
    p = np.einsum("i,j,k,ijk->ijk", weight, weight, weight, stretch)
    p *= np.exp(-energy / chain.temperature)
    p /= p.sum()
    mean = (places * p).sum(axis=(1, 2, 3))
    width = np.sqrt(((places - mean[:, None, None, None]) ** 2 * p).sum(axis=(1, 2, 3)))
    exact = equilibrium(chain)
    np.testing.assert_allclose(
        exact.mean_displacement, mean - chain.reduced_anchors, atol=2e-5 * width.max()
    )
    np.testing.assert_allclose(exact.displacement_width, width, rtol=2e-5)


@pytest.mark.parametrize(
    ("room", "gap", "amplitude", "spring"),
    [
        *((15.0, 0.3, 3.0, "linear"), (4.0, 0.3, 1.0, "quadratic"), (20.0, 0.3, 10.0, "quadratic")),
        (5.0, 1.0, 3.0, "linear"),  # rods that the walls press together
    ],
)
def test_the_pressure_is_the_work_of_a_wall(room, gap, amplitude, spring):
    """P = T d(log Z)/dX, of all rods on springs with gaps."""
    chain = in_a_box(room, size=50, gap=gap, amplitude=amplitude, spring=spring)
    step = 1e-4 * room
    log_z = []
    for change in (-step, step):
        recursion = recursion_of(chain.replace(box=chain.box + change))
        log_z.append(recursion.log_z(49)[-1] + 50 * np.log(recursion.spacing))
    pressure = chain.temperature * (log_z[1] - log_z[0]) / (2 * step)
    exact = equilibrium(chain)
    np.testing.assert_allclose(exact.wall_force, pressure, rtol=1e-6)
    assert exact.residual < 1e-5


def test_both_walls_are_alike_where_a_node_is_on_the_place_of_a_rod():
    density = equilibrium(Chain(size=10, box=30)).density.values
    np.testing.assert_allclose(density, density[::-1], atol=1e-9)


def test_far_walls_change_nothing():
    chain = Chain(size=20, gap=0.5, amplitude=3)
    near, far = equilibrium(chain), equilibrium(chain.replace(box=1e7))
    for name in ("mean_displacement", "displacement_width"):
        np.testing.assert_allclose(far[name], near[name], atol=1e-6)
    assert (far.wall_force < 1e-9).all()


@pytest.mark.parametrize(
    "chain",
    [
        *(Chain(size=20), Chain(size=20, gap=0.2, spring="quadratic"), Chain(size=20, gap=1)),
        in_a_box(8.0, size=20, amplitude=4, mass_ratio=3, gap=0.4),
        in_a_box(8.0, size=20, amplitude=4, mass_ratio=3, stiffness=0),
    ],
    ids=repr,
)
def test_sampled_states_have_the_exact_statistics(chain):
    n = 10_000
    exact, states = equilibrium(chain), equilibrium_states(chain, n, seed=11)
    y = chain.reduced(states.position)
    assert (np.diff(y, axis=1) >= -1e-12).all()
    assert not chain.box or np.abs(y).max() <= chain.walls[1]
    d = y - chain.reduced_anchors
    pull = (d.mean(axis=0) - exact.mean_displacement) / (exact.displacement_width / math.sqrt(n))
    assert np.abs(pull).max() < 5
    # The variance of a sample variance needs the fourth moment, which the sample gives.
    squares = (d - exact.mean_displacement.values) ** 2
    pull = (squares.mean(axis=0) - exact.displacement_width**2) / (squares.std(0) / math.sqrt(n))
    assert np.abs(pull).max() < 5
    squares = (states.velocity / exact.velocity_width) ** 2
    assert np.abs(squares.mean("replica") - 1).max() < 5 * math.sqrt(2 / n)
    assert equilibrium_states(chain, 3, seed=11).identical(equilibrium_states(chain, 3, seed=11))
