"""Sweeps on every engine, and their command: the same results, nothing lost to a kill."""

import json
import logging
import os
import subprocess
import sys
import threading
from concurrent.futures import Executor
from contextlib import nullcontext
from functools import partial

import psutil
import pytest
from killed import until
from missing_cases import missing_cases
from small_sweeps import AtOnce

from crazybilliards.apps.commands import sweep as command
from crazybilliards.comparison import load_sweep
from crazybilliards.comparison.sweeps import Case, dask_cluster, process_pool, read_sweep, run_cases
from crazybilliards.model import Chain

SCHEDULER = "distributed.cli.dask_scheduler"
GRID = """
[grid]
size = [3, 5]
restitution = [0.5, 1.0]

[chain]
damping = 2.0

[simulate]
duration = {duration}
observe = ["widths", "density"]
"""


@pytest.fixture
def grid(tmp_path):
    path = tmp_path / "grid.toml"
    path.write_text(GRID.format(duration=100))
    return path


# -- engines ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def cluster():
    """Run cases on a dask cluster of this machine, whose workers take seconds to start."""
    import distributed

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distributed, "LocalCluster", partial(distributed.LocalCluster, n_workers=1))
        with dask_cluster() as executor:
            yield executor


@pytest.mark.compiled
@pytest.mark.parametrize("engine", ["processes", pytest.param("dask", marks=pytest.mark.validate)])
def test_processes_and_dask_give_the_same_results(engine, grid, request, tmp_path):
    cases = read_sweep(grid).cases()
    dask = nullcontext(request.getfixturevalue("cluster")) if engine == "dask" else None
    with dask or process_pool(1) as executor:
        for name, each in {"here": AtOnce(), "there": executor}.items():
            assert run_cases(cases, tmp_path / name, each, progress=False) == {}
    for case in cases:
        here, there = (case.load(tmp_path / name) for name in ("here", "there"))
        there.attrs["seconds"] = here.attrs["seconds"]
        assert here.identical(there)


# A worker sends the first half of its result. Then it dies; or the caller gives up.
HALF_SENT = """
import os, signal, sys, time
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import Connection
from pathlib import Path

from crazybilliards.comparison.sweeps import process_pool


def send_half(place, dies):
    send = Connection._send

    def half(self, content, *rest):
        send(self, content[: len(content) // 2])
        Path(place).touch()
        if dies:
            os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(600)

    Connection._send = half
    return b"result" * 100


if __name__ == "__main__":
    for dies in (True, False):
        place = f"dies: {dies}"
        try:
            with process_pool(2) as pool:
                result = pool.submit(send_half, place, dies)
                while not Path(place).exists():
                    time.sleep(0.01)
                if not dies:
                    raise KeyboardInterrupt
                result.result()
        except (KeyboardInterrupt, BrokenProcessPool) as error:
            print(type(error).__name__)
"""


@pytest.mark.validate
@pytest.mark.skipif(sys.platform == "win32", reason="sends by another function there")
def test_a_worker_that_has_half_sent_its_result_holds_up_nothing(tmp_path):
    """Neither the block nor the end of the script."""
    (tmp_path / "half_sent.py").write_text(HALF_SENT)
    run = [sys.executable, "half_sent.py"]
    done = subprocess.run(run, capture_output=True, text=True, timeout=120, cwd=tmp_path)
    said = ["BrokenProcessPool", "KeyboardInterrupt"]
    assert (done.returncode, done.stdout.split()) == (0, said), done.stderr


@pytest.mark.validate
@pytest.mark.compiled
def test_a_dask_worker_killed_in_the_middle_costs_nothing(cluster, tmp_path):
    from distributed import Client

    cases = [
        Case("simulate", Chain(size=20), {"duration": 20_000, "seed": seed}) for seed in range(8)
    ]
    address = cluster._client.scheduler.address
    killed = []

    def kill_one():
        # As soon as a first result is there, others are being worked on.
        until(lambda: list(tmp_path.glob("*.nc")))
        with Client(address, set_as_default=False) as client:
            victim = next(iter(client.run(os.getpid).values()))
        psutil.Process(victim).kill()
        killed.append(victim)

    killer = threading.Thread(target=kill_one)
    with dask_cluster(address) as executor:
        killer.start()
        assert run_cases(cases, tmp_path, executor, progress=False) == {}
        killer.join()
    assert killed
    assert missing_cases(cases, tmp_path) == []


@pytest.fixture
def scheduler(tmp_path):
    """Start a scheduler of its own, without workers; return its process and its address."""
    file = tmp_path / "scheduler.json"
    arguments = ["--host", "127.0.0.1", "--port", "0", "--no-dashboard"]
    process = subprocess.Popen(
        [sys.executable, "-m", SCHEDULER, *arguments, "--scheduler-file", str(file)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    until(lambda: process.poll() is not None or (file.exists() and file.stat().st_size))
    yield process, json.loads(file.read_text())["address"]
    process.kill()
    process.wait()


@pytest.mark.validate
@pytest.mark.parametrize("number", [1, 1100], ids=["all submitted", "not all submitted"])
def test_the_death_of_the_scheduler_is_one_line(number, scheduler, tmp_path, monkeypatch, caplog):
    process, address = scheduler
    cases = [Case("simulate", Chain(size=2), {"duration": 100, "seed": i}) for i in range(number)]

    class Killing(Executor):
        def submit(self, function, /, *arguments):
            future = executor.submit(function, *arguments)
            submitted.append(future)
            if len(submitted) == min(number, 1000):  # as many as may be under way
                process.kill()
            return future

    submitted = []
    # What people see of these logs, from warnings on, does not come here by itself.
    monkeypatch.setattr(logging.getLogger("distributed"), "propagate", True)
    monkeypatch.setattr(logging.getLogger("distributed.client"), "propagate", True)
    with (
        pytest.raises(RuntimeError, match="the dask scheduler is gone; finished cases are kept"),
        dask_cluster(address) as executor,
    ):
        run_cases(cases, tmp_path / "results", Killing(), progress=False)
    assert [each for each in caplog.records if each.levelno >= logging.WARNING] == []


def test_no_scheduler_at_the_address():
    with pytest.raises(ValueError, match="no dask scheduler"), dask_cluster("nowhere"):
        pass


# -- the command ------------------------------------------------------------------------------


def test_the_command_computes_what_is_missing(run, grid, tmp_path, monkeypatch):
    monkeypatch.setattr(command, "engine", lambda *_: nullcontext(AtOnce()))
    folder = tmp_path / "results"
    status, printed, errors = run("sweep", grid, "--output", folder)
    assert status == 0, errors
    assert "4 cases, 0 of them" in printed
    assert "computed 4 cases" in printed
    status, printed, _ = run("sweep", grid, "--output", folder)
    assert status == 0
    assert "4 cases, 4 of them" in printed
    assert "computed" not in printed
    assert load_sweep(folder).sizes["size"] == 2
