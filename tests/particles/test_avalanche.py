"""Avalanches against a slow twin that follows every wave by itself."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.laws.avalanche import make_tally, record_collision


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


@given(size=st.integers(2, 8), seed=st.integers(0, 2**32), number=st.integers(0, 300))
def test_waves_are_counted_like_the_slow_twin(size, seed, number):
    """Clusters that meet pass the push on from rod to rod, to the far end of the one pushed."""
    generator = np.random.default_rng(seed)
    contacts = generator.integers(0, size - 1, number)
    firsts = generator.integers(0, contacts + 1)
    lasts = generator.integers(contacts + 1, size)
    momenta = generator.normal(0.3, 1, number)
    tally = make_tally(size, contacts=True, waves=True)
    pushes = []
    for contact, first, last, momentum in zip(contacts, firsts, lasts, momenta, strict=True):
        record_collision(contact, first, last, momentum, tally)
        row = range(contact, last) if momentum > 0 else range(contact, first - 1, -1)
        pushes += [(each, momentum) for each in row]
    expected, under_way = follow_every_wave(size, pushes)
    np.testing.assert_array_equal(tally.sizes, expected)
    np.testing.assert_array_equal(tally.contacts, np.bincount(contacts, minlength=size - 1))
    assert tally.sizes.sum() + len(under_way) == sum(momentum > 0 for _, momentum in pushes)


def test_a_push_through_a_row_at_rest_is_one_wave_of_every_origin():
    """Contacts closing one after another from the left: the wave from 0 runs to the end."""
    tally = make_tally(6, contacts=False, waves=True)
    for contact in range(5):
        record_collision(contact, contact, contact + 1, 1.0, tally)
    record_collision(4, 4, 5, -1.0, tally)  # the last front is thrown back: all waves end there
    expected = np.zeros((6, 6), dtype=int)
    for origin in range(5):
        expected[origin, 5 - origin - 1] = 1
    np.testing.assert_array_equal(tally.sizes, expected)


@pytest.mark.compiled
def test_large_avalanches_are_rare_in_the_dissipative_chain():
    chain = Chain(size=50, restitution=0)
    run = simulate(chain, duration=500, replicas=2, observe="avalanches", progress=False)
    counts = run.avalanche_count.sel(particle=slice(15, 25)).sum("particle").values
    assert run.avalanche_count.attrs["units"] == "1"
    assert counts[0] > 2 * counts[1] > 4 * counts[3] > 0
    # No wave runs further than there are rods to its right.
    sizes, particles = run.avalanche_size, run.particle
    assert (run.avalanche_count.where(particles + sizes > 50, 0) == 0).all()
