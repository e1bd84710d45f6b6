"""Checkpoints: a run that is killed and resumed gives the bits of an undisturbed one."""

import errno
import io
import os
import signal

import numpy as np
import pytest
import xarray as xr
from killed import run_and_signal

from crazybilliards.model import Chain, load, save
from crazybilliards.model.locks import locked
from crazybilliards.model.storage import read_sealed, write_sealed
from crazybilliards.particles import simulate
from crazybilliards.particles.running import checkpoint
from crazybilliards.particles.running.replica import Replica

PATIENCE = 200  # for what must come to an end, in seconds

SCRIPT = """
import sys
from crazybilliards.model import Chain, save
from crazybilliards.particles import simulate
checkpoint, output = sys.argv[1:]
run = simulate(
    Chain(size=40, restitution={e}, gap=0.1), duration={duration}, replicas=3, seed=4,
    observe=("widths", "density", "energy", "velocities"), progress=False,
    checkpoint=checkpoint or None, checkpoint_interval=0.05,
)
save(run, output)
"""


@pytest.mark.posix
@pytest.mark.compiled
@pytest.mark.parametrize("e", [1.0, pytest.param(0.7, marks=pytest.mark.validate)])
def test_killed_at_random_moments_and_resumed_it_is_the_undisturbed_run(e, tmp_path):
    script = SCRIPT.format(e=e, duration=100_000)
    undisturbed, output = tmp_path / "undisturbed.nc", tmp_path / "run.nc"
    checkpoint = tmp_path / "state"
    assert run_and_signal(script, "", undisturbed) == 0
    generator = np.random.default_rng(int(10 * e))
    for how in (signal.SIGTERM, signal.SIGKILL, signal.SIGINT):
        status = run_and_signal(script, checkpoint, output, how, after=generator.random() / 8)
        assert status == (0 if how == signal.SIGINT else -how)
    assert load(output).attrs["status"] == "interrupted"
    # However far it came, now to the end.
    assert run_and_signal(script, checkpoint, output) == 0
    resumed = load(output)
    assert resumed.attrs["status"] == "completed"
    xr.testing.assert_identical(resumed, load(undisturbed))


def test_a_finished_run_is_not_done_again(tmp_path):
    chain = Chain(size=10)
    arguments = {"duration": 500, "progress": False, "checkpoint": tmp_path / "state"}
    first = simulate(chain, **arguments)
    xr.testing.assert_identical(simulate(chain, **arguments), first)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["state"]


def test_the_checkpoint_of_another_run_is_refused_with_the_reason(tmp_path):
    arguments = {"duration": 500, "progress": False, "checkpoint": tmp_path / "state"}
    simulate(Chain(size=10), **arguments)
    before = (tmp_path / "state").read_bytes()
    for chain, change, reason in (
        (Chain(size=11), {}, "size is 10 there and 11 here"),
        (Chain(size=10, gap=1), {}, "gap is 0.0 there and 1.0 here"),
        (Chain(size=10), {"seed": 5}, "seed is 0 there and 5 here"),
        (
            Chain(size=10),
            {"duration": 300},
            "duration is 5.* here, and a run can be made longer, but not shorter",
        ),
        (Chain(size=10), {"duration": 900, "every": 2.0}, "every is 1.0.* there and 2.0 here"),
        (Chain(size=10), {"average": "ensemble"}, "average is time there and ensemble here"),
        (Chain(size=10), {"observe": "widths"}, "observe is"),
        (Chain(size=10), {"replicas": 2}, "replicas is 1 there and 2 here"),
    ):
        with pytest.raises(ValueError, match=reason):
            simulate(chain, **(arguments | change))
    assert (tmp_path / "state").read_bytes() == before


def test_a_damaged_or_foreign_checkpoint_is_refused(tmp_path):
    path = tmp_path / "state"
    arguments = {"duration": 500, "progress": False, "checkpoint": path}
    simulate(Chain(size=10), **arguments)
    whole = path.read_bytes()
    for content in (whole[:-1], whole[:100], b"", bytes([whole[0] ^ 1]) + whole[1:]):
        path.write_bytes(content)
        with pytest.raises(ValueError, match=r"truncated|damaged"):
            simulate(Chain(size=10), **arguments)
    path.write_bytes(whole)
    with pytest.raises(ValueError, match="not a result"):
        load(path)


def test_a_second_run_on_one_checkpoint_is_refused(tmp_path):
    arguments = {"duration": 500, "progress": False, "checkpoint": tmp_path / "state"}
    first = simulate(Chain(size=10), **arguments)
    before = (tmp_path / "state").read_bytes()
    with locked(tmp_path / "state"):
        with pytest.raises(BlockingIOError, match="state"):
            simulate(Chain(size=10), **arguments)
        assert (tmp_path / "state").read_bytes() == before
    xr.testing.assert_identical(simulate(Chain(size=10), **arguments), first)


def test_a_disk_that_fills_up_costs_the_checkpoint_and_not_the_run(tmp_path, monkeypatch):
    arguments = {"duration": 500, "progress": False}
    undisturbed = simulate(Chain(size=10), **arguments)
    arguments |= {"checkpoint": tmp_path / "state", "checkpoint_interval": 0}
    replace = os.replace

    def once(source, target):
        replace(source, target)
        monkeypatch.setattr(os, "replace", full)

    def full(source, target):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "replace", once)
    with pytest.warns(RuntimeWarning, match=r"state: no checkpoint written: No space left"):
        run = simulate(Chain(size=10), **arguments)
    xr.testing.assert_identical(run, undisturbed)
    assert [path.name for path in tmp_path.iterdir()] == ["state"]
    monkeypatch.undo()
    xr.testing.assert_identical(simulate(Chain(size=10), **arguments), undisturbed)


@pytest.mark.compiled
def test_between_two_snapshots_far_apart_a_run_can_be_stopped_and_resumed(tmp_path, monkeypatch):
    chain = Chain(size=50, spring="quadratic")
    options = {"duration": 4e4, "every": 2e4, "average": "ensemble", "progress": False}
    options |= {"observe": ("widths", "energy")}
    whole = simulate(chain, **options)
    measure = Replica._measure

    def stopped(replica, stop):
        for number, steps in enumerate(measure(replica, stop)):
            if number == 3:
                os.kill(os.getpid(), signal.SIGINT)
                assert stop.wait(120)
            yield steps

    monkeypatch.setattr(Replica, "_measure", stopped)
    cut = simulate(chain, **options, checkpoint=tmp_path / "state")
    assert cut.attrs["status"] == "interrupted"
    assert cut.time.values.tolist() == [0]
    monkeypatch.undo()
    resumed = simulate(chain, **options, checkpoint=tmp_path / "state")
    xr.testing.assert_identical(resumed, whole)


def test_a_checkpoint_that_cannot_be_written_is_an_error_before_any_work(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(Replica, "work", lambda *_: pytest.fail("it works"))
    with pytest.raises(OSError, match="file"):
        simulate(Chain(size=100), duration=1e8, checkpoint=tmp_path / "file" / "state")


def test_a_sealed_file_that_is_no_checkpoint_is_refused_and_kept(tmp_path):
    """A result given by mistake, and what numpy would take for something else."""
    chain, options = Chain(size=2), {"duration": 200.0, "progress": False}
    path = save(simulate(chain, **options), tmp_path / "run.nc")
    contents = [read_sealed(path), b"", b"PK\x03\x04", b"\x93NUMPY", b'{"identity": 3}']
    for content in contents:
        write_sealed(path, content)
        with pytest.raises(ValueError, match=r"run\.nc: not a checkpoint"):
            simulate(chain, checkpoint=path, **options)
        assert read_sealed(path) == content
    with pytest.raises(ValueError, match="a folder"):
        simulate(chain, checkpoint=tmp_path, **options)


def test_a_checkpoint_without_a_part_is_refused(tmp_path):
    chain, options = Chain(size=2), {"duration": 200.0, "progress": False}
    path = tmp_path / "state"
    simulate(chain, checkpoint=path, **options)
    whole = dict(np.load(io.BytesIO(read_sealed(path))))
    for missing in ("0/y", "0/noise lanes", "0/noise taken", "0/observer 0 sums"):
        buffer = io.BytesIO()
        np.savez(buffer, **{name: value for name, value in whole.items() if name != missing})
        write_sealed(path, buffer.getvalue())
        with pytest.raises(ValueError, match="without a part of the run"):
            simulate(chain, checkpoint=path, **options)


def test_a_checkpoint_of_other_source_code_is_refused(tmp_path, monkeypatch):
    """An edited kernel would continue the run to numbers of which half are the old one's."""
    arguments = {"duration": 500, "progress": False, "checkpoint": tmp_path / "state"}
    with monkeypatch.context() as patched:
        patched.setattr(checkpoint, "_SOURCE", "before the edit")
        before = simulate(Chain(size=10), **arguments)
    with pytest.raises(ValueError, match="that other source code of crazybilliards has written"):
        simulate(Chain(size=10), **arguments)
    (tmp_path / "state").unlink()
    xr.testing.assert_identical(simulate(Chain(size=10), **arguments), before)
