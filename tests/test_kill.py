"""Kills: whatever ends a run, the same call goes on and ends with the bits of an undisturbed run.

Each job is killed at random moments by SIGKILL, SIGTERM or Ctrl-C (SIGINT to the whole process
group): some kills in a row, the same call after each, and then to the end, some times over. After
every kill each file is whole or has a name that says that it is none, and no process is left. In
the end the files are those of an undisturbed run and no others.
"""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from typing import NamedTuple

import matplotlib as mpl
import numpy as np
import pytest
from killed import begin, contents, end, members, require_same, until
from small_sweeps import missing_cases
from tqdm import tqdm

from crazybilliards.apps.commands.line import main
from crazybilliards.comparison import load_sweep
from crazybilliards.comparison.sweeps import read_sweep
from crazybilliards.model import Chain, load, save
from crazybilliards.model.storage import write_sealed
from crazybilliards.particles import simulate
from crazybilliards.reproduction.figures import elastic

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="forks, reads /proc"),
    pytest.mark.compiled,
]
torture = pytest.mark.torture

MAIN = """
import faulthandler, signal
faulthandler.register(signal.SIGUSR1)
from crazybilliards.apps.commands.line import main
main()
"""
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
GRID = """
[grid]
size = [4, 10]
restitution = [0.5, 1.0]
[simulate]
duration = 300
"""
# It takes a minute, of cases that take a third of a second each.
LONG_GRID = f"""
[grid]
seed = {list(range(200))}
[chain]
size = 20
[simulate]
duration = 5e4
"""


def simulated(function, chain, **settings):
    """Return a job that writes its checkpoint as often as possible."""

    def job(folder):
        state = {"checkpoint": folder / "state", "checkpoint_interval": 0}
        run = function(chain, progress=False, **settings, **state)
        if run.attrs["status"] == "completed":
            save(run, folder / "run.nc")

    return job


def command(*arguments, real=False):
    """Return a job that is a command, in the forked process or as a program of its own."""

    def job(folder):
        os.chdir(folder.parent)
        own = [*arguments, "--output", str(folder)]
        if real:
            os.execv(sys.executable, [sys.executable, "-c", MAIN, *own])
        sys.argv = ["crazybilliards", *own]
        main()

    return job


@pytest.fixture(scope="module", autouse=True)
def prepared():
    """Import and compile everything."""
    # The lock of the progress bars is one semaphore of all forks. A kill that comes while it is
    # held would stop all later attempts. A lock of threads belongs to one process.
    tqdm.set_lock(threading.RLock())
    mpl.pyplot.close(mpl.pyplot.figure())
    for restitution in (0.9, 1.0):
        simulate(Chain(size=5, restitution=restitution), duration=200, progress=False)
    with pytest.MonkeyPatch.context() as patch:
        for runs in elastic._RUNS.values():
            patch.setitem(runs.effort, "quick", (1, {"duration": 5000.0}))
        yield


class Killed(NamedTuple):
    """A job, and how often it is killed: in a row, one after another, and until when."""

    job: Callable
    kills: int
    sequences: int = 1

    def latest(self, duration):
        """Return the last moment of a kill: together they may last as long as three runs.

        What a run has done helps the next ones.
        """
        return duration * min(3 / self.kills, 1)


ALL = {"observe": ("widths", "density", "energy", "velocities")}
INELASTIC = Chain(size=40, restitution=0.9, gap=0.1)
COMPARE = ("compare", "--size", "10", "--duration", "1000", "--amplitude", "1,2,5")
RUN = simulated(simulate, INELASTIC, duration=3000.0, replicas=3, **ALL)
ELASTIC = simulated(simulate, INELASTIC.replace(restitution=1.0), duration=2e4, replicas=3, **ALL)
JOBS = {
    "simulate": (Killed(ELASTIC, 3), pytest.mark.validate),
    "simulate, e < 1": (Killed(RUN, 3), ()),
    "simulate, often": (Killed(RUN, 10, 10), torture),
    "sweep": (Killed(command("sweep", "grid.toml", "--processes", "2"), 10, 10), torture),
    "reproduce": (Killed(command("reproduce", "1,16", "--processes", "2"), 10, 10), torture),
    "compare": (Killed(command(*COMPARE, "--threads", "1"), 10, 10), torture),
    # Start-up and workers included.
    "real sweep": (
        Killed(command("sweep", "grid.toml", "--processes", "2", real=True), 3),
        torture,
    ),
    "real reproduce": (
        Killed(command("reproduce", "16", "--processes", "2", real=True), 3),
        torture,
    ),
    "real compare": (Killed(command(*COMPARE, real=True), 3), torture),
}


@pytest.mark.parametrize(
    ("name", "killed"),
    [pytest.param(name, each, marks=marks, id=name) for name, (each, marks) in JOBS.items()],
)
def test_killed_at_random_moments_it_ends_with_the_bits_of_an_undisturbed_run(
    name, killed, tmp_path
):
    def place(part):
        (tmp_path / part).mkdir()
        (tmp_path / part / "grid.toml").write_text(GRID)
        return tmp_path / part / "results"

    start, clean = time.monotonic(), place("undisturbed")
    assert end(begin(killed.job, clean)) == 0
    duration = time.monotonic() - start
    undisturbed, generator, running = contents(clean), np.random.default_rng(len(name)), 0
    for sequence in range(killed.sequences):
        folder = place(str(sequence))
        for number in range(killed.kills):
            child = begin(killed.job, folder)
            time.sleep(generator.uniform(0, killed.latest(duration)))
            how = SIGNALS[number % 3]
            running += bool(members(child))
            end(child, how, group=how == signal.SIGINT or generator.random() < 0.5)
            require_same(contents(folder), undisturbed)
        assert end(begin(killed.job, folder)) == 0
        require_same(contents(folder), undisturbed)
        left = ("-interrupted.", ".part")
        final = {path.name for path in folder.rglob("*") if not any(map(path.name.count, left))}
        assert final == {path.name for path in clean.rglob("*")}
        # Imports that Ctrl-C ends say where.
        if not name.startswith("real"):
            assert "Traceback" not in (folder.parent / "log.txt").read_text()
    every = killed.sequences * killed.kills
    print(f"{name}: {running} of {every} kills found it running {duration:.1f} s")
    assert every < 10 or running >= every / 3  # a few may all come too late


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGKILL"])
def test_a_sweep_that_is_killed_keeps_what_is_finished_and_leaves_no_workers(name, tmp_path):
    number = getattr(signal, name)
    (tmp_path / "grid.toml").write_text(LONG_GRID)
    folder = tmp_path / "results"
    child = begin(command("sweep", "grid.toml", "--processes", "2", real=True), folder)
    until(lambda: list(folder.glob("*.nc")))
    assert len(members(child)) > 1
    ended = {"SIGINT": -number, "SIGTERM": 128 + number, "SIGKILL": -number}
    assert end(child, number) == ended[name]
    said = (tmp_path / "log.txt").read_text()
    assert said.count("interrupted") == (name != "SIGKILL")
    assert name == "SIGKILL" or not {"Traceback", "leaked"} & {*said.split()}
    cases = read_sweep(tmp_path / "grid.toml").cases()
    assert 0 < len(missing_cases(cases, folder)) < len(cases)
    assert load_sweep(folder).status.size >= 1


@torture
def test_killed_while_writing_it_leaves_the_old_file_or_the_new_one(tmp_path):
    results = [simulate(Chain(size=size), duration=200, progress=False) for size in (3, 30)]
    stored = [bytes(each.to_netcdf(engine="h5netcdf")) for each in results]

    def written(folder):
        """Write one of two results over the other for ever, to a slow disk."""
        os.fsync = lambda descriptor: time.sleep(0.02)
        while True:
            for content in stored:
                write_sealed(folder / "run.nc", content)

    folder, generator = tmp_path / "results", np.random.default_rng(5)
    for _ in range(100):
        child = begin(written, folder)
        time.sleep(generator.uniform(0, 0.3))
        end(child, signal.SIGKILL)
        if (folder / "run.nc").exists():
            assert any(load(folder / "run.nc").identical(each) for each in results)
    assert "Traceback" not in (tmp_path / "log.txt").read_text()
    names = {path.name for path in folder.iterdir()} - {"run.nc"}
    print(f"{len(names)} of 100 kills left an unfinished file")
    assert names
    assert all(name.startswith(".run.nc.") and name.endswith(".part") for name in names)
