"""Elastic rods with one anchor, flown exactly: any step, damping and stiffness, any start."""

import math

import numpy as np
import pytest
from drifts import moved
from scipy.optimize import brentq

from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.exact_flight import make_propagator

CRITICAL = 2 * math.sqrt(4 * math.pi / 3)


def matrices(chain, time):
    """Return E and Sigma of the step: what it keeps of (y, v), and the covariance of its noise."""
    step = make_propagator(chain, time)
    root = np.array([[step.shared_noise, step.own_noise], [step.noise, 0.0]])
    e = np.array([[step.y_from_y, step.y_from_v], [step.v_from_y, step.v_from_v]])
    return e, root @ root.T


def moves(chain, time):
    """Return E by the roots of the characteristic equation; shape (2, 2), and that of ``time``."""
    half, square = chain.damping / (2 * chain.mass), chain.stiffness / chain.mass
    turn = np.emath.sqrt(half**2 - square) * time
    even, odd = np.cosh(turn), time * np.sinc(1j * turn / np.pi)
    e = np.array([[even + half * odd, odd], [-square * odd, even - half * odd]])
    return (np.exp(-half * time) * e).real


def heats(chain, time):
    """Return Sigma by Gauss-Legendre quadrature over times that are short for the chain."""
    pieces = max(int(20 * time * max(1.0, chain.damping / chain.mass)), 1)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    times = time / pieces * (np.arange(pieces)[:, None] + (nodes + 1) / 2)
    response = moves(chain, times)[:, 1]
    sigma = np.einsum("ipn,jpn,n->ij", response, response, weights)
    return sigma * (chain.amplitude / chain.mass) ** 2 * time / pieces / 2


@pytest.mark.parametrize("time", [1e-4, 0.1, 3.0, 20.0])
@pytest.mark.parametrize("damping", [0.0, 0.1, 1.0, CRITICAL, 10.0])
@pytest.mark.parametrize("stiffness", [0.0, 1.0])
def test_the_propagator_is_that_of_an_oscillator(stiffness, damping, time):
    chain = Chain(size=3, stiffness=stiffness, damping=damping, amplitude=1.7)
    e, sigma = matrices(chain, time)
    np.testing.assert_allclose(e, moves(chain, time), rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(sigma, heats(chain, time), rtol=1e-9, atol=1e-14)


@pytest.mark.parametrize(
    ("chain", "settings"),
    [
        (Chain(size=3, restitution=0.9), {}),
        (Chain(size=3, gap=0.1), {}),
        (Chain(size=3), {"stepper": "euler"}),
        (Chain(size=3), {"observe": ("widths", "collisions")}),
    ],
)
def test_what_cannot_be_flown_is_taken_in_steps(chain, settings):
    run = simulate(chain, duration=300, progress=False, **settings)
    assert run.attrs["flight"] == "in steps"
    # Where collisions are counted, the splitting has the right W_v at every step.
    assert (run.attrs["time_step_error"] == 0) == ("observe" in settings)


# -- between walls: each point bounces as if it were alone ----------------------------------------

ALONE = Chain(size=6, gap=0.3, box=16.0, mass=2, amplitude=0, damping=0, stiffness=0)
TIED = ALONE.replace(gap=0, stiffness=3)
TIME = 40.7
# Two at each wall that leave it, meet it or rest there, one at rest, and one that meets no wall.
STATE = np.array([-2.0, -2.0, 0.0, 0.3, 2.0, 2.0]), np.array([1.0, -3.3, 0.0, -0.4, 1.7, 0.0])


def bounced(y, v, time, rate, high):
    """Move one point on a spring, whose rate is given, in steps with at most one bounce each.

    Return its place, its velocity, and the impulses and hits of the two walls per mass.
    """
    struck, short = np.zeros((2, 2)), 0.1

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


@pytest.mark.parametrize("chain", [ALONE, TIED])
def test_each_point_bounces_as_if_it_were_alone(chain):
    """Linear springs with one anchor, or none."""
    rate = np.sqrt(chain.stiffness / chain.mass)
    ends = [bounced(*point, TIME, rate, 2.0) for point in zip(*STATE, strict=True)]
    places, speeds, struck = zip(*sorted(ends, key=lambda end: end[0]), strict=True)
    for steps in (1, 8):
        tally = make_tally(chain.size, contacts=False)._replace(struck=np.zeros((2, 2)))
        state = moved(chain, STATE, TIME / steps, steps, tally=tally, struck=True)
        np.testing.assert_allclose(state, (places, speeds), atol=1e-9)
        np.testing.assert_allclose(tally.struck, np.sum(struck, axis=0), rtol=1e-9)
    assert tally.struck[1].min() > 20


@pytest.mark.parametrize("damping", [0.0, 1e-12])
def test_a_step_of_any_number_of_turns_keeps_the_energy(damping):
    chain = Chain(size=2, damping=damping, amplitude=0.0, stiffness=1.0, mass=1.0)
    p = make_propagator(chain, 6.3e9)
    kept = math.exp(-damping * 6.3e9)
    for y, v in ((p.y_from_y, p.v_from_y), (p.y_from_v, p.v_from_v)):
        assert y**2 + v**2 == pytest.approx(kept, rel=1e-13 if damping == 0 else 1e-10)


@pytest.mark.parametrize("kind", [np.float16, np.float32])
def test_rods_that_overlap_by_the_rounding_of_their_type_are_moved_apart(kind):
    chain = Chain(size=40, restitution=0.0)
    x = (chain.anchors + 1 / 3).astype(kind)
    with pytest.warns(UserWarning, match=f"rounding of {kind.__name__} were moved apart by up to"):
        start = given_start(chain, x)
    assert (np.diff(chain.reduced(start.position)) > -1e-13).all()
    np.testing.assert_allclose(start.position[0], x, rtol=0, atol=40 * np.finfo(kind).eps)
    with pytest.raises(ValueError, match="rods 20 and 21 of replica 1 overlap by 1"):
        given_start(chain, np.where(np.arange(40) == 20, x - 1, x).astype(kind))
