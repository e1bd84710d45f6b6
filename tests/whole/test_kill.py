"""Kills: whatever ends a run, the same call goes on and ends with the bits of an undisturbed run.

Each job is killed at random moments by SIGKILL, SIGTERM or Ctrl-C (SIGINT to the whole process
group): some kills in a row, the same call after each, and then to the end, some times over. After
every kill each file is whole or has a name that says that it is none, and no process is left. In
the end the files are those of an undisturbed run and no others.
"""

import os
import re
import signal
import sys
import threading
import time

import matplotlib as mpl
import numpy as np
import pytest
from forked import begin, command, end, members, until
from small_sweeps import missing_cases
from tqdm import tqdm

from crazybilliards.comparison import load_sweep
from crazybilliards.comparison.sweeps import read_sweep
from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain, load, save
from crazybilliards.model.storage import read_sealed
from crazybilliards.particles import simulate
from crazybilliards.reproduction.figures import elastic

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="forks many threads"),
    pytest.mark.compiled,
    pytest.mark.validate,
]
torture = pytest.mark.torture

MAIN = "from crazybilliards.apps.commands.line import main; main()"
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
GRID = """
[grid]
size = [4, 10]
restitution = [0.5, 1.0]
[simulate]
duration = 300
"""
# It takes a quarter of a minute, of cases that take a tenth of a second each.
LONG_GRID = f"""
[grid]
seed = {list(range(200))}
[chain]
size = 20
[simulate]
duration = 1e4
"""
ALL = {"observe": ("widths", "density", "energy", "velocities"), "replicas": 3}
CHAIN = Chain(size=40, restitution=0.9, gap=0.1)


def simulated(duration):
    """Return a job that writes its checkpoint as often as possible."""

    def job(folder):
        state = {"checkpoint": folder / "state", "checkpoint_interval": 0}
        run = simulate(CHAIN, duration=duration, progress=False, **ALL, **state)
        if run.attrs["status"] == "completed":
            save(run, folder / "run.nc")

    return job


def written(folder):
    """Write a result over itself, to a slow disk."""
    result = equilibrium(Chain(size=30))
    os.fsync = lambda descriptor: time.sleep(0.02)
    for _ in range(30):
        save(result, folder / "result.nc")


def called(line, real=False):
    """Return a job that is a command, in the forked process or as a program of its own."""

    def job(folder):
        os.chdir(folder.parent)
        own = [*line.split(), "--output", str(folder)]
        if real:
            os.execv(sys.executable, [sys.executable, "-c", MAIN, *own])
        command(*own)()

    return job


SWEEP, REPRODUCE = "sweep grid.toml --processes 2", "reproduce 1,16 --processes 2"
COMPARE = "compare --size 10 --duration 1000 --amplitude 1,2,5 --threads 1"
# A job, how often it is killed in a row, how many rows there are, and which run they are part of.
JOBS = {
    "simulate": (simulated(1500.0), 3, 1, ()),
    "simulate, often": (simulated(3000.0), 10, 10, torture),
    "save": (written, 10, 10, torture),
    "sweep": (called(SWEEP), 10, 10, torture),
    "reproduce": (called(REPRODUCE), 10, 10, torture),
    "compare": (called(COMPARE), 10, 10, torture),
    # Start-up and workers included.
    "real sweep": (called(SWEEP, real=True), 3, 1, torture),
    "real reproduce": (called(REPRODUCE, real=True), 3, 1, torture),
    "real compare": (called(COMPARE, real=True), 3, 1, torture),
}


@pytest.fixture(scope="module", autouse=True)
def prepared():
    """Import and compile everything."""
    # The lock of the progress bars is one semaphore of all forks. A kill that comes while it is
    # held would stop all later attempts. A lock of threads belongs to one process.
    for bars in (kinds := [tqdm]):
        bars.set_lock(threading.RLock())
        kinds += bars.__subclasses__()
    mpl.pyplot.close(mpl.pyplot.figure())
    simulate(Chain(size=5, restitution=0.9), duration=200, progress=False)
    with pytest.MonkeyPatch.context() as patch:
        for runs in elastic._RUNS.values():
            patch.setitem(runs.effort, "quick", (1, {"duration": 5000.0}))
        yield


def contents(folder):
    """Read every file that counts as a result; raises if one is torn."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_dir() or (path.name[0] == "." and path.name.endswith((".part", ".lock"))):
            continue
        if path.suffix == ".nc":
            found[name] = load(path)
        else:
            content = read_sealed(path) if name == "state" else path.read_bytes()
            found[name] = re.sub(rb"\d+ s of computing", b"", content)
    return found


def require_same(found, undisturbed):
    """Compare whatever there is with an undisturbed run; what is interrupted says so."""
    for name, content in found.items():
        if "-interrupted" in name:
            assert name.endswith(".png") or content.attrs["status"] == "interrupted"
        elif name.endswith(".nc"):
            assert content.identical(undisturbed[name])
        elif name != "state":
            assert content == undisturbed[name], name


class Place:
    """A folder with a grid, its results and what was said."""

    def __init__(self, folder, grid):
        self.results, self.log = folder / "results", folder / "log.txt"
        self.results.mkdir(parents=True)
        (folder / "grid.toml").write_text(grid)

    def begin(self, job):
        with self.log.open("a") as log:
            return begin(lambda: job(self.results), log, log)


@pytest.mark.parametrize(
    ("name", "job", "kills", "rows"),
    [pytest.param(name, *how, marks=marks, id=name) for name, (*how, marks) in JOBS.items()],
)
def test_killed_at_random_moments_it_ends_with_the_bits_of_an_undisturbed_run(
    name, job, kills, rows, tmp_path
):
    start, clean = time.monotonic(), Place(tmp_path / "undisturbed", GRID)
    assert end(clean.begin(job)) == 0
    duration = time.monotonic() - start
    latest = duration * min(3 / kills, 1)  # what a run has done helps the next ones
    undisturbed = contents(clean.results)
    generator, running = np.random.default_rng(len(name)), 0
    for row in range(rows):
        place = Place(tmp_path / str(row), GRID)
        for number in range(kills):
            child = place.begin(job)
            time.sleep(generator.uniform(0, latest))
            how = SIGNALS[number % 3]
            running += bool(members(child))
            end(child, how, group=how == signal.SIGINT or generator.random() < 0.5)
            require_same(contents(place.results), undisturbed)
        assert end(place.begin(job)) == 0
        require_same(contents(place.results), undisturbed)
        left = ("-interrupted.", ".part")
        files = {path.name for path in place.results.rglob("*")}
        final = {name for name in files if not any(map(name.count, left))}
        assert final == {path.name for path in clean.results.rglob("*")}
        # Imports that Ctrl-C ends say where, and which error they were about to handle.
        log = place.log.read_text()
        tracebacks = log.count("Traceback (") - log.count("\nDuring handling of")
        assert name.startswith("real") or tracebacks == log.count("\nKeyboardInterrupt")
    every = rows * kills
    print(f"{name}: {running} of {every} kills found it running {duration:.1f} s")
    assert every < 10 or running >= every / 3  # a few may all come too late


SCRIPT = """
from crazybilliards.comparison.sweeps import process_pool, read_sweep, run_cases
with process_pool(2) as pool:
    run_cases(read_sweep("grid.toml"), "results", pool)
"""


def script(folder):
    """Sweep by a script, which needs no guard of its main part."""
    os.chdir(folder.parent)
    (folder.parent / "script.py").write_text(SCRIPT)
    os.execv(sys.executable, [sys.executable, "script.py"])


ENDED = {signal.SIGINT: called("sweep grid.toml --processes 1", real=True), signal.SIGKILL: script}


@pytest.mark.parametrize("number", ENDED, ids=lambda number: number.name)
def test_a_sweep_that_is_killed_keeps_what_is_finished_and_leaves_no_workers(number, tmp_path):
    place = Place(tmp_path, LONG_GRID)
    child = place.begin(ENDED[number])
    until(lambda: list(place.results.glob("*.nc")))
    assert len(members(child)) > 1
    assert end(child, number) == -number
    said = place.log.read_text()
    assert said.count("interrupted") == (number != signal.SIGKILL)
    assert number == signal.SIGKILL or not {"Traceback", "leaked"} & {*said.split()}
    cases = read_sweep(tmp_path / "grid.toml").cases()
    assert 0 < len(missing_cases(cases, place.results)) < len(cases)
    assert load_sweep(place.results).status.size >= 1
