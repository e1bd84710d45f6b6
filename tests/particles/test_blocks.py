"""Blocks of time: the jackknife over them, and how long they are."""

import numpy as np
import pytest

from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.observers.error_bars import jackknife


def mean(average):
    return average


def test_the_error_of_a_mean_of_equal_blocks_is_the_standard_error():
    blocks = np.random.default_rng(0).normal(size=(20, 3))
    value, error = jackknife(mean, 7 * blocks, np.full(20, 7))
    np.testing.assert_allclose(value, blocks.mean(axis=0))
    np.testing.assert_allclose(error, blocks.std(axis=0, ddof=1) / np.sqrt(20))


def test_unequal_blocks_are_weighted_and_empty_ones_ignored():
    """Blocks of n samples of variance 1 give the mean of all with an error 1/sqrt(N)."""
    generator = np.random.default_rng(1)
    counts = generator.integers(5, 15, size=4000)
    sums = np.array([generator.normal(size=n).sum() for n in counts])
    value, error = jackknife(mean, sums, counts)
    assert value == pytest.approx(sums.sum() / counts.sum())
    assert error * np.sqrt(counts.sum()) == pytest.approx(1, abs=0.05)
    padded = jackknife(mean, np.append(sums, 0.0), np.append(counts, 0))
    np.testing.assert_allclose(padded, (value, error))


def test_every_time_has_blocks_of_its_own():
    generator = np.random.default_rng(2)
    sums, counts = generator.normal(size=(6, 4, 2, 5)), generator.integers(1, 4, size=(6, 4))

    def difference(average):
        return average[..., 0, :] - average[..., 1, :]

    counts[3:, 2] = 0
    value, error = jackknife(difference, sums * counts[..., None, None], counts)
    assert value.shape == error.shape == (4, 5)
    for time in range(4):
        alone = jackknife(difference, sums[:, time] * counts[:, time, None, None], counts[:, time])
        np.testing.assert_allclose((value[time], error[time]), alone)


def test_one_block_tells_nothing_of_the_error():
    value, error = jackknife(mean, np.array([[2.0, 4.0]]), np.array([2]))
    np.testing.assert_array_equal(value, [1, 2])
    assert np.isinf(error).all()


@pytest.mark.compiled
def test_blocks_are_added_up_in_pairs_and_stay_longer_than_the_memory():
    """The error of a mean is right, from 33 to 64 blocks, as that of a known process."""
    chain = Chain(size=1, damping=2)
    for duration in (2000, 40_000):
        run = simulate(chain, duration=duration, replicas=2, observe="density", progress=False)
        assert 32 <= run.sizes["block"] <= 64
    # The mean of a displacement over a time t has the variance 2 tau <d^2>/t, tau = gamma/k.
    how = {"duration": 5000, "observe": "widths", "progress": False, "replicas": 2}
    runs = [simulate(chain, seed=seed, **how) for seed in range(40)]
    found = np.mean([run.mean_displacement_error.item() ** 2 for run in runs])
    known = 2 * chain.damping / chain.stiffness * chain.temperature / chain.stiffness / 10_000
    assert found == pytest.approx(known, rel=5 * np.sqrt(2 / 40 / 32))
