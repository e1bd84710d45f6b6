"""Two hundred million random numbers: whatever a few seconds of statistics can see in them."""

from typing import NamedTuple

import numpy as np
import pytest
from scipy.special import factorial2, ndtr
from scipy.stats import chi2, kstest, kstwobign, norm, poisson

from crazybilliards.particles.noise import BLOCK, fill, make_noise

BATCH, BATCHES = 1000 * BLOCK, 196
NUMBER = BATCH * BATCHES
CELLS = 1_000_000  # of equal probability
SIGMAS = (3.0, 4.0, 5.0, 5.5)
# From one number of a generator to the next, and from one block to the next; half a block away is
# the other projection of the same radius.
LAGS = (*range(1, 33), 511, 512, 513, 1023, 1024, 1025, 2048)
FIVE_SIGMA = 2 * norm.sf(5)


class Sums(NamedTuple):
    powers: np.ndarray  # of the numbers to the power k = 1 to 8
    cells: np.ndarray  # how many numbers lie in each
    tails: np.ndarray  # how many lie below and above each of the SIGMAS, (2, 4)
    products: np.ndarray  # of numbers, and of x^2 - 1, a lag apart, (2, lags)
    blocks: np.ndarray  # the sum over every block, and of the squares, (2, blocks)


@pytest.fixture(scope="module")
def sums():
    noise = make_noise(np.random.SeedSequence(0))
    x, blocks = np.empty(BATCH), np.empty((2, BATCHES, BATCH // BLOCK))
    found = Sums(
        np.zeros(8),
        np.zeros(CELLS, dtype=np.int64),
        np.zeros((2, len(SIGMAS)), dtype=np.int64),
        np.zeros((2, len(LAGS))),
        blocks.reshape(2, -1),
    )
    for batch in range(BATCHES):
        fill(noise, x)
        power = np.ones(BATCH)
        for k in range(8):
            power *= x
            found.powers[k] += power.sum()
        np.add.at(found.cells, (CELLS * ndtr(x)).astype(np.int64), 1)
        for number, sigmas in enumerate(SIGMAS):
            found.tails[:, number] += (x < -sigmas).sum(), (x > sigmas).sum()
        squares = x * x - 1
        for row, values in enumerate((x, squares)):
            for number, lag in enumerate(LAGS):
                found.products[row, number] += values[lag:] @ values[:-lag]
            blocks[row, batch] = values.reshape(-1, BLOCK).sum(axis=1)
    return found


@pytest.mark.parametrize("k", range(1, 9))
def test_moments(sums, k):
    exact = 0 if k % 2 else factorial2(k - 1)
    error = np.sqrt((factorial2(2 * k - 1) - exact**2) / NUMBER)
    assert abs(sums.powers[k - 1] / NUMBER - exact) < 5 * error


def test_thousand_cells_of_equal_probability_are_filled_alike(sums):
    counts = sums.cells.reshape(1000, -1).sum(axis=1)
    square = ((counts - NUMBER / 1000) ** 2).sum() / (NUMBER / 1000)
    assert FIVE_SIGMA / 2 < chi2.sf(square, 999) < 1 - FIVE_SIGMA / 2


def test_the_distribution_is_normal(sums):
    """Kolmogorov and Smirnov's test, at the ends of the cells."""
    distance = np.abs(sums.cells.cumsum() / NUMBER - np.arange(1, CELLS + 1) / CELLS).max()
    assert kstwobign.sf(distance * np.sqrt(NUMBER)) > FIVE_SIGMA


@pytest.mark.parametrize("tail", [0, 1])
@pytest.mark.parametrize("number", range(len(SIGMAS)))
def test_tails(sums, number, tail):
    found, expected = sums.tails[tail, number], NUMBER * norm.sf(SIGMAS[number])
    assert poisson.cdf(found, expected) > FIVE_SIGMA / 2
    assert poisson.sf(found - 1, expected) > FIVE_SIGMA / 2


@pytest.mark.parametrize("number", range(len(LAGS)))
def test_no_number_knows_of_an_earlier_one(sums, number):
    pairs = (BATCH - LAGS[number]) * BATCHES
    assert abs(sums.products[0, number]) < 5 * np.sqrt(pairs)
    assert abs(sums.products[1, number]) < 5 * 2 * np.sqrt(pairs)  # x^2 has the variance 2


def test_sums_over_blocks_are_distributed_as_those_of_independent_numbers(sums):
    total, squares = sums.blocks
    assert kstest(total / np.sqrt(BLOCK), "norm").pvalue > FIVE_SIGMA
    assert kstest(squares + BLOCK, chi2(BLOCK).cdf).pvalue > FIVE_SIGMA
