"""The paper's fit of the velocity widths of a dissipative chain: power laws from both borders."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import curve_fit

from crazybilliards.model import chain_of
from crazybilliards.model.checks import check_integer
from crazybilliards.model.vocabulary import require


@dataclass(frozen=True)
class PowerLawFit:
    """W_v(i) = B [i^nu + (L + 1 - i)^nu] + C, the paper's sum of two power laws from the borders.

    Callable on particle numbers.

    Attributes
    ----------
    size
        L.
    scale, exponent, offset
        B [R/T], nu and C [R/T], which is 0 unless it was fitted.
    scale_error, exponent_error, offset_error
        Their standard errors, from the scatter about the fit. Neighbouring rods move together, so
        the scatter between independent runs is larger and the better measure.
    misfit
        Root mean square of the relative residuals.
    """

    size: int
    scale: float
    exponent: float
    scale_error: float
    exponent_error: float
    misfit: float
    offset: float = 0.0
    offset_error: float = 0.0

    def __call__(self, particle: ArrayLike) -> NDArray[np.float64]:
        """Return B [i^nu + (L + 1 - i)^nu] + C."""
        i = np.asarray(particle, dtype=float)
        powers = i**self.exponent + (self.size + 1 - i) ** self.exponent
        return np.asarray(self.scale * powers + self.offset)


def fit_border_power_law(
    source: xr.Dataset, *, skip: int | None = None, offset: bool = False
) -> PowerLawFit:
    """Fit the sum of two power laws to the velocity widths of a dissipative chain.

    Widths count by their error bars; those of a theory, which has none, by relative deviations, so
    that the narrow centre weighs as much as the wide border.

    Parameters
    ----------
    source
        A result with ``velocity_width`` of all particles.
    skip
        Rods at each border that are left out; None: L/30. The power law is that of the interior:
        at L = 300, e = 0 the exponent is -0.445 with all rods, -0.461 without 10 at each end.
    offset
        Fit the constant C as well. It and the exponent are hard to tell apart: errors grow much.

    Raises
    ------
    ValueError
        If fewer than 4 rods are left, or if no power law fits.

    Examples
    --------
    >>> from crazybilliards.model import Chain
    >>> from crazybilliards.particles import simulate
    >>> run = simulate(Chain(size=30, restitution=0), duration=300, progress=False)
    >>> bool(-0.6 < fit_border_power_law(run).exponent < -0.3)
    True
    """
    require(source, ("velocity_width",))
    size = chain_of(source).size
    skip = size // 30 if skip is None else check_integer("skip", skip, least=0)
    if source.sizes["particle"] != size or size - 2 * skip < 4:
        raise ValueError(
            "the fit needs the widths of all particles, at least 4 without the skipped"
        )
    inner = slice(skip, size - skip)
    i = np.arange(1.0, size + 1)[inner]
    width = source.velocity_width.values[inner]
    weight = source.get("velocity_width_error", source.velocity_width).values[inner]

    def model(
        i: NDArray[np.float64], scale: float, nu: float, constant: float = 0.0
    ) -> NDArray[np.float64]:
        return np.asarray(scale * (i**nu + (size + 1 - i) ** nu) + constant)

    start = (float(width[0]), -0.5) + ((0.0,) if offset else ())
    try:
        values, covariance = curve_fit(model, i, width, p0=start, sigma=weight, maxfev=10_000)
    except RuntimeError as error:
        raise ValueError(f"no power law fits: {error}") from error
    errors = np.sqrt(np.diag(covariance))
    misfit = np.sqrt(np.mean((model(i, *values) / width - 1) ** 2))
    numbers = map(float, (values[0], values[1], errors[0], errors[1], misfit))
    return PowerLawFit(size, *numbers, *map(float, (*values[2:], *errors[2:])))
