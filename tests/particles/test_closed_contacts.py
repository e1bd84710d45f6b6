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
    strengthen,
)
from crazybilliards.particles.laws.law import EVENTS, ISOTONIC, Law, make_scratch
from crazybilliards.particles.noise import fill, make_noise
from crazybilliards.particles.stepping import FIRST, LAST, WHOLE, advance, kick
from studies.time_step import QUANTITIES, compared


def listed(clusters):
    """Return the clusters as pairs (first, end)."""
    number = clusters.number[0]
    return list(zip(clusters.firsts[:number], clusters.lasts[:number], strict=True))


def found(y):
    """Return the clusters of positions as pairs."""
    clusters = make_clusters(y.size)
    find_clusters(y, clusters)
    return listed(clusters)


def runs(y):
    """Return where equal numbers stand next to one another, as pairs."""
    pairs, begin = [], 0
    for _, members in groupby(y):
        end = begin + len(list(members))
        if end - begin > 1:
            pairs.append((begin, end))
        begin = end
    return pairs


def strengthened(kicks, y, clusters, strength, masses=1.0, high=np.inf):
    """Return kicks whose deviations from those that move their cluster as one get the strength.

    Clusters at the walls, at -+ ``high``, rest.
    """
    kicks, masses = kicks.copy(), masses * np.ones(y.size)
    for begin, end in clusters:
        own, share = kicks[begin:end], masses[begin:end] / masses[begin:end].sum()
        together = 0 if abs(y[begin]) == high else own.sum() * share
        kicks[begin:end] = together + strength * (own - together)
    return kicks


positions = st.lists(st.integers(0, 6), min_size=1, max_size=15).map(
    lambda y: np.sort(np.array(y, dtype=float)) / 7
)
seeds = st.integers(0, 2**32)


@given(y=positions)
def test_clusters_are_the_runs_of_equal_coordinates(y):
    assert found(y) == runs(y)
    nearby = y + 1e-15 * np.arange(y.size)
    assert found(nearby) == runs(nearby)


@given(y=positions, seed=seeds, strength=st.floats(0.5, 2))
def test_deviations_are_made_stronger_and_momentum_is_kept(y, seed, strength):
    kicks = np.random.default_rng(seed).normal(size=y.size)
    clusters, after = make_clusters(y.size), kicks.copy()
    find_clusters(y, clusters)
    strengthen(after, clusters, strength)
    np.testing.assert_allclose(after, strengthened(kicks, y, runs(y), strength), rtol=0, atol=4e-15)
    for begin, end in runs(y):
        momentum, rounding = kicks[begin:end].sum(), 1e-15 * (end - begin)
        assert after[begin:end].sum() == pytest.approx(momentum, rel=0, abs=4 * rounding)
    alone = np.ones(y.size, dtype=bool)
    for begin, end in runs(y):
        alone[begin:end] = False
    np.testing.assert_array_equal(after[alone], kicks[alone])


@given(
    y=positions,
    seed=seeds,
    dt=st.floats(1e-3, 2),
    law=st.sampled_from([(ISOTONIC, 0.0), (EVENTS, 0.0), (EVENTS, 0.1)]),
)
def test_what_an_operator_reports_are_the_clusters_it_leaves(y, seed, dt, law):
    v, scratch = np.random.default_rng(seed).normal(size=y.size), make_scratch(y.size)
    law = Law(*law, merge_speed=1e-3, most=10**6)
    drift(y, v, np.zeros(y.size), dt, law, scratch, UNSEEN)
    assert listed(scratch.clusters) == found(y)


@pytest.mark.parametrize("time_step", [0.01, 0.5])
@pytest.mark.parametrize("damping", [0.0, 1.0, 20.0])
def test_two_half_kicks_have_the_variance_of_a_whole_one(time_step, damping):
    """Relative velocity of two rods in contact, where no spring pulls."""
    chain = Chain(size=2, restitution=0, damping=damping)
    step = make_step(chain, time_step, "splitting")
    y, apart, none = chain.reduced_anchors, np.array([-1.0, 1.0]), np.zeros(2)

    def after(*kicks):
        v = np.zeros(2)
        for kicked, strength, part in kicks:
            kick(y, v, y, strengthened(kicked, y, runs(y), strength), step, part)
        return v[1] - v[0]

    whole = after((apart, step.closed, WHOLE))
    earlier = after((apart, 1.0, LAST), (none, 1.0, FIRST))
    later = after((none, 1.0, LAST), (apart, step.closed_outer, FIRST))
    assert whole == pytest.approx(2 * step.noise * CLOSED_KICK)
    assert earlier**2 + later**2 == pytest.approx(whole**2)


@pytest.mark.parametrize("e", [0.0, 0.1, 0.2])
@pytest.mark.parametrize("counted", [False, True])
@pytest.mark.parametrize("box", [0.0, 26.0])
@pytest.mark.parametrize("mass_ratio", [1.0, 3.0])
def test_steps_are_those_that_the_page_describes(mass_ratio, box, counted, e):
    """Kicks by spring, damping and strengthened noise, written out; the drift is the operator's."""
    walls = {"box": box, "wall_restitution": e} if box else {}
    chain = Chain(size=12, restitution=e, amplitude=3, mass_ratio=mass_ratio, **walls)
    dynamics = make_dynamics(chain, 0.2, speed=1.0, counted=counted)
    law, own = dynamics.law, (chain.rod_masses, chain.walls[1])
    scratch, other = (make_scratch(chain.size, dynamics.inverse) for _ in range(2))
    # The numbers of the two sorts of rods, for each rod.
    step = Step(*(np.resize(each, 12) for each in zip(dynamics.step, dynamics.second, strict=True)))
    strength = CLOSED_KICK if e < CRITICAL_RESTITUTION else 1.0
    assert (step.closed == strength).all()
    y, v = np.zeros((2, chain.size))
    other_y, other_v = y.copy(), v.copy()
    kicks, in_contact = np.empty(chain.size), 0
    noise, same = (make_noise(np.random.SeedSequence(1)) for _ in range(2))
    for steps in (1, 1, 3, 40):
        advance(other_y, other_v, same, dynamics, scratch, UNSEEN, steps)
        decay, size, strength = step.outer_decay, step.outer_noise, step.closed_outer
        find_clusters(y, other.clusters, *chain.walls)
        for _ in range(steps):
            fill(noise, kicks)
            clusters = listed(other.clusters)
            in_contact += len(clusters)
            kicks = strengthened(kicks, y, clusters, strength[0], *own)
            v = decay * v - step.kick * y + size * kicks
            drift(y, v, dynamics.anchors, 0.2, law, other, UNSEEN)
            v -= step.kick * y
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
