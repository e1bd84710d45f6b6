"""The paper's fits along the chain, with uncertainties, and what other fits share with them."""

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.optimize import OptimizeWarning, curve_fit

from crazybilliards.model import Array, chain_of
from crazybilliards.model.arrays import check_numbers
from crazybilliards.model.checks import refuse_units, shown
from crazybilliards.model.vocabulary import require, require_all_particles

_STEEPEST = -5.0  # of the exponents that are tried
_STARTS = ((-0.5, 0.0), (-0.5, 0.8), (-1.0, -5.0), (-0.1, 0.0))  # of nu and c
_LEAST_RODS = 5


@dataclass(frozen=True)
class Fit:
    """A fitted curve: call it with x to get its values.

    Every number is an attribute too, a standard error as ``NAME_error``: ``fit.exponent``,
    ``fit.exponent_error``, ``fit.misfit``.

    Attributes
    ----------
    parameters, errors
        The parameters of the curve and their standard errors, by name.
    curve
        The function of x and the parameters, by name.
    quality
        How well the curve agrees with the points, and other numbers of the fit, by name.
    """

    parameters: Mapping[str, float]
    errors: Mapping[str, float]
    curve: Callable[..., Array] = field(repr=False)
    quality: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Make every number an attribute."""
        of_errors = {f"{name}_error": error for name, error in self.errors.items()}
        vars(self).update({**self.parameters, **of_errors, **self.quality})

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    def __call__(self, x: ArrayLike) -> Array:
        """Return the values of the curve."""
        refuse_units("x", x)
        return np.asarray(self.curve(np.asarray(x, dtype=float), **self.parameters))


def check_points(**columns: object) -> list[Array]:
    """Return the columns as arrays; a ValueError names the arguments that do not fit."""
    arrays = [check_numbers(name, values) for name, values in columns.items()]
    shapes = [array.shape for array in arrays]
    if len(set(shapes)) > 1 or arrays[0].ndim != 1:
        raise ValueError(
            f"{', '.join(columns)} must have one dimension and the same length, got the shapes "
            f"{', '.join(map(str, shapes))}"
        )
    for name, array in zip(columns, arrays, strict=True):
        if not np.isfinite(array).all():
            raise ValueError(f"{name} must be finite, got {shown(columns[name])}")
    return arrays


def least_squares(
    what: str,
    curve: Callable[..., Array],
    points: tuple[Array, Array],
    start: tuple[float, ...],
    error: Array | None = None,
) -> tuple[list[float], list[float], dict[str, Any]]:
    """Fit a curve to points (x, y); return its parameters, their errors, and the quality.

    Without standard errors of y they follow from the scatter, and the quality is the ``misfit``.
    With ``error`` it is ``chi_square``, the sum of the squared residuals in standard errors over
    the degrees of freedom (nan if there are none), and where this is above 1, they are larger by
    its square root. ``what`` names the curve in the error of points that do not fit.
    """
    x, y = points
    try:
        # A step of the search may overflow. What it finds must not.
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("error", OptimizeWarning)  # there is no covariance
            values, covariance = curve_fit(
                curve, x, y, p0=start, sigma=error, absolute_sigma=error is not None, maxfev=20_000
            )
            residuals = y - curve(x, *values)
    except (RuntimeError, OptimizeWarning) as problem:
        raise ValueError(f"no {what} fits: {problem}") from problem
    if not all(np.isfinite(each).all() for each in (values, covariance, residuals)):
        raise ValueError(f"no {what} fits: the search for its parameters runs away")
    quality = {"misfit": root_mean_square(residuals)}
    if error is not None:
        residuals, freedom = residuals / error, x.size - len(start)
        chi_square = float(residuals @ residuals / freedom) if freedom else math.nan
        covariance, quality = covariance * np.fmax(chi_square, 1.0), {"chi_square": chi_square}
    return values.tolist(), np.sqrt(np.diag(covariance)).tolist(), quality


def root_mean_square(residuals: Array) -> float:
    """Return the root mean square of residuals."""
    return float(np.sqrt(np.mean(residuals**2)))


def fit_arctanh(source: xr.Dataset) -> Fit:
    """Fit <dx>(x) = B arctanh(C x) to the mean displacements at the mean positions.

    It is the fit of the paper's figure ``fig:atan``. Every rod has the same weight, because the
    misfit is systematic and far above the error bars. The fit can be the ``displacement`` of
    ``force_balance``.

    Parameters
    ----------
    source
        A result with ``mean_displacement`` of all particles.

    Returns
    -------
    Fit
        ``scale`` and ``steepness``, B [R] and C [1/R], and their standard errors from the scatter
        about the fit. ``misfit``: root mean square of the residuals [R]. ``support``: the interval
        (-1/C, 1/C).

    Raises
    ------
    ValueError
        If the chain has fewer than 3 rods, or if no arctanh fits because the rods are not
        displaced outward (they do not touch).
    """
    require(source, ("mean_displacement",))
    chain = chain_of(source)
    chain.require_known("fit_arctanh")
    require_all_particles(source, chain.size, "fit_arctanh")
    displacement = source.mean_displacement.values
    x = chain.anchors + displacement
    if chain.size < 3:
        raise ValueError(f"an arctanh fit needs at least 3 rods, got {chain.size}")
    outward = float(np.sum(displacement * x))
    if outward <= 0:
        raise ValueError("no arctanh fits: the rods are not displaced outward")
    edge = float(np.abs(x).max())

    # C = 1/(edge (1 + exp(q))) keeps every rod inside the support, for every q.
    def model(position: Array, scale: float, q: float) -> Array:
        return scale * np.arctanh(position / (edge * (1 + np.exp(q))))

    (scale, q), (scale_error, q_error), quality = least_squares(
        "arctanh", model, (x, displacement), (outward / float(x @ x) * edge, -2.0)
    )
    beyond = 1 + math.exp(q)  # the half support over the edge
    steepness = 1 / (edge * beyond)
    parameters = {"scale": scale, "steepness": steepness}
    errors = {"scale": scale_error, "steepness": steepness * math.exp(q) / beyond * q_error}
    return Fit(parameters, errors, _arctanh, quality | {"support": (-1 / steepness, 1 / steepness)})


def _arctanh(x: Array, scale: float, steepness: float) -> Array:
    return scale * np.arctanh(steepness * x)


def fit_border_power_law(
    source: xr.Dataset, *, shifted: bool = True, weighted: bool = False
) -> Fit:
    """Fit the paper's sum of two power laws to the velocity widths of all rods.

    W_v(i) = a [(i - c)^nu + (L + 1 - c - i)^nu], equation ``eq:power_law`` of arXiv:1404.7460.

    Parameters
    ----------
    source
        A result with ``velocity_width`` of all particles.
    shifted
        Fit c, as the paper does. False: c = 0, which flattens the exponent by some 0.03 and makes
        it depend on the size.
    weighted
        Weight the widths by their error bars, or by relative deviations for a theory, which has
        no errors. The narrow interior then counts more. The paper does not say which. At L = 300,
        e = 0 the exponent is -0.460 without weights and -0.473 with weights.

    Returns
    -------
    Fit
        ``scale``, ``exponent`` and ``origin``: a [R/t_0], nu and c. The power laws begin at the
        particle numbers c and L + 1 - c, beyond the outermost rods: c < 1. The errors are standard
        errors from the scatter about the fit. The scatter between independent runs is larger, as
        neighbouring rods move together, and the better measure. ``correlation``: of the errors of c
        and nu, typically 0.8; 0 if c was not fitted. ``misfit``: root mean square of the relative
        residuals.

    Raises
    ------
    ValueError
        If the chain has fewer than 5 rods or a width is not positive, or if no such law with
        -5 < nu < 0 and -L < c < 1 fits, as for a chain with e >= 1.

    Examples
    --------
    >>> from crazybilliards.model import Chain
    >>> from crazybilliards.particles import simulate
    >>> run = simulate(Chain(size=30, restitution=0), duration=300, progress=False)
    >>> bool(-0.6 < fit_border_power_law(run).exponent < -0.3)
    True
    """
    require(source, ("velocity_width",))
    chain = chain_of(source)
    size = chain.size
    chain.require_known("fit_border_power_law")
    require_all_particles(source, size, "fit_border_power_law")
    if size < _LEAST_RODS:
        raise ValueError(f"the fit needs the widths of at least {_LEAST_RODS} particles")
    width = source.velocity_width.values
    error = source.get("velocity_width_error", source.velocity_width).values
    weight = error if weighted else np.ones(size)
    if not (np.min([width, weight]) > 0 and np.isfinite([width, weight]).all()):
        raise ValueError("the fit needs positive widths and errors")
    i = np.arange(1.0, size + 1)
    curve = partial(_sum_of_powers, size=size)
    values, errors, correlation = _best_fit(curve, i, width, weight, shifted)
    parameters, of_errors = (
        dict(zip(("scale", "exponent", "origin"), map(float, each), strict=True))
        for each in (values, errors)
    )
    misfit = root_mean_square(curve(i, *values) / width - 1)
    return Fit(
        parameters, of_errors, curve, {"correlation": correlation, "misfit": misfit, "size": size}
    )


def _best_fit(
    curve: Callable[..., Array], i: Array, width: Array, weight: Array, shifted: bool
) -> tuple[Array, Array, float]:
    """Return a, nu and c, their errors, and the correlation of the last two."""
    number = 3 if shifted else 2
    low, high = np.array([[0.0, _STEEPEST, -i.size], [np.inf, 0.0, 1.0]])[:, :number]
    best: tuple[float, Array, Array] | None = None
    for nu, c in _STARTS if shifted else _STARTS[:1]:
        # The best scale for these two.
        unscaled = curve(i, 1.0, nu, c) / weight
        scale = float(unscaled @ (width / weight) / (unscaled @ unscaled))
        try:
            values, covariance = curve_fit(
                curve,
                i,
                width,
                p0=(scale, nu, c)[:number],
                sigma=weight,
                absolute_sigma=True,
                bounds=(low, high),
                jac=lambda *point: _slopes_of_powers(*point)[:, :number],
                x_scale=(scale, 0.1, 1.0)[:number],
                max_nfev=2000,
                ftol=1e-12,
                xtol=1e-10,
                gtol=1e-12,
            )
        except RuntimeError:
            continue  # no fit from this start; another may succeed
        cost = float(np.sum(((curve(i, *values) - width) / weight) ** 2))
        if best is None or cost < best[0]:
            best = cost, values, covariance
    # Nu and c are away from their bounds if there is such a law.
    if (
        best is None
        or not ((low + 1e-3 < best[1]) & (best[1] < high - 1e-3))[1:].all()
        or not np.isfinite(best[2]).all()
    ):
        raise ValueError("no power law fits: the widths do not fall like one from the borders")
    cost, values, covariance = best
    one = np.sqrt(np.diag(covariance))  # errors for weights of one standard error each
    correlation = float(covariance[1, 2] / (one[1] * one[2])) if shifted else 0.0
    errors = one * np.sqrt(cost / (width.size - number))
    rest = np.zeros(3 - number)
    return np.append(values, rest), np.append(errors, rest), correlation


def _sum_of_powers(
    i: Array, scale: float, exponent: float, origin: float = 0.0, *, size: int
) -> Array:
    return np.asarray(scale * ((i - origin) ** exponent + (size + 1 - origin - i) ** exponent))


def _slopes_of_powers(i: Array, scale: float, exponent: float, origin: float = 0.0) -> Array:
    """Return the derivatives with respect to scale, exponent and origin, a column each."""
    distance = np.array([i - origin, i.size + 1 - origin - i])
    laws = distance**exponent
    columns = laws, scale * laws * np.log(distance), -scale * exponent * laws / distance
    return np.array([column.sum(axis=0) for column in columns]).T
