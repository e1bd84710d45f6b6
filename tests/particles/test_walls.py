"""Elastic rods between walls, flown exactly at any step, against points that bounce."""

import numpy as np
import pytest
from drifts import moved
from scipy.optimize import brentq

from crazybilliards.model import Chain
from crazybilliards.particles.laws.avalanche import make_tally

ALONE = Chain(size=6, gap=0.3, box=16.0, mass=2, amplitude=0, damping=0, stiffness=0)
TIED = ALONE.replace(gap=0, stiffness=3)
TIME = 40.7
# Two at each wall that leave it, meet it or rest there, one at rest, and one that meets no wall.
STATE = np.array([-2.0, -2.0, 0.0, 0.3, 2.0, 2.0]), np.array([1.0, -3.3, 0.0, -0.4, 1.7, 0.0])


def bounced(y, v, time, rate, high):
    """Move one point on a spring, whose rate is given, in steps with at most one bounce each.

    Return its place, its velocity, and the impulses and hits of the two walls per mass.
    """
    struck, short = np.zeros((2, 2)), 1e-2

    def flown(t):
        turn = np.cos(rate * t), t * np.sinc(rate * t / np.pi)
        return turn[0] * y + turn[1] * v, turn[0] * v - rate**2 * turn[1] * y

    for _ in range(round(time / short)):
        rest = short
        if abs(flown(rest)[0]) > high:
            meeting = brentq(lambda t: abs(flown(t)[0]) - high, 0, rest, xtol=1e-15)
            y, v = flown(meeting)
            struck[:, int(y > 0)] += 2 * abs(v), 1
            rest, v = rest - meeting, -v
        y, v = flown(rest)
    return y, v, struck


def struck_by(chain, time_step, steps, **settings):
    """Return positions and velocities, and what the walls have received."""
    tally = make_tally(chain.size, contacts="counted" in settings)
    tally = tally._replace(struck=np.zeros((2, 2)))
    return moved(chain, STATE, time_step, steps, tally=tally, struck=True, **settings), tally.struck


@pytest.mark.parametrize("steps", [1, 8])
@pytest.mark.parametrize("chain", [ALONE, TIED])
def test_each_point_bounces_as_if_it_were_alone(chain, steps):
    """Linear springs with one anchor, or none."""
    rate = np.sqrt(chain.stiffness / chain.mass)
    ends = [bounced(*point, TIME, rate, 2.0) for point in zip(*STATE, strict=True)]
    places, speeds, struck = zip(*sorted(ends, key=lambda end: end[0]), strict=True)
    state, received = struck_by(chain, TIME / steps, steps)
    np.testing.assert_allclose(state, (places, speeds), atol=1e-9)
    np.testing.assert_allclose(received, np.sum(struck, axis=0), rtol=1e-9)
    assert received[1].min() > 20


@pytest.mark.parametrize("steps", [1, 8])
def test_without_springs_flight_is_one_collision_after_the_other(steps):
    """The gas of D. W. Jepsen (1965), folded at its walls."""
    folded = moved(ALONE, STATE, TIME / steps, steps)
    flown, received = struck_by(ALONE, TIME / steps, steps)
    state, expected = struck_by(ALONE, TIME / steps, steps, counted=True)
    np.testing.assert_allclose(folded, state, atol=1e-9)
    np.testing.assert_allclose(flown, state, atol=1e-9)
    np.testing.assert_allclose(received, expected, rtol=1e-9)
