"""A described run that observers are prepared for, which there are, and snapshots for them."""

import inspect

import numpy as np

from crazybilliards.particles import simulate
from crazybilliards.particles.observers import OBSERVERS
from crazybilliards.particles.observers.base import Snapshots
from crazybilliards.particles.simulation import make_run


def a_run(chain, **changes):
    """Return a run with the defaults of simulate and some changes."""
    arguments = {
        name: parameter.default
        for name, parameter in inspect.signature(simulate).parameters.items()
        if name not in ("chain", "threads", "checkpoint", "checkpoint_interval", "progress")
    }
    return make_run(chain, **arguments | changes)


def observers_of(chain):
    """Return the names of all observers that measure the chain."""
    return [
        name
        for name, each in OBSERVERS.items()
        if each.least_rods <= chain.size
        and (chain.box or not each.meets_walls)
        and (not each.reads_chain or chain.unknown().keys() <= each.knows)
    ]


def some_snapshots(run, generator, first):
    """Return three snapshots of ordered rods, and the collisions since the last ones."""
    y = np.sort(generator.normal(scale=run.chain.thermal_length, size=(3, run.chain.size)))
    v = generator.normal(scale=2000 * run.chain.free_velocity_width, size=y.shape)
    y[0, -1] = 1e9  # beyond any grid
    collisions = generator.integers(1, 9, size=run.chain.size - 1)
    return Snapshots(0, first, 0, y, v, collisions)
