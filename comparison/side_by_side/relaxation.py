"""Relaxation from one start: simulated rods, two fluids and, where it is known, the exact solution.

The fluids are the paper's two equations with a constant W^2, for restitution 1, and those with
equations for temperature and heat flux.
"""

from typing import Literal, get_args

import numpy as np
import xarray as xr

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.curves import displacement_unit
from crazybilliards.comparison.side_by_side.grid import SIMULATION
from crazybilliards.kinetic import (
    compressed,
    displaced,
    equilibrium_states,
    force_balance,
    hydrodynamics,
    rod_by_rod,
)
from crazybilliards.kinetic.exact.motion import breathing_cloud, gas_of_points, points_of
from crazybilliards.kinetic.fluids.stated_errors import has_one_mass
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.kinetic.starts import gathered, wave
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.checks import check_choice, check_integer, check_real
from crazybilliards.model.parameters import WALLS_AND_MASSES
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.particles import simulate

Release = Literal["compressed", "displaced", "quenched", "gathered", "wave", "confined"]

# The starts of a gas in a box whose rods are drawn independently of one another.
_OF_POINTS = {"gathered": gathered, "wave": wave}
# The argument velocity_variance of hydrodynamics.
FLUIDS: dict[str, Literal["evolving"] | None] = {"isothermal": None, "evolving": "evolving"}
LEGEND = {
    "isothermal": "isothermal fluid",
    "evolving": "fluid with a temperature",
    "rods": "this fluid, rod by rod",
    "exact": "exact",
}


def compare_relaxation(
    chain: Chain,
    release: Release = "compressed",
    by: float = 0.3,
    *,
    duration: float = 40.0,
    every: float = 0.5,
    replicas: int = 300,
    seed: Seed = 0,
    threads: int | None = None,
    progress: bool = True,
) -> xr.DataTree:
    """Follow the release of a chain in all descriptions.

    Parameters
    ----------
    chain
        The chain, with any restitution, also in a box, and at restitution 1 of two masses.
    release
        The equilibrium state at restitution 1, changed. ``"compressed"``: with y multiplied by
        ``by`` (above 1: stretched); ``"displaced"``: moved by ``by`` thermal lengths;
        ``"quenched"``: that of the chain driven with ``by`` times its amplitude. In a box, whose
        rods leave the room l = X - 2RL free, also ``"gathered"``: rods spread evenly over the left
        share ``by`` of l; ``"wave"``: with a density over y like 1 + ``by`` cos(pi (y + l/2)/l);
        ``"confined"``: that of the chain in the middle share ``by`` of l. Of these three only the
        wave takes another restitution.
    duration, every
        Time, and time between outputs [t_0].
    replicas, seed, threads
        Those of the ensemble of simulated chains, as in ``simulate``.

    Returns
    -------
    xarray.DataTree
        ``tree["simulation"]``, ``["evolving"]``, its ``["rods"]`` and, at restitution 1,
        ``["isothermal"]`` and, for linear springs without gap, or equal rods in a box without
        springs, ``["exact"]``: results over time in the common vocabulary. The densities are as
        they are, not smoothed, those of the simulation in groups of replicas as well.

    Raises
    ------
    ValueError
        For a wrong argument, or a fluid that cannot be followed so long, before the simulation.
    """
    check_choice("release", release, get_args(Release))
    in_part = release in ("gathered", "confined")
    name = f"compare_relaxation with release={release!r}"
    require_chain(chain, name, elastic=in_part, elastic_walls=True, knows=WALLS_AND_MASSES)
    if release in ("compressed", "displaced"):
        chain.require_known(f"release={release!r}")
    signed = release in ("displaced", "wave")
    by = check_real("by", by, positive=not signed, signed=signed)
    replicas = check_integer("replicas", replicas, least=2)
    seed = seed_of(seed)
    fluid = _fluid(chain, release, by)
    # The fluids take a second and are computed first, to find a wrong duration before the long run.
    results = {}
    for name, variance in FLUIDS.items():
        if chain.restitution != 1 and variance is None:
            continue
        results[name] = found = hydrodynamics(
            chain,
            fluid,
            duration,
            every=every,
            velocity_variance=variance,
            # On labels the outermost cell would fill an empty room at a wall, and hold the others
            # off.
            frame="eulerian" if in_part else "label",
            progress=False,
        )
        if found.attrs["status"] == "interrupted":
            raise KeyboardInterrupt("interrupted before the simulation")
        if found.attrs["status"] == "diverged":
            raise ValueError(
                f"the energy diverges after t = {found.attrs['end_time']:g}: give a shorter "
                "duration"
            )
    results["rods"] = rod_by_rod(results["evolving"])
    # Rods that exchange their names move independently on such springs.
    free = chain.restitution == 1 and chain.gap == 0 and chain.spring == "linear"
    if has_one_mass(chain):
        results["exact"] = rod_by_rod(gas_of_points(chain, fluid, duration, every))
    elif free and not chain.unknown():
        results["exact"] = _exact(chain, release, by, duration, every)
    results[SIMULATION] = simulate(
        chain,
        start=_states(chain, release, by, fluid, replicas, seed),
        observe=("widths", "density", "energy"),
        duration=duration,
        every=every,
        average="ensemble",
        replicas=replicas,
        seed=seed,
        threads=threads,
        progress=progress and f"{replicas} chains",
    )
    tree = xr.DataTree.from_dict(results)
    tree.attrs |= {
        "status": results[SIMULATION].attrs["status"],
        "source": "comparison",
        "release": release,
        "by": by,
    }
    return tree


def condensed(tree: xr.DataTree) -> xr.DataTree:
    """Return what the pictures of a relaxation show, a tenth of the tree, to be stored.

    Densities are smoothed and in single precision, and other fields over x left out.
    """
    stored = tree.copy()
    for name, group in tree.children.items():
        result = group.to_dataset()
        if "density" in result:
            density = smooth(result)
            density = density.drop_vars(["density_block", "outside", "rods"], errors="ignore")
            result = result.drop_dims("x").merge(density.astype(np.float32))
            result.attrs["smoothed"] = density.attrs["smoothed"]
            for each in density.data_vars:
                result[each].encoding = {"zlib": True, "shuffle": True}
            stored[name] = xr.DataTree(result)
    return stored


def label_distances(tree: xr.DataTree) -> dict[str, float]:
    """Largest rms distance in time of mean positions from those of the ensemble, in s or h."""
    rods = tree[SIMULATION].mean_displacement
    s = displacement_unit(chain_of(tree[SIMULATION].to_dataset()))[1]
    return {
        key: float(np.sqrt(((tree[key].mean_displacement - rods) ** 2).mean("particle")).max() / s)
        for key in LEGEND
        if key in tree
    }


def cloud(result: xr.Dataset) -> xr.Dataset:
    """Centre and width of the cloud in the reduced coordinate, of any of the results [R].

    Of a simulation with upper bounds of their standard errors, as if all rods erred to one side.
    """
    if "cloud_width" in result:
        return result[["centre", "cloud_width"]]
    place = result.mean_displacement + chain_of(result).reduced_anchors
    square = (place**2 + result.displacement_width**2).mean("particle")
    centre = place.mean("particle")
    width = np.sqrt(square - centre**2)
    found = xr.Dataset({"centre": centre, "cloud_width": width}, attrs=result.attrs)
    if "mean_displacement_error" in result:
        shift = result.mean_displacement_error
        spread = result.displacement_width_error * result.displacement_width
        error = (np.abs(place - centre) * shift + spread).mean("particle") / width
        found = found.assign(centre_error=shift.mean("particle"), cloud_width_error=error)
    return found


def _states(
    chain: Chain, release: Release, by: float, fluid: xr.Dataset, replicas: int, seed: int
) -> xr.Dataset:
    """Return states with the change of the release, one for each replica: those of the fluid."""
    before = _before(chain, release, by)
    # The random numbers differ from those of the noise.
    states = equilibrium_states(before, replicas, seed=seed + 1)
    y = before.reduced(states.position.values)
    if release in _OF_POINTS:
        places, labels = points_of(chain, fluid)
        drawn = chain.size * np.random.default_rng(seed + 2).random(y.shape)
        y = np.sort(np.interp(drawn, labels, places), axis=1)
    y = by * y if release == "compressed" else y
    y = y + by * chain.thermal_length if release == "displaced" else y
    return states.assign(position=(("replica", "particle"), chain.physical(y)))


def _before(chain: Chain, release: Release, by: float) -> Chain:
    """Return the chain whose equilibrium state is released."""
    chain = chain.replace(restitution=1.0)
    if release == "quenched":
        return chain.replace(amplitude=by * chain.amplitude)
    if release == "confined":
        return chain.replace(box=chain.box - 2 * (1 - by) * chain.walls[1])
    return chain


def _fluid(chain: Chain, release: Release, by: float) -> xr.Dataset:
    if release == "compressed":
        return compressed(chain, by)
    if release == "displaced":
        return displaced(chain, by * chain.thermal_length)
    if release in _OF_POINTS:
        return _OF_POINTS[release](chain, by)
    if release == "confined" and not (chain.box and by <= 1):
        raise ValueError(f"release: confined needs a box, and by <= 1, got by={by:g}")
    return force_balance(_before(chain, release, by))


def _exact(chain: Chain, release: Release, by: float, duration: float, every: float) -> xr.Dataset:
    if release == "displaced":
        return breathing_cloud(chain, duration, every=every, shift=by * chain.thermal_length)
    hot = (by * chain.free_velocity_width) ** 2 if release == "quenched" else None
    return breathing_cloud(chain, duration, every=every, stretch=by, start_velocity_variance=hot)
