"""What theories ask of a chain, and of the times to solve for, checked in one place."""

from collections.abc import Collection

import numpy as np

from crazybilliards.model import Array, Chain
from crazybilliards.model.checks import check_chain, check_real

_OUTPUTS, _MOST_OUTPUTS = 100, 1_000_000


def require_chain(
    chain: Chain,
    theory: str,
    *,
    elastic: bool = False,
    elastic_walls: bool = False,
    linear: bool = False,
    gapless: bool = False,
    steady: bool = True,
    remedy: str = "",
    knows: Collection[str] = (),
) -> None:
    """Raise a ValueError with the reason if ``theory`` does not hold for this chain.

    Every theory calls this once, before any work. ``theory`` is its name in the error. It needs
    restitution 1 (``elastic``; of the walls alone: ``elastic_walls``), linear springs, no gap, or a
    steady state, where these are True. ``remedy`` says what to do for another restitution.
    ``knows``: parameters beside ``KNOWN`` that this theory takes. Others must have their defaults.
    """
    check_chain(chain)
    chain.require_known(theory, knows)
    if elastic and chain.restitution != 1:
        raise ValueError(
            f"{theory} holds for elastic collisions only: restitution must be 1, got "
            f"{chain.restitution:g}{remedy}"
        )
    if (elastic or elastic_walls) and chain.wall_restitution != 1:
        raise ValueError(
            f"{theory} holds for elastic walls only: wall_restitution must be 1, got "
            f"{chain.wall_restitution:g}"
        )
    if linear and chain.spring != "linear":
        raise ValueError(
            f"{theory} holds for linear springs only: spring must be 'linear', got {chain.spring!r}"
        )
    if gapless and chain.gap != 0:
        raise ValueError(f"{theory} holds without gap only: gap must be 0, got {chain.gap:g}")
    if steady:
        chain.require_steady_state()


def output_times(duration: float | None, every: float | None) -> Array:
    """Return 0, every (None: duration/100), ... up to ``duration`` or the next time [t_0]."""
    duration = check_real("duration", duration, positive=True)
    every = duration / _OUTPUTS if every is None else check_real("every", every, positive=True)
    if every > duration * (1 + 1e-9):
        raise ValueError(f"every must be at most the duration {duration:g}, got {every:g}")
    count = np.ceil(duration / every - 1e-9)
    if count > _MOST_OUTPUTS:
        raise ValueError(f"every = {every:g} asks for {count:.1g} outputs, {_MOST_OUTPUTS} at most")
    return every * np.arange(count + 1)
