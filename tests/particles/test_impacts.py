"""The distribution of the speeds at which rods meet."""

import math

import numpy as np
import pytest

import crazybilliards as cb
from crazybilliards.model import Chain
from crazybilliards.particles import simulate


@pytest.mark.compiled
@pytest.mark.parametrize("size", [2, 10])
def test_elastic_rods_meet_with_the_speeds_of_gaussian_processes(size):
    """Rice: the speed w of a crossing has the density w exp(-w^2/4 W^2)/2 W^2."""
    chain = Chain(size=size)
    how = {"duration": 1000, "observe": cb.Impacts(bins=40), "progress": False}
    runs = [simulate(chain, seed=seed, **how) for seed in range(32)]
    [speed] = {tuple(run.impact_speed.values) for run in runs}
    edges = np.sinh(np.linspace(0, np.arcsinh(20_000), 41)) * 0.05 * chain.free_velocity_width
    np.testing.assert_allclose(speed, (edges[1:] + edges[:-1]) / 2)
    shares = np.array([run.impact_speed_density.values for run in runs]) * np.diff(edges)
    np.testing.assert_allclose(shares.sum(axis=2), 1)
    below = np.exp(-(edges**2) / (4 * chain.free_velocity_width**2))
    expected, common = below[:-1] - below[1:], slice(8, 19)
    assert expected[common].sum() > 0.95
    of_runs = shares.mean(axis=1)[:, common]  # of all contacts
    error = of_runs.std(axis=0, ddof=1) / math.sqrt(len(runs))
    assert (abs(of_runs.mean(axis=0) - expected[common]) < 5 * error).all()


@pytest.mark.compiled
def test_speeds_of_impacts_are_those_whose_temperature_is_given():
    """At any restitution, cold chains and started ones without W included."""
    driven = Chain(size=5, restitution=0.5, gap=0.3)
    free = driven.replace(amplitude=0, damping=0, restitution=0.99)
    start = cb.given_start(free, free.anchors + np.array([-3.0, -1.0, 0.0, 1.0, 3.0]))
    how = {"duration": 200, "observe": cb.Impacts(bins=5000), "progress": False}
    for chain, given in ((driven, None), (free, start)):
        run = simulate(chain, start=given, **how)
        width = np.diff(run.impact_speed, prepend=-run.impact_speed[0])
        w, density = run.impact_speed, run.impact_speed_density * width
        temperature = np.pi / 16 * ((density * w**2).sum("impact_speed") / density.dot(w)) ** 2
        np.testing.assert_allclose(temperature, run.contact_temperature, rtol=0.01)
