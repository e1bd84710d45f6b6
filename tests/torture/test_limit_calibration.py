"""The error bars of a limit dt -> 0 mean what they say: 68 % of the values lie within one.

100 independent limits of 30 rods at e = 0 against one long run at a quarter of the default step,
which is off by less than 0.05 % and whose errors are a seventh of theirs. For every quantity the
share of values within one of its own errors is counted over runs and rods, nodes or bins. The error
of that share is taken from its scatter between runs; for a single number it is 4.7 %.

An error includes the bias that is expected. Where that is half of the squared error and the bias
itself is zero, 84 % of the values lie within one error. Halved errors fail the test, and so do
doubled ones.
"""

import json

import numpy as np
import pytest

from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain
from crazybilliards.particles import simulate, simulate_limit
from crazybilliards.particles.scales import default_time_step

RUNS = 100
SHARE, SHARE_WITHOUT_BIAS = 0.68, 0.84
LEAST_KNOWN = 0.8  # of the bins in the mean: few visits to a bin, and no error is stated
CHAIN = Chain(size=30, restitution=0)
OBSERVE = ("widths", "density", "velocities", "energy")


def reference():
    """Return the values of a long run by name, and where their errors are to be looked at."""
    run = simulate(
        CHAIN,
        duration=100_000,
        time_step=default_time_step(CHAIN) / 4,
        every=10 * default_time_step(CHAIN),
        replicas=2,
        observe=OBSERVE,
        seed=1,
        progress=False,
    )
    rank = np.abs(CHAIN.rank)
    widths = run.velocity_width.values
    values = {name: run[name].values for name in run.data_vars if f"{name}_error" in run}
    del values["mean_velocity"]  # is zero
    values["velocity_density"] = run.velocity_density.values
    values["central_velocity_width"] = np.sqrt((widths[rank <= 1.5] ** 2).mean())
    values["kinetic_energy"] = run.kinetic_energy.values.mean()
    # Mirrored, a chain has the same law: half the error for nothing.
    for name in ("velocity_width", "displacement_width"):
        values[name] = (values[name] + values[name][::-1]) / 2
    values["mean_displacement"] = (
        values["mean_displacement"] - values["mean_displacement"][::-1]
    ) / 2
    looked_at = {name: np.full(np.shape(value), True) for name, value in values.items()}
    # Bins that a rod visits a few times in a run have no Gaussian errors.
    for name in ("density", "velocity_density"):
        looked_at[name] = values[name] > 0.1 * values[name].max()
    return values, looked_at


def test_a_limit_lies_within_its_error_as_often_as_it_should():
    values, looked_at = reference()
    inside, stated, coupled = {}, {}, 0
    for seed in range(RUNS):
        limit = simulate_limit(
            CHAIN, accuracy=0.01, observe=OBSERVE, seed=600 + seed, progress=False
        )
        coupled += len(json.loads(limit.attrs["provenance"])["levels"]) > 1
        for name, value in values.items():
            errors = limit[f"{name}_error"].values
            known = looked_at[name] & ~np.isnan(errors)
            within = np.abs(limit[name].values - value) <= errors
            inside.setdefault(name, []).append(within[known].mean())
            stated.setdefault(name, []).append(known.sum() / looked_at[name].sum())
    found = {
        name: (float(np.mean(each)), float(np.std(each) / np.sqrt(RUNS)))
        for name, each in inside.items()
    }
    print(coupled, {name: f"{share:.3f} +- {error:.3f}" for name, (share, error) in found.items()})
    for name, (share, error) in found.items():
        assert np.mean(stated[name]) > LEAST_KNOWN, name
        assert SHARE - 5 * error < share < SHARE_WITHOUT_BIAS + 5 * error, name


@pytest.mark.parametrize("accuracy", [0.1, 0.03])
@pytest.mark.parametrize("damping", [1.0, 4.0, 10.0])
def test_short_limits_have_honest_errors(damping, accuracy):
    """At e = 1 the truth is known. With groups of two relaxation times the last number was 1.5.

    Deviations in units of their errors have the root mean square 1, and 200 values determine it to
    5 %. The errors of velocities include an expected bias, which is zero here.
    """
    chain = Chain(size=3, damping=damping)
    exact = equilibrium(chain)
    deviations = {"displacement_width": [], "mean_displacement": [], "velocity_width": []}
    for seed in range(200):
        limit = simulate_limit(
            chain, accuracy=accuracy, observe="widths", seed=seed, progress=False
        )
        for name, found in deviations.items():
            found.append((limit[name] - exact[name]).values / limit[f"{name}_error"].values)
    for name, found in deviations.items():
        assert np.sqrt(np.mean(np.square(found))) < 1.25, name
