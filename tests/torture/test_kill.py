"""Kills: whatever ends a run, the same call goes on and ends with the bits of an undisturbed run.

Each of four jobs, `simulate` with a checkpoint and the commands `sweep`, `reproduce` and `compare`,
is killed at random moments by SIGKILL, SIGTERM or Ctrl-C (SIGINT to the whole process group): ten
kills in a row, the same call after each, and then to the end, ten times over. After every kill each
file is whole or has a name that says that it is none, and no process is left; in the end the files
are those of an undisturbed run and no others. A fifth job does nothing but write.

Importing and compiling would take most of the time. So this process has done both, and each
attempt is a fork of it; workers are forked, too. `test_kill_commands.py` kills the real commands.
"""

import multiprocessing
import os
import re
import signal
import sys
import threading
import time
import traceback
import warnings
from functools import partial
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from tqdm import tqdm

from crazybilliards.apps.commands.line import main
from crazybilliards.model import Chain, load, save
from crazybilliards.model.storage import read_sealed, write_sealed
from crazybilliards.particles import simulate
from crazybilliards.reproduction import figures
from crazybilliards.reproduction.figures import fig01_model, fig16_arctanh, fig17_density

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="forks, reads /proc")

SEQUENCES, KILLS = 10, 10  # one after another, and in a row
PATIENCE = 600.0  # for what must come to an end
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
GRID = """
[grid]
size = [4, 10]
restitution = [0.5, 1.0]
[simulate]
duration = 300
"""


# -- the jobs ---------------------------------------------------------------------------------


def simulated(folder):
    """Write the checkpoint as often as possible."""
    chain = Chain(size=40, restitution=0.9, gap=0.1)
    observe = ("widths", "density", "energy")
    arguments = {"duration": 3000.0, "replicas": 3, "observe": observe, "progress": False}
    run = simulate(chain, **arguments, checkpoint=folder / "state", checkpoint_interval=0)
    if run.attrs["status"] == "completed":
        save(run, folder / "run.nc")


def swept(folder):
    grid = folder.parent / "grid.toml"
    grid.write_text(GRID)
    command("sweep", grid, "--output", folder, "--processes", "2")


def reproduced(folder):
    command("reproduce", "all", "--output", folder, "--processes", "2")


def compared(folder):
    arguments = ("--size", "10", "--duration", "1000", "--amplitudes", "1,2,5", "--threads", "1")
    command("compare", *arguments, "--output", folder)


def written(folder):
    """Write one of two results over the other for ever, to a slow disk."""
    os.fsync = lambda descriptor: time.sleep(0.02)
    while True:
        for content in CONTENTS:
            write_sealed(folder / "run.nc", content)


def command(*arguments):
    sys.argv = ["crazybilliards", *map(str, arguments)]
    main()


@pytest.fixture(scope="module", autouse=True)
def prepared():
    """Import and compile everything; two cheap figures stand for all."""
    # The lock of the progress bars is one semaphore of all forks. A kill that comes while it is
    # held would stop all later attempts. A lock of threads belongs to one process.
    tqdm.set_lock(threading.RLock())
    mpl.use("Agg")
    mpl.pyplot.close(mpl.pyplot.figure())
    for restitution in (0.9, 1.0):
        simulate(Chain(size=5, restitution=restitution), duration=200, progress=False)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(figures, "FIGURES", (fig01_model.FIGURE, fig16_arctanh.FIGURE))
        patch.setattr(fig17_density, "_DURATION", 5000.0)
        yield


# -- attempts ---------------------------------------------------------------------------------


def begin(job, folder):
    """Fork a process that does the job, in a session of its own; return its number."""
    folder.mkdir(exist_ok=True)
    ready, begun = os.pipe()
    # The child has to be able to catch Ctrl-C before it may come.
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads: those of linear algebra
        child = os.fork()
    if child == 0:
        code = 70
        try:
            code = _attempt(job, folder, begun)
        except SystemExit as error:
            code = error.code or 0
        except KeyboardInterrupt:
            code = 130
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(code)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    os.close(begun)
    assert os.read(ready, 1) == b"!"
    os.close(ready)
    return child


def _attempt(job, folder, begun):
    os.setsid()
    log = os.open(folder.parent / "log.txt", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    for stream in (1, 2):
        os.dup2(log, stream)
    sys.stdout = sys.stderr = os.fdopen(log, "w", buffering=1)
    fork = multiprocessing.get_context("fork")
    multiprocessing.get_context = lambda name: fork
    # A worker that is started anew has none of the handlers of its parent; a forked one would.
    for number in (signal.SIGTERM, signal.SIGHUP):
        os.register_at_fork(after_in_child=partial(signal.signal, number, signal.SIG_DFL))
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    os.write(begun, b"!")
    job(folder)
    return 0


def end(child, how=None, group=False):
    """Send it a signal; wait until it and all its workers are gone; return its exit status."""
    if how is not None:
        (os.killpg if group else os.kill)(child, how)
    deadline = time.monotonic() + PATIENCE
    done = 0
    while not done:
        done, status = os.waitpid(child, os.WNOHANG)
        assert time.monotonic() < deadline, f"{how} did not end it"
        time.sleep(0.002)
    leave_nobody(child)
    return os.waitstatus_to_exitcode(status)


def leave_nobody(session):
    """Wait until no process of a session is left."""
    deadline = time.monotonic() + PATIENCE
    while left := members(session):
        assert time.monotonic() < deadline, f"there are still {left}"
        time.sleep(0.002)


def members(session):
    """Return the living processes of a session."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            number, rest = path.read_text().split(" (", 1)
        except OSError:
            continue  # it has just ended
        state, _, _, own = rest.rpartition(") ")[2].split()[:4]
        if int(own) == session and state not in "ZX":
            found.append(int(number))
    return found


# -- what is in a folder ----------------------------------------------------------------------


def contents(folder):
    """Read every file that counts as a result; raises if one is torn."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_dir() or (path.name[0] == "." and path.name.endswith((".part", ".lock"))):
            continue
        if path.suffix == ".nc":
            found[name] = load(path)
            found[name].attrs.pop("seconds", None)  # computing time
        else:
            content = read_sealed(path) if name == "state" else path.read_bytes()
            found[name] = re.sub(rb"\d+ s of computing", b"", content)
    return found


def check(found, undisturbed):
    """Compare whatever there is with an undisturbed run; what is interrupted says so."""
    for name, content in found.items():
        if "-interrupted" in name:
            assert name.endswith(".png") or content.attrs["status"] == "interrupted"
        elif name.endswith(".nc"):
            assert content.identical(undisturbed[name])
        elif name != "state":
            assert content == undisturbed[name], name


# -- promises ---------------------------------------------------------------------------------


@pytest.mark.parametrize("job", [simulated, swept, reproduced, compared])
def test_killed_at_random_moments_it_ends_with_the_bits_of_an_undisturbed_run(job, tmp_path):
    clean = tmp_path / "undisturbed" / "results"
    clean.parent.mkdir()
    start = time.monotonic()
    assert end(begin(job, clean)) == 0
    duration = time.monotonic() - start
    undisturbed = contents(clean)
    # What a run has done helps the next ones: ten of them together may last as long as three.
    latest = 3 * duration / KILLS
    generator = np.random.default_rng(len(job.__name__))
    running = 0
    for sequence in range(SEQUENCES):
        folder = tmp_path / str(sequence) / "results"
        folder.parent.mkdir()
        for _ in range(KILLS):
            child = begin(job, folder)
            time.sleep(generator.uniform(0, latest))
            how = SIGNALS[generator.integers(3)]
            running += bool(members(child))
            end(child, how, group=how == signal.SIGINT or generator.random() < 0.5)
            check(contents(folder), undisturbed)
        assert end(begin(job, folder)) == 0
        check(contents(folder), undisturbed)
        final = {path.name for path in folder.rglob("*") if "-interrupted" not in path.name}
        assert final == {path.name for path in clean.rglob("*")}
        assert "Traceback" not in (folder.parent / "log.txt").read_text()
    print(
        f"{job.__name__}: {running} of {SEQUENCES * KILLS} kills found it running {duration:.1f} s"
    )
    assert running > SEQUENCES * KILLS / 2


CONTENTS = []  # what is written


def test_killed_while_writing_it_leaves_the_old_file_or_the_new_one(tmp_path):
    results = [simulate(Chain(size=size), duration=200, progress=False) for size in (3, 30)]
    CONTENTS[:] = [bytes(each.to_netcdf(engine="h5netcdf")) for each in results]
    folder = tmp_path / "results"
    generator = np.random.default_rng(5)
    unfinished = 0
    for _ in range(SEQUENCES * KILLS):
        child = begin(written, folder)
        time.sleep(generator.uniform(0, 0.3))
        end(child, signal.SIGKILL)
        names = {path.name for path in folder.iterdir()}
        assert names <= {"run.nc", ".run.nc.part"}
        unfinished += ".run.nc.part" in names
        if "run.nc" in names:
            assert any(load(folder / "run.nc").identical(each) for each in results)
    assert "Traceback" not in (tmp_path / "log.txt").read_text()
    save(results[0], folder / "run.nc")
    assert [path.name for path in folder.iterdir()] == ["run.nc"]
    print(f"{unfinished} of {SEQUENCES * KILLS} kills left an unfinished file")
    assert unfinished > 0
