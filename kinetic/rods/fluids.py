"""The rods of a theory that describes the chain as a fluid."""

import json
import math

import numpy as np
import xarray as xr

from crazybilliards.kinetic.accuracy import Accuracy, expected
from crazybilliards.kinetic.rods.places import LabelledPoints, are_resolved, over_positions, rods_of
from crazybilliards.kinetic.statics.label_closure import BY_LABELS
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.arrays import Array
from crazybilliards.model.grid import require_all_held, require_even
from crazybilliards.model.parameters import WALLS_AND_MASSES
from crazybilliards.model.vocabulary import (
    OF_RODS,
    VOCABULARY,
    described,
    require,
    require_all_particles,
)


def rod_by_rod(theory: xr.Dataset) -> xr.Dataset:
    """Return a result with the density of the rods in place of that of a fluid.

    ``force_balance`` and ``hydrodynamics`` compute the density rho of a fluid, in which every rod
    with the label N is at the place x where N(x) rods lie to the left. A real rod is an order
    statistic, found around this place,

        rho(x) = sum_i p_i(x - 2R (i - (L+1)/2)),    p_i(y) = n(y)/L Beta(N(y)/L; i, L + 1 - i),

    with the points' density n = rho/(1 - 2 R rho) at y = x - 2R (N - L/2). Without a gap this is
    exact at restitution 1 if the theory's n is. With a gap rod i has its labels in the elastic
    chain of the fluid's temperature (:mod:`.places`), which takes as long as ``equilibrium``.

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
    position = described(*VOCABULARY["mean_position"])
    result = result.assign_coords(
        particle=("particle", np.arange(chain.size) + 1, described(*VOCABULARY["particle"])),
        mean_position=(mean.dims, mean.values + chain.anchors, position),
    )
    by_labels = json.loads(theory.attrs["provenance"]).get("theory") == BY_LABELS
    exact = by_labels and not math.isnan(theory.attrs.get("density_model_error", math.nan))
    stated = (expected("equilibrium", chain) if exact else Accuracy()).named()
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
    points = LabelledPoints(chain.size, y, n, below, below[-1] - below)
    rods = rods_of(chain, points, _temperature(chain, fluid))
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
