"""Locks: one at a time, freed by any death, and no hindrance where there are none."""

import errno
import os
import signal
import subprocess
import sys
import threading

import pytest

from crazybilliards.model.locks import locked

fcntl = pytest.importorskip("fcntl")  # not on Windows

HOLDER = """
import sys, time
from pathlib import Path
from crazybilliards.model.locks import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(1000)
"""


@pytest.mark.parametrize("name", ["folder", "state"])
def test_another_process_holds_it_until_it_dies_even_if_it_hangs(name, tmp_path):
    path = tmp_path / name
    if name == "folder":
        path.mkdir()
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(path)], stdout=subprocess.PIPE, text=True
    ) as holder:
        assert holder.stdout.readline() == "held\n"
        holder.send_signal(signal.SIGSTOP)
        reason = rf"in use by process {holder.pid} on .*; wait .*{name}"
        with pytest.raises(BlockingIOError, match=reason), locked(path):
            pass
        holder.kill()
        holder.wait()
    [left] = tmp_path.rglob(".*.lock") if name == "state" else path.iterdir()
    with locked(path):
        assert left.read_text().strip().startswith(f"process {os.getpid()} on ")
    assert not left.exists()


def test_another_thread_is_refused_as_well(tmp_path):
    refused = []

    def work():
        try:
            with locked(tmp_path):
                pass
        except BlockingIOError as error:
            refused.append(error)

    with locked(tmp_path):
        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
    assert len(refused) == 1


def test_where_there_are_no_locks_work_goes_on(tmp_path, monkeypatch):
    def flock(descriptor, operation):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", flock)
    with locked(tmp_path), locked(tmp_path):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_lock_that_its_holder_removes_meanwhile_is_made_anew(tmp_path, monkeypatch):
    """Between opening and locking the file, its former holder may have gone."""
    flock, lock = fcntl.flock, tmp_path / ".lock"

    def late(descriptor, operation):
        monkeypatch.setattr(fcntl, "flock", flock)
        lock.unlink()
        flock(descriptor, operation)

    monkeypatch.setattr(fcntl, "flock", late)
    with locked(tmp_path):
        assert lock.exists()
        with pytest.raises(BlockingIOError), locked(tmp_path):
            pass


def test_no_room_for_it_is_an_error_that_names_it(tmp_path, monkeypatch):
    def write(descriptor, content):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "write", write)
    with pytest.raises(OSError, match=r"No space left on device: '.*\.lock'"), locked(tmp_path):
        pass
    assert list(tmp_path.iterdir()) == []


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


@pytest.mark.torture
def test_never_are_two_inside(tmp_path):
    """The lock file is made and removed all the time, which must let nobody slip in."""
    command = [sys.executable, "-c", CONTENDER, str(tmp_path)]
    contenders = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(4)]
    entered = [int(each.communicate(timeout=600)[0]) for each in contenders]
    print(f"{sum(entered)} times inside, {4000 - sum(entered)} times refused")
    assert all(each.returncode == 0 for each in contenders)
    assert list(tmp_path.iterdir()) == []
