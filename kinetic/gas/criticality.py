r"""Chains with e > 1: the critical size, and the rate of growth, on linear springs.

**Weak damping.** On linear springs every pair of rods meets once in half a period, whatever the
amplitude, and gains the fraction e^2 - 1 of its relative energy. The relative energies of all pairs
add up to L/2 times the energy E of the chain, and damping takes out gamma/m E per time. The energy
of a chain so hot that the noise does not count therefore obeys

    E' = [(e^2 - 1) L sqrt(k/m)/(2 pi) - gamma/m] E.

The growth vanishes at a size that is, to first order in e - 1,

    L_c = pi gamma/((e - 1) sqrt(k m)).

**Any damping.** The kinetic equation of first order in e - 1, solved for gamma/sqrt(k m) from 1e-3
to 3.5, has no steady state from a size on that differs from L_c by 0.01 % up to 0.5 and by 1.2 % at
3. Four critical sizes that were simulated, up to gamma/sqrt(k m) = 1.95 and e = 1.1, lie within 7 %
of L_c, 9 % with two standard errors (``studies/critical_size.py``).
"""

import math
from typing import NamedTuple

from crazybilliards.kinetic.accuracy import warn_if_unmeasured
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain

_STRONGEST = 10.0  # damping
_SIMULATED = 1.955  # damping, and
_LARGEST = 1.1  # restitution up to which
_ERROR = 0.1  # of the value is more than simulations differ, two standard errors included


class CriticalValue(NamedTuple):
    """A critical value and its error."""

    value: float
    error: float


def critical_size(chain: Chain) -> CriticalValue:
    """Return the number of rods from which on a chain with e > 1 has no steady state.

    The value is that of weak damping. The error is 10 % of it where gamma/sqrt(k m) is up to 1.95
    and e up to 1.1, and NaN beyond, with an ``UnmeasuredWarning``. Size and gap do not matter.

    Raises
    ------
    ValueError
        For e <= 1, where chains of every size have a steady state; for quadratic springs, where
        no chain has one; for two masses or a box; for a damping above 10 sqrt(k m).

    Examples
    --------
    >>> critical = critical_size(Chain(restitution=1.05, damping=4.0))
    >>> round(critical.value)
    123
    """
    _require_drive(chain)
    value = math.pi * chain.relative_damping / (chain.restitution - 1)
    measured = chain.relative_damping <= _SIMULATED and chain.restitution <= _LARGEST
    error = _ERROR * value if measured else math.nan
    warn_if_unmeasured("the critical size", error)
    return CriticalValue(value, error)


def _require_drive(chain: Chain) -> None:
    """Raise if the chain has no critical size."""
    require_chain(chain, "the critical size", steady=False)
    if chain.restitution <= 1:
        raise ValueError(
            "every size has a steady state unless restitution is above 1, got "
            f"{chain.restitution:g}"
        )
    if chain.spring != "linear":
        raise ValueError(
            "with quadratic springs and e > 1 there is no critical size: rods collide the more "
            "often the faster they are, and a fluctuation large enough always runs away"
        )
    for name in ("damping", "stiffness"):
        if getattr(chain, name) == 0:
            raise ValueError(f"{name}=0: no size has a steady state with e > 1")
    if chain.relative_damping > _STRONGEST:
        raise ValueError(
            f"gamma/sqrt(k m) = {chain.relative_damping:.3g} is too strong a damping: the critical "
            f"size is known up to {_STRONGEST:g}"
        )


def weak_damping_growth_rate(chain: Chain) -> float:
    """Return E'/E [1/t_0], without an expansion in e - 1, on linear springs without a gap.

    Simulated chains grow at this rate within 5 % if they have L >= 30 rods, (e^2 - 1) L/2 <= 1.05,
    gamma <= sqrt(k m)/4 and L >= 1.5 L_c. At (e^2 - 1) L/2 = 3 they grow 16 % faster, and 10 rods
    grow 10 % more slowly. With a gap they may not run away at all.
    """
    meetings = math.sqrt(chain.stiffness / chain.mass) / math.pi  # of a pair, per time
    return (chain.restitution**2 - 1) / 2 * chain.size * meetings - chain.damping / chain.mass
