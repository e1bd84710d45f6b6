"""Sweeps: the same case the same file, nothing computed twice, nothing lost."""

import errno
import json
import os
import signal
from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace

import numpy as np
import pytest
from missing_cases import missing_cases
from small_sweeps import AtOnce, sweep

from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.comparison.sweeps import Case, read_sweep, run_cases
from crazybilliards.comparison.sweeps.case import compute
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.model import Chain
from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.model.locks import locked

# -- grids ------------------------------------------------------------------------------------


SWEEP = b"""[grid]
size = [3, 4]
restitution = [0.5, 1.0]

[simulate]
duration = 200
observe = ["widths"]
"""


@pytest.mark.parametrize("flips", [100, pytest.param(1000, marks=pytest.mark.torture)])
def test_a_description_with_flipped_bits_or_cut_is_another_sweep_or_refused(flips, tmp_path):
    """A text without checksum: what is still TOML and makes sense is a sweep."""
    generator, refusals = np.random.default_rng(4), []
    changed = [SWEEP[: cut * len(SWEEP) // 50] for cut in range(50)]
    for _ in range(flips):
        text = bytearray(SWEEP)
        text[generator.integers(len(text))] ^= 1 << int(generator.integers(8))
        changed.append(bytes(text))
    for text in changed:
        (tmp_path / "grid.toml").write_bytes(text)
        try:
            read_sweep(tmp_path / "grid.toml").cases()
        except ValueError as error:
            refusals.append(str(error))
    assert not any("\n" in message for message in refusals)
    assert flips / 2 < len(refusals) < flips + 50


def test_the_mark_that_some_editors_write_before_a_text_is_left_out(tmp_path):
    (tmp_path / "grid.toml").write_bytes(b"\xef\xbb\xbf" + SWEEP)
    assert read_sweep(tmp_path / "grid.toml").grid


def test_a_folder_is_no_description_of_a_sweep(tmp_path):
    with pytest.raises(ValueError, match="a folder, not a TOML file"):
        read_sweep(tmp_path)


# -- cases -------------------------------------------------------------------------------------


def test_equal_cases_have_equal_keys_however_their_numbers_are_written():
    chain = Chain(size=3, damping=2)
    one = Case("simulate", chain, {"duration": 100, "observe": ("widths",), "seed": np.int64(1)})
    other = Case(
        "simulate",
        Chain(size=np.int64(3), damping=np.float64(2.0)),
        {"seed": 1, "observe": ["widths"], "duration": 100.0, "replicas": 1},
    )
    assert one == other
    assert one.key == other.key
    assert len({one, other}) == 1
    assert one.key != Case("simulate", chain, {"duration": 100, "seed": 2}).key
    assert one.key != Case("simulate", chain.replace(gap=0.1), dict(one.settings)).key


def test_the_canonical_text_holds_every_parameter():
    stored = json.loads(Case("simulate", Chain(), {"duration": 100}).canonical)
    assert set(Chain().parameters()) < set(stored)
    assert {"duration", "warmup", "time_step", "method", "seed", "job"} < set(stored)
    assert not {"threads", "checkpoint", "progress", "start"} & set(stored)


def test_key_and_seed_follow_from_what_is_not_the_default():
    """A parameter that the package gets later, at its default, changes neither."""
    case = Case("simulate", Chain(size=3, gap=0), {"duration": 5000, "seed": 1})
    assert case.changed == {"size": 3, "seed": 1}
    assert case.key == "1ea596a9dd6911f2ba11"
    assert case.own_seed == 703106191185711103
    others = [
        Case("simulate", Chain(size=3), {}),
        Case("simulate", Chain(size=3, gap=1), {"seed": 1}),
        Case("equilibrium", Chain(size=3), {}),
        Case("phase_space", Chain(size=3), {}),
    ]
    assert len({each.key for each in [case, *others]}) == 5
    assert len({each.own_seed for each in [case, *others]}) == 5


def test_every_theory_is_a_job():
    assert set(JOBS) == {"simulate", *THEORIES}
    for name, theory in THEORIES.items():
        assert Case(name, Chain(size=10), {}).key
        assert JOBS[name].function is theory.solve
        assert JOBS[name].source == room_fingerprint("model", "kinetic")
    assert JOBS["simulate"].source == room_fingerprint("model", "particles")


def test_a_worker_with_other_source_code_refuses():
    case = Case("simulate", Chain(size=2), {"duration": 100})
    with pytest.raises(ValueError, match="other source code"):
        compute(case, "0123456789abcdef0123")


# -- running ----------------------------------------------------------------------------------


def test_cases_have_random_numbers_of_their_own(tmp_path):
    cases = [
        Case("simulate", Chain(size=2, gap=gap), {"duration": 100, "observe": ["snapshots"]})
        for gap in (0.0, 1e3, 2e3)  # the last two never meet: equal noise would show
    ]
    assert run_cases(cases, tmp_path, AtOnce(), progress=False) == {}
    v = [case.load(tmp_path).velocity.values for case in cases]
    assert abs(np.corrcoef(v[1].ravel(), v[2].ravel())[0, 1]) < 0.3


def test_nothing_is_computed_twice_and_a_damaged_file_is_computed_anew(tmp_path, capsys):
    cases = sweep().cases()
    run_cases([*cases, *cases], tmp_path, AtOnce(), progress=False)
    before = {case: case.file(tmp_path).stat().st_mtime_ns for case in cases}
    broken = cases[2].file(tmp_path)
    content = broken.read_bytes()
    broken.write_bytes(content[:-500] + b"x" + content[-499:])
    assert missing_cases(cases, tmp_path) == [cases[2]]
    run_cases(cases, tmp_path, AtOnce(), progress=False)
    assert "computing it anew" in capsys.readouterr().err
    after = {case: case.file(tmp_path).stat().st_mtime_ns for case in cases}
    assert [case for case in cases if after[case] != before[case]] == [cases[2]]
    assert missing_cases(cases, tmp_path) == []


@pytest.mark.parametrize("columns", [1, 20, 57, 80, 200])
def test_the_terminal_may_be_narrow(columns, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    case = Case("equilibrium", Chain(size=3, amplitude=12.5, damping=2.0), {})
    assert run_cases([case], tmp_path, AtOnce()) == {}


def test_whatever_is_wrong_with_a_case_does_not_cost_the_others(tmp_path, monkeypatch):
    bad, good = sweep().cases()[:2]
    job = JOBS["simulate"]

    def failing(chain, **settings):
        if chain == bad.chain:
            raise TypeError("a fault of the program")
        return job.function(chain, **settings)

    monkeypatch.setitem(JOBS, "simulate", replace(job, function=failing))
    failed = run_cases([bad, good], tmp_path, AtOnce(), progress=False)
    assert failed == {bad: "TypeError: a fault of the program"}
    assert missing_cases([bad, good], tmp_path) == [bad]


def test_what_was_finished_before_a_worker_died_is_written(tmp_path):
    class Dying(AtOnce):
        """Gives the first case back last, and with it the news that its worker died."""

        def submit(self, function, /, case, source):
            submitted.append(case)
            if case == submitted[0]:
                return dead
            if len(submitted) == len(cases):
                dead.set_exception(BrokenProcessPool("terminated abruptly"))
            return super().submit(function, case, source)

    dead, submitted, cases = Future(), [], sweep().cases()
    with pytest.raises(RuntimeError, match="a worker process died"):
        run_cases(cases, tmp_path, Dying(), progress=False)
    assert missing_cases(cases, tmp_path) == [submitted[0]]


@pytest.mark.parametrize("raised", [True, False], ids=["when submitted", "when asked"])
def test_nothing_is_submitted_to_workers_that_died(raised, tmp_path):
    class Dead(Executor):
        def submit(self, function, /, case, source):
            submitted.append(case)
            if raised:
                raise BrokenProcessPool("terminated abruptly")
            future = Future()
            future.set_exception(BrokenProcessPool("terminated abruptly"))
            return future

    submitted = []
    with pytest.raises(RuntimeError, match="a worker process died"):
        run_cases(sweep().cases(), tmp_path, Dead(), progress=False)
    assert len(submitted) == 1


def test_a_folder_is_filled_by_one_process_at_a_time(tmp_path):
    cases = sweep().cases()[:1]
    with locked(tmp_path), pytest.raises(BlockingIOError, match=f"in use by process {os.getpid()}"):
        run_cases(cases, tmp_path, AtOnce(), progress=False)
    assert run_cases(cases, tmp_path, AtOnce(), progress=False) == {}


def test_a_full_disk_is_an_error_that_says_what_to_do(tmp_path, monkeypatch):
    def full(source, target):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    cases = sweep().cases()
    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(OSError, match=r"No space left .* the same call .*\.nc"):
        run_cases(cases, tmp_path, AtOnce(), progress=False)
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_does_not_reach_workers_from_their_first_moment_on(tmp_path):
    """While they import, before they can ignore it, it would end them with a traceback."""

    class Asking(AtOnce):
        def submit(self, function, /, *arguments):
            blocked.append(signal.pthread_sigmask(signal.SIG_BLOCK, []))
            return super().submit(function, *arguments)

    blocked = []
    run_cases(sweep().cases()[:1], tmp_path, Asking(), progress=False)
    assert signal.SIGINT in blocked[0]  # which workers inherit
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])
