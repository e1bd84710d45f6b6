"""Two processes in one place: the second is refused, and a dead one holds up nobody.

A checkpoint and what a command writes to belong to one process at a time. Real processes hold them
here, are stopped and killed.
"""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager

import pytest
import xarray as xr
from killed import PATIENCE, begin, end, members, until

from crazybilliards.model import Chain
from crazybilliards.particles import simulate

COMMAND = [sys.executable, "-c", "from crazybilliards.apps.commands.line import main; main()"]
GRID = """
[grid]
size = [4, 10, 30]
[simulate]
duration = 1e7
"""


@contextmanager
def holding(path, job):
    """Start a process that writes this file, wait for the file, and kill it at the end."""
    child = begin(job, path.parent)
    try:
        until(lambda: path.exists() and path.stat().st_size)
        yield child
    finally:
        if members(child):
            end(child, signal.SIGKILL, group=True)


def test_a_second_run_on_a_checkpoint_is_refused_until_the_first_is_dead(tmp_path):
    state, chain = tmp_path / "work" / "state", Chain(size=30)
    endless = {"duration": 1e9, "progress": False, "checkpoint": state}
    with holding(state, lambda _: simulate(chain, **endless)) as holder:
        for how in (signal.SIGSTOP, signal.SIGCONT):  # one that hangs is not waited for
            os.kill(holder, how)
            with pytest.raises(BlockingIOError, match=f"in use by process {holder} on .*state"):
                simulate(chain, **endless)
    with pytest.raises(ValueError, match="remove the file to start anew"):  # not of this run
        simulate(chain.replace(size=31), **endless)
    state.unlink()
    short = {"duration": 2000.0, "progress": False}
    undisturbed = simulate(chain, **short)
    xr.testing.assert_identical(simulate(chain, **short, checkpoint=state), undisturbed)
    assert [path.name for path in state.parent.iterdir()] == ["state"]


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
    command = [sys.executable, "-c", CONTENDER, str(tmp_path)]
    contenders = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(4)]
    entered = [int(each.communicate(timeout=PATIENCE)[0]) for each in contenders]
    print(f"{sum(entered)} times inside, {4000 - sum(entered)} times refused")
    assert all(each.returncode == 0 for each in contenders)
    assert list(tmp_path.iterdir()) == []
