"""Error bars mean what they say: 68 % of the exact values lie within one standard error.

200 independent runs of an elastic chain, whose averages are known exactly (``equilibrium``; the
collision rates by hand below). For every quantity the share of values within one of its own
standard errors is counted over runs and rods, bins or times. The error of that share itself is
at most 3.3 % (200 runs whose values are all the same one); values of one run are correlated.
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
    return np.array([*density, 0.0]) * chain.free_velocity_width / np.sqrt(np.pi)


def exact():
    """Return the exact averages by name, and where their errors are to be looked at."""
    state = equilibrium(CHAIN)
    values = {name: state[name].values for name in state.data_vars}
    values["mean_velocity"] = np.zeros(CHAIN.size)
    values["collision_rate"] = collision_rates(CHAIN)
    values["kinetic_energy"] = CHAIN.size * CHAIN.temperature / 2
    looked_at = {name: slice(None) for name in values}
    # Bins that a rod visits a few times in a run have no Gaussian errors.
    looked_at["density"] = values["density"] > 0.1 * values["density"].max()
    looked_at["collision_rate"] = slice(0, -1)
    return values, looked_at


def shares(runs):
    """Return the share of exact values within one standard error, for every quantity."""
    values, looked_at = exact()
    inside = {}
    for run in runs:
        for name in (each for each in values if f"{each}_error" in run):
            deviation = abs(run[name].values - values[name]) <= run[f"{name}_error"].values
            inside.setdefault(name, []).append(deviation[..., looked_at[name]].mean())
    return {name: float(np.mean(each)) for name, each in inside.items()}


def check(found, expected):
    print({name: f"{share:.3f}" for name, share in found.items()})
    assert found.keys() == expected
    for name, share in found.items():
        assert share == pytest.approx(SHARE, abs=TOLERANCE), name


WIDTHS = {"mean_displacement", "displacement_width", "mean_velocity", "velocity_width"}


def test_averages_over_time():
    runs = (
        simulate(
            CHAIN,
            duration=5000,
            observe=("widths", "density", "collisions"),
            seed=seed,
            progress=False,
        )
        for seed in range(RUNS)
    )
    check(shares(runs), WIDTHS | {"density", "collision_rate"})


def test_averages_over_replicas():
    """Of an ensemble at equal times, started from exact samples of the steady state."""
    runs = (
        simulate(
            CHAIN,
            duration=8,
            every=2,
            observe=("widths", "density", "energy"),
            start=equilibrium_states(CHAIN, 320, seed=seed),
            replicas=320,
            average="ensemble",
            seed=RUNS + seed,
            progress=False,
        )
        for seed in range(RUNS)
    )
    check(shares(runs), WIDTHS | {"density", "kinetic_energy"})


def test_energy_in_time():
    """Averages over successive snapshots, with the errors of 32 replicas."""
    runs = (
        simulate(CHAIN, duration=1000, observe=("energy",), replicas=32, seed=seed, progress=False)
        for seed in range(RUNS)
    )
    check(shares(runs), {"kinetic_energy"})
