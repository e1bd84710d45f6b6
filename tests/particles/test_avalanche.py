"""Avalanches against a slow twin that follows every wave by itself."""

import numpy as np
import pytest
from drifts import everything
from hypothesis import given
from hypothesis import strategies as st

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


def test_the_papers_first_hit_needs_no_momentum_to_the_right():
    tally = everything(4)
    record_collision(0, 0, 1, 0.5, -1.0, tally)  # 0 hits 1, the momentum points left
    record_collision(1, 1, 2, 1.0, 0.0, tally)  # 1 hits 2: one triggered collision
    record_collision(2, 2, 3, 0.0, -1.0, tally)  # interrupted
    assert tally.triggered.sizes[0].tolist() == [0, 1, 0, 0]
    assert tally.pushes.sizes[0].sum() == 0
    assert tally.pushes.sizes[1].tolist() == [1, 0, 0, 0]


@pytest.mark.compiled
def test_both_counts_are_taken_in_one_run():
    """Elastic rods never stick: the counts differ by the first hits only."""
    options = {"duration": 300, "seed": 4, "progress": False}
    both = simulate(Chain(size=8), observe=["avalanches", "triggered-collisions"], **options)
    alone = simulate(Chain(size=8), observe="triggered-collisions", **options)
    np.testing.assert_array_equal(both.triggered_count, alone.triggered_count)
    hits, waves = both.triggered_count, both.avalanche_count
    assert both.triggered_collisions.values.tolist() == list(range(8))
    assert both.avalanche_size.values.tolist() == list(range(1, 9))
    # Half of the first hits point left. Of the others all that follows is the same.
    assert int(waves.sum()) < int(hits.sum()) < 3 * int(waves.sum())
    assert (hits.values >= waves.values).all()
