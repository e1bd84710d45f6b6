"""Sweeps: the same case the same file, nothing computed twice, nothing lost."""

import json
from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool
from functools import wraps
from queue import Queue

import numpy as np
import pytest
from small_sweeps import AtOnce, missing_cases, sweep

import crazybilliards as cb
from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.comparison.sweeps import Case, Sweep, run_cases, running
from crazybilliards.comparison.sweeps.case import JOBS, compute
from crazybilliards.model import Chain
from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.particles import simulate

QUIET = {"progress": False}

# -- cases -------------------------------------------------------------------------------------


def test_equal_cases_have_one_file_however_their_numbers_are_written(tmp_path):
    chain = Chain(size=3, damping=2)
    one = Case("simulate", chain, {"duration": 100, "observe": ("widths",), "seed": np.int64(1)})
    other = Case(
        "simulate",
        Chain(size=np.int64(3), damping=np.float64(2.0)),
        {"seed": 1, "observe": ["widths"], "duration": 100.0, "replicas": 1},
    )
    assert len({one, other}) == 1
    assert one.file(tmp_path) == other.file(tmp_path)
    for different in (
        Case("simulate", chain, {"duration": 100, "seed": 2}),
        Case("simulate", chain.replace(gap=0.1), dict(one.settings)),
    ):
        assert one.file(tmp_path) != different.file(tmp_path)


def test_the_canonical_text_holds_every_parameter():
    stored = json.loads(Case("simulate", Chain(), {"duration": 100}).canonical)
    assert set(Chain().parameters()) < set(stored)
    assert {"duration", "warmup", "time_step", "method", "seed", "job"} < set(stored)
    assert not {"threads", "checkpoint", "progress", "start"} & set(stored)


def test_name_and_random_numbers_follow_from_what_is_not_the_default(tmp_path, monkeypatch):
    """A parameter that the package gets later, at its default, changes neither."""

    @wraps(simulate)
    def seeded(chain, *, seed, **settings):
        seeds.append(seed)
        return simulate(chain, seed=seed, **settings)

    case, seeds = Case("simulate", Chain(size=3, gap=0), {"duration": 5000, "seed": 1}), []
    assert case.changed == {"size": 3, "seed": 1}
    assert case.file(tmp_path).name == "1ea596a9dd6911f2ba11.nc"
    monkeypatch.setitem(JOBS, "simulate", seeded)
    compute(case, case.source)
    assert seeds == [703106191185711103]


def test_every_theory_is_a_job():
    assert set(JOBS) == {"simulate", *THEORIES}
    for name in THEORIES:
        assert Case(name, Chain(size=10), {}).source == room_fingerprint("model", "kinetic")
    assert Case("simulate", Chain(), {}).source == room_fingerprint("model", "particles")


def test_a_worker_with_other_source_code_refuses():
    case = Case("simulate", Chain(size=2), {"duration": 100})
    with pytest.raises(ValueError, match="other source code"):
        compute(case, "0123456789abcdef0123")


# -- running ----------------------------------------------------------------------------------


def test_nothing_is_computed_twice_and_a_damaged_file_is_computed_anew(tmp_path):
    cases = sweep().cases()
    run_cases([*cases, *cases], tmp_path, **QUIET)
    before = {case: case.file(tmp_path).stat().st_mtime_ns for case in cases}
    broken = cases[2].file(tmp_path)
    content = broken.read_bytes()
    broken.write_bytes(content[:-500] + b"x" + content[-499:])
    assert missing_cases(cases, tmp_path) == [cases[2]]
    with pytest.warns(UserWarning, match="computing it anew"):
        run_cases(cases, tmp_path, **QUIET)
    after = {case: case.file(tmp_path).stat().st_mtime_ns for case in cases}
    assert [case for case in cases if after[case] != before[case]] == [cases[2]]
    assert missing_cases(cases, tmp_path) == []


@pytest.mark.parametrize("executor", [None, AtOnce()], ids=["here", "executor"])
def test_whatever_is_wrong_with_a_case_does_not_cost_the_others(executor, tmp_path, monkeypatch):
    @wraps(simulate)
    def failing(chain, **settings):
        if chain == bad.chain:
            raise TypeError("a fault of the program")
        return simulate(chain, **settings)

    bad, good = sweep().cases()[:2]
    monkeypatch.setitem(JOBS, "simulate", failing)
    failed = run_cases([bad, good], tmp_path, executor, **QUIET)
    assert failed == {bad: "TypeError: a fault of the program"}
    assert missing_cases([bad, good], tmp_path) == [bad]


class Scripted(Executor):
    """A function says what becomes of each case that is submitted, the last of the futures."""

    def __init__(self, script):
        self.futures, self.script = [], script

    def submit(self, function, /, *arguments):
        self.futures.append(Future())
        self.script(self.futures, lambda: function(*arguments))
        return self.futures[-1]


def test_what_was_finished_before_a_pool_broke_is_written(tmp_path):
    """It gives the first case back last, and with it the news that the pool is broken."""

    def dying(futures, compute):
        if len(futures) > 1:
            futures[-1].set_result(compute())
        if len(futures) == len(cases):
            futures[0].set_exception(BrokenProcessPool("terminated abruptly"))

    cases = sweep().cases()
    with pytest.raises(RuntimeError, match="finished cases are kept"):
        run_cases(cases, tmp_path, Scripted(dying), **QUIET)
    assert missing_cases(cases, tmp_path) == cases[:1]


@pytest.mark.parametrize("raised", [True, False], ids=["when submitted", "when asked"])
def test_nothing_is_submitted_to_a_pool_that_broke(raised, tmp_path):
    def dead(futures, _):
        error = BrokenProcessPool("terminated abruptly")
        if raised:
            raise error
        futures[-1].set_exception(error)

    pool = Scripted(dead)
    with pytest.raises(RuntimeError, match="finished cases are kept"):
        run_cases(sweep().cases(), tmp_path, pool, **QUIET)
    assert len(pool.futures) == 1


def test_few_of_many_cases_are_submitted_at_a_time_and_ctrl_c_cancels_them(tmp_path, monkeypatch):
    class Asked(Queue):
        def get(self):
            pool.futures[-1].set_exception(KeyboardInterrupt())
            return super().get()

    monkeypatch.setattr(running, "SimpleQueue", Asked)
    monkeypatch.setattr(running, "_MOST_UNDER_WAY", 50)
    many = Sweep({"amplitude": np.linspace(1, 2, 150)}, "equilibrium")
    pool = Scripted(lambda *_: None)
    with pytest.raises(KeyboardInterrupt):
        run_cases(many, tmp_path, pool, **QUIET)
    assert [future.cancelled() for future in pool.futures] == 49 * [True] + [False]


def test_a_wrong_case_at_the_end_of_a_grid_is_found_before_any_work(tmp_path):
    grid = {"gap": [0.0, 1.0], "restitution": [1.0, 0.5]}
    with pytest.raises(ValueError, match="restitution must be 1"):
        run_cases(Sweep(grid, "equilibrium"), tmp_path / "results")
    assert not (tmp_path / "results").exists()


def test_runs_that_are_too_short_are_counted(tmp_path):
    short = Sweep({"size": [10, 20], "duration": [20, 1000]})
    told = "^2 of 4 cases; the first: duration=20 is short"
    with pytest.warns(cb.particles.ShortRunWarning, match=told):
        run_cases(short, tmp_path, **QUIET)
