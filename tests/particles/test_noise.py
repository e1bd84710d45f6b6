"""White noise: its bits against a readable twin, its functions against numpy."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.particles import noise as module
from crazybilliards.particles.noise import BLOCK, LANES, fill, make_noise

WORD = 2**64 - 1
QUARTER_BITS = 50


def stream(seed):
    return make_noise(np.random.SeedSequence(seed))


def numbers(noise, count):
    values = np.empty(count)
    fill(noise, values)
    return values


def xoshiro(state):
    """Yield the numbers of xoshiro256++, as Blackman and Vigna write it; changes the state."""

    def rotated(word, by):
        return (word << by | word >> (64 - by)) & WORD

    while True:
        yield (rotated((state[0] + state[3]) & WORD, 23) + state[0]) & WORD
        shifted = state[1] << 17 & WORD
        state[2] ^= state[0]
        state[3] ^= state[1]
        state[1] ^= state[2]
        state[0] ^= state[3]
        state[2] ^= shifted
        state[3] = rotated(state[3], 45)


def box_muller(bits):
    """Return normal numbers: the first half of the bits gives radii, the second angles."""
    first, second = np.split(bits, 2)
    radius = np.sqrt(-2 * np.log(((first >> np.uint64(12)) + 0.5) * 2.0**-52))
    fraction = (second >> np.uint64(12)) & np.uint64(2**QUARTER_BITS - 1)
    angle = ((fraction + 0.5) * 2.0**-QUARTER_BITS - 0.5) * np.pi / 2
    backward, turned = (second >> np.uint64(bit) & np.uint64(1) for bit in (62, 63))
    direction = np.where(turned, 0, np.pi / 2) + np.where(backward, 0, np.pi) - angle
    return np.concatenate([radius * np.cos(direction), radius * np.sin(direction)])


def test_every_lane_is_a_generator_of_its_own():
    lanes, bits = stream(3).lanes, np.zeros((3, BLOCK), dtype=np.uint64)
    states = lanes.T.tolist()
    for row in bits:
        module._draw_bits(lanes, row)
    for state, drawn in zip(states, bits.reshape(-1, LANES).T, strict=True):
        assert list(itertools.islice(xoshiro(state), drawn.size)) == drawn.tolist()
    # The published numbers of the state 1, 2, 3, 4.
    published = [41943041, 58720359, 3588806011781223, 3591011842654386, 9228616714210784205]
    assert list(itertools.islice(xoshiro([1, 2, 3, 4]), 5)) == published


def test_no_two_words_of_any_streams_are_alike():
    """As a seed of zeros, or one for all lanes or replicas, would make them."""
    root = np.random.SeedSequence(10)
    seeds = [root, *root.spawn(3), *map(np.random.SeedSequence, (0, 11))]
    words = np.stack([make_noise(seed).lanes for seed in seeds])
    assert np.unique(words).size == words.size == len(seeds) * 4 * LANES


def test_numbers_are_those_of_box_and_muller():
    noise, bits = stream(4), np.zeros(BLOCK, dtype=np.uint64)
    lanes = noise.lanes.copy()
    for _ in range(4):
        module._draw_bits(lanes, bits)
        np.testing.assert_allclose(numbers(noise, BLOCK), box_muller(bits), rtol=0, atol=8e-15)


def test_radii_are_right_from_the_smallest_to_the_largest():
    """The uniform number is neither 0, of which the logarithm is infinite, nor 1."""
    b = [2**k + n for k in range(1, 52) for n in (-1, 0, 1)]
    b = np.array([0, *b, *(2**52 - 2**k for k in range(52)), 2**52 - 1], dtype=np.uint64)
    bits, radii = (b << np.uint64(12)) + np.uint64(77), np.empty(b.size)  # lower bits are not used
    reals = bits.view(np.int64)
    module._radii(reals, reals.view(np.float64), radii)
    u = b + 0.5
    expected = np.sqrt(-2 * np.where(u < 2**51, np.log(u * 2.0**-52), np.log1p(u * 2.0**-52 - 1)))
    np.testing.assert_allclose(radii, expected, rtol=1e-15)
    assert radii.max() == pytest.approx(8.571674348652905)
    assert radii.min() == pytest.approx(2.0**-26)


@given(pieces=st.lists(st.integers(0, 2 * BLOCK) | st.integers(0, 20), max_size=8))
def test_numbers_do_not_depend_on_how_many_are_taken_at_a_time(pieces):
    taken = stream(6)
    found = np.concatenate([[], *(numbers(taken, piece) for piece in pieces)])
    np.testing.assert_array_equal(found, numbers(stream(6), sum(pieces)))
