"""Averages with standard errors from the jackknife over blocks.

Successive snapshots are correlated. Means over blocks much longer than the correlation time are
not, and neither are replicas or groups of them. The jackknife leaves out one block at a time. It
gives the standard error of any function of the averages (e.g. a width), not only of the averages
themselves. Blocks may differ in length. The weights are those of the delete-m_j jackknife (Busing,
Meijer and van der Leeden, Statistics and Computing 9, 3-8, 1999).
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Array


def jackknife(
    function: Callable[[Array], Array], sums: Array, counts: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Return value and standard error of ``function(averages)``, from sums over blocks.

    ``counts``, shape (blocks, ...), says how many snapshots went into each block, ``sums`` has
    that shape and further dimensions behind, on which ``function`` works. Blocks without snapshots
    are left out. Where fewer than two blocks are left the error is unknown, and infinite.
    """
    begun = counts.reshape(len(counts), -1).any(axis=1)
    if not begun.all():
        sums, counts = sums[begun], counts[begun]
    total, number = sums.sum(axis=0), counts.sum(axis=0)
    value = function(total / _behind(number, total.ndim))
    if len(sums) < 2:
        return value, np.full_like(value, np.inf)
    left_out = np.array(
        [
            function((total - part) / _behind(np.maximum(rest, 1), total.ndim))
            for part, rest in zip(sums, number - counts, strict=True)
        ]
    )
    used = (counts > 0) & (number - counts > 0)
    blocks = _behind(used.sum(axis=0), value.ndim)
    used, ratio = (
        _behind(array, left_out.ndim) for array in (used, number / np.where(used, counts, 1))
    )
    ratio = np.where(used, ratio, 2)
    mean = blocks * value - (used * (1 - 1 / ratio) * left_out).sum(axis=0)
    pseudovalues = ratio * value - (ratio - 1) * left_out
    terms = used * (pseudovalues - mean) ** 2 / (ratio - 1)
    variance = terms.sum(axis=0) / np.maximum(blocks, 1)
    # What one block alone has, the longest lags say, is not a number without it.
    unknown = (blocks < 2) | (np.isnan(variance) & np.isfinite(value))
    return value, np.where(unknown, np.inf, np.sqrt(variance))


def _behind(array: NDArray[Any], dimensions: int) -> NDArray[Any]:
    """Add dimensions of length 1 behind those of ``array``."""
    return array.reshape(array.shape + (1,) * (dimensions - array.ndim))
