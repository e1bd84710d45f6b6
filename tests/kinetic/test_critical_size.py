"""The critical size: its closed form, its error, and the rate of growth above it."""

import csv
from pathlib import Path

import numpy as np
import pytest

from crazybilliards.kinetic import critical_size
from crazybilliards.kinetic.accuracy import UnmeasuredWarning
from crazybilliards.kinetic.gas.criticality import weak_damping_growth_rate
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.reproduction.fits import fit_growth

TABLE = Path(__file__).parents[2] / "docs" / "tables" / "critical_size.csv"


def test_it_is_that_of_weak_damping_and_simulations_are_within_its_error():
    """Each pair meets once in half a period and gains e^2 - 1 of its relative energy.

    Damping takes pi gamma/sqrt(k m) of all energy meanwhile. To first order in e - 1 they balance.
    """
    for row in csv.DictReader(TABLE.read_text("utf-8").splitlines()):
        chain = Chain(restitution=float(row["e"]), damping=float(row["gamma"]), size=3, gap=2.0)
        value, error = critical_size(chain)
        weak = np.pi * chain.relative_damping / (chain.restitution - 1)
        assert value == pytest.approx(weak, rel=1e-12)
        assert value == pytest.approx(float(row["theory"]), abs=0.05)
        simulated, own = map(float, row["simulation"].split(" ± "))
        assert abs(value - simulated) + 2 * own < error < 0.11 * value


@pytest.mark.parametrize("beyond", [{"damping": 4.1}, {"restitution": 1.11}])
def test_its_error_is_not_known_beyond_the_simulations(beyond):
    chain = Chain(restitution=1.1, damping=4.0).replace(**beyond)
    with pytest.warns(UnmeasuredWarning, match="error of the critical size was not measured"):
        assert np.isnan(critical_size(chain).error)


def test_growth_begins_at_the_critical_size_for_restitutions_near_1():
    chain = Chain(restitution=1 + 1e-6, damping=0.4)
    size = critical_size(chain).value
    below, above = (chain.replace(size=round(share * size)) for share in (1 - 2e-6, 1 + 2e-6))
    assert weak_damping_growth_rate(below) < 0 < weak_damping_growth_rate(above)


# Chains at the borders of where the rate holds, in size, gain and 1.5 critical sizes.
GROWING = [
    Chain(size=30, restitution=1.03, damping=0.3),
    Chain(size=50, restitution=1.02, damping=0.43),
    Chain(size=100, restitution=1.01, damping=0.1),
    Chain(size=200, restitution=1.005, damping=0.4),
]


@pytest.mark.compiled
@pytest.mark.filterwarnings("ignore:the chain diverged")
@pytest.mark.parametrize("chain", GROWING, ids=lambda chain: f"{chain.size}")
def test_energies_grow_at_the_rate_of_weak_damping_where_it_holds(chain):
    rate = weak_damping_growth_rate(chain)
    rates = []
    for seed in range(4):
        run = simulate(chain, duration=25 / rate, average="ensemble", observe="energy", seed=seed)
        hot = run.kinetic_energy.values > 10 * chain.size * chain.temperature / 2
        rates.append(fit_growth(run.time.values[hot], run.kinetic_energy.values[hot]).rate)
    assert np.mean(rates) == pytest.approx(rate, rel=0.05)
