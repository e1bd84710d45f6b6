"""The density as the paper bins it: partial coverage of bins, then a running average.

The paper divides the line into bins much smaller than R, adds to each bin the fraction of it
that rods cover, divides by the number of samples and by 2R, and takes a running average over a
window of 2R (its figure ``fig:rho_num_sim`` and the text below). Both steps are convolutions of the
density of the rods' centres with a box of length 2R. Densities should be compared only after the
same steps: for small A the rods form a near-crystal, and their bare density is a row of spikes.
Beyond its grid a density is 0, so each step needs a grid that holds all rods.

On the package's grid (nodes at multiples of h = 2R/n, n odd) the first step is exact for points
kept in hat weights: the covered fraction of a node's bin is the mean of the n hats around it.
"""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from scipy.ndimage import convolve1d

from crazybilliards.model import Chain, chain_of
from crazybilliards.model.grid import deposit, position_grid, require_all_held, require_even
from crazybilliards.model.vocabulary import check_result, require, result

_ONCE, _TWICE = "coverage", "coverage, running average"
_SMOOTHED = {"density", "density_block"}
_ROUGH = 0.01  # of the rods, by which the sum of a density of one's own may be wrong


def coverage_density(source: xr.Dataset) -> xr.Dataset:
    """First step of the paper: the fraction of each bin that rods cover, divided by 2R.

    Parameters
    ----------
    source
        One of three kinds of result: a *simulation* (``density``, ``density_error``,
        ``density_block`` over x), a *theory* (``density`` and ``label`` over x), or, without a
        density, *states* (``position`` of all or some rods, averaged over replicas and times). The
        first two may be over time. Their grid must be whole: cut the result of this function, not
        its argument.

    Returns
    -------
    xarray.Dataset
        ``density`` over x. A simulation also has ``density_error``, ``density_block`` and
        ``outside``. ``rods``: how many rods the states had.

    Raises
    ------
    ValueError
        If the result holds none of these, is smoothed already, or was cut or thinned.
    """
    check_result(source)
    if "smoothed" in source.attrs:
        raise ValueError("the density is smoothed already")
    return _covered(source, "coverage_density")


def smooth(source: xr.Dataset) -> xr.Dataset:
    """Both steps of the paper: :func:`coverage_density`, then the running average over 2R.

    What is smoothed already, as its attribute ``smoothed`` says, stays. A grid that was cut or
    thinned is refused: smooth the whole result first.
    """
    check_result(source)
    done = source.attrs.get("smoothed")
    if done == _TWICE:
        return source
    once = _whole(source, "smooth") if done == _ONCE else _covered(source, "smooth")
    return _box(once).assign_attrs(smoothed=_TWICE)


def require_same_smoothing(results: Mapping[str, xr.Dataset]) -> None:
    """Raise a ValueError if some densities are smoothed and others are not, or in another way."""
    ways = {label: each.attrs.get("smoothed", "not smoothed") for label, each in results.items()}
    if len(set(ways.values())) > 1:
        listed = "; ".join(f"{label}: {way}" for label, way in ways.items())
        raise ValueError(f"the densities are not smoothed alike ({listed}); take cb.smooth of all")


def _covered(source: xr.Dataset, who: str) -> xr.Dataset:
    chain = chain_of(source)
    if "density" not in source and "position" in source:
        found = _hat_density_of_states(chain, source)
    else:
        source = _whole(source, who)
        found = _hat_density_of_theory(source) if "label" in source else source
    return _box(found).assign_attrs(smoothed=_ONCE)


def _whole(source: xr.Dataset, who: str) -> xr.Dataset:
    """Return a result with x as the last dimension, or raise a ValueError if its grid is cut."""
    require(source, ("density",))
    if "x" not in source.density.dims:
        raise ValueError(f"density must be over x, got {source.density.dims}: {who} needs its grid")
    source, chain = source.transpose(..., "x"), chain_of(source)
    spacing = require_even(source.x.values, who)
    nodes = 2 * chain.radius / spacing
    if not abs(nodes - round(nodes)) < 1e-4 or round(nodes) % 2 == 0:
        raise ValueError(
            f"x must have an odd number of nodes in a rod's length, got {nodes:.4g}: {who} needs "
            "the whole grid of the result"
        )
    rods = source.get("rods", xr.DataArray(chain.size)).values
    if "label" in source:
        require_all_held(source.label[..., -1] - source.label[..., 0], rods, who)
        return source
    lost, smoothed = float(source.get("outside", 0)), "smoothed" in source.attrs
    # At which times they were outside is not known, nor where they are after the first step.
    if lost == 0 or not ("time" in source.density.coords or smoothed):
        held = source.density.values.sum(axis=-1) * spacing + lost
        summed = smoothed or source.attrs.get("source") == "simulation"
        unknown = np.isnan(held)  # at times that an interrupted run did not reach
        require_all_held(np.where(unknown, rods, held), rods, who, *([] if summed else [_ROUGH]))
    return source


def _box(source: xr.Dataset) -> xr.Dataset:
    """Convolve density (and block densities, hence the error) with a box of length 2R."""
    n = round(2 * chain_of(source).radius / float(source.x[1] - source.x[0]))
    convolved = source.drop_vars(set(source.data_vars) - _SMOOTHED - {"outside", "rods"})
    for name in _SMOOTHED & set(convolved.data_vars):
        convolved[name] = convolved[name].copy(
            data=convolve1d(source[name].values, np.full(n, 1 / n), axis=-1, mode="constant")
        )
    if "density_block" in convolved:
        blocks = convolved.density_block
        # Not by their std(): older versions of xarray warn if there is one block only.
        number, squares = blocks.count("block"), (blocks - blocks.mean("block")) ** 2
        error = np.sqrt(squares.sum("block") / (number * (number - 1)))
        convolved["density_error"] = error.assign_attrs(source.density_error.attrs)
    return convolved


def _hat_density_of_states(chain: Chain, source: xr.Dataset) -> xr.Dataset:
    positions = source.position.transpose(..., "particle").values
    observed = source.particle.values.astype(int) - 1
    reach = float(np.abs(positions - chain.anchors[observed]).max()) + chain.radius
    x = position_grid(chain, reach)
    weights = np.zeros(x.size)
    if deposit(positions.ravel(), x[0], x[1] - x[0], weights):
        raise ValueError("the states hold positions that are not finite")
    density = weights / (x[1] - x[0]) / (positions.size / observed.size)
    return result(
        chain,
        {"density": ("x", density), "rods": ((), observed.size)},
        source=source.attrs["source"],
        method={"density": "of states"},
        coordinates={"x": x},
    )


def _hat_density_of_theory(source: xr.Dataset) -> xr.Dataset:
    """Hat weights of a smooth density: second differences of the integral of the label.

    The integral over a cell is that of the Hermite cubic from N and N' = rho at both ends, kept
    between h N(left) and h N(right). So the weights are positive and add up to the number of rods
    exactly, even if the peaks of rho are narrower than a cell.
    """
    h = float(source.x[1] - source.x[0])
    label, density = source.label.values, source.density.values
    left, right = label[..., :-1], label[..., 1:]
    cells = np.clip(h * (right + left) / 2 - h**2 * np.diff(density) / 12, h * left, h * right)
    weights = np.zeros(label.shape)
    weights[..., 1:-1] = np.diff(cells) / h**2
    return source.assign(density=source.density.copy(data=weights))
