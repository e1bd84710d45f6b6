"""The result of the kinetic equation in time, in the common vocabulary."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import RectBivariateSpline

from crazybilliards.kinetic.kinetic_equation.order_statistics import points
from crazybilliards.kinetic.kinetic_equation.stationary_result import density_and_label, positions
from crazybilliards.kinetic.kinetic_equation.velocity_moments import moments
from crazybilliards.kinetic.kinetic_equation.velocity_space import VelocitySpace
from crazybilliards.kinetic.kinetic_equation.weak_form import Units
from crazybilliards.kinetic.rods.places import LabelledPoints, RodPlaces, are_resolved, rods_of
from crazybilliards.kinetic.rods.profiles import ascending, over_positions
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import OF_FLUID, OF_RODS, result


def snapshot(
    chain: Chain, units: Units, space: VelocitySpace, f: Array, energy: float
) -> dict[str, Any]:
    """Return the variables of a distribution at one time, by name, on its own mesh.

    ``energy``: the mean of v^2, 1 for free rods.
    """
    length, velocity = units
    profiles = moments(space, f)
    of = points(chain.size, profiles)
    share = profiles.density * profiles.weights
    total = share.sum()
    centre = share @ profiles.y
    spread = share @ profiles.y**2 - centre**2
    drift = profiles.weights @ profiles.flux
    covariance = (profiles.weights * profiles.y) @ profiles.flux - centre * drift
    y, v, values = space.sampled(f)
    # Ripples in the vacuum are left out, so that the positions ascend.
    alive = np.maximum(profiles.density, 0.0)
    number = chain.size / (alive @ profiles.weights)
    return {
        "y": length * y,
        "v": velocity * v,
        "points": number / length * alive,
        "below": number * np.maximum(ascending(space.cumulative(alive)), 0.0),
        # Counted from its own end, as the difference to all of them would be rounding errors there.
        "beyond": number * np.maximum(ascending(space.cumulative(alive[::-1])), 0.0)[::-1],
        "phase_space_density": chain.size / (length * velocity) * values,
        "mean_displacement": length * of.position - chain.reduced_anchors,
        "mean_velocity": velocity * of.velocity,
        "velocity_width": velocity * np.sqrt(of.velocity_variance + of.velocity**2),
        "rods": chain.size * total,
        "centre": length * centre,
        "cloud_width": length * math.sqrt(spread),
        "kinetic_energy": chain.size * chain.temperature / 2 * energy,
        "covariance": length * velocity * covariance,
    }


def in_vocabulary(
    chain: Chain,
    units: Units,
    outputs: list[dict[str, Any]],
    times: Array,
    last: VelocitySpace,
    status: str,
) -> xr.Dataset:
    """Put the outputs into the common vocabulary, on the axes of the last, largest mesh."""
    x, density, label = _over_positions(chain, outputs, positions(chain, units.length, last))
    y, v = outputs[-1]["y"], outputs[-1]["v"]
    phase_space = np.zeros((len(outputs), y.size, v.size))
    for place, output in zip(phase_space, outputs, strict=True):
        if output["y"].shape == y.shape and (output["y"] == y).all() and (output["v"] == v).all():
            place[...] = output["phase_space_density"]
            continue
        spline = RectBivariateSpline(output["y"], output["v"], output["phase_space_density"])
        inside = (np.abs(y) <= output["y"][-1])[:, None] & (np.abs(v) <= output["v"][-1])
        place[...] = np.where(inside, spline(y, v), 0.0)
    over_time = ("rods", "centre", "cloud_width", "kinetic_energy", "covariance")
    over_rods = ("mean_displacement", "mean_velocity", "velocity_width")
    stacked = {
        name: np.array([output[name] for output in outputs]) for name in over_time + over_rods
    }
    return result(
        chain,
        {
            "phase_space_density": (("time", "y", "velocity"), phase_space),
            "density": (("time", "x"), density),
            "label": (("time", "x"), label),
            **{name: (("time", "particle"), stacked[name]) for name in over_rods},
            **{name: ("time", stacked[name]) for name in over_time},
        },
        coordinates={"time": times, "x": x, "y": y, "velocity": v},
        source="theory",
        method={"theory": "kinetic equation in time", "cells": last.cells},
        status=status,
        end_time=times[-1],
    ).assign_attrs(density_of=OF_RODS if are_resolved(chain) else OF_FLUID)


def _over_positions(
    chain: Chain, outputs: list[dict[str, Any]], x: Array
) -> tuple[Array, Array, Array]:
    """Return positions that hold all rods at all times, at least ``x``, density and label there."""
    if not are_resolved(chain):
        fluid = [
            density_and_label(chain, x, *(output[name] for name in ("y", "points", "below")))
            for output in outputs
        ]
        return x, *np.swapaxes(fluid, 0, 1)
    # Their tables, which need much memory, are made twice and not kept.
    farthest = max(float(np.abs(_rods(chain, output).places).max()) for output in outputs)
    x = max(x, position_grid(chain, farthest - chain.reduced_anchors[-1]), key=len)
    rods = [over_positions(chain, x, _rods(chain, output)) for output in outputs]
    return x, *np.swapaxes(rods, 0, 1)


def _rods(chain: Chain, output: dict[str, Any]) -> RodPlaces:
    points = (output[name] for name in ("y", "points", "below", "beyond"))
    variance = output["velocity_width"] ** 2 - output["mean_velocity"] ** 2
    labelled = LabelledPoints(chain.size, *points)
    return rods_of(chain, labelled, chain.mass * float(variance.mean()))
