"""The kinetic equation with pair correlations: exact at e = 1, its balances, simulations."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic import correlated_phase_space, equilibrium, phase_space
from crazybilliards.kinetic.correlations import stationary
from crazybilliards.kinetic.correlations.stationary_result import as_seen_in_place
from crazybilliards.kinetic.kinetic_equation.continuation import elastic_state, free_units
from crazybilliards.kinetic.kinetic_equation.newton import stationary_state
from crazybilliards.kinetic.kinetic_equation.velocity_moments import moments
from crazybilliards.kinetic.kinetic_equation.velocity_space import Box, VelocitySpace
from crazybilliards.kinetic.kinetic_equation.weak_form import Equation, Factors, coefficients
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

CHAIN = Chain(size=30, restitution=0.9)
LABELS = np.linspace(-0.45, 0.45, 19)


@pytest.fixture(scope="module")
def theory():
    """Return the theory of a chain of 30 rods, solved once for each restitution."""
    known = {}

    def find(restitution):
        if restitution not in known:
            chain = CHAIN.replace(restitution=restitution)
            known[restitution] = correlated_phase_space(chain, cells=22)
        return known[restitution]

    return find


def test_elastic_chain_is_exact(theory):
    chain = CHAIN.replace(restitution=1)
    found, exact = theory(1), equilibrium(chain)
    np.testing.assert_allclose(found.velocity_width, chain.free_velocity_width, rtol=2e-4)
    for name in ("mean_displacement", "displacement_width"):
        np.testing.assert_allclose(found[name], exact[name], atol=5e-3 * chain.thermal_length)
    np.testing.assert_array_equal(found.neighbour_covariance, 0)
    np.testing.assert_array_equal(found.contact_loss, 0)
    free = chain.free_velocity_width**2
    np.testing.assert_allclose(found.relative_temperature, free, rtol=1e-3)
    np.testing.assert_allclose(found.mode_velocity_variance, free, rtol=1e-3)


@pytest.mark.compiled
@pytest.mark.parametrize("restitution", [0.9, 0.75])
def test_energy_and_momentum_balance(restitution, theory):
    """Noise heats, damping and collisions cool; the centre of mass is as warm as if alone."""
    chain, found = CHAIN.replace(restitution=restitution), theory(restitution)
    free = chain.free_velocity_width**2
    rate = chain.damping / chain.mass
    lost = 2 * found.contact_loss.sum() / chain.mass + 2 * rate * (found.velocity_width**2).sum()
    assert float(lost / (2 * rate * free * chain.size)) == pytest.approx(1, abs=4e-3)
    assert float(found.mode_velocity_variance[0] / free) == pytest.approx(1, abs=8e-3)
    assert (found.mode_velocity_variance > 0).all()


@pytest.mark.compiled
def test_the_force_balances_the_springs(theory):
    """Between two rods there is what pulls all rods beyond them."""
    chain, found = CHAIN, theory(0.9)
    pull = chain.stiffness * found.mean_displacement.values[::-1].cumsum()[::-1][1:]
    np.testing.assert_allclose(found.contact_force, pull, rtol=0.02)


@pytest.mark.compiled
@pytest.mark.parametrize("restitution", [0.9, 0.75])
def test_simulation(restitution, theory):
    """Widths within the errors that the theory states; all covariances have a test of their own."""
    chain, found = CHAIN.replace(restitution=restitution), theory(restitution)
    run = simulate(chain, duration=8_000, seed=3, observe="widths", threads=1, progress=False)
    ratio = (found.velocity_width / run.velocity_width).values[2:-2] - 1
    error = (run.velocity_width_error / run.velocity_width).values[2:-2].max()
    assert np.abs(ratio).max() < found.attrs["velocity_width_model_error"] + 5 * error
    wide = (found.displacement_width / run.displacement_width).values - 1
    error = (run.displacement_width_error / run.displacement_width).values.max()
    assert np.abs(wide).max() < 0.07 + 5 * error


@pytest.mark.compiled
@pytest.mark.validate
def test_correlations_warm_a_long_chain():
    """What the theory is for: strangers make 100 rods at e = 0.75 nine per cent too slow."""
    chain = Chain(size=100, restitution=0.75)
    middle = slice(45, 55)
    strangers = phase_space(chain, cells=22).velocity_width[middle].mean()
    found = correlated_phase_space(chain, cells=22).velocity_width[middle].mean()
    assert float(found / strangers) == pytest.approx(1.10, abs=0.02)


def along(collisions, noise):
    return Factors(
        *(PchipInterpolator(LABELS, values + 0 * LABELS) for values in (collisions, noise))
    )


def test_constant_factors_are_those_of_collisions_and_noise():
    state = elastic_state(CHAIN, 2, 10)
    numbers = coefficients(CHAIN, free_units(CHAIN), 2)
    with_factors = stationary_state(state.space, numbers, state.f, factors=along(0.7, 0.9)).f
    weaker = numbers._replace(
        drag=0.7 * numbers.drag, diffusion=0.7 * numbers.diffusion, noise=0.9 * numbers.noise
    )
    expected = stationary_state(state.space, weaker, state.f).f
    np.testing.assert_allclose(with_factors, expected, atol=1e-8 * expected.max())


@pytest.mark.parametrize("symmetric", [True, False])
def test_the_variation_knows_the_factors(symmetric):
    """Newton's method needs how the factors move with the label: a difference quotient."""
    space = VelocitySpace(Box(4.0, 4.0, 1.0, 1.0), 6, symmetric)
    y, v = space.axes
    f = space.nodal(np.exp(-(y[:, None] ** 2 + v**2) / 2))
    f = f / (space.whole_mass @ f)
    change = space.nodal(np.exp(-((y[:, None] - 0.5) ** 2 + v**2) / 1.5)) * 0.01
    factors = along(1 + 0.5 * np.cos(3 * LABELS), 1 - 0.4 * np.cos(2 * LABELS))
    equation = Equation(space, coefficients(CHAIN, free_units(CHAIN), 2), factors)
    frozen = equation.matrix(equation.mean(f))
    step = 1e-5
    shifted = [equation.matrix(equation.mean(f + sign * step * change)) for sign in (1, -1)]
    expected = (shifted[0] @ f - shifted[1] @ f) / (2 * step)
    found = equation.variation(f)(change)
    np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(frozen @ f).max())


def test_collective_motion_widens_what_is_seen():
    """Variances add, at every place for the velocities; the number of rods stays."""
    state = elastic_state(CHAIN, 2, 16)
    seen = as_seen_in_place(state, np.array([0.0, 30.0]), np.array([0.2, 0.2]))
    still, moving = (moments(each.space, each.f) for each in (state, seen))
    y, weights = moving.y, moving.weights * moving.density
    assert weights.sum() == pytest.approx(1, abs=1e-4)
    assert weights @ y**2 == pytest.approx(1.2, abs=4e-3)
    inside = y < 2
    np.testing.assert_allclose(moving.variance[inside], still.variance[inside] + 0.2, rtol=0.01)
    unmoved = as_seen_in_place(state, np.array([0.0, 30.0]), np.zeros(2))
    np.testing.assert_allclose(unmoved.f, state.f, atol=1e-3 * state.f.max())


@pytest.mark.compiled
def test_the_coldest_place_is_warmer_than_the_coldest_rods(theory):
    """Warmer rods come there with their neighbourhood: 0.182 and 0.162 in a simulation."""
    found, free = theory(0.75), CHAIN.free_velocity_width**2
    rod = float(found.velocity_width[CHAIN.size // 2]) ** 2 / free
    place = float(found.velocity_variance.interp(x=0)) / free
    stated = 2 * found.attrs["velocity_width_model_error"]  # of squares
    assert rod == pytest.approx(0.162, rel=stated + 0.01)
    assert place == pytest.approx(0.182, rel=stated + 0.01)
    assert place > 1.05 * rod


def test_no_agreement_is_an_error_with_a_reason(monkeypatch):
    monkeypatch.setattr(stationary, "_MOST_ITERATIONS", 2)
    with pytest.raises(ValueError, match=r"no agreement after 2 iterations.*phase_space and sim"):
        correlated_phase_space(CHAIN)


@pytest.mark.validate
def test_the_way_to_small_restitutions_does_not_matter(monkeypatch):
    """From e = 0.5 and 0.2, or from independent points: the fixed point is the same."""
    chain = Chain(size=12, restitution=0)
    by_way = correlated_phase_space(chain, cells=32)
    monkeypatch.setattr(stationary, "_WAY", ())
    direct = correlated_phase_space(chain, cells=32)
    assert by_way.attrs["iterations"] > direct.attrs["iterations"]
    np.testing.assert_allclose(by_way.velocity_width, direct.velocity_width, rtol=2e-3)
