"""Energy and centre of mass, which are known for every law, spring, gap and restitution.

A time step that does not fit a collision heats or cools a chain a little in every collision. That
shows in no single step, and in long runs it decides what comes out.
"""

import math
from itertools import product

import numpy as np
import pytest
from drifts import moved

from crazybilliards.kinetic import equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.impacts import make_impacts
from crazybilliards.particles.scales import default_time_step

SPRINGS = ["linear", "quadratic"]
GAPS = [0.0, 0.3, 2.0]
RESTITUTIONS = [0.0, 0.5, 0.9999, 1.0]
METHODS = ["event-driven", "contact-dynamics"]
COPIES = 8


def energy(chain, y, v):
    """Kinetic energy and that of the springs."""
    return (chain.mass / 2 * v**2 + chain.potential(y - chain.reduced_anchors)).sum()


def released(chain, heat, *, duration, seed, method="event-driven", counted=False):
    """Start and end of a chain that begins in the equilibrium of ``heat``, and the energy lost."""
    start = equilibrium_states(heat, 1, seed)
    before = chain.reduced(start.position.values[0]), start.velocity.values[0]
    step = default_time_step(heat)
    impacts = make_impacts(chain.size if counted else 0)
    tally = make_tally(chain.size, contacts=counted)._replace(impacts=impacts)
    how = {"method": method, "counted": counted, "tally": tally}
    after = moved(chain, before, step, round(duration / step), **how)
    lost = chain.mass * (impacts[1] - impacts[3]).sum()
    return before, after, lost, round(duration / step) * step


@pytest.mark.compiled
@pytest.mark.parametrize("e", RESTITUTIONS)
@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("spring", SPRINGS)
def test_only_collisions_take_energy_and_nothing_adds_any(spring, gap, e):
    """Without noise and damping the energy at the end and what collisions took are that at start.

    Where rods merge (e = 0) the springs of a cluster differ from what they would be apart, so that
    the balance is right to the order of the time step.
    """
    heat = Chain(size=20, gap=gap, amplitude=3.0, spring=spring)
    chain = heat.replace(restitution=e, amplitude=0.0, damping=0.0)
    kept, left = [], []
    for seed in range(COPIES):
        start, end, lost, _ = released(chain, heat, duration=1000, seed=seed, counted=True)
        at_start = energy(chain, *start)
        kept.append((energy(chain, *end) + lost) / at_start)
        _, (y, v), *_ = released(chain, heat, duration=1000, seed=seed)
        left.append(energy(chain, y, v) / at_start)
    assert np.mean(kept) == pytest.approx(1, abs=6e-3 if e == 0 else 2e-3)
    assert max(left) < 1.003
    if e == 1:
        assert np.mean(left) == pytest.approx(1, abs=1e-3)


@pytest.mark.compiled
@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("spring", SPRINGS)
def test_two_elastic_rods_of_contact_dynamics_keep_their_energy(spring, gap):
    """More of them lose some, because several contacts at a time share an impulse."""
    for size in (2, 6):
        heat = Chain(size=size, gap=gap, amplitude=3.0, spring=spring)
        chain = heat.replace(amplitude=0.0, damping=0.0)
        kept = []
        for seed in range(COPIES):
            start, end, *_ = released(chain, heat, duration=2000, seed=seed, method=METHODS[1])
            kept.append(energy(chain, *end) / energy(chain, *start))
        assert np.mean(kept) < 1.002
        if size == 2:
            assert np.mean(kept) == pytest.approx(1, abs=2e-3)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("e", RESTITUTIONS)
@pytest.mark.parametrize("gap", GAPS)
def test_the_centre_of_mass_swings_as_one_rod(gap, e, method):
    """Linear springs: collisions do not change it, whatever the law; here with a weak damping."""
    heat = Chain(size=12, gap=gap, amplitude=3.0)
    chain = heat.replace(restitution=e, amplitude=0.0, damping=0.02)
    (y, v), (y_end, _), _, time = released(chain, heat, duration=20, seed=3, method=method)
    rate = chain.damping / (2 * chain.mass)
    omega = math.sqrt(chain.stiffness / chain.mass - rate**2)
    turn, decay = omega * time, math.exp(-rate * time)
    x, u = y.mean(), v.mean()
    swing = (u + rate * x) / omega
    there = decay * (x * math.cos(turn) + swing * math.sin(turn))
    assert y_end.mean() == pytest.approx(there, abs=2e-3 * math.hypot(x, swing))


def balance(chain, *, observe, seeds=8, **times):
    """Power that damping and collisions take over that of the noise, and its standard error.

    The noise gives L A^2/2m. Damping takes gamma sum <v^2>, collisions the loss at the contacts.
    """
    shares = []
    for seed in range(seeds):
        run = simulate(chain, seed=seed, observe=observe, progress=False, **times)
        taken = chain.damping * (run.velocity_width**2).sum()
        if "contact_loss" in run:
            taken = taken + run.contact_loss.sum()
        shares.append(2 * chain.mass * float(taken) / (chain.size * chain.amplitude**2))
    return np.mean(shares), np.std(shares, ddof=1) / math.sqrt(seeds)


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize(
    ("e", "spring", "damping", "gap"),
    [
        *product([1.0], ["linear"], [0.001], [0.0, 1.0, 2.0]),
        *product([1.0], ["quadratic"], [0.01], [0.0, 1.0, 2.0]),
        *product([0.5, 0.9999], ["linear"], [0.001], [1.0, 2.0]),
    ],
)
def test_noise_damping_and_collisions_balance(e, spring, damping, gap):
    chain = Chain(size=20, restitution=e, spring=spring, gap=gap, damping=damping)
    chain = chain.replace(amplitude=math.sqrt(8 * damping))  # alike hot at any damping
    if e == 1:
        start = equilibrium_states(chain, 1, seed=1)
        how = {"observe": "widths", "start": start, "duration": 20 * chain.mass / damping}
    else:
        long = 3.0 if e > 0.9 else 1.0
        how = {"observe": ("widths", "impacts"), "warmup": long * 6000, "duration": long * 20_000}
    share, error = balance(chain, **how)
    assert error < 0.06
    assert abs(share - 1) < 5 * error
