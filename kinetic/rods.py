r"""The rods of a theory that describes the chain as a fluid.

Theories compute the density n(y) of *points*, of which N(y) lie below y. Read as a fluid, rod i is
at the place where N = i - 1/2. A real rod is found around it, and :mod:`.exact.places` says where.
With a gap the exact places of the elastic chain and the N(y) of its force balance together say at
which labels N rod i is found. A theory takes these labels, of the elastic chain with its own mean
temperature m <W^2>, to the places that have them in its own N(y). This is exact at e = 1 at rest
and after a shift or a stretch from there.
"""

import json
import math
from functools import lru_cache

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline
from scipy.special import ndtr, ndtri

from crazybilliards.kinetic.accuracy import Accuracy, errors_of_equilibrium
from crazybilliards.kinetic.exact.places import (
    RodPlaces,
    are_resolved,
    at_temperature,
    elastic_rods,
    exchangeable,
    normal,
    over_positions,
)
from crazybilliards.kinetic.statics.label_closure import BY_LABELS, stationary
from crazybilliards.model import WALLS_AND_MASSES, Array, Chain, chain_of
from crazybilliards.model.grid import require_all_held, require_even
from crazybilliards.model.vocabulary import (
    OF_RODS,
    VOCABULARY,
    described,
    require,
    require_all_particles,
)

_FARTHEST = 1e-8  # shares of the points closer to an end than this are numerical noise


def rod_by_rod(theory: xr.Dataset) -> xr.Dataset:
    """Return a result with the density of the rods in place of that of a fluid.

    ``force_balance`` and ``hydrodynamics`` compute the density rho of a fluid, in which every rod
    with the label N is at the place x where N(x) rods lie to the left. A real rod is an order
    statistic, found around this place,

        rho(x) = sum_i p_i(x - 2R (i - (L+1)/2)),    p_i(y) = n(y)/L Beta(N(y)/L; i, L + 1 - i),

    with the points' density n = rho/(1 - 2 R rho) at y = x - 2R (N - L/2). Without a gap this is
    exact at restitution 1 if the theory's n is. With a gap rod i has its labels in the elastic
    chain of the fluid's temperature (see this module), which takes as long as ``equilibrium``.

    Parameters
    ----------
    theory
        A result of ``force_balance`` or ``hydrodynamics``, or a start of it, at one time or all.
        One that has the density of its rods already is returned as it is.

    Returns
    -------
    xarray.Dataset
        The same with ``density`` [1/R], which may have one peak for each rod, and ``label`` of the
        rods, and with their ``mean_displacement``, ``displacement_width`` [R] and, if there is a
        flow, ``mean_velocity``. Other profiles over x stay those of the fluid. Where peaks are
        narrower than the spacing of x, the integral of the density is rough, and ``label`` counts
        the rods exactly. ``attrs["density_of"]`` is ``"rods"``, or ``"fluid"``, as the density, of
        more than 10 000 rods, or 3000 with a gap. The errors of the theory are 0 for
        ``force_balance`` by labels at restitution 1 and NaN, not known, for others.

    Raises
    ------
    ValueError
        For a simulation, a density that is smoothed or has no label, a grid without all rods.

    Examples
    --------
    >>> from crazybilliards import equilibrium, force_balance
    >>> chain = Chain(size=20)
    >>> rods, exact = rod_by_rod(force_balance(chain)), equilibrium(chain)
    >>> float(abs(rods.density.interp(x=exact.x) - exact.density).max()) < 1e-4
    True
    """
    chain = _check(theory)
    if theory.attrs.get("density_of") == OF_RODS or not are_resolved(chain):
        return theory
    x, leading = theory.x.values, theory.label.dims[:-1]
    fluids = [theory.isel(time=k) for k in range(theory.sizes["time"])] if leading else [theory]
    at_times = [_at_one_time(chain, x, fluid) for fluid in fluids]
    result = theory.copy()
    for name, (along, _) in at_times[0].items():
        values = np.array([moment[name][1] for moment in at_times])
        meaning = described(*VOCABULARY[name])
        result[name] = ((*leading, along), values if leading else values[0], meaning)
    mean = result.mean_displacement
    result = result.assign_coords(
        particle=("particle", np.arange(chain.size) + 1, described(*VOCABULARY["particle"])),
        mean_position=(
            mean.dims,
            mean.values + chain.anchors,
            described(*VOCABULARY["mean_position"]),
        ),
    )
    by_labels = json.loads(theory.attrs["provenance"]).get("theory") == BY_LABELS
    exact = by_labels and not math.isnan(theory.attrs.get("density_model_error", math.nan))
    stated = (errors_of_equilibrium(chain) if exact else Accuracy()).named()
    errors = {name: value for name, value in stated.items() if name in theory.attrs}
    return result.assign_attrs(density_of=OF_RODS, **errors)


def _check(theory: xr.Dataset) -> Chain:
    """Return the chain of a theory, or raise for what it is not."""
    require(theory, ("density",))
    chain = chain_of(theory)
    chain.require_known("rod_by_rod", WALLS_AND_MASSES)
    if theory.attrs.get("source") == "simulation":
        raise ValueError("rod_by_rod takes a theory; a simulation has the density of its rods")
    if "smoothed" in theory.attrs:
        raise ValueError("the density is smoothed already; smooth what rod_by_rod returns")
    require(theory, ("label",))
    label = theory.label
    if label.dims not in (("x",), ("time", "x")) or theory.density.dims != label.dims:
        raise ValueError(f"density and label must be over x or (time, x), got {label.dims}")
    require_even(theory.x.values, "rod_by_rod")
    require_all_held(label[..., -1] - label[..., 0], chain.size, "rod_by_rod")
    if "particle" in theory.dims:
        require_all_particles(theory, chain.size, "rod_by_rod")
    return chain


def _at_one_time(chain: Chain, x: Array, fluid: xr.Dataset) -> dict[str, tuple[str, Array]]:
    """Return the variables of the rods at one time."""
    R, rho = chain.radius, fluid.density.values
    below = np.clip(fluid.label.values - fluid.label.values[0], 0.0, chain.size)
    y = np.maximum.accumulate(x - 2 * R * (below - chain.size / 2))
    n = rho / np.maximum(1 - 2 * R * rho, np.finfo(float).tiny)
    points = _LabelledPoints(chain.size, y, n, below, below[-1] - below)
    rods = _rods_of(chain, points, _temperature(chain, fluid))
    density, label = over_positions(chain, x, rods)
    moments = {
        "density": ("x", density),
        "label": ("x", label),
        "mean_displacement": ("particle", rods.mean() - chain.reduced_anchors),
        "displacement_width": ("particle", rods.width()),
    }
    if "flow_velocity" in fluid:
        velocity = rods.mean(np.interp(rods.places, y, fluid.flow_velocity.values))
        moments["mean_velocity"] = ("particle", velocity)
    return moments


def _temperature(chain: Chain, fluid: xr.Dataset) -> float:
    """Return the mean of m W^2 over the rods."""
    if "velocity_variance" in fluid:
        share = fluid.density.values / fluid.density.values.sum()
        return chain.mean_mass * float(share @ fluid.velocity_variance.values)
    if "velocity_width" in fluid:
        return float((chain.rod_masses * fluid.velocity_width.values**2).mean())
    return chain.temperature


class _LabelledPoints:
    """A theory's points: y as a function of the normal score z of their label, N = L Phi(z)."""

    def __init__(self, size: int, y: Array, density: Array, below: Array, beyond: Array) -> None:
        """Read the points' density n and the numbers below and beyond each ascending y."""
        share = np.minimum(below, beyond) / size
        occupied = share > _FARTHEST
        y, density = y[occupied], density[occupied]
        # The smaller of the two numbers is more accurate.
        score = np.where(below < beyond, 1, -1)[occupied] * ndtri(share[occupied])
        # From the middle outwards, so that both sides of a symmetric state are the same.
        middle = np.abs(score).argmin()
        new = _farther_out(score, middle) & _farther_out(y, middle)
        y, score, density = y[new], score[new], density[new]
        secant = np.diff(y) / np.diff(score)
        # Three times the smaller secant at most keeps the cubic monotonic.
        most = 3 * np.minimum(np.append(secant, np.inf), np.append(np.inf, secant))
        with np.errstate(divide="ignore"):
            slope = np.minimum(size * normal(score) / density, most)
        self._curve = CubicHermiteSpline(score, y, slope)
        self.ends = score[0], score[-1]

    def at(self, score: Array) -> tuple[Array, Array]:
        """Return y and dy/dz at scores, continued linearly; of a Gaussian, y is linear in z."""
        inside = np.clip(score, *self.ends)
        slope = self._curve(inside, 1)
        return self._curve(inside) + slope * (score - inside), slope


def _farther_out(values: Array, middle: np.intp) -> NDArray[np.bool_]:
    """Return which values are farther out than all those between them and the middle one."""
    up, down = (
        side[1:] > np.maximum.accumulate(side)[:-1]
        for side in (values[middle:], -values[middle::-1])
    )
    return np.concatenate([down[::-1], [True], up])


def _rods_of(chain: Chain, points: _LabelledPoints, temperature: float) -> RodPlaces:
    """Return the rods of a theory's points; ``temperature``: the mean of m W^2 over the rods."""
    if chain.exchangeable:
        return exchangeable(chain.size).mapped(*points.at(exchangeable(chain.size).places))
    cold = at_temperature(chain, temperature)
    rest, score, slope_at_rest = elastic_rods(cold), *_scores_at_rest(cold)
    # Beyond the last points, rods are moved as these are.
    inside = np.clip(score, *points.ends)
    places, slope = points.at(inside)
    at_rest = rest.places.copy()
    for beyond, end in zip((score < inside, score > inside), points.ends, strict=True):
        at_rest[beyond] = stationary(cold).unit * stationary(cold).at(ndtr(end) - 0.5)
    stretch = np.where(inside == score, slope / slope_at_rest, 1.0)
    return rest.mapped(rest.places + (places - at_rest), stretch)


@lru_cache(maxsize=4)
def _scores_at_rest(chain: Chain) -> tuple[Array, Array]:
    """Return z of the places of the exact rods in the fluid at rest, and dy/dz there."""
    s = stationary(chain).unit
    label, log_density = stationary(chain).profile(elastic_rods(chain).places / s)
    score = -np.sign(label) * ndtri(np.maximum(0.5 - np.abs(label), np.finfo(float).tiny))
    return score, s * normal(score) * np.exp(-np.maximum(log_density, -600.0))
