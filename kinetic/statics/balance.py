r"""The stationary gas-kinetic force balance for the density rho(x).

The paper (arXiv:1404.7460, eq. ``diff_gl``; the factor 1/m is in the sentence below it) balances
the gradient of the pressure rho W^2/(1 - 2 R rho) of hard rods against the springs:

    rho' = -(k / (m W^2)) <dx>(x) rho (1 - 2 R rho)^2,                                    (*)

with the velocity variance W^2 = A^2/(2 m gamma) of the elastic chain and the mean displacement
<dx> from their anchors of the rods at x. For a non-linear spring k <dx> becomes F(<dx>), which
ignores the spread of the displacements at one place. In the density of the reduced coordinate,
rho_y = rho/(1 - 2 R rho), it reads

    (ln rho_y)' = -(F(<dx>) / (m W^2)) / (1 + 2 R rho_y),                                (**)

which stays accurate where 1 - 2 R rho is too small to be stored.

**Closures.** *By labels*, the default, without an input: the N-th rod from the left belongs to the
N-th anchor, so <dx> = x - (2R + g)(N - L/2) with N' = rho
(:mod:`crazybilliards.kinetic.statics.label_closure`). *Prescribed* displacement, as in the paper:
<dx>(x) is measured and fitted, figure ``fig:atan``
(:mod:`crazybilliards.kinetic.statics.wright_closure`). With either, (**) has a solution with
``scipy.special.wrightomega``, and ``scipy.optimize.brentq`` finds its constant, which gives L rods.

**Temperature.** With a prescribed W^2(x), for example one measured for e != 1, the balance is

    (1/rho) d/dx [rho W^2/(1 - 2 R rho)] = -F(<dx>)/m,                                  (***)

the paper's ``modeleq`` at V = 0. It is closed by labels in
:mod:`crazybilliards.kinetic.statics.variable_temperature` (scikit-fem).

**Boundary conditions.** The paper gives none. By labels N(-inf) = 0 and N(+inf) = L, in a box
N(-X/2) = 0 and N(X/2) = L, and no other: the force on a wall is the pressure
rho m W^2/(1 - 2 R rho) there. With a prescribed displacement there are L rods in the interval of
its profile, or in the box. An arctanh ends where the density is small but not zero.

**Two masses** have the same density at the same temperature T = m W^2, with their mean mass m.
"""

import xarray as xr

from crazybilliards.kinetic.accuracy import Accuracy, warn_if_unmeasured
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.kinetic.statics.label_closure import solve_label_closure
from crazybilliards.kinetic.statics.profiles import (
    Prescribed,
    Profile,
    read_displacement,
    read_velocity_variance,
)
from crazybilliards.kinetic.statics.variable_temperature import solve_variable_temperature
from crazybilliards.kinetic.statics.wright_closure import solve_wright_closure
from crazybilliards.model import WALLS_AND_MASSES, Chain
from crazybilliards.model.checks import check_chain
from crazybilliards.model.vocabulary import OF_FLUID


def force_balance(
    chain: Chain,
    displacement: Prescribed | None = None,
    velocity_variance: float | Prescribed | None = None,
) -> xr.Dataset:
    """Density of the chain from the force balance (*) of this module.

    Parameters
    ----------
    chain
        The chain. A from 0.1 to 100, g from 0 to 3 and L from 2 to beyond 1e5 work.
    displacement
        None: by labels, without an input. Otherwise <dx>(x) [R]: a table (x, <dx>), a DataArray
        over x, a result with ``mean_displacement``, or a callable of x (in the paper an arctanh).
    velocity_variance
        W^2 [R^2/t_0^2]. None: the free value, which is right for restitution 1 only. Otherwise a
        number, or a profile W^2(x) in any form of the displacement (the ``velocity_width`` of a
        simulation is squared). A profile needs linear springs and the closure by labels.

    Returns
    -------
    xarray.Dataset
        ``density``, ``label`` and ``displacement`` over x, by labels also ``mean_displacement``
        and ``velocity_width`` over particle, and in a box ``wall_force`` over wall, which is exact
        at restitution 1 without a gap or without springs. ``attrs["residual"]`` is the relative
        error of the number of rods.

        By labels there are also the distances from the exact equilibrium for chains like this one
        (2 to 1000 rods, linear springs, gaps up to 10 s, e = 1):
        ``attrs["density_model_error"]``, of the smoothed density, relative to close packing, and
        ``attrs["mean_displacement_model_error"]`` in thermal lengths. In a box without a gap or
        without springs the density is off by up to 0.18 near the walls, where the rods have layers.
        For others the errors are NaN, with an ``UnmeasuredWarning``.

    Raises
    ------
    ValueError
        If there is no steady state; if the restitution is not 1 and no variance is given; for a
        displacement of a wrong form, that does not hold the rods, or beside a profile W^2(x).

    Examples
    --------
    >>> theory = force_balance(Chain(size=100, amplitude=10))
    >>> round(theory.density.max().item(), 4)  # 0.5 is close packing
    0.4593
    """
    chain, prescribed, variance = check_force_balance(chain, displacement, velocity_variance)
    if prescribed is not None:
        return solve_wright_closure(chain, prescribed).assign_attrs(density_of=OF_FLUID)
    result = solve_variable_temperature(chain, variance) if variance else solve_label_closure(chain)
    if velocity_variance is not None:  # measured for the free variance only
        result.attrs |= Accuracy().named()
    warn_if_unmeasured("the force balance", result.attrs["density_model_error"])
    return result.assign_attrs(density_of=OF_FLUID)


def check_force_balance(
    chain: Chain,
    displacement: Prescribed | None = None,
    velocity_variance: float | Prescribed | None = None,
) -> tuple[Chain, Profile | None, Profile | None]:
    """Raise for a wrong argument; return the elastic chain, <dx>(x) and W^2(x) if given."""
    check_chain(chain)
    prescribed = read_displacement(chain, displacement)
    chain, variance = read_velocity_variance(chain, velocity_variance)
    if prescribed is not None and variance is not None:
        raise ValueError(
            "displacement and a profile of velocity_variance cannot be given together: leave out "
            "displacement, which then follows by labels, or give a number as velocity_variance"
        )
    require_chain(
        chain,
        "the force balance",
        elastic=velocity_variance is None,
        linear=variance is not None,
        knows=WALLS_AND_MASSES,
        remedy="; give velocity_variance for others",
    )
    if prescribed is not None and chain.box:
        if chain.stiffness == 0:
            raise ValueError("displacement: without springs it has no effect; leave it out")
        end = chain.box / 2
        prescribed = prescribed._replace(
            left=max(prescribed.left, -end), right=min(prescribed.right, end)
        )
    if prescribed is not None and not prescribed.left < 0 < prescribed.right:
        raise ValueError(
            "displacement must be given on both sides of x = 0, got the interval "
            f"({prescribed.left:g}, {prescribed.right:g})"
        )
    return chain, prescribed, variance
