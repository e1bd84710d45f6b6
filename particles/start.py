"""The start of a simulation: at the anchors, or from given positions and velocities."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Chain
from crazybilliards.model.checks import check_integer
from crazybilliards.model.memory import require_memory
from crazybilliards.model.vocabulary import require, result

Array = NDArray[np.float64]


def given_start(
    chain: Chain, position: ArrayLike, velocity: ArrayLike = 0.0, *, replicas: int = 1
) -> xr.Dataset:
    """Make a ``start`` for :func:`simulate` from given positions and velocities.

    Parameters
    ----------
    chain
        The chain.
    position
        Rod centres x_i [R], shape (L,) for all replicas or (replicas, L), in order from the left.
    velocity
        Velocities v_i [R/T], of the same shapes, or one for all rods.
    replicas
        Number of replicas with this start, the same as in the call of ``simulate``.

    Raises
    ------
    ValueError
        If the shapes do not fit, anything is not finite, or rods overlap or are out of order.

    Examples
    --------
    >>> chain = Chain(size=3, gap=1.0)
    >>> displaced = given_start(chain, chain.anchors + 5.0)
    >>> compressed = given_start(chain, chain.physical(0.2 * chain.reduced_anchors), replicas=2)
    >>> compressed.position.values[0]
    array([-2.2,  0. ,  2.2])
    """
    replicas = check_integer("replicas", replicas, least=1)
    require_memory(f"replicas={replicas} of {chain.size} rods", 40.0 * replicas * chain.size)
    shape, dims = (replicas, chain.size), ("replica", "particle")
    try:
        states = {
            "position": (dims, np.broadcast_to(np.asarray(position, dtype=float), shape).copy()),
            "velocity": (dims, np.broadcast_to(np.asarray(velocity, dtype=float), shape).copy()),
        }
    except ValueError as error:
        raise ValueError(
            f"start: positions and velocities must be numbers that fit {replicas} replicas of "
            f"{chain.size} rods"
        ) from error
    start = result(chain, states, source="start", method={"start": "given"})
    replica_starts(chain, start, replicas)
    return start


def replica_starts(
    chain: Chain, start: xr.Dataset | None, replicas: int
) -> list[tuple[Array, Array]]:
    """Return each replica's own reduced positions and velocities, checked."""
    if start is None:
        rest = (chain.reduced_anchors, np.zeros(chain.size))
        return [(rest[0].copy(), rest[1].copy()) for _ in range(replicas)]
    require(start, ("position", "velocity"))
    shape = (replicas, chain.size)
    y = chain.reduced(start.position.transpose("replica", "particle").values)
    v = start.velocity.transpose("replica", "particle").values
    if y.shape != shape or v.shape != shape:
        raise ValueError(
            f"start must hold {replicas} replicas of {chain.size} particles, got {y.shape}"
        )
    if not (np.isfinite(y).all() and np.isfinite(v).all()):
        raise ValueError("start must be finite")
    # Rounding in x -> y may put touching rods out of order by one unit in the last place of x.
    tolerance = 1e-12 * max(float(np.abs(start.position).max()), chain.radius)
    if (np.diff(y, axis=1) < -tolerance).any():
        raise ValueError("start must hold rods in order that do not overlap")
    y = np.maximum.accumulate(y, axis=1)
    return [(np.array(y[i]), np.array(v[i], dtype=float)) for i in range(replicas)]
