"""The critical size: its closed form, its scaling, and where there is none."""

import numpy as np
import pytest

from crazybilliards.kinetic import critical_size
from crazybilliards.kinetic.kinetic_equation.weak_damping import (
    weak_damping_critical_size,
    weak_damping_growth_rate,
)
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.reproduction.fits import fit_growth

# gamma/sqrt(k m) = 0.1: weakly damped, where the answer is known.
WEAK = Chain(restitution=1.05, damping=0.1 * np.sqrt(4 * np.pi / 3))


def test_closed_form_for_weak_damping():
    """Each pair meets once in half a period and gains (e^2 - 1) of its relative energy, while.

    damping takes pi gamma/sqrt(k m) of all energy: to first order in e - 1 they balance at
    |lambda| L = (pi/2) gamma/sqrt(k m).
    """
    value, error = critical_size(WEAK)
    assert value == pytest.approx(np.pi * 0.1 / 0.05, rel=2e-3)
    assert 0 < error < 0.01 * value


def test_the_closed_form_is_one_number_everywhere():
    """The limit of the kinetic equation, the number of the page, and for e -> 1 that of growth."""
    weak = WEAK.replace(damping=1e-4)
    assert weak_damping_critical_size(weak) == pytest.approx(critical_size(weak).value, rel=1e-12)
    driven = Chain(size=100, restitution=1.01, damping=0.4)
    nearly_elastic = driven.replace(restitution=1 + 1e-6)
    below, above = (
        nearly_elastic.replace(size=round(share * weak_damping_critical_size(nearly_elastic)))
        for share in (1 - 2e-6, 1 + 2e-6)
    )
    assert weak_damping_growth_rate(below) < 0 < weak_damping_growth_rate(above)


# Chains at the borders of where the rate holds, in size, gain and 1.5 critical sizes.
GROWING = [
    Chain(size=30, restitution=1.03, damping=0.3),
    Chain(size=50, restitution=1.02, damping=0.43),
    Chain(size=100, restitution=1.01, damping=0.1),
    Chain(size=200, restitution=1.005, damping=0.4),
]


@pytest.mark.compiled
@pytest.mark.parametrize("chain", GROWING, ids=lambda chain: f"{chain.size}")
def test_energies_grow_at_the_rate_of_weak_damping_where_it_holds(chain):
    rate = weak_damping_growth_rate(chain)
    rates = []
    for seed in range(4):
        run = simulate(chain, duration=25 / rate, average="ensemble", observe="energy", seed=seed)
        hot = run.kinetic_energy.values > 10 * chain.size * chain.temperature / 2
        rates.append(fit_growth(run.time.values[hot], run.kinetic_energy.values[hot]).rate)
    assert np.mean(rates) == pytest.approx(rate, rel=0.05)


@pytest.mark.compiled
def test_the_closed_form_takes_over_from_the_equation():
    """Where both are solved they agree: below gamma/sqrt(k m) = 1e-3 the closed form is taken."""
    weak, weaker = (
        critical_size(WEAK.replace(damping=damping * np.sqrt(WEAK.mass)))
        for damping in (1.001e-3, 0.999e-3)
    )
    assert weak.value / 1.001 == pytest.approx(weaker.value / 0.999, rel=1e-5)
    assert weak.error == pytest.approx(weaker.error, rel=0.01)
