"""Two processes in one place: the second is refused, and a dead one holds up nobody.

A checkpoint and what a command writes to belong to one process at a time. Real processes hold them
here, are stopped and killed.
"""

import os
import signal
import subprocess
import sys
import time

import pytest
import xarray as xr

from crazybilliards.model import Chain
from crazybilliards.particles import simulate

COMMAND = [sys.executable, "-c", "from crazybilliards.apps.commands.line import main; main()"]
PATIENCE = 600.0
GRID = """
[grid]
size = [4, 10, 30]
[simulate]
duration = 1e7
"""
LONG = """
import sys
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
simulate(Chain(size=30), duration=1e9, progress=False, checkpoint=sys.argv[1])
"""


@pytest.fixture
def first():
    """Start a process that is killed at the end, and wait for a file it writes."""
    started = []

    def start(path, *command):
        started.append(
            subprocess.Popen(
                command,
                start_new_session=True,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        )
        deadline = time.monotonic() + PATIENCE
        while not (path.exists() and path.stat().st_size):
            assert time.monotonic() < deadline
            assert started[0].poll() is None
            time.sleep(0.05)
        return started[0]

    yield start
    for process in started:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def test_a_second_run_on_a_checkpoint_is_refused_until_the_first_is_dead(first, tmp_path):
    state = tmp_path / "state"
    holder = first(state, sys.executable, "-c", LONG, str(state))
    arguments = {"duration": 1e9, "progress": False, "checkpoint": state}
    for how in (signal.SIGSTOP, signal.SIGCONT):  # one that hangs is refused to, not waited for
        os.kill(holder.pid, how)
        with pytest.raises(BlockingIOError, match=f"in use by process {holder.pid} on .*state"):
            simulate(Chain(size=30), **arguments)
    holder.kill()
    holder.wait()
    with pytest.raises(ValueError, match="remove the file to start anew"):  # not of this run
        simulate(Chain(size=31), **arguments)
    state.unlink()
    short = {"duration": 2000.0, "progress": False}
    undisturbed = simulate(Chain(size=30), **short)
    xr.testing.assert_identical(simulate(Chain(size=30), **short, checkpoint=state), undisturbed)
    assert [path.name for path in tmp_path.iterdir()] == ["state"]


@pytest.mark.parametrize(
    ("what", "other"),
    [
        (["sweep", "grid.toml", "--processes", "1"], ["--processes", "2"]),
        (["reproduce", "all", "--processes", "1"], ["--processes", "2"]),
        (["compare", "--duration", "1e9"], ["--size", "3"]),
        (["relax", "--replicas", "100000"], ["--size", "3"]),
    ],
    ids=lambda what: what[0],
)
def test_a_second_command_in_a_folder_is_refused_and_overwrites_nothing(
    what, other, first, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "grid.toml").write_text(GRID)
    folder = tmp_path / "results"
    arguments = [*what, "--output", str(folder)]
    holder = first(folder / ".lock", *COMMAND, *arguments)
    for second in (arguments, [*arguments, *other]):
        done = subprocess.run(
            [*COMMAND, *second], capture_output=True, text=True, timeout=PATIENCE, check=False
        )
        assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
        assert f"error: {folder}: in use by process {holder.pid}" in done.stderr
    assert holder.poll() is None


CONTENDER = """
import os, sys
from pathlib import Path
from crazybilliards.model.locks import locked
folder, entered = Path(sys.argv[1]), 0
for _ in range(1000):
    try:
        with locked(folder):
            os.close(os.open(folder / "inside", os.O_CREAT | os.O_EXCL))
            os.unlink(folder / "inside")
            entered += 1
    except BlockingIOError:
        pass
print(entered)
"""


def test_never_are_two_inside(tmp_path):
    """The lock file is made and removed all the time, which must let nobody slip in."""
    contenders = [
        subprocess.Popen(
            [sys.executable, "-c", CONTENDER, str(tmp_path)], stdout=subprocess.PIPE, text=True
        )
        for _ in range(4)
    ]
    entered = [int(each.communicate(timeout=PATIENCE)[0]) for each in contenders]
    print(f"{sum(entered)} times inside, {4000 - sum(entered)} times refused")
    assert all(each.returncode == 0 for each in contenders)
    assert list(tmp_path.iterdir()) == []
