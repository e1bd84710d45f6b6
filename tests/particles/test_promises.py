"""What docstrings of collision laws, steppers and observers promise, under hostile input.

No noise, no damping, no spring, one long step or many short ones, and chains of one to three rods.
"""

import numpy as np
import pytest
from described_runs import a_run
from drifts import drifted, moved

from crazybilliards.model import Chain
from crazybilliards.particles.laws.exact_flight import make_propagator
from crazybilliards.particles.laws.law import EVENTS

METHODS = ["event-driven", "contact-dynamics"]


@pytest.mark.parametrize(("step", "last"), [(500.0, 0.13572), (5.0, 0.12505), (0.5, 0.125)])
def test_a_collapse_without_noise_depends_on_the_step_as_the_page_says(step, last):
    chain = Chain(size=8, restitution=0.3, gap=0.3, amplitude=0, damping=0, stiffness=0)
    _, v = moved(chain, (chain.reduced_anchors, np.eye(1, 8)[0]), step, round(500 / step))
    assert v[-1] == pytest.approx(last, abs=1e-5)
    assert v.mean() == pytest.approx(1 / 8)


@pytest.mark.parametrize(("ratio", "least", "most"), [(1.0, 38, 40), (1.06, 0, 0)])
def test_three_rods_stick_up_to_a_little_more_than_the_exact_restitution(ratio, least, most):
    """``merging=0`` is 1e-9 of the speed, so that they still do a few per cent above it."""
    generator, stuck = np.random.default_rng(1), 0
    for _ in range(40):
        y = [-generator.exponential(), 0.0, generator.exponential()]
        v = [1.0, 0.1 * generator.normal(), -1.0]
        _, w, *_ = drifted(EVENTS, (y, v), 1000.0, ratio * (7 - 4 * np.sqrt(3)))
        stuck += np.ptp(w) == 0
    assert least <= stuck <= most


@pytest.mark.parametrize("damping", [10.0, 1e4, 1e7])
def test_a_step_of_exact_flight_is_right_with_strong_damping_but_for_rounding(damping):
    strong = Chain(damping=damping, stiffness=1.0, mass=1.0)
    half, time = strong.damping / 2, strong.damping
    quick = half + np.sqrt(half**2 - 1)
    slow = 1 / quick
    expected = (quick * np.exp(-slow * time) - slow * np.exp(-quick * time)) / (quick - slow)
    found = make_propagator(strong, time).y_from_y
    assert found == pytest.approx(expected, rel=1e-13 + 1e-16 * strong.damping**2)


@pytest.mark.parametrize(("spring", "gap"), [("linear", 0.0), ("linear", 0.3), ("quadratic", 0.0)])
@pytest.mark.parametrize("size", [1, 2, 6])
@pytest.mark.parametrize("counted", [True, False])
def test_elastic_steps_are_symmetric_in_time(counted, size, gap, spring):
    """Turned round, the rods go back to where they began, collisions included."""
    chain = Chain(size=size, gap=gap, amplitude=0, damping=0, spring=spring)
    generator = np.random.default_rng(size)
    y = np.sort(chain.reduced_anchors + generator.normal(size=size))
    v = generator.normal(size=size)
    there = moved(chain, (y, v), 0.1, 40, counted=counted)
    back = moved(chain, (there[0], -there[1]), 0.1, 40, counted=counted)
    np.testing.assert_allclose(back, (y, -v), atol=1e-9)
    assert np.abs(there[0] - y).max() > 0.1


@pytest.mark.compiled
@pytest.mark.parametrize(("gap", "e"), [(0.0, 0.5), (0.3, 0.9999), (0.3, 1.05)])
@pytest.mark.parametrize(("method", "size", "order"), [(METHODS[0], 5, 2), (METHODS[1], 2, 1)])
def test_steps_with_collisions_have_the_order_stated(method, size, order, gap, e):
    """The mean error of transients from many starts."""
    chain = Chain(size=size, restitution=e, amplitude=0, damping=0.3, gap=gap)
    errors = []
    for seed in range(40):
        generator = np.random.default_rng(seed)
        y = np.sort(chain.reduced_anchors + generator.normal(size=size))
        v = generator.normal(size=size)
        how = {"method": method, "counted": method == METHODS[0]}
        fine, *ends = (
            np.array(moved(chain, (y, v), 2.0**-k, 2 ** (k + 1), **how)) for k in (12, 4, 8)
        )
        errors.append([np.abs(end - fine).max() for end in ends])
    coarse, finer = np.mean(errors, axis=0)
    assert np.log2(coarse / finer) / 4 == pytest.approx(order, abs=0.25)


@pytest.mark.parametrize("average", ["time", "ensemble"])
@pytest.mark.parametrize("replicas", [1, 7, 63, 64, 100])
def test_a_run_keeps_what_it_was_asked_for(replicas, average):
    for every in (1 / 3, np.pi, 1e-3, 1e4 / 7):
        for step in (None, 0.033):
            asked = {"every": every, "time_step": step, "warmup": 7.7, "duration": 6400 * every}
            asked |= {"average": average, "replicas": replicas, "observe": "energy"}
            run = a_run(Chain(size=3, restitution=0.5), **asked)
            assert run.every == pytest.approx(every, rel=4e-16)
            assert run.time_step <= (step or np.inf) * (1 + 1e-9)
            if average == "ensemble":
                assert run.times[0] == run.warmup >= 7.7 * (1 - 1e-9)
                continue
            assert run.duration >= 6400 * every * (1 - 1e-9)
            assert 10 <= run.blocks * replicas < 64 + replicas


def test_a_warm_up_is_not_made_much_longer_by_rare_snapshots():
    run = a_run(Chain(size=3), duration=64_000, every=1000.0, observe="snapshots", warmup=50)
    assert run.times[0] == pytest.approx(1050, abs=1.1)
