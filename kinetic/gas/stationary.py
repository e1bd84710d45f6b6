r"""The steady state of every chain, by the gas along labels.

Mean state and fluctuations of the equations in :mod:`crazybilliards.kinetic.gas` agree with one
another (:mod:`.agreement`). No number is fitted, and nothing from a simulation goes in:

    W_v(i)^2 = T(i) + K h_uu(i),       W_x(i)^2 = q(i)^2 + h'_uu(i),

T being the temperature within a neighbourhood, K h_uu the velocity that it shares, q the width of a
rod in it (without a gap of the i-th of L points, with a gap in the elastic chain at its
temperature), and h'_uu the displacement of neighbourhoods (:mod:`.agreement`).

**The mean field** (``correlations=False``, and always for e > 1) takes colliding rods for
independent. The noise drives the centre of mass as well, which collisions leave alone, so that

    W_v^2 = (1 - 1/L) T + 1/L,

and the same for the displacements on linear springs. For e > 1, on linear springs without a gap and
walls, T is that of points in phase space (:mod:`.driven`). Other chains with e > 1 have the
closure, which is too cold at the ends if the damping is above 0.6 sqrt(k m).
"""

import xarray as xr
from threadpoolctl import threadpool_limits

from crazybilliards.kinetic.accuracy import Accuracy, expected, warn_if_unmeasured
from crazybilliards.kinetic.gas.agreement import in_agreement, mean_field
from crazybilliards.kinetic.gas.cells import make_cells
from crazybilliards.kinetic.gas.mean_state import NoSteadyStateError
from crazybilliards.kinetic.gas.stationary_result import in_vocabulary
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_chain, shown

_MOST_RODS = 100_000
_FEWEST_CORRELATED = 4  # rods; fewer have no pairs beyond neighbours


def steady_state(chain: Chain, *, correlations: bool = True) -> xr.Dataset:
    """Solve for the steady state of the gas in this module.

    Parameters
    ----------
    chain
        Up to 100 000 rods of one mass, with any restitution and any gap, on linear or quadratic
        springs, also between walls with a wall restitution above 0, and without springs in a box.
        At restitution 1 ``equilibrium`` is exact.
    correlations
        False: the mean field, in which colliding rods are independent. It is the theory of first
        order in 1 - e, and the only one for e > 1. There it is solved up to 0.85 of the critical
        size if the damping is 3 sqrt(k m), and further if it is weaker.

    Returns
    -------
    xarray.Dataset
        Over particle ``velocity_width``, ``displacement_width`` and ``mean_displacement``; over x
        ``density`` and ``label`` of the rods (``attrs["density_of"]``: of more than 10 000, or 3000
        with a gap, of a fluid), ``displacement``, ``velocity_variance`` and ``heat_flux`` of the
        gas; in a box ``wall_force`` over wall.

        With correlations, over ``contact`` (i with i + 1): ``neighbour_covariance`` <v_i v_{i+1}>,
        ``relative_temperature`` <(v_i - v_{i+1})^2>/2, ``contact_force`` and ``contact_loss``, the
        power that collisions take; over ``mode`` the ``mode_velocity_variance`` <|v_q|^2> of the
        waves cos(pi q (i - 1/2)/L), q = 0 being the centre of mass; up to 1000 rods over (particle,
        separation) the ``velocity_covariance`` <v_i v_{i+r}>, NaN beyond the chain.

        ``attrs``: ``residual``, the largest disagreement of mean state and fluctuations, and
        for e > 1 the share of points that the grid loses in a time m/gamma; ``iterations``; and
        the errors measured in simulations of chains like this one, or NaN:
        ``velocity_width_model_error`` and ``border_model_error``, relative, of W_v of the particles
        3 to L - 2 and of the first and the last; ``displacement_width_model_error``, relative;
        ``mean_displacement_model_error``, in thermal lengths; ``density_model_error``, of the
        smoothed density, relative to close packing; ``wall_force_model_error``, relative. An
        ``UnmeasuredWarning`` says that the first of these is not known.

    Raises
    ------
    ValueError
        For a chain without a steady state; for two masses; for absorbing walls; if mean state and
        fluctuations cannot be brought to agree.

    Notes
    -----
    It takes 0.1 s for 30 rods, half a second to two for 100, and up to 10 s for more than 200.

    Examples
    --------
    >>> theory = steady_state(Chain(size=30, restitution=0.5))
    >>> theory.velocity_width.values[[0, 7, 14]].round(3)
    array([0.236, 0.134, 0.122])
    """
    check_steady_state(chain, correlations=correlations)
    correlated = correlations and chain.restitution <= 1 and chain.size >= _FEWEST_CORRELATED
    solve = in_agreement if correlated else mean_field
    try:
        with threadpool_limits(limits=1, user_api="blas"):  # small matrices: more only wait
            found = solve(chain, make_cells(chain.size, walled=chain.box > 0))
    except NoSteadyStateError as error:
        raise ValueError(f"the gas has no steady state that could be found: {error}") from error
    state = in_vocabulary(chain, found)
    # Below e = 1 the mean field was not measured.
    measured = correlations or chain.restitution >= 1
    errors = expected("steady_state", chain) if measured else Accuracy()
    warn_if_unmeasured("the steady state of the gas", errors.velocity_width)
    return state.assign_attrs(errors.named())


def check_steady_state(chain: Chain, *, correlations: bool = True) -> None:
    """Raise for what ``steady_state`` does not take."""
    check_chain(chain)
    if not isinstance(correlations, bool):
        raise ValueError(f"correlations must be True or False, got {shown(correlations)}")
    if chain.size > _MOST_RODS:
        raise ValueError(f"size must be at most {_MOST_RODS}, got {chain.size}")
    require_chain(chain, "the gas in its steady state", knows=("box", "wall_restitution"))
    if chain.wall_restitution == 0:
        raise ValueError("the gas needs walls that do not absorb: wall_restitution above 0, got 0")
