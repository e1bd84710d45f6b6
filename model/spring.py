r"""The law of the springs in units of the stiffness k; no other module repeats it.

A spring stretched by d has the potential U and pulls back with the force F = U':

    U(d) = |d|^n / n,      F(d) = d |d|^(n-2).

n is 2 for the linear spring, F = d, and 3 for the quadratic one, F = d |d|. The functions take
floats and arrays. They are plain Python, so that a kernel can compile them in with ``inlined`` of
:mod:`crazybilliards.model.kernels`.
"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", float, NDArray[np.float64])


def force(d: Number, exponent: int) -> Number:
    """Return the restoring force F(d)/k; its sign is that of d."""
    return d if exponent == 2 else d * abs(d)


def potential(d: Number, exponent: int) -> Number:
    """Return the energy U(d)/k, by products: unlike ``**``, they scale exactly by powers of two."""
    return d * force(d, exponent) / exponent


def reach(energy: Number, exponent: int) -> Number:
    """Return the d > 0 at which the energy U(d)/k is ``energy``."""
    return root(exponent * energy, exponent)


def root(power: Number, exponent: int) -> Number:
    """Return power^(1/n), by roots that, unlike ``**``, scale exactly by powers of two."""
    if exponent == 2:
        return np.sqrt(power)
    # On some machines cbrt rounds differently above and below 1, so its argument is kept below 4.
    fraction, doublings = np.frexp(power)
    thirds = doublings // 3
    return np.ldexp(np.cbrt(np.ldexp(fraction, doublings - 3 * thirds)), thirds)


def displacement(f: Number, exponent: int) -> Number:
    """Return the d at which the force F(d)/k is ``f``: the inverse of :func:`force`."""
    return f if exponent == 2 else np.sign(f) * np.sqrt(abs(f))
