"""The challenges of the page, judged on chains that run without a browser."""

import numpy as np
import pytest

from crazybilliards.apps.explore.challenges import (
    ARRIVED,
    CHALLENGES,
    KICK,
    BorderJudge,
    PushJudge,
    RunawayJudge,
    TurningJudge,
)
from crazybilliards.apps.explore.ratio import EnergyRatio
from crazybilliards.apps.explore.session import Session
from crazybilliards.apps.explore.setting import Setting
from crazybilliards.model import Chain

PUSH, RUNAWAY, BORDER, TURNING = (challenge.chain for challenge in CHALLENGES)


def run(session, judge, duration, frame=1.0):
    """Let time run as the page does, with the judge looking on in every frame."""
    end = session.time + duration
    while session.time < end and not session.diverged:
        session.advance(frame)
        judge.follow(session)
    return judge.verdict(session)


def pushed(judge, restitution, seed):
    session = Session(PUSH.replace(restitution=restitution), seed)
    session.advance(300.0)
    session.push(0, KICK * session.chain.free_velocity_width)
    judge.pushed(session)
    return run(session, judge, 20.0, 0.1)


def test_the_page_begins_with_the_first_challenge_and_takes_all_of_them():
    assert Setting().chain() == PUSH
    for challenge in CHALLENGES:
        setting = Setting()
        setting.take(challenge.chain)
        assert setting.chain() == challenge.chain


@pytest.mark.compiled
def test_a_push_arrives_at_restitution_one_and_not_at_nine_tenths():
    judge = PushJudge()
    assert (
        "e = 1: no push has ended yet. e = 0.9: no push has ended yet."
        in judge.verdict(Session(PUSH)).said
    )
    elastic = pushed(judge, 1.0, 1)
    assert "e = 1: 1 of 1 arrived" in elastic.said
    assert not elastic.done
    lossy = pushed(judge, 0.9, 2)
    assert "e = 0.9: 0 of 1 arrived" in lossy.said
    assert lossy.done


def test_a_push_is_forgotten_when_it_is_shown_too_fast_to_be_seen():
    judge, session = PushJudge(), Session(PUSH)
    judge.pushed(session)
    assert "e = 1: no push has ended yet" in run(session, judge, 30.0, 1.0).said


def test_a_push_is_forgotten_when_the_chain_changes_before_it_arrives():
    judge, session = PushJudge(), Session(PUSH)
    judge.pushed(session)
    session.v[-1] = 2 * ARRIVED * session.chain.free_velocity_width
    session.change(PUSH.replace(damping=1.0))
    assert "e = 1: no push has ended yet" in run(session, judge, 30.0).said


@pytest.mark.compiled
def test_fifteen_rods_that_run_away_do_it_and_forty_do_not():
    judge = RunawayJudge()
    many = Session(RUNAWAY.replace(restitution=1.1))
    many.advance(1e4)
    assert many.diverged
    assert judge.verdict(many) == (False, "Now 40 rods have run away. Fewest so far: 40.")
    few = Session(RUNAWAY.replace(size=15, restitution=1.1, damping=0.1))
    few.advance(1e4)
    verdict = judge.verdict(few)
    assert verdict.done
    assert "Fewest so far: 15. Theory, for weak damping: more than" in verdict.said
    # A chain whose rod was thrown too far has not run away by itself.
    thrown = Session(RUNAWAY.replace(restitution=0.9, size=5))
    thrown.diverged = True
    assert "have run away" not in RunawayJudge().verdict(thrown).said


@pytest.mark.compiled
def test_the_ratio_of_energies_is_one_for_elastic_rods_within_its_error():
    off = []
    for seed in range(20):
        session, ratio = Session(Chain(size=10), seed), EnergyRatio()
        while ratio.known is None:
            session.advance(10.0)
            ratio.follow(session)
        found, error = ratio.known
        off.append((found - 1) / error)
    # The errors have the right size: 20 of them scatter by 1, to within three standard errors.
    assert np.mean(off) == pytest.approx(0, abs=4 / np.sqrt(20))
    assert 0.5 < np.std(off) < 1.7


@pytest.mark.compiled
def test_ends_are_hot_enough_where_collisions_take_much_energy():
    hot, judge = Session(BORDER.replace(restitution=0.3, size=60)), BorderJudge()
    waiting = judge.verdict(hot)
    assert "settling for another" in waiting.said
    assert "It counts when it is clearly above 3: by 3 standard errors." in waiting.said
    assert run(hot, judge, 2000.0, 10.0).done
    mild, judge = Session(BORDER), BorderJudge()
    verdict = run(mild, judge, 2000.0, 10.0)
    assert "border over centre: 1." in verdict.said or "border over centre: 2." in verdict.said
    assert not verdict.done


@pytest.mark.compiled
def test_the_profile_turns_between_two_dampings_that_are_close():
    judge = TurningJudge()
    session = Session(TURNING)
    assert "Found: concave at" in run(session, judge, 3000.0, 10.0).said
    session.change(TURNING.replace(damping=2.2))
    verdict = run(session, judge, 30_000.0, 10.0)
    assert "Found: convex at" in verdict.said
    assert "= 2.2, concave at" in verdict.said
    assert not verdict.done
    session.change(TURNING.replace(damping=5.0, size=30))
    assert judge.verdict(session).said.startswith("Another chain than that of the challenge.")
