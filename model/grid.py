"""The grid of positions that simulations and theories share, and how points are put on it.

Nodes are whole multiples of a spacing h = 2R/n with n **odd**. Then a bin of width h on a node,
convolved with a rod of length 2R on a point, is exactly the mean of n hat functions on nodes. A
density is kept in hat weights: each point is shared linearly between its two neighbouring nodes.
The fraction of a bin that rods cover then follows without any error, in O(1) per bin.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model.chain import Chain
from crazybilliards.model.checks import require_memory
from crazybilliards.model.kernels import kernel

_BINS_PER_ROD = 21  # "bins much smaller than R": h = 0.095 R
_MOST_NODES = 2**18
_BYTES_PER_NODE = 200  # some 25 arrays of a theory

# In units of the chain's length: displacements of this size keep seven digits in a position.
_SMALLEST_REACH = 1e-9
_MISSED = 1e-5  # share of the rods that a whole grid may miss: rounding, or single precision


def require_resolved(chain: Chain, extent: float) -> None:
    """Raise a ValueError if thermal displacements are lost in the rounding of such positions."""
    if 0 < chain.thermal_reach < _SMALLEST_REACH * extent:
        raise ValueError(
            f"the thermal length {chain.thermal_length:.3g} is lost in the rounding of positions "
            f"up to {extent:.3g}: amplitude is too small for this chain"
        )


def position_grid(chain: Chain, reach: float | None = None) -> NDArray[np.float64]:
    """Nodes x, uniform and symmetric about 0, that hold every rod and its smoothing [R].

    A rod length 2R has 21 spacings, or more to resolve the thermal length, but at most as many as
    make 2**18 nodes. ``reach``: the largest displacement from the outer anchors to make room for;
    ``chain.thermal_reach`` if None. It is a ValueError if the 200 bytes per node that a theory
    needs are not available, or if displacements are lost in the rounding of positions.
    """
    half_width = float(chain.anchors[-1]) + (chain.thermal_reach if reach is None else reach)
    # The two running averages, of a rod length each, spread a point by 2R to either side.
    half_width = min(half_width, chain.box / 2 or math.inf) + 4 * chain.radius
    require_resolved(chain, half_width)
    wanted = max(_BINS_PER_ROD, 8 * chain.radius / (chain.thermal_length or math.inf))
    affordable = _MOST_NODES * 2 * chain.radius / (2 * half_width)
    n = int(min(math.ceil(wanted), max(affordable, 1.0)))
    spacing = 2 * chain.radius / (n if n % 2 else n - 1)
    half = math.ceil(half_width / spacing)
    of_what = f"{2.0 * half:.3g} positions, {spacing:.3g} apart, from {-half_width:.3g} R on"
    require_memory(f"size, radius or stiffness: a grid of {of_what}", 2.0 * half * _BYTES_PER_NODE)
    return spacing * np.arange(-half, half + 1.0)


def require_even(x: NDArray[np.float64], who: str) -> float:
    """Return the spacing of positions, or raise a ValueError unless they ascend evenly."""
    steps = np.diff(x)
    if not (x.size > 1 and steps[0] > 0 and np.allclose(steps, steps[0], rtol=1e-6)):
        raise ValueError(f"x must be even and ascend: {who} needs the whole grid of the result")
    return float(steps[0])


def require_all_held(held: ArrayLike, rods: ArrayLike, who: str, missed: float = _MISSED) -> None:
    """Raise a ValueError unless a grid holds all rods at all times, but for a share ``missed``."""
    held, rods = (each.ravel() for each in np.broadcast_arrays(held, rods))
    worst = np.argmax(np.abs(held - rods))
    if not abs(held[worst] - rods[worst]) <= missed * rods[worst]:
        raise ValueError(
            f"the grid of x holds {held[worst]:.6g} of the chain's {rods[worst]:.6g} rods: {who} "
            f"needs the whole grid of the result; cut what {who} returns"
        )


@kernel
def deposit(points, first, spacing, weights):  # type: ignore[no-untyped-def]
    """Add the hat weights of points (1-d) in place; return how many lay outside, and are not added.

    A point between two nodes, ``first + j * spacing``, gives each the share 1 - distance/spacing.
    """
    outside = 0
    last = weights.size - 1
    for point in points:
        position = (point - first) / spacing
        # Also catches NaN, which fails every comparison.
        if not (position >= 0.0 and position < last):
            outside += 1
            continue
        node = int(position)
        share = position - node
        weights[node] += 1.0 - share
        weights[node + 1] += share
    return outside
