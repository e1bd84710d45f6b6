"""Error bars mean what they say: 68 % of the true values lie within one standard error.

Many independent runs of one chain, whose averages are known: exactly at e = 1 (``equilibrium``; the
collision rates by hand below). For every quantity the share of values within one of its own
standard errors is counted over runs and rods, bins or times. Halved errors fail the test, and so do
doubled ones.
"""

import threading
from contextlib import contextmanager

import numpy as np
import psutil
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
    """Return the share of values within one standard error."""
    found = {}
    for run in runs:
        for name in (each for each in values if f"{each}_error" in run):
            errors, truth = run[f"{name}_error"].values, values[name]
            # Bins that a rod visits a few times in a run have no Gaussian errors.
            seen = truth > 0.1 * np.max(truth) if "density" in name else np.isfinite(truth)
            known = np.broadcast_to(seen, errors.shape) & ~np.isnan(errors)
            within = np.abs(run[name].values - truth) <= errors
            found.setdefault(name, []).append(within[known].mean())
    return {name: np.mean(each) for name, each in found.items()}


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
    print(found)
    for name, share in found.items():
        assert share == pytest.approx(SHARE, abs=TOLERANCE), name


PARTICLE_STEPS = 1e10
REPLICAS = 2
MEGABYTE = 2**20
SIGNIFICANCE = 1e-6  # of a Gaussian, 5 standard errors


@contextmanager
def memory():
    """Look at this process's resident memory every tenth of a second."""
    seen, over = [], threading.Event()

    def look():
        while not over.wait(0.1):
            seen.append(psutil.Process().memory_info().rss)

    threading.Thread(target=look, daemon=True).start()
    yield seen
    over.set()


def test_ten_thousand_million_particle_steps():
    chain = Chain(size=100)
    time_step = 0.1
    duration = PARTICLE_STEPS / chain.size / REPLICAS * time_step
    how = {"duration": duration, "time_step": time_step, "every": duration / 5000}
    how |= {"observe": ("snapshots", "widths", "density"), "replicas": REPLICAS}
    with memory() as seen:
        run = simulate(chain, progress=False, **how)
    method = run.attrs["provenance"]
    print(method)
    # While the run went on: at the end the replicas' snapshots are joined, at first compiled code
    # is loaded.
    early, late = np.quantile(np.arange(len(seen)), [0.2, 0.9]).astype(int)
    growth = (seen[late] - seen[early]) / MEGABYTE
    print(f"memory grew by {growth:.2f} MiB over {late - early} looks")
    assert growth < 4  # one byte kept in every step would be 48

    y = run.position.values  # no gap: the rods' places are the points'
    assert (np.diff(y, axis=-1) >= 0).all()
    assert np.isfinite(run.velocity.values).all()
    kinetic = (chain.mass * run.velocity.values**2).sum(axis=-1) / chain.temperature
    displacement = y - chain.anchors
    potential = (chain.stiffness * displacement**2).sum(axis=-1) / chain.temperature
    for name, energy in {"kinetic": kinetic, "spring": potential}.items():
        halves = np.array_split(energy, 2, axis=1)
        for part, each in {"whole": energy, "first half": halves[0], "second": halves[1]}.items():
            test = stats.kstest(each.ravel(), stats.chi2(chain.size).cdf)
            print(f"{name}, {part}: D = {test.statistic:.4f}, p = {test.pvalue:.3f}")
            assert test.pvalue > SIGNIFICANCE
        assert stats.ks_2samp(*(half.ravel() for half in halves)).pvalue > SIGNIFICANCE
