"""Sweeps on every executor: the same results, nothing lost to the death of a worker."""

import os
import signal
import subprocess
import sys
import threading
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context

import loky
import psutil
import pytest
from killed import until
from small_sweeps import missing_cases, sweep

from crazybilliards.comparison.sweeps import Case, process_pool, run_cases
from crazybilliards.model import Chain

QUIET = {"progress": False}
pytestmark = pytest.mark.compiled


@contextmanager
def dask():
    """Start a dask cluster of this machine, whose workers take seconds to start."""
    from distributed import Client, LocalCluster

    one = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with LocalCluster(**one) as cluster, Client(cluster, set_as_default=False) as client:
        yield client.get_executor()


EXECUTORS = {
    "processes": lambda: process_pool(2),
    "threads": lambda: ThreadPoolExecutor(2),
    "standard library": lambda: ProcessPoolExecutor(1, get_context("spawn")),
    "loky": lambda: loky.ProcessPoolExecutor(1),
    "dask": dask,
}


@pytest.mark.parametrize(
    "name",
    [
        "processes",
        "threads",
        *(pytest.param(each, marks=pytest.mark.validate) for each in [*EXECUTORS][2:]),
    ],
)
def test_every_executor_gives_the_same_results(name, tmp_path):
    cases = sweep().cases()
    assert run_cases(cases, tmp_path / "here", **QUIET) == {}
    with EXECUTORS[name]() as executor:
        assert run_cases(cases, tmp_path / "there", executor, **QUIET) == {}
    for case in cases:
        assert case.load(tmp_path / "here").identical(case.load(tmp_path / "there"))


LONG = [Case("simulate", Chain(size=20), {"duration": 20_000, "seed": seed}) for seed in range(8)]


@pytest.mark.parametrize("name", ["processes", pytest.param("dask", marks=pytest.mark.validate)])
def test_a_worker_killed_in_the_middle_costs_nothing(name, tmp_path):
    def kill_one():
        # As soon as a first result is there, others are being worked on.
        until(lambda: list(tmp_path.glob("*.nc")))
        if name == "dask":
            victim = next(iter(executor._client.run(os.getpid).values()))
        else:
            victim = executor.submit(os.getpid).result()
        psutil.Process(victim).kill()
        killed.append(victim)

    killed, killer = [], threading.Thread(target=kill_one)
    with EXECUTORS[name]() as executor:
        killer.start()
        assert run_cases(LONG, tmp_path, executor, **QUIET) == {}
        killer.join()
    assert killed
    assert missing_cases(LONG, tmp_path) == []


def die(size):
    if size == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return size


@pytest.mark.posix
def test_what_kills_its_process_twice_has_failed_and_costs_nothing_else():
    with process_pool(2) as pool:
        futures = [pool.submit(die, size) for size in range(6)]
        with pytest.raises(RuntimeError, match="its process died, and so did the next one"):
            futures.pop(3).result()
        assert [future.result() for future in futures] == [0, 1, 2, 4, 5]


SCRIPT = """
import os, sys, time
from crazybilliards.comparison.sweeps import process_pool

with process_pool(2) as pool:
    print(*pool.map(lambda _: time.sleep(0.5) or os.getpid(), range(2)), flush=True)
    for number in range(2):
        pool.submit(time.sleep, 600)
    time.sleep(600)
"""


@pytest.mark.posix
def test_no_process_outlives_a_script_that_is_killed_and_it_needs_no_guard(tmp_path):
    (tmp_path / "script.py").write_text(SCRIPT)
    how = {"stdout": subprocess.PIPE, "text": True, "cwd": tmp_path}
    with subprocess.Popen([sys.executable, "script.py"], **how) as script:
        workers = [*map(int, script.stdout.readline().split())]
        assert len({*workers, script.pid}) == 3
        script.kill()
    until(lambda: not any(map(psutil.pid_exists, workers)))
