"""Averages with honest error bars: block means and the jackknife over blocks.

Successive snapshots are correlated; means over blocks much longer than the correlation time are
not. The jackknife leaves out one block at a time, which gives the standard error of any function
of the averages (a width, say), not only of the averages themselves.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def block_means(sums: Array, counts: NDArray[np.int64]) -> tuple[Array, Array]:
    """Return the overall mean and the means of the complete blocks.

    ``sums`` has shape (blocks, ...), ``counts`` (blocks,): how many snapshots went into each. A
    block that an interruption cut short counts in the mean but not among the complete ones.
    """
    mean = sums.sum(axis=0) / counts.sum()
    complete = counts == np.max(counts)
    shape = (-1,) + (1,) * (sums.ndim - 1)
    return mean, sums[complete] / counts[complete].reshape(shape)


def jackknife(
    function: Callable[[Array], Array], mean: Array, blocks: Array
) -> tuple[Array, Array]:
    """Value and standard error of ``function(averages)``, from the mean and the block means.

    With fewer than two blocks nothing is known about the error: it is infinite.
    """
    value = function(mean)
    n = len(blocks)
    if n < 2:
        return value, np.full_like(value, np.inf)
    total = blocks.sum(axis=0)
    left_out = np.array([function((total - block) / (n - 1)) for block in blocks])
    return value, np.sqrt((n - 1) * left_out.var(axis=0))
