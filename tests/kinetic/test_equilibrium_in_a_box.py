"""The exact equilibrium between walls: order statistics, sums over a mesh, and its samples."""

import numpy as np
import pytest
from scipy.stats import beta, gennorm

from crazybilliards.kinetic import equilibrium, equilibrium_states
from crazybilliards.kinetic.exact.recursion import recursion_of
from crazybilliards.model import Chain


def in_a_box(room, **parameters):
    """Return a chain whose reduced coordinates have this room."""
    chain = Chain(**parameters)
    return chain.replace(box=room + 2 * chain.radius * chain.size)


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
    n = chain.potential_exponent
    free = gennorm(n, scale=n ** (1 / n) * chain.thermal_length)
    at_wall = free.pdf(1.5) / (free.cdf(1.5) - free.cdf(-1.5))
    pressure = chain.size * chain.temperature * at_wall
    np.testing.assert_allclose(equilibrium(chain).wall_force, pressure, rtol=1e-7)


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("amplitude", [0.7, 4.0])
def test_three_rods_with_a_gap_against_a_sum_over_a_mesh(amplitude, spring):
    chain = in_a_box(2.0, size=3, gap=0.6, spring=spring, amplitude=amplitude)
    y, weight = np.polynomial.legendre.leggauss(160)
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


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize(
    ("size", "room", "amplitude"),
    [(30, 15.0, 3.0), (30, 4.0, 1.0), (30, 20.0, 10.0), (300, 30.0, 30.0)],
)
def test_the_pressure_is_the_work_of_a_wall(size, room, amplitude, spring):
    """P = T d(log Z)/dX, of all rods on springs with gaps."""
    chain = in_a_box(room, size=size, gap=0.3, amplitude=amplitude, spring=spring)
    step = 1e-4 * room
    log_z = []
    for change in (-step, step):
        recursion = recursion_of(chain.replace(box=chain.box + change))
        log_z.append(recursion.log_z(size - 1)[-1] + size * np.log(recursion.spacing))
    pressure = chain.temperature * (log_z[1] - log_z[0]) / (2 * step)
    np.testing.assert_allclose(equilibrium(chain).wall_force, pressure, rtol=1e-6)


def test_rods_that_walls_press_together_are_resolved():
    exact = equilibrium(in_a_box(5.0, size=50, gap=1, amplitude=3))
    assert exact.residual < 1e-5
    assert exact.wall_force[0] > 200


def test_both_walls_are_alike_where_a_node_is_on_the_place_of_a_rod():
    density = equilibrium(Chain(size=10, box=30)).density.values
    np.testing.assert_allclose(density, density[::-1], atol=1e-9)


def test_far_walls_change_nothing():
    chain = Chain(size=20, gap=0.5, amplitude=3)
    near, far = equilibrium(chain), equilibrium(chain.replace(box=1e7))
    for name in ("mean_displacement", "displacement_width"):
        np.testing.assert_allclose(far[name], near[name], atol=1e-6)
    assert (far.wall_force < 1e-9).all()


@pytest.mark.parametrize("parameters", [{"stiffness": 0}, {"gap": 0.4}, {}])
def test_states_are_drawn_from_it(parameters):
    chain = in_a_box(8.0, size=20, amplitude=4, mass_ratio=3, **parameters)
    exact, states = equilibrium(chain), equilibrium_states(chain, 4000, seed=1)
    assert np.abs(states.position).max() <= chain.box / 2 - chain.radius
    displacement = states.position.values - chain.anchors
    error = exact.displacement_width.values / np.sqrt(4000)
    assert (
        np.abs(displacement.mean(axis=0) - exact.mean_displacement.values).max() < 5 * error.max()
    )
    spread = displacement.std(axis=0) / exact.displacement_width.values - 1
    assert np.abs(spread).max() < 5 / np.sqrt(4000)
    speeds = states.velocity.values.std(axis=0) / exact.velocity_width.values - 1
    assert np.abs(speeds).max() < 5 / np.sqrt(8000)


def test_walls_that_take_energy_are_refused():
    with pytest.raises(
        ValueError, match=r"elastic walls only: wall_restitution must be 1, got 0\.5"
    ):
        equilibrium(in_a_box(8.0, size=20, wall_restitution=1.0).replace(wall_restitution=0.5))
