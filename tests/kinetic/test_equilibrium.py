"""The exact equilibrium against order statistics, a truncated Gaussian, and its own samples."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import betainc
from scipy.stats import beta, gennorm, truncnorm

from crazybilliards.kinetic import equilibrium, equilibrium_states
from crazybilliards.model import Chain


def free_displacement(chain):
    """Distribution of one rod's displacement without collisions: exp(-U/T)."""
    n = chain.potential_exponent
    return gennorm(n, scale=n ** (1 / n) * chain.thermal_length)


@pytest.mark.parametrize("amplitude", [0.1, 100.0])
@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("size", [1, 2, 20, 100])
def test_without_gap_displacements_are_order_statistics(size, spring, amplitude):
    chain = Chain(size=size, spring=spring, amplitude=amplitude)
    exact = equilibrium(chain)
    free = free_displacement(chain)
    for i in {1, size // 3 + 1, (size + 1) // 2, size}:
        rank = beta(i, size - i + 1)
        ends = free.ppf(rank.ppf([1e-14, 1 - 1e-14]))

        def moment(power, centre=0.0, free=free, rank=rank, ends=ends):
            return quad(
                lambda d: (d - centre) ** power * rank.pdf(free.cdf(d)) * free.pdf(d),
                *ends,
                epsabs=0,
                epsrel=1e-10,
                limit=200,
                points=[0.0] if ends[0] < 0 < ends[1] else None,
            )[0]

        mean = moment(1) if i != size + 1 - i else 0.0
        tolerance = 1e-5 * chain.thermal_length
        assert exact.mean_displacement.values[i - 1] == pytest.approx(mean, abs=tolerance)
        width = math.sqrt(moment(2, mean))
        assert exact.displacement_width.values[i - 1] == pytest.approx(width, rel=1e-5)


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
def test_without_gap_the_label_is_a_sum_of_beta_distributions(spring):
    chain = Chain(size=20, amplitude=3, spring=spring)
    exact = equilibrium(chain)
    free = free_displacement(chain)
    x, i = exact.x.values[:, None], np.arange(1, 21)
    share = free.cdf(x - 2 * chain.radius * chain.rank)
    label = betainc(i, 21 - i, share).sum(axis=1)
    np.testing.assert_allclose(exact.label, label, atol=2e-6)
    density = (beta(i, 21 - i).pdf(share) * free.pdf(x - 2 * chain.radius * chain.rank)).sum(axis=1)
    np.testing.assert_allclose(exact.density, density, atol=1e-5)


@pytest.mark.parametrize("gap", [0.0, 0.3, 2.0])
def test_two_rods_are_a_truncated_gaussian(gap):
    """The distance of two rods on linear springs is a Gaussian cut off at contact."""
    chain = Chain(size=2, gap=gap)
    s = chain.thermal_length
    distance = truncnorm(-gap / (math.sqrt(2) * s), np.inf, loc=gap, scale=math.sqrt(2) * s)
    exact = equilibrium(chain)
    shift = (distance.mean() - gap) / 2
    np.testing.assert_allclose(exact.mean_displacement, [-shift, shift], atol=1e-6)
    width = math.sqrt(s**2 / 2 + distance.var() / 4)
    np.testing.assert_allclose(exact.displacement_width, width, rtol=1e-5)


@pytest.mark.parametrize("amplitude", [0.1, 1.0, 100.0])
@pytest.mark.parametrize("gap", [1e-6, 0.2, 3.0])
@pytest.mark.parametrize("size", [2, 50, 150])
def test_it_just_works(size, gap, amplitude):
    chain = Chain(size=size, gap=gap, amplitude=amplitude)
    exact = equilibrium(chain)
    assert exact.attrs["residual"] < 1e-5
    for name in exact.data_vars:
        assert np.isfinite(exact[name]).all(), name
    assert (exact.density >= -1e-9).all()
    assert exact.label[-1] == pytest.approx(size)
    np.testing.assert_allclose(exact.label + exact.label[::-1].values, size, atol=1e-6 * size)
    np.testing.assert_allclose(
        exact.mean_displacement, -exact.mean_displacement[::-1].values, atol=1e-9 * amplitude
    )
    assert (exact.velocity_width == chain.free_velocity_width).all()


def test_rods_far_apart_are_free():
    chain = Chain(size=5, gap=100.0)
    exact = equilibrium(chain)
    np.testing.assert_allclose(exact.mean_displacement, 0, atol=1e-12)
    np.testing.assert_allclose(exact.displacement_width, chain.thermal_length, rtol=1e-6)


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("gap", [0.0, 0.2, 1.0])
def test_sampled_states_have_the_exact_statistics(gap, spring):
    chain = Chain(size=20, gap=gap, spring=spring)
    n = 20_000
    states = equilibrium_states(chain, n, seed=11)
    exact = equilibrium(chain)
    y = chain.reduced(states.position)
    assert (np.diff(y, axis=1) >= -1e-12).all()
    d = y - chain.reduced_anchors
    pull = (d.mean(axis=0) - exact.mean_displacement) / (exact.displacement_width / math.sqrt(n))
    assert np.abs(pull).max() < 5
    # The variance of a sample variance needs the fourth moment, which the sample gives.
    squares = (d - exact.mean_displacement.values) ** 2
    pull = (squares.mean(axis=0) - exact.displacement_width**2) / (squares.std(0) / math.sqrt(n))
    assert np.abs(pull).max() < 5
    velocity = states.velocity / chain.free_velocity_width
    assert abs(float((velocity**2).mean()) - 1) < 5 * math.sqrt(2 / velocity.size)
    assert equilibrium_states(chain, 3, seed=11).identical(equilibrium_states(chain, 3, seed=11))
