"""The jackknife over blocks."""

import numpy as np
import pytest

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
