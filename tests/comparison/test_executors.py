"""Sweeps on every executor: the same results, nothing lost to the death of a worker."""

import os
import signal
import threading
from concurrent.futures import ThreadPoolExecutor

import psutil
import pytest
from forked import until

from crazybilliards.comparison.sweeps import Case, process_pool, run_cases, running
from crazybilliards.model import Chain

QUIET = {"progress": False}
CASES = [Case("simulate", Chain(size=20), {"duration": 5_000, "seed": seed}) for seed in range(3)]
pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def here(tmp_path_factory):
    """Return a folder with what this process computes of the cases."""
    folder = tmp_path_factory.mktemp("here")
    assert run_cases(CASES, folder, **QUIET) == {}
    return folder


def require_alike(folder, here):
    for case in CASES:
        assert case.load(folder).identical(case.load(here))


def test_threads_give_the_same_results(here, tmp_path):
    with ThreadPoolExecutor(2) as executor:
        assert run_cases(CASES, tmp_path, executor, **QUIET) == {}
    require_alike(tmp_path, here)


def killer(folder, process):
    """Return a thread that kills a process as soon as a first result is there."""

    def kill():
        until(lambda: list(folder.glob("*.nc")))
        process.kill()

    return threading.Thread(target=kill)


@pytest.mark.validate
def test_a_process_killed_in_the_middle_costs_nothing(here, tmp_path):
    with process_pool(1) as pool:
        process = psutil.Process(pool.submit(os.getpid).result())
        killing = killer(tmp_path, process)
        killing.start()
        assert run_cases(CASES, tmp_path, pool, **QUIET) == {}
        killing.join()
        assert pool.submit(os.getpid).result() != process.pid
    require_alike(tmp_path, here)


@pytest.mark.posix
def test_what_kills_its_process_twice_has_failed_and_costs_nothing_else(monkeypatch):
    """In processes that import nothing, which takes seconds each."""
    monkeypatch.setattr(running, "_prepare_process", None)
    with process_pool(1) as pool:
        before, deadly, after = (
            pool.submit(*call) for call in [(abs, -1), (signal.raise_signal, 9), (abs, -2)]
        )
        with pytest.raises(RuntimeError, match="its process died, and so did the next one"):
            deadly.result()
        assert (before.result(), after.result()) == (1, 2)


@pytest.mark.cluster
def test_a_dask_cluster_gives_the_same_results_and_may_lose_a_worker(here, tmp_path):
    distributed = pytest.importorskip("distributed", reason="make cluster installs dask")
    one = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0"}
    with (
        distributed.LocalCluster(**one) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        killing = killer(tmp_path, psutil.Process(next(iter(client.run(os.getpid).values()))))
        killing.start()
        assert run_cases(CASES, tmp_path, client.get_executor(), **QUIET) == {}
        killing.join()
    require_alike(tmp_path, here)
