"""The critical size: its closed form, its scaling, and where there is none."""

import numpy as np
import pytest

from crazybilliards.kinetic import critical_size, steady_state
from crazybilliards.kinetic.gas.criticality import weak_damping_growth_rate
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.reproduction.fits import fit_growth


def damped(ratio, **others):
    """Return a chain with this gamma/sqrt(k m)."""
    chain = Chain(**others)
    return chain.replace(damping=ratio * chain.damping / chain.relative_damping)


@pytest.mark.parametrize(("ratio", "off"), [(1e-3, 1e-4), (0.1, 0.01), (3.0, 0.06)])
def test_the_critical_size_is_that_of_weak_damping(ratio, off):
    """Each pair meets once in half a period and gains e^2 - 1 of its relative energy.

    Damping takes pi gamma/sqrt(k m) of all energy meanwhile. To first order in e - 1 they balance
    at (e - 1) L = pi gamma/sqrt(k m). The gas agrees the better the weaker the damping.
    """
    value, error = critical_size(damped(ratio, restitution=1.05, size=3, gap=2.0))
    assert value == pytest.approx(np.pi * ratio / 0.05, rel=1e-12)
    assert 0 < error < off * value


@pytest.mark.parametrize(("share", "exists"), [(0.97, True), (1.015, False)])
def test_the_error_is_the_distance_from_where_the_steady_state_of_the_gas_ends(share, exists):
    chain = damped(1.5, restitution=1.003)
    value, error = critical_size(chain)
    longest = chain.replace(size=round(share * (value - error)))
    assert longest.size < value
    if exists:
        hot = steady_state(longest, correlations=False).velocity_width
        assert float(hot.min()) > 2 * chain.free_velocity_width
    else:
        with pytest.raises(ValueError, match=r"give more than damping takes|too heavy"):
            steady_state(longest, correlations=False)


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
@pytest.mark.parametrize("chain", GROWING, ids=lambda chain: f"{chain.size}")
def test_energies_grow_at_the_rate_of_weak_damping_where_it_holds(chain):
    rate = weak_damping_growth_rate(chain)
    rates = []
    for seed in range(4):
        run = simulate(chain, duration=25 / rate, average="ensemble", observe="energy", seed=seed)
        hot = run.kinetic_energy.values > 10 * chain.size * chain.temperature / 2
        rates.append(fit_growth(run.time.values[hot], run.kinetic_energy.values[hot]).rate)
    assert np.mean(rates) == pytest.approx(rate, rel=0.05)
