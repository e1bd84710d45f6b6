"""Two chains under the same noise: each has the law of a chain alone at its own step."""

import numpy as np
import pytest

from crazybilliards.model import Chain
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.closed_contacts import find_clusters
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import fill, make_noise
from crazybilliards.particles.stepping import FIRST, LAST, WHOLE, advance, take_step
from crazybilliards.particles.vanishing_step.coupling import advance_pair, record_pair

RATIOS = (3, 9)


class Pair:
    """A finer and a coarser chain, from rest, with all that the kernels want."""

    def __init__(self, chain, time_step, ratio, seed=1):
        self.chain, self.ratio = chain, ratio
        self.y = np.array([chain.reduced_anchors] * 2)
        self.v = np.zeros((2, chain.size))
        self.noise = make_noise(np.random.SeedSequence(seed))
        self.dynamics = tuple(
            make_dynamics(chain, step, speed=1.0) for step in (time_step, ratio * time_step)
        )
        self.scratch = make_scratch(chain.size), make_scratch(chain.size)
        self.tally = make_tally(chain.size, contacts=False)

    def advance(self, steps):
        arguments = self.y, self.v, self.noise, self.dynamics, self.ratio
        assert advance_pair(*arguments, self.scratch, self.tally, steps) == 0


def test_the_finer_chain_has_the_bits_of_a_chain_alone():
    for restitution in (0.0, 0.5, 1.0):
        chain = Chain(size=12, restitution=restitution, gap=0.05)
        for ratio in RATIOS:
            pair, alone = Pair(chain, 0.02, ratio), Pair(chain, 0.02, ratio)
            for steps in (1, 7, 0, 20):
                pair.advance(steps)
                single = alone.y[0], alone.v[0], alone.noise, alone.dynamics[0], alone.scratch[0]
                advance(*single, alone.tally, ratio * steps)
                np.testing.assert_array_equal(pair.y[0], alone.y[0])
                np.testing.assert_array_equal(pair.v[0], alone.v[0])
                assert pair.noise.taken == alone.noise.taken


def test_without_springs_and_collisions_both_have_the_same_velocities():
    """The noise of a kick is the sum of that of shorter ones, damped in between: half kicks too."""
    chain = Chain(size=4, stiffness=0, gap=1e6, damping=1.3)
    for ratio in RATIOS:
        pair = Pair(chain, 0.1, ratio)
        for steps in (1, 2, 5):
            pair.advance(steps)
            assert np.abs(pair.v[0]).min() > 1e-3
            np.testing.assert_allclose(pair.v[1], pair.v[0], rtol=1e-12)


def weights(chain, time_step, durations):
    """Return the weights of normal numbers in a kick over durations in steps, by hand."""
    rate, variance = chain.damping / chain.mass, chain.temperature / chain.mass
    durations = time_step * np.array(durations)
    later = durations.sum() - np.cumsum(durations)
    sigma = np.sqrt(variance * -np.expm1(-2 * rate * durations))
    whole = np.sqrt(variance * -np.expm1(-2 * rate * durations.sum()))
    return np.exp(-rate * later) * sigma / whole


@pytest.mark.parametrize("restitution", [0.0, 0.1, 0.7])
@pytest.mark.parametrize("ratio", RATIOS)
def test_the_coarser_chain_is_a_chain_alone_under_normal_numbers(restitution, ratio):
    """Its kicks are worked out by hand: unit variance, none used twice, its own closed contacts."""
    chain, time_step, steps = Chain(size=12, restitution=restitution, gap=0.05), 0.02, 8
    pair, alone = Pair(chain, time_step, ratio), Pair(chain, time_step, ratio)
    half = ratio // 2
    parts = [(FIRST, [0.5] + half * [1]), *(steps - 1) * [(WHOLE, ratio * [1])]]
    parts.append((LAST, half * [1] + [0.5]))
    y, v, dynamics, scratch = alone.y[1], alone.v[1], alone.dynamics[1], alone.scratch[1]
    closed = 0
    for _ in range(6):
        pair.advance(steps)
        xi = np.zeros((ratio * steps + 1, chain.size))
        fill(alone.noise, xi.ravel())
        taken = 0
        find_clusters(y, scratch.clusters)
        for part, durations in parts:
            weight = weights(chain, time_step, durations)
            assert (weight**2).sum() == pytest.approx(1, abs=1e-13)
            kicks = weight @ xi[taken : taken + len(durations)]
            taken += len(durations)
            assert take_step(y, v, kicks, part, dynamics, scratch, alone.tally) >= 0
            closed += scratch.clusters.number[0]
        assert taken == len(xi)
        np.testing.assert_allclose(pair.y[1], y, atol=1e-10)
        np.testing.assert_allclose(pair.v[1], v, atol=1e-10)
    assert (closed > 5) == (restitution < 0.163)
    assert np.abs(pair.v[1] - pair.v[0]).max() > 1e-6


def test_recorded_states_are_those_between_advances():
    chain = Chain(size=5, restitution=0)
    pair, stepped = Pair(chain, 0.02, 3), Pair(chain, 0.02, 3)
    y, v = np.zeros((2, 2, 4, chain.size))
    arguments = pair.y, pair.v, pair.noise, pair.dynamics, 3, pair.scratch, pair.tally
    assert record_pair(*arguments, 2, 3, y, v) == 3
    for snapshot in range(3):
        stepped.advance(2)
        np.testing.assert_array_equal(y[:, snapshot], stepped.y)
        np.testing.assert_array_equal(v[:, snapshot], stepped.v)
    assert not y[:, 3].any()


def test_a_chain_that_blows_up_ends_the_recording():
    """The coarser one does: its step is far too long."""
    pair = Pair(Chain(size=3), 3.0, 9)
    y, v = np.zeros((2, 2, 500, 3))
    arguments = pair.y, pair.v, pair.noise, pair.dynamics, 9, pair.scratch, pair.tally
    good = record_pair(*arguments, 1, 500, y, v)
    assert 0 < good < 500
    assert np.isfinite(v[:, :good]).all()
