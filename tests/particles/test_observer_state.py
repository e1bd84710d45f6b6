"""What a checkpoint keeps of an observer."""

import numpy as np
import pytest
from described_runs import a_run, some_snapshots

from crazybilliards.model import Chain
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.observers import OBSERVERS
from crazybilliards.particles.running.replica import restore

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
