"""The conditions of the theories on a chain, checked in one place."""

from __future__ import annotations

from crazybilliards.model import Chain


def require_chain(
    chain: Chain,
    theory: str,
    *,
    elastic: bool = False,
    linear: bool = False,
    gapless: bool = False,
    steady: bool = True,
    remedy: str = "",
) -> None:
    """Raise a ValueError with the reason if ``theory`` does not hold for this chain.

    Every theory calls this once, before any work. A chain with a parameter that the theories do
    not know passes only if that parameter has its default value.

    Parameters
    ----------
    chain
        The chain to check.
    theory
        The name of the theory in the error.
    elastic, linear, gapless
        Whether the theory needs restitution 1, linear springs, no gap.
    steady
        Whether the theory needs a chain that has a steady state.
    remedy
        What to do for a restitution other than 1; the end of that error.
    """
    chain.require_known(theory)
    if elastic and chain.restitution != 1:
        raise ValueError(
            f"{theory} holds for elastic collisions only: restitution must be 1, got "
            f"{chain.restitution:g}{remedy}"
        )
    if linear and chain.spring != "linear":
        raise ValueError(
            f"{theory} holds for linear springs only: spring must be 'linear', got {chain.spring!r}"
        )
    if gapless and chain.gap != 0:
        raise ValueError(f"{theory} holds without gap only: gap must be 0, got {chain.gap:g}")
    if steady:
        chain.require_steady_state()
