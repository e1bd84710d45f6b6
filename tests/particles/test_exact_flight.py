"""Elastic rods with one anchor, flown exactly: any step, damping and stiffness, any start."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate
from crazybilliards.particles.laws.exact_flight import make_propagator
from crazybilliards.particles.observers import Raw

CRITICAL = 2 * math.sqrt(4 * math.pi / 3)
DAMPINGS = [0.0, 0.1, 1.0, CRITICAL, 10.0]
STEPS = [0.1, 3.0, 20.0]


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


@pytest.mark.parametrize("time", [1e-4, *STEPS])
@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("stiffness", [0.0, 1.0])
def test_the_propagator_is_that_of_an_oscillator(stiffness, damping, time):
    chain = Chain(size=3, stiffness=stiffness, damping=damping, amplitude=1.7)
    step = make_propagator(chain, time)
    e = [[step.y_from_y, step.y_from_v], [step.v_from_y, step.v_from_v]]
    np.testing.assert_allclose(e, moves(chain, time), rtol=1e-10, atol=1e-12)
    root = np.array([[step.shared_noise, step.own_noise], [step.noise, 0.0]])
    np.testing.assert_allclose(root @ root.T, heats(chain, time), rtol=1e-9, atol=1e-14)


some = st.just(0.0) | st.floats(1e-9, 20)


@given(one=st.floats(1e-3, 30), other=st.floats(1e-3, 30), damping=some, stiffness=some)
def test_two_steps_are_one_of_their_sum(one, other, damping, stiffness):
    """E and Sigma alike, whatever the damping: nothing else is assumed of an exact law."""
    chain = Chain(size=3, damping=damping, stiffness=stiffness)

    def matrices(time):
        step = make_propagator(chain, time)
        root = np.array([[step.shared_noise, step.own_noise], [step.noise, 0.0]])
        e = np.array([[step.y_from_y, step.y_from_v], [step.v_from_y, step.v_from_v]])
        return e, root @ root.T

    (e, sigma), (f, rho), (both, all_noise) = (matrices(t) for t in (one, other, one + other))
    scale = np.abs(f) @ np.abs(e)
    assert np.abs(f @ e - both).max() <= 1e-10 * scale.max()
    found = f @ sigma @ f.T + rho
    assert np.abs(found - all_noise).max() <= 1e-9 * np.abs(all_noise).max()


@pytest.mark.compiled
@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("stiffness", [0.0, 1.0])
def test_rods_forget_as_one_oscillator(stiffness, damping, step):
    """Sums over the chain do not know who is who: those of x and of v, and of their squares.

    What a step adds to them beyond E is the noise, whose moments are known.
    """
    chain = Chain(size=6, damping=damping, stiffness=stiffness)
    copies, steps, generator = 40, 100, np.random.default_rng(7)
    y = np.sort(generator.normal(1.0, 2.0, (copies, chain.size)), axis=1)
    v = generator.normal(0.5, 0.7, (copies, chain.size))
    start = given_start(chain, chain.physical(y), v, replicas=copies)
    times = {"duration": steps * step, "every": step, "time_step": step}
    how = {"average": "ensemble", "observe": Raw(), "replicas": copies, "seed": 1}
    run = simulate(chain, start=start, progress=False, **how, **times)
    rods = np.stack([run.position.values - chain.anchors, run.velocity.values])
    assert (np.diff(rods[0]) > -1e-9 * np.abs(rods[0]).max()).all()
    e, sigma = moves(chain, step), heats(chain, step)
    before, after = rods[:, :, :-1], rods[:, :, 1:]
    moved = np.tensordot(e, before, 1)
    left = (after - moved).mean(axis=-1).reshape(2, -1)
    of_mean, number = sigma / chain.size, copies * steps
    variance = np.diag(of_mean)
    assert (np.abs(left.mean(1)) < 5 * np.sqrt(variance / number)).all()
    error = np.sqrt((np.outer(variance, variance) + of_mean**2) / number)
    assert (np.abs(left @ left.T / number - of_mean) < 5 * error).all()
    for added, known, noise in zip(after**2 - moved**2, moved, np.diag(sigma), strict=True):
        error = np.sqrt((4 * noise * known**2 + 2 * noise**2).sum())
        assert abs(added.sum() - noise * added.size) < 5 * error


@pytest.mark.parametrize(
    ("chain", "settings"),
    [
        (Chain(size=3, restitution=0.9), {}),
        (Chain(size=3, gap=0.1), {}),
        (Chain(size=3, spring="quadratic"), {}),
        (Chain(size=3), {"stepper": "euler"}),
        (Chain(size=3), {"method": "contact-dynamics"}),
        (Chain(size=3), {"observe": ("widths", "collisions")}),
    ],
)
def test_what_cannot_be_flown_is_taken_in_steps(chain, settings):
    run = simulate(chain, duration=300, progress=False, **settings)
    assert run.attrs["flight"] == "in steps"
    # Where collisions are counted, the splitting has the right W_v at every step.
    assert (run.attrs["time_step_error"] == 0) == ("observe" in settings)


def test_a_warm_up_is_not_made_much_longer_by_rare_snapshots():
    chain = Chain(size=3)
    options = {"duration": 64_000, "every": 1000.0, "observe": "snapshots", "progress": False}
    assert simulate(chain, **options, warmup=50).time[0] == pytest.approx(1050, abs=1.1)
    assert simulate(chain, **options, warmup=0).time[0] == 1000
