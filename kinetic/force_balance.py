r"""The stationary gas-kinetic force balance for the density rho(x).

The paper (arXiv:1404.7460, last numbered equation of its analytics section) balances the
gradient of the pressure rho W^2/(1 - 2 R rho) of hard rods against the springs:

    rho' = -(k / (m W^2)) <dx>(x) rho (1 - 2 R rho)^2,                                    (*)

with the velocity variance W^2 = A^2/(2 m gamma) of the elastic chain and the mean displacement
<dx> from their anchors of the rods at x. For a non-linear spring k <dx> becomes F(<dx>). In the
density of the reduced coordinate, rho_y = rho/(1 - 2 R rho), it reads

    (ln rho_y)' = -(F(<dx>) / (m W^2)) / (1 + 2 R rho_y),                                (**)

which stays accurate where 1 - 2 R rho is too small to be stored.

**Closures.** *Prescribed*, the paper's: <dx>(x) is measured (and fitted), see
:mod:`crazybilliards.kinetic.prescribed_closure`. *By labels*, with no input: the N-th rod from
the left belongs to the N-th anchor, so <dx> = x - (2R + g)(N - L/2) with N' = rho, see
:mod:`crazybilliards.kinetic.label_closure`.

**Boundary conditions.** rho -> 0 on both sides with L rods in between: N(-inf) = 0,
N(+inf) = L.
"""

from __future__ import annotations

import math

import xarray as xr

from crazybilliards.kinetic.displacement import Displacement, make_profile
from crazybilliards.kinetic.label_closure import solve_label_closure
from crazybilliards.kinetic.prescribed_closure import solve_prescribed_closure
from crazybilliards.model import Chain
from crazybilliards.model.chain import check_real


def force_balance(
    chain: Chain,
    displacement: Displacement | None = None,
    velocity_variance: float | None = None,
) -> xr.Dataset:
    """Density of the chain from the force balance (*) of this module.

    Parameters
    ----------
    chain
        The chain. Works for A from 0.1 to 100, g from 0 to 3, L from 2 to 1e5 and beyond.
    displacement
        None: by labels, nothing is put in. Otherwise <dx>(x) [R]: a table (x, <dx>), a result
        with ``mean_displacement``, or a callable of x (the paper: a fitted arctanh).
    velocity_variance
        W^2 [R^2/T^2]; None: the free value, which is right for restitution 1 only.

    Returns
    -------
    xarray.Dataset
        ``density``, ``label`` and ``displacement`` over x, by labels also ``mean_displacement``
        and ``velocity_width`` over particle. ``attrs["residual"]``: by labels, the drift of the
        conserved quantity of the equations (an error of ln rho); prescribed, the relative error
        of the number of rods.

    Raises
    ------
    ValueError
        If there is no steady state; if the restitution is not 1 and no variance is given; if the
        displacement is not understood or does not hold the rods together.

    Examples
    --------
    >>> theory = force_balance(Chain(size=100, amplitude=10))
    >>> round(theory.density.max().item(), 4)  # 0.5 is close packing
    0.4593
    """
    if velocity_variance is None:
        if chain.restitution != 1:
            raise ValueError(
                "the velocity variance is the free one for restitution=1 only; give "
                f"velocity_variance for restitution={chain.restitution:g}"
            )
    else:
        # W^2 enters as T = m W^2 only: the elastic chain with that temperature is equivalent.
        variance = check_real("velocity_variance", velocity_variance, positive=True)
        amplitude = math.sqrt(2 * chain.damping * chain.mass * variance)
        chain = chain.replace(amplitude=amplitude, restitution=1)
    chain.require_steady_state()
    if displacement is None:
        return solve_label_closure(chain)
    return solve_prescribed_closure(chain, make_profile(chain, displacement))
