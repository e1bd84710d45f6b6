"""Locks: one process at a time, and a dead one blocks nobody."""

import signal
import subprocess
import sys

import pytest

from crazybilliards.model.storage import locked

HOLDER = """
import sys, time
from pathlib import Path
from crazybilliards.model.storage import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600)
"""


@pytest.mark.posix
@pytest.mark.parametrize("name", ["state", "folder"])
def test_a_lock_is_held_until_its_process_ends_however_it_ends(name, tmp_path):
    path = tmp_path / name
    if name == "folder":
        path.mkdir()
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(path)], stdout=subprocess.PIPE, text=True
    ) as holder:
        assert holder.stdout.readline() == "held\n"
        holder.send_signal(signal.SIGSTOP)
        with pytest.raises(BlockingIOError, match=f"in use by another process.*{name}"):
            locked(path).__enter__()
        holder.kill()
        holder.wait()
    with locked(path):
        pass
    assert list(tmp_path.rglob("*.lock")) == []


CONTENDER = """
import os, sys
from pathlib import Path
from crazybilliards.model.storage import locked
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


@pytest.mark.torture
def test_never_are_two_inside(tmp_path):
    """The lock file is made and removed all the time, which must let nobody slip in."""
    command = [sys.executable, "-c", CONTENDER, str(tmp_path)]
    contenders = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(4)]
    entered = [int(each.communicate(timeout=600)[0]) for each in contenders]
    print(f"{sum(entered)} times inside, {4000 - sum(entered)} times refused")
    assert all(each.returncode == 0 for each in contenders)
    assert list(tmp_path.iterdir()) == []
