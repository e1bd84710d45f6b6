"""Checkpoints: a run that is killed and resumed gives the bits of an undisturbed one."""

import numpy as np
import pytest
import xarray as xr

from crazybilliards.model import Chain
from crazybilliards.model.storage import locked
from crazybilliards.particles import simulate
from crazybilliards.particles.observers.widths import Widths
from crazybilliards.particles.running import checkpoint
from crazybilliards.particles.running.replica import Replica


def test_a_finished_run_is_not_done_again_nor_one_whose_checkpoint_is_taken(tmp_path):
    chain = Chain(size=10)
    arguments = {"duration": 500, "progress": False, "checkpoint": tmp_path / "state"}
    first = simulate(chain, **arguments)
    before = (tmp_path / "state").read_bytes()
    with locked(tmp_path / "state"), pytest.raises(BlockingIOError, match="state"):
        simulate(chain, **arguments)
    assert (tmp_path / "state").read_bytes() == before
    xr.testing.assert_identical(simulate(chain, **arguments), first)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["state"]


INTERRUPTED = {  # the run, and what was called how often when Ctrl-C comes
    "all that is summed": (
        Chain(size=12, restitution=0.6),
        {"duration": 400, "observe": ["widths", "covariances", "modes", "impacts"], "threads": 1},
        (Replica, "_observe", 20),
    ),
    "replicas done and not": (
        Chain(size=10),
        {"duration": 40, "every": 4, "replicas": 50, "average": "ensemble"},
        (Widths, "observe", 250),  # of 550
    ),
    "between snapshots far apart": (
        Chain(size=20, spring="quadratic"),
        {"duration": 4e4, "every": 2e4, "average": "ensemble", "observe": ("widths", "energy")},
        (Replica, "_advance", 3),
    ),
}


@pytest.mark.compiled
@pytest.mark.parametrize("name", INTERRUPTED)
def test_an_interrupted_run_goes_on_as_if_it_had_not_been(name, ctrl_c, tmp_path):
    chain, options, (owner, method, number) = INTERRUPTED[name]
    options = options | {"progress": False}
    whole = simulate(chain, **options)
    ctrl_c(owner, method, lambda callers: len(callers) == number)
    cut = simulate(chain, checkpoint=tmp_path / "state", **options)
    assert cut.attrs["status"] == "interrupted"
    assert np.isfinite(cut.velocity_width).all()
    if "far apart" in name:
        assert cut.time.values.tolist() == [0]
    xr.testing.assert_identical(simulate(chain, checkpoint=tmp_path / "state", **options), whole)


def test_a_checkpoint_of_other_source_code_is_refused(tmp_path, monkeypatch):
    """An edited kernel would continue the run to numbers of which half are the old one's."""
    arguments = {"duration": 500, "progress": False, "checkpoint": tmp_path / "state"}
    with monkeypatch.context() as patched:
        patched.setattr(checkpoint, "_SOURCE", "before the edit")
        simulate(Chain(size=10), **arguments)
    with pytest.raises(ValueError, match="differs in source code; remove"):
        simulate(Chain(size=10), **arguments)
