"""Avalanches against a slow twin that follows every wave, and the speeds at which rods meet."""

import math

import numpy as np
import pytest
from drifts import everything
from hypothesis import given
from hypothesis import strategies as st

import crazybilliards as cb
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.laws.avalanche import record_collision


def follow_every_wave(size, collisions):
    """Waves as (origin, front) pairs, looked through at every collision."""
    waves, sizes = [], np.zeros((size, size), dtype=int)
    for contact, momentum in collisions:
        going_on = []
        for origin, front in waves:
            if front == contact and momentum > 0:
                going_on.append((origin, contact + 1))
            elif front in (contact, contact + 1):
                sizes[origin, front - origin - 1] += 1
            else:
                going_on.append((origin, front))
        waves = going_on + ([(contact, contact + 1)] if momentum > 0 else [])
    return sizes, waves


class TrackedHit:
    """A hit of i on i + 1 as the paper's section seq:e_0 tracks it, told step by step."""

    def __init__(self, i):
        self.i, self.carrier, self.triggered, self.over = i, i + 1, 0, False

    def next_collision(self, left, right, v_left, v_right):
        if self.over or self.carrier not in (left, right):
            return
        hits_its_right_neighbour = self.carrier == left
        if hits_its_right_neighbour and v_left + v_right > 0:
            self.triggered += 1
            self.carrier = right
        else:  # it returns, or the momentum transfer is interrupted
            self.over = True


@given(size=st.integers(2, 8), seed=st.integers(0, 2**32), number=st.integers(0, 300))
def test_waves_are_counted_like_the_slow_twins(size, seed, number):
    """Clusters that meet pass the push on from rod to rod, to the far end of the one pushed.

    In the paper's count they do not, and every hit starts a wave.
    """
    generator = np.random.default_rng(seed)
    contacts = generator.integers(0, size - 1, number)
    firsts = generator.integers(0, contacts + 1)
    lasts = generator.integers(contacts + 1, size)
    velocities = generator.normal(0.3, 1, (number, 2))
    tally = everything(size)
    pushes, hits = [], []
    for contact, first, last, (left, right) in zip(
        contacts, firsts, lasts, velocities, strict=True
    ):
        record_collision(contact, first, last, left, right, tally)
        momentum = (contact - first + 1) * left + (last - contact) * right
        row = range(contact, last) if momentum > 0 else range(contact, first - 1, -1)
        pushes += [(each, momentum) for each in row]
        for hit in hits:
            hit.next_collision(contact, contact + 1, left, right)
        hits.append(TrackedHit(contact))
    expected, under_way = follow_every_wave(size, pushes)
    np.testing.assert_array_equal(tally.pushes.sizes, expected)
    np.testing.assert_array_equal(tally.contacts, np.bincount(contacts, minlength=size - 1))
    counted = tally.pushes.sizes.sum() + len(under_way)
    assert counted == sum(momentum > 0 for _, momentum in pushes)
    triggered = np.zeros((size, size), dtype=int)
    for hit in hits:
        triggered[hit.i, hit.triggered] += hit.over
    np.testing.assert_array_equal(tally.triggered.sizes, triggered)


@pytest.mark.compiled
def test_both_counts_are_taken_in_one_run():
    """Elastic rods never stick: the counts differ by the first hits only."""
    options = {"duration": 300, "seed": 4, "progress": False}
    both = simulate(Chain(size=8), observe=["avalanches", "triggered-collisions"], **options)
    hits, waves = both.triggered_count, both.avalanche_count
    assert both.triggered_collisions.values.tolist() == list(range(8))
    assert both.avalanche_size.values.tolist() == list(range(1, 9))
    # Half of the first hits point left. Of the others all that follows is the same.
    assert int(waves.sum()) < int(hits.sum()) < 3 * int(waves.sum())
    assert (hits.values >= waves.values).all()


# -- the speeds at which rods meet ------------------------------------------------------------


@pytest.mark.compiled
def test_elastic_rods_meet_with_the_speeds_of_gaussian_processes():
    """Rice: the speed w of a crossing has the density w exp(-w^2/4 W^2)/2 W^2.

    Each of the L(L-1)/2 pairs of relabelled points meets w0/pi times a time unit.
    """
    chain = Chain(size=10)
    observe = [cb.observers.Impacts(bins=40), "collisions"]
    how = {"duration": 300, "observe": observe, "progress": False}
    runs = [simulate(chain, seed=seed, **how) for seed in range(20)]
    rates = np.array([float(run.collision_rate.sum()) for run in runs])
    expected = 45 * math.sqrt(chain.stiffness / chain.mass) / math.pi
    error = rates.std(ddof=1) / math.sqrt(len(runs))
    assert abs(rates.mean() - expected) < 5 * error < 0.04 * expected
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
    how = {"duration": 200, "observe": cb.observers.Impacts(bins=5000), "progress": False}
    for chain, begun in ((driven, None), (free, start)):
        run = simulate(chain, start=begun, **how)
        width = np.diff(run.impact_speed, prepend=-run.impact_speed[0])
        w, density = run.impact_speed, run.impact_speed_density * width
        temperature = np.pi / 16 * ((density * w**2).sum("impact_speed") / density.dot(w)) ** 2
        np.testing.assert_allclose(temperature, run.contact_temperature, rtol=0.01)
