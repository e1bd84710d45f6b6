"""Closed contacts: which they are, and the noise that opens them as the continuous chain does."""

from itertools import groupby

import numpy as np
import pytest
from drifts import UNSEEN, drift
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.model import Chain
from crazybilliards.particles import dynamics as dynamics_module
from crazybilliards.particles.dynamics import Step, make_dynamics, make_step
from crazybilliards.particles.laws.closed_contacts import (
    CLOSED_KICK,
    CRITICAL_RESTITUTION,
    find_clusters,
    make_clusters,
)
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import fill, make_noise
from crazybilliards.particles.stepping import advance
from studies.time_step import QUANTITIES, compared


def runs(y, high=np.inf):
    """Return as pairs where equal numbers stand next to one another, or any at a wall."""
    pairs, begin = [], 0
    for place, members in groupby(y):
        end = begin + len(list(members))
        if end - begin > 1 or abs(place) == high:
            pairs.append((begin, end))
        begin = end
    return pairs


def strengthened(kicks, y, clusters, strength, masses, high):
    """Return kicks whose deviations from those that move their cluster as one get the strength.

    Clusters at the walls, at -+ ``high``, rest.
    """
    kicks = kicks.copy()
    for begin, end in clusters:
        own, share = kicks[begin:end], masses[begin:end] / masses[begin:end].sum()
        together = 0 if abs(y[begin]) == high else own.sum() * share
        kicks[begin:end] = together + strength * (own - together)
    return kicks


@given(st.lists(st.integers(0, 6), min_size=1, max_size=15))
def test_clusters_are_the_runs_of_equal_coordinates(places):
    places = np.array(sorted(places)) / 7
    for y in (places, places + 1e-15 * np.arange(places.size)):
        clusters = make_clusters(y.size)
        find_clusters(y, clusters)
        found = zip(clusters.firsts, clusters.lasts, strict=True)
        assert list(found)[: clusters.number[0]] == runs(y)


@pytest.mark.parametrize("time_step", [0.01, 0.5])
@pytest.mark.parametrize("damping", [0.0, 1.0, 20.0])
def test_two_half_kicks_have_the_variance_of_a_whole_one(time_step, damping):
    """Also in contact: the first half, which decays in the second, is not made stronger."""
    step = make_step(Chain(size=2, restitution=0, damping=damping), time_step, "splitting")
    halves = step.outer_decay * step.outer_noise, step.closed_outer * step.outer_noise
    assert step.closed == CLOSED_KICK
    assert np.hypot(*halves) == pytest.approx(CLOSED_KICK * step.noise)


@pytest.mark.parametrize("counted", [False, True])
@pytest.mark.parametrize(
    ("e", "mass_ratio", "box", "gap", "spring"),
    [
        (0.0, 1.0, 0.0, 0.0, "linear"),
        (0.1, 1.0, 26.0, 0.05, "quadratic"),
        (0.2, 1.0, 0.0, 0.0, "linear"),
        (0.0, 3.0, 0.0, 0.0, "quadratic"),
        (0.0, 3.0, 26.0, 0.0, "linear"),
    ],
)
def test_steps_are_those_that_the_page_describes(e, mass_ratio, box, gap, spring, counted):
    """Kicks by spring, damping and strengthened noise, written out; the drift is the operator's."""
    walls = {"box": box, "wall_restitution": e} if box else {}
    springs = {"gap": gap, "spring": spring, "mass_ratio": mass_ratio}
    chain = Chain(size=12, restitution=e, amplitude=3, **springs, **walls)
    dynamics = make_dynamics(chain, 0.2, speed=1.0, counted=counted)
    law, own = dynamics.law, (chain.rod_masses, chain.walls[1])
    scratch, other = (make_scratch(chain.size, dynamics.inverse) for _ in range(2))
    # The numbers of the two sorts of rods, for each rod.
    step = Step(*(np.resize(each, 12) for each in zip(dynamics.step, dynamics.second, strict=True)))
    strength = CLOSED_KICK if e < CRITICAL_RESTITUTION else 1.0
    assert (step.closed == strength).all()

    def pull():
        return step.kick * chain.force(y - chain.reduced_anchors) / chain.stiffness

    y, v = chain.reduced_anchors.copy(), np.zeros(chain.size)
    other_y, other_v = y.copy(), v.copy()
    kicks, in_contact = np.empty(chain.size), 0
    noise, same = (make_noise(np.random.SeedSequence(1)) for _ in range(2))
    for steps in (1, 1, 3, 40):
        advance(other_y, other_v, same, dynamics, scratch, UNSEEN, steps)
        decay, size, strength = step.outer_decay, step.outer_noise, step.closed_outer
        for _ in range(steps):
            fill(noise, kicks)
            clusters = runs(y, chain.walls[1])
            in_contact += len(clusters)
            kicks = strengthened(kicks, y, clusters, strength[0], *own)
            v = decay * v - pull() + size * kicks
            drift(y, v, dynamics.anchors, 0.2, law, other, UNSEEN)
            v -= pull()
            decay, size, strength = step.decay, step.noise, step.closed
        fill(noise, kicks)
        v = step.outer_decay * v + step.outer_noise * kicks
        np.testing.assert_allclose(other_y, y, atol=1e-12)
        np.testing.assert_allclose(other_v, v, atol=1e-12)
    assert in_contact > 20


@pytest.mark.parametrize("e", [0.0, 0.1])
@pytest.mark.parametrize("settings", [{"stepper": "euler"}, {"method": "contact-dynamics"}])
def test_what_the_paper_describes_is_left_alone(e, settings):
    step = make_dynamics(Chain(restitution=e), 0.01, speed=1.0, **settings).step
    assert (step.closed, step.closed_outer) == (1.0, 1.0)


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize("strength", [CLOSED_KICK, 1.0])
def test_a_long_step_is_right_to_a_percent_and_only_so_with_the_correction(strength, monkeypatch):
    """Ten rods at e = 0; a kick of 0.4 widths, against one of 0.2 under the same noise."""
    monkeypatch.setattr(dynamics_module, "CLOSED_KICK", strength)
    chain, corrected = Chain(size=10, restitution=0), strength == CLOSED_KICK
    seeds, duration = (8, 4000) if corrected else (6, 1500)
    off = np.array([compared(chain, 0.11, duration, seed) for seed in range(seeds)])
    mean, error = off.mean(axis=0), off.std(axis=0, ddof=1) / np.sqrt(seeds)
    width, displacement = (QUANTITIES.index(name) for name in ("W_v, centre", "<dx>, outer tenth"))
    if corrected:
        assert (error[[width, displacement]] < 0.0015).all()
        assert (np.abs(mean[[width, displacement]]) < 0.01).all()
    else:
        assert mean[displacement] + 5 * error[displacement] < -0.01
