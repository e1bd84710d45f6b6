"""The paper's arctanh fit of the mean displacement (its figure ``fig:atan``)."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import OptimizeWarning, curve_fit

from crazybilliards.model import chain_of
from crazybilliards.model.vocabulary import require


@dataclass(frozen=True)
class ArctanhFit:
    """<dx>(x) = B arctanh(C x), the paper's fit of the mean displacement.

    It is callable on |x| < 1/C and can be the ``displacement`` of ``force_balance``.

    Attributes
    ----------
    scale, steepness
        B [R] and C [1/R].
    scale_error, steepness_error
        Their standard errors, from the scatter about the fit.
    misfit
        Root mean square of the residuals [R].
    """

    scale: float
    steepness: float
    scale_error: float
    steepness_error: float
    misfit: float

    @property
    def support(self) -> tuple[float, float]:
        """The interval (-1/C, 1/C) on which it is finite."""
        return -1 / self.steepness, 1 / self.steepness

    def __call__(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return B arctanh(C x)."""
        return self.scale * np.arctanh(self.steepness * np.asarray(x, dtype=float))


def fit_arctanh(source: xr.Dataset) -> ArctanhFit:
    """Fit B arctanh(C x) to the mean displacements at the mean positions, as the paper does.

    Every rod has the same weight, because the misfit is systematic and far above the error bars.

    Parameters
    ----------
    source
        A result with ``mean_displacement``.

    Raises
    ------
    ValueError
        If the chain has fewer than 3 rods, or if no arctanh fits because the rods are not
        displaced outward (they do not touch).
    """
    require(source, ("mean_displacement",))
    chain = chain_of(source)
    displacement = source.mean_displacement.values
    x = chain.anchors + displacement
    if chain.size < 3:
        raise ValueError(f"an arctanh fit needs at least 3 rods, got {chain.size}")
    outward = float(np.sum(displacement * x))
    if outward <= 0:
        raise ValueError("no arctanh fits: the rods are not displaced outward")
    edge = float(np.abs(x).max())

    # C = 1/(edge (1 + exp(q))) keeps every rod inside the support, for every q.
    def model(position: NDArray[np.float64], scale: float, q: float) -> NDArray[np.float64]:
        return scale * np.arctanh(position / (edge * (1 + math.exp(q))))

    slope = outward / float(x @ x)
    start = (slope * edge, -2.0)
    try:
        with warnings.catch_warnings():
            # Without a covariance the data do not determine both parameters, and there is no fit.
            warnings.simplefilter("error", OptimizeWarning)
            (scale, q), covariance = curve_fit(model, x, displacement, p0=start, maxfev=10_000)
    except (RuntimeError, OptimizeWarning) as error:
        raise ValueError(f"no arctanh fits: {error}") from error
    steepness = 1 / (edge * (1 + math.exp(q)))
    scale_error, q_error = np.sqrt(np.diag(covariance))
    return ArctanhFit(
        scale=float(scale),
        steepness=float(steepness),
        scale_error=float(scale_error),
        steepness_error=float(steepness * math.exp(q) / (1 + math.exp(q)) * q_error),
        misfit=float(np.sqrt(np.mean((model(x, scale, q) - displacement) ** 2))),
    )
