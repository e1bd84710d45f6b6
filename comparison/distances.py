"""Distances between two results, absolute and in units of the error bar."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from crazybilliards.comparison.coverage import require_same_smoothing, smooth
from crazybilliards.model import WALLS_AND_MASSES, Array, chain_of
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.model.checks import check_real
from crazybilliards.model.grid import require_even
from crazybilliards.model.vocabulary import require
from crazybilliards.model.warn import warn_user

_SAME_RODS = 0.05  # of the number of rods, by which two densities of a chain may differ
_WHOLE = 1e-3  # of the number of rods, by which they may if their grids end at other places
_SAME_NODE = 1e-3  # of the spacing, by which nodes may differ
_LEAST_INNER = 7  # rods from which on the two at each border are left out of the largest deviation
_RELIABLE = 0.2  # of a density, up to which an error bar is


@dataclass(frozen=True)
class Deviation:
    """Distances between two densities.

    Attributes
    ----------
    maximum, rms
        Largest and root-mean-square difference, in units of the close-packed density 1/(2R).
    integrated
        int |difference| dx / L, which is twice the share of the rods in the wrong place.
    maximum_in_errors, rms_in_errors
        The same with each difference divided by its standard error; None if neither result has
        errors. If the two agree they are about 3 to 4.5 and 1 for 10 to 100 rods and a long run. A
        short run has fewer blocks and larger maxima.
    """

    maximum: float
    rms: float
    integrated: float
    maximum_in_errors: float | None
    rms_in_errors: float | None


def deviation(
    result: xr.Dataset, reference: xr.Dataset, floor: float = 1e-3, *, raw: bool = False
) -> Deviation:
    """Compare the densities of two results, and nothing else, on their common grid.

    Widths are compared by a division: ``run.velocity_width / theory.velocity_width - 1``.

    Parameters
    ----------
    result, reference
        Two results with ``density`` over x of one chain, smoothed in the same way. Beyond the end
        of a whole grid the density is 0; if x was cut, it must be the same in both. A warning says
        in which parameters two chains differ.
    floor
        Differences count where either density exceeds this fraction of close packing, and those
        in units of errors where both do and the error is at most a fifth of the density.
    raw
        Compare densities of which none is smoothed. In a near-crystal the smallest shift of their
        spikes is then a large deviation.

    Raises
    ------
    ValueError
        If a result has no density, if only one is smoothed, or none unless ``raw``, or if they are
        of other numbers of rods, or of rods of other lengths.
    """
    floor = check_real("floor", floor)
    chain = chain_of(reference)
    for dataset in (result, reference):
        require(dataset, ("density",))
    require_same_smoothing({"result": result, "reference": reference})
    if not raw and "smoothed" not in result.attrs:
        raise ValueError(
            "the densities are not smoothed: take cb.smooth of both, or raw=True to compare spikes"
        )
    mine, others = chain_of(result).parameters(), chain.parameters()
    if differ := [f"{n} {mine[n]} and {others[n]}" for n in mine if mine[n] != others[n]]:
        warn_user(f"the two results are of different chains: {', '.join(differ)}")
    difference, error, either = _differences(result, reference, floor)
    differences = difference[either] if either.any() else np.zeros(1)
    in_errors = (difference / error)[np.isfinite(error)]
    spacing = float(reference.x[1] - reference.x[0])
    share = np.abs(difference).sum() * chain.close_packed_density * spacing / chain.size
    return Deviation(
        maximum=float(np.abs(differences).max()),
        rms=float(np.sqrt((differences**2).mean())),
        integrated=float(share),
        maximum_in_errors=float(np.abs(in_errors).max()) if in_errors.size else None,
        rms_in_errors=float(np.sqrt((in_errors**2).mean())) if in_errors.size else None,
    )


class WidthDeviation(NamedTuple):
    """Relative deviations of velocity widths, theory minus simulation."""

    largest: float  # over the particles 3 to L - 2
    centre: float  # of the middle tenth of the rods
    border: float  # of the first and the last rod
    error: float  # typical standard error of a rod's simulated width
    border_error: float  # that of the border's
    largest_in_errors: float  # over all particles, in standard errors of each


def width_deviation(run: xr.Dataset, theory: xr.Dataset) -> WidthDeviation:
    """Compare the velocity widths of a simulation and a theory of the same chain.

    Both ends of a chain have the same averages, if their rods have the same mass. Simulated widths
    are then averaged over a rod and its mirror image, but not for ``largest_in_errors``.
    """
    chain = chain_of(run)
    chain.require_known("the mean over mirror images", WALLS_AND_MASSES)
    size = chain.size
    square = run.velocity_width.values**2
    if chain.mass_ratio == 1 or size % 2:
        square = (square + square[::-1]) / 2
    expected = theory.velocity_width.values**2
    inner = slice(2, size - 2) if size >= _LEAST_INNER else slice(None)

    def relative(part: slice | list[int]) -> float:
        return float(np.sqrt(expected[part].mean() / square[part].mean()) - 1)

    each = np.sqrt(expected / square) - 1
    in_errors = (theory.velocity_width.values - run.velocity_width) / run.velocity_width_error
    relative_error = (run.velocity_width_error / run.velocity_width).values
    return WidthDeviation(
        largest=float(np.abs(each[inner]).max()),
        centre=relative(middle_tenth(size)),
        border=relative([0, -1]),
        error=float(np.median(relative_error)),
        border_error=float(np.hypot(relative_error[0], relative_error[-1]) / 2),
        largest_in_errors=float(np.abs(in_errors).max()),
    )


class Deviations(NamedTuple):
    """How far a theory is from the simulation of the same chain."""

    density: Deviation  # smoothed
    velocity_width: WidthDeviation | None  # if the theory has one


def deviations(group: xr.DataTree) -> dict[str, Deviations]:
    """Compare each theory with the ``simulation`` beside it, unless this diverged."""
    results = {str(name): each.to_dataset() for name, each in group.children.items()}
    run = results.pop("simulation")
    if run.attrs["status"] == "diverged":
        require(run, (), "not compared with theories")
        return {}
    smoothed = smooth(run)
    found = {}
    for name, theory in results.items():
        width = width_deviation(run, theory) if "velocity_width" in theory else None
        found[name] = Deviations(deviation(smoothed, smooth(theory)), width)
    return found


def _differences(
    result: xr.Dataset, reference: xr.Dataset, floor: float
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return differences, their errors, and the bins where either density exceeds the floor.

    In units of close packing, on the common grid. An error is infinite where it is not reliable.
    """
    result, reference = (each.transpose(..., "x") for each in (result, reference))
    spacing = _common_spacing(result, reference)
    ours, theirs = (each.density.sum("x") * spacing for each in (result, reference))
    if ours.dims != theirs.dims or (ours.dims and not ours.time.equals(theirs.time)):
        raise ValueError("the densities are of several times; choose one of each: .isel(time=...)")
    _require_same_rods(result, reference, ours.values, theirs.values)
    unit = chain_of(reference).close_packed_density
    # The nodes of both are the same, so their numbers align the grids exactly.
    first = float(reference.x[0])
    ours, theirs = (
        dataset.assign_coords(x=np.rint((dataset.x - first) / spacing).astype(int))
        for dataset in (result, reference)
    )
    a, b = xr.align(ours.density, theirs.density, join="outer", fill_value=0.0)
    squared_error = np.zeros(a.shape)
    for each in (ours, theirs):
        error = each.get("density_error", xr.zeros_like(a))
        squared_error += (error**2).reindex_like(a, fill_value=0.0).values
    high = [(density > floor * unit).values for density in (a, b)]
    reliable = squared_error <= np.square(_RELIABLE * np.maximum(a.values, b.values))
    known = high[0] & high[1] & (squared_error > 0) & reliable
    errors = np.where(known, np.sqrt(squared_error), np.inf) / unit
    return (a - b).values / unit, errors, high[0] | high[1]


def _common_spacing(result: xr.Dataset, reference: xr.Dataset) -> float:
    """Return the spacing of x, or raise a ValueError if the nodes of two grids differ."""
    ours, theirs = (require_even(each.x.values, "deviation") for each in (result, reference))
    if not np.isclose(ours, theirs, rtol=1e-9):
        raise ValueError("the two densities lie on grids of different spacing")
    apart = float(result.x[0] - reference.x[0]) / theirs
    if abs(apart - round(apart)) > _SAME_NODE:
        raise ValueError("the two densities lie on grids with other nodes")
    return theirs


def _require_same_rods(
    result: xr.Dataset, reference: xr.Dataset, ours: Array, theirs: Array
) -> None:
    """Raise a ValueError if the grids of two results hold other numbers of rods."""
    alike = result.x.size == reference.x.size and np.allclose(result.x, reference.x)
    missing = any(each.get("outside", 0) > 0 for each in (result, reference))
    tolerance = _SAME_RODS if alike or missing else _WHOLE
    if (np.abs(ours - theirs) > tolerance * np.maximum(ours, theirs)).any():
        held = (f"{float(each.max()):.4g}" for each in (ours, theirs))
        where = "" if alike else "; their grids end at other places: if x was cut, cut both alike"
        raise ValueError(f"the two densities hold {' and '.join(held)} rods{where}")


def distances_in_plot(
    x: ArrayLike,
    y: ArrayLike,
    line_x: ArrayLike,
    line_y: ArrayLike,
    *,
    x_range: tuple[float, float] | None = None,
    y_range: tuple[float, float] | None = None,
) -> Array:
    """Distances of symbols from a line in the plane of a plot, shape of ``x``.

    Each axis is in units of its range, by default from the least to the greatest symbol. The line
    is given by points to be joined by straight pieces. For logarithmic axes give logarithms.
    """
    symbols, line = np.array([x, y], dtype=float), np.array([line_x, line_y], dtype=float)
    for axis, span in enumerate((x_range, y_range)):
        low, high = span or (symbols[axis].min(), symbols[axis].max())
        for points in (symbols, line):
            points[axis] = (points[axis] - low) / (high - low)
    pieces = np.diff(line)
    squares = np.maximum((pieces**2).sum(axis=0), np.finfo(float).tiny)
    distances = np.empty(symbols.shape[1])
    for number, symbol in enumerate(symbols.T):
        away = symbol[:, np.newaxis] - line[:, :-1]
        along = np.clip((away * pieces).sum(axis=0) / squares, 0, 1)
        distances[number] = np.sqrt(((away - along * pieces) ** 2).sum(axis=0).min())
    return distances
