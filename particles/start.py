"""The start of a simulation: at the anchors, or from given positions and velocities."""

import hashlib
from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from crazybilliards.model import WALLS_AND_MASSES, Array, Chain
from crazybilliards.model.arrays import check_numbers
from crazybilliards.model.checks import check_chain, check_integer, require_memory, shown
from crazybilliards.model.vocabulary import refuse_unread, require, result
from crazybilliards.model.warn import warn_user

# Parameters beside ``KNOWN`` with which a start is right: at the anchors, or where rods are put.
knows: frozenset[str] = WALLS_AND_MASSES

MOST_REPLICAS = 10**15  # more than any memory holds, and still exact as a float


def given_start(
    chain: Chain, position: ArrayLike, velocity: ArrayLike = 0.0, *, replicas: int = 1
) -> xr.Dataset:
    """Make a ``start`` for :func:`simulate` from given positions and velocities.

    Parameters
    ----------
    position
        Rod centres x_i [R], shape (L,) for all replicas or (replicas, L), in order from the left.
    velocity
        Velocities v_i [R/t_0], of the same shapes, or one for all rods.
    replicas
        Number of replicas with this start, the same as in the call of ``simulate``.

    Raises
    ------
    ValueError
        If the shapes do not fit, anything is not finite, or rods overlap or are out of order. Rods
        that overlap by the rounding of single precision are moved apart, with a warning.

    Examples
    --------
    >>> chain = Chain(size=3, gap=1.0)
    >>> displaced = given_start(chain, chain.anchors + 5.0)
    >>> compressed = given_start(chain, chain.physical(0.2 * chain.reduced_anchors), replicas=2)
    >>> compressed.position.values[0]
    array([-2.2,  0. ,  2.2])
    """
    check_chain(chain)
    replicas = check_integer("replicas", replicas, least=1, most=MOST_REPLICAS)
    require_memory(f"replicas={replicas} of {chain.size} rods", 40.0 * replicas * chain.size)
    shape, dims = (replicas, chain.size), ("replica", "particle")
    states, given = {}, dict[str, Any](position=position, velocity=velocity)
    for name, values in given.items():
        if {*dims} == {*getattr(values, "dims", ())}:
            values = values.transpose(*dims)
        numbers = check_numbers(name, values)
        try:
            states[name] = (dims, np.broadcast_to(numbers, shape).copy())
        except ValueError:
            raise ValueError(
                f"{name} must fit {replicas} replicas of {chain.size} rods, shape {shape}, got "
                f"{numbers.shape}"
            ) from None
    start = result(chain, states, source="start", method={"start": "given"})
    kind = np.asarray(position).dtype
    if kind.kind == "f" and kind.itemsize < start.position.dtype.itemsize:
        rounded = start.assign(position=start.position.astype(kind))
        y = [y for y, _ in replica_starts(chain, rounded, replicas)]
        return start.assign(position=start.position.copy(data=chain.physical(y)))
    replica_starts(chain, start, replicas)
    return start


def digest(starts: Iterable[tuple[Array, Array]]) -> bytes:
    """Return a number that belongs to these states of the replicas alone."""
    return hashlib.sha256(b"".join(state.tobytes() for pair in starts for state in pair)).digest()


def replica_starts(
    chain: Chain, start: xr.Dataset | None, replicas: int
) -> list[tuple[Array, Array]]:
    """Return each replica's own reduced positions and velocities, checked."""
    chain.require_known("a start", knows)
    low, high = chain.walls
    if start is None:
        y = np.clip(chain.reduced_anchors, low, high)
        if chain.box and chain.stiffness == 0:  # anchors mean nothing
            y = np.linspace(low, high, chain.size + 2)[1:-1]
        return [(y, np.zeros(chain.size))] * replicas
    x, v = _states(start)
    if x.shape[1] != chain.size:
        raise ValueError(f"start has {x.shape[1]} rods, the chain {chain.size}")
    if len(x) != replicas:
        raise ValueError(f"start is for replicas={len(x)}, got replicas={replicas}")
    y = chain.reduced(x)
    if not (np.isfinite(y).all() and np.isfinite(v).all()):
        raise ValueError("start must be finite")
    # Rounding in x -> y may put touching rods out of order by one unit in the last place of x.
    kind, largest = start.position.dtype, max(float(np.abs(x).max()), chain.radius)
    rounding = 4 * float(np.finfo(kind).eps) if kind.kind == "f" else 0.0
    _require_apart(chain, y, max(1e-12, rounding) * largest)
    apart = np.clip(np.maximum.accumulate(y, axis=1), low, high)
    moved = float(np.abs(apart - y).max())
    if moved > 1e-12 * largest:
        warn_user(
            f"start: rods that overlap by the rounding of {kind} were moved apart by up to "
            f"{moved:.2g} R"
        )
    return list(zip(apart, v, strict=True))


def _require_apart(chain: Chain, y: Array, tolerance: float) -> None:
    """Raise a ValueError that names the rods that overlap most, or the one most inside a wall."""
    low, high = chain.walls
    over = -np.diff(y, axis=1, prepend=low, append=high)
    replica, rod = np.unravel_index(np.argmax(over), over.shape)
    if over[replica, rod] <= tolerance:
        return
    where = f"of replica {replica + 1}"
    if 0 < rod < chain.size:
        raise ValueError(
            f"start must hold rods in order that do not overlap: rods {rod} and {rod + 1} {where} "
            f"overlap by {over[replica, rod]:.4g} R"
        )
    raise ValueError(
        f"start must hold rods between the walls: their centres lie within "
        f"{chain.box / 2 - chain.radius:g} of the middle, and rod {max(rod, 1)} {where} is "
        f"{over[replica, rod]:.4g} R too far out"
    )


def _states(start: xr.Dataset) -> list[Array]:
    """Return positions and velocities of a start, each of shape (replicas, rods)."""
    names = ("position", "velocity")
    variables = sorted(map(str, start.data_vars)) if isinstance(start, xr.Dataset) else []
    if not set(names) <= set(variables):
        raise ValueError(
            "start must be a result with position and velocity, which given_start(chain, position) "
            f"and equilibrium_states(chain, replicas) return, got {shown(variables or start)}; "
            "None is rest"
        )
    refuse_unread(start, "start of simulate", names)
    for name in names:
        dims = start[name].dims
        if "time" in dims:
            raise ValueError("start is over time; choose one time, such as start.isel(time=-1)")
        if set(dims) != {"replica", "particle"}:
            raise ValueError(f"start: {name} must be over replica and particle, got {dims}")
    require(start, names, "start")
    return [check_numbers(name, start[name].transpose("replica", ...)) for name in names]
