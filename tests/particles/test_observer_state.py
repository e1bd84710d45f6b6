"""What a checkpoint keeps of an observer, and what it refuses."""

from types import SimpleNamespace

import numpy as np
import pytest
from described_runs import a_run, some_snapshots

from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.observers import OBSERVERS
from crazybilliards.particles.observers.base import Averaged, restore

BUILT_IN = [pytest.param(observer, id=name) for name, observer in OBSERVERS.items()]


@pytest.mark.parametrize("average", ["time", "ensemble"])
@pytest.mark.parametrize("observer", BUILT_IN)
def test_a_checkpoint_keeps_everything_that_observing_changes(observer, average):
    """Save and restore, then observe the same: every attribute agrees. None can be forgotten."""
    if average == "ensemble" and not observer.ensemble:
        return
    chain = Chain(size=5, box=12 * observer.meets_walls)
    run = a_run(chain, duration=100, observe=observer(), average=average, replicas=2)
    generator = np.random.default_rng(1)
    [original] = (each.prepared(run, 2) for each in run.observers)
    untouched = {name: np.array(value) for name, value in original.state().items()}
    original.observe(some_snapshots(run, generator, 0))
    tally = original.tally(make_tally(5, contacts=True))
    for array in (
        tally.contacts,
        *tally.pushes,
        *tally.triggered,
        tally.impacts,
        tally.struck,
        tally.speeds.counts,
    ):
        array += 1  # as the collision kernels do
    state = {name: np.array(value) for name, value in original.state().items()}
    assert any(not np.array_equal(state[name], untouched[name]) for name in state)
    [resumed] = (each.prepared(run, 2) for each in run.observers)
    for name, value in state.items():
        restore(resumed, name, value)
    snapshots = some_snapshots(run, generator, 3)
    for each in (original, resumed):
        each.observe(snapshots)
    assert vars(original).keys() == vars(resumed).keys()
    for name, value in vars(original).items():
        assert np.array_equal(value, vars(resumed)[name], equal_nan=isinstance(value, np.ndarray))


class Holding(Averaged):
    """An observer with an attribute of some kind."""

    name = "holding"
    gives = ("density",)

    def __init__(self, held):
        self.held = held

    def observe(self, snapshots):
        pass

    def report(self, counts):
        return {}


@pytest.mark.parametrize(
    "held",
    [
        [],
        {},
        set(),
        bytearray(),
        np.random.default_rng(1),
        object(),
        iter([]),
        (1, [2]),
        (np.zeros(1),),
        np.array([None]),
        SimpleNamespace(count=0),
    ],
    ids=lambda held: type(held).__name__,
)
def test_what_a_checkpoint_cannot_hold_is_refused(held):
    message = f"holding: held must be an array or a number, .* got {type(held).__name__}"
    with pytest.raises(TypeError, match=message):
        simulate(Chain(size=2), duration=200, observe=Holding(held), progress=False)


@pytest.mark.parametrize(
    "held",
    [
        *(None, True, 2, 0.5, 1j, "text", np.float32(3), np.arange(3), Chain(size=3)),
        *((1, ("a", None)), frozenset({1}), np.cos, max, int, lambda y: y),
    ],
    ids=lambda held: type(held).__name__,
)
def test_what_a_checkpoint_holds_or_what_never_changes_is_taken(held):
    run = a_run(Chain(size=2), duration=200, observe=Holding(held))
    original, resumed = (run.observers[0].prepared(run, 1) for _ in range(2))
    for name, value in original.state().items():
        restore(resumed, name, np.array(value))
    assert type(resumed.held) is type(held)
    assert np.all(resumed.held == held)


def test_an_attribute_made_while_measuring_is_refused_at_the_next_checkpoint(tmp_path):
    class Late(Holding):
        def observe(self, snapshots):
            self.held = [snapshots.first]

    with pytest.raises(TypeError, match="held must be an array or a number"):
        simulate(
            Chain(size=2),
            duration=200,
            observe=Late(0),
            progress=False,
            checkpoint=tmp_path / "state",
        )
