"""Error bars mean what they say: 68 % of the true values lie within one standard error.

Many independent runs of one chain, whose averages are known: exactly at e = 1 (``equilibrium``; the
collision rates by hand below). For every quantity the share of values within one of its own
standard errors is counted over runs and rods, bins or times. Halved errors fail the test, and so do
doubled ones.
"""

import numpy as np
import pytest
from scipy import integrate, special, stats

from crazybilliards.kinetic import equilibrium, equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

RUNS = 200
SHARE, TOLERANCE = 0.68, 0.07
CHAIN = Chain(size=10)
WIDTHS = {"mean_displacement", "displacement_width", "mean_velocity", "velocity_width"}


def shares(runs, values):
    """Return the share of values within one standard error, its error, and how many have one."""
    found = {}
    for run in runs:
        for name in (each for each in values if f"{each}_error" in run):
            errors, truth = run[f"{name}_error"].values, values[name]
            # Bins that a rod visits a few times in a run have no Gaussian errors.
            seen = truth > 0.1 * np.max(truth) if "density" in name else np.isfinite(truth)
            seen = np.broadcast_to(seen, errors.shape)
            known = seen & ~np.isnan(errors)
            within = np.abs(run[name].values - truth) <= errors
            found.setdefault(name, []).append((within[known].mean(), known.sum() / seen.sum()))
    means = {name: np.mean(each, axis=0) for name, each in found.items()}
    errors = {name: np.std(each, axis=0)[0] / len(each) ** 0.5 for name, each in found.items()}
    print({name: f"{mean[0]:.3f} +- {errors[name]:.3f}" for name, mean in means.items()})
    return {name: (mean[0], errors[name], mean[1]) for name, mean in means.items()}


# -- averages at e = 1 ------------------------------------------------------------------------


def collision_rates(chain):
    """Rate at each contact without gap: density of two neighbours at one place, times W/sqrt(pi).

    W/sqrt(pi) is the mean speed of approach of two Gaussian velocities, counted where they
    approach. The places are order statistics of L Gaussian draws.
    """
    places = stats.norm(scale=chain.thermal_length)

    def together(x, i):
        pairs = special.factorial(chain.size)
        pairs /= special.factorial(i) * special.factorial(chain.size - i - 2)
        rest = places.cdf(x) ** i * places.sf(x) ** (chain.size - i - 2)
        return pairs * places.pdf(x) ** 2 * rest

    reach = 8 * chain.thermal_length
    density = [integrate.quad(together, -reach, reach, args=(i,))[0] for i in range(chain.size - 1)]
    return np.array([*density, np.nan]) * chain.free_velocity_width / np.sqrt(np.pi)


# How a chain is simulated for a seed, and what has error bars.
AVERAGES = {
    "over time": (
        {"duration": 5000, "observe": ("widths", "density", "collisions")},
        WIDTHS | {"density", "collision_rate"},
    ),
    # At equal times, started from exact samples of the steady state.
    "over replicas": (
        {"duration": 8, "every": 2, "replicas": 320, "average": "ensemble"}
        | {"observe": ("widths", "density", "energy")},
        WIDTHS | {"density", "kinetic_energy"},
    ),
    # Over successive snapshots, with the errors of 32 replicas.
    "of energy in time": (
        {"duration": 1000, "observe": ("energy",), "replicas": 32},
        {"kinetic_energy"},
    ),
}


def simulated(settings):
    """Yield the runs, an ensemble with a start."""
    for seed in range(RUNS):
        own = {"seed": seed, "progress": False}
        if "average" in settings:
            own |= {"seed": RUNS + seed, "start": equilibrium_states(CHAIN, 320, seed=seed)}
        yield simulate(CHAIN, **settings, **own)


@pytest.mark.parametrize("name", AVERAGES)
def test_averages(name):
    """The error of a share is at most 3.3 % (200 runs whose values are all the same one)."""
    settings, expected = AVERAGES[name]
    exact = equilibrium(CHAIN)
    values = {name: exact[name].values for name in exact.data_vars}
    values["mean_velocity"] = np.zeros(CHAIN.size)
    values["collision_rate"] = collision_rates(CHAIN)
    values["kinetic_energy"] = np.array(CHAIN.size * CHAIN.temperature / 2)
    found = shares(simulated(settings), values)
    assert found.keys() == expected
    for name, (share, *_) in found.items():
        assert share == pytest.approx(SHARE, abs=TOLERANCE), name
