"""Large sweeps: the first result comes at once, few cases are held, each is looked at once."""

from concurrent.futures import Executor, Future
from dataclasses import replace
from queue import SimpleQueue

import numpy as np
import pytest
import xarray as xr
from small_sweeps import AtOnce

import crazybilliards as cb
from crazybilliards.comparison.sweeps import Case, Sweep, engines, run_cases
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.model import Chain, load
from crazybilliards.model.storage import read_sealed

CASES = 3000


def many(number=CASES):
    """Return a sweep of as many chains."""
    return Sweep({"amplitude": [1 + i / number for i in range(number)]}, "equilibrium", {}, {})


class Counting(Executor):
    """Its cases fail as soon as somebody waits for one; it keeps how many there were then."""

    def __init__(self):
        self.waiting, self.under_way = [], []

    def submit(self, function, /, *arguments):
        self.waiting.append(Future())
        return self.waiting[-1]

    def give_back(self):
        self.under_way.append(len(self.waiting))
        while self.waiting:
            self.waiting.pop().set_exception(ValueError("not computed"))


@pytest.fixture
def counting(monkeypatch):
    class Queue(SimpleQueue):
        def get(self):
            if self.empty():
                executor.give_back()
            return super().get()

    monkeypatch.setattr(engines, "SimpleQueue", Queue)
    executor = Counting()
    return executor


@pytest.fixture
def planned(monkeypatch):
    """Count how often a case is planned."""
    calls = []
    job = JOBS["equilibrium"]

    def work(chain, **settings):
        calls.append(chain)
        return job.work(chain, **settings)

    monkeypatch.setitem(JOBS, "equilibrium", replace(job, work=work))
    return calls


def test_few_cases_are_submitted_at_a_time_and_each_is_looked_at_twice(planned, counting, tmp_path):
    """When it is checked, and when it is computed."""
    failed = run_cases(many(), tmp_path, counting, progress=False)
    assert len(failed) == sum(counting.under_way) == CASES
    assert max(counting.under_way) == 1000
    assert len(planned) == 2 * CASES + 1  # and the first one for its seed


def test_ctrl_c_ends_a_sweep_without_another_look_at_its_cases(planned, tmp_path):
    class Interrupted(Executor):
        def submit(self, function, /, *arguments):
            planned.clear()
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_cases(many(), tmp_path, Interrupted(), progress=False)
    assert len(planned) <= 1


class Noting(Executor):
    """Notes the cases in their order, and computes none."""

    def __init__(self, seen):
        self.seen = seen

    def submit(self, function, /, case, source):
        self.seen.append(case)
        future = Future()
        future.set_exception(ValueError("not computed"))
        return future


def test_the_shortest_cases_come_first(tmp_path):
    seen = []
    for name, values, order in (
        ("size", [5, 50, 10], [5, 5, 10, 10, 50, 50]),
        ("duration", [900, 100, 400], [100, 100, 400, 400, 900, 900]),
        ("restitution", [0.0, 0.5, 0.9], [0.9, 0.9, 0.5, 0.5, 0.0, 0.0]),
    ):
        seen.clear()
        settings = {} if name == "duration" else {"duration": 100}
        grid = {"seed": [1, 2], name: values}
        run_cases(Sweep(grid, settings=settings), tmp_path, Noting(seen), progress=False)
        assert [each.arguments[name] for each in seen] == order


def test_theories_are_solved_while_the_first_simulation_compiles_the_kernels(tmp_path):
    """The first one that needs all kernels: exact flight at restitution 1 needs few."""

    def simulation(size, restitution):
        return Case("simulate", Chain(size=size, restitution=restitution), {"duration": 100})

    simulations = [simulation(3, 1.0), simulation(4, 0.5), simulation(5, 0.5)]
    theories = [Case("phase_space", Chain(size=size, restitution=0.5), {}) for size in (10, 30)]
    seen = []
    run_cases([*simulations, *theories], tmp_path, Noting(seen), progress=False)
    assert seen == [simulations[1], *theories, simulations[0], simulations[2]]


def test_a_wrong_case_at_the_end_of_a_grid_is_found_before_any_work(counting, tmp_path):
    grid = {"gap": [0.0, 1.0], "restitution": [1.0, 0.5]}
    with pytest.raises(ValueError, match="restitution must be 1"):
        run_cases(Sweep(grid, "equilibrium", {}, {}), tmp_path / "results", counting)
    assert not (tmp_path / "results").exists()


def test_runs_that_are_too_short_are_counted_once_for_all_seeds(counting, tmp_path):
    grid = {"size": [10, 20], "seed": [1, 2, 3], "duration": [20, 1000]}
    with pytest.warns(cb.ShortRunWarning, match=r"^2 of 4 cases; the first: duration=20 is short"):
        run_cases(Sweep(grid), tmp_path, counting, progress=False)


def test_a_sweep_gives_the_cases_of_its_grid():
    sweep = Sweep({"size": [3, 4], "seed": [1, 2, 3]}, "simulate", {"gap": 1}, {"duration": 100})
    assert len(sweep) == 6
    assert [(case.chain.size, case.settings["seed"]) for case in sweep] == [
        (size, seed) for size in (3, 4) for seed in (1, 2, 3)
    ]
    assert list(sweep) == sweep.cases() == [sweep.case(number) for number in range(6)]
    assert sweep.case(4) == Case("simulate", Chain(size=4, gap=1), {"duration": 100, "seed": 2})


# -- the files of cases -----------------------------------------------------------------------


@pytest.mark.parametrize(
    "case",
    [
        Case("equilibrium", Chain(size=3), {}),
        Case("simulate", Chain(size=3), {"duration": 100, "observe": ["widths", "density"]}),
        Case(
            "simulate",
            Chain(size=3, restitution=0.5),
            {"duration": 100, "observe": ["avalanches", "collisions", "snapshots"]},
        ),
    ],
    ids=["theory", "widths", "avalanches"],
)
def test_a_case_is_read_back_with_its_types(case, tmp_path):
    """A classic NetCDF file has no integers of 64 bits, which sums and products may need."""
    assert run_cases([case], tmp_path, AtOnce(), progress=False) == {}
    assert read_sealed(case.file(tmp_path)).startswith(b"CDF")
    seed = {"seed": case.own_seed} if case.job == "simulate" else {}
    direct = JOBS[case.job].function(case.chain, **{**case.settings, **seed})
    loaded = case.load(tmp_path)
    assert {name: each.dtype for name, each in loaded.variables.items()} == {
        name: each.dtype for name, each in direct.variables.items()
    }
    for name in ("case", "source_fingerprint", "package_version", "seconds"):
        del loaded.attrs[name]
    xr.testing.assert_identical(loaded, direct)


def test_counts_beyond_32_bits_are_kept(tmp_path, monkeypatch):
    job = JOBS["equilibrium"]

    def counting(chain):
        return job.function(chain).assign(count=("particle", np.array([1, 2**40, 2**62])))

    monkeypatch.setitem(JOBS, "equilibrium", replace(job, function=counting))
    case = Case("equilibrium", Chain(size=3), {})
    assert run_cases([case], tmp_path, AtOnce(), progress=False) == {}
    assert load(case.file(tmp_path))["count"].values.tolist() == [1, 2**40, 2**62]
    case.check_file(tmp_path)
