"""Ctrl-C, SIGTERM and SIGHUP during a run: nothing is lost, and nothing hangs."""

import io
import signal
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from itertools import product

import numpy as np
import pytest
from forked import forked

from crazybilliards.model import Chain
from crazybilliards.model.storage import read_sealed
from crazybilliards.particles import given_start, simulate
from crazybilliards.particles.observers.widths import Widths


def test_ctrl_c_while_replicas_are_started_stops_the_run(tmp_path, monkeypatch):
    """It used to wait for the end of the run."""
    submit = ThreadPoolExecutor.submit

    def interrupting(pool, work, replica):
        submit(pool, work, replica)
        raise KeyboardInterrupt

    monkeypatch.setattr(ThreadPoolExecutor, "submit", interrupting)
    with pytest.raises(KeyboardInterrupt, match="nothing was measured"):
        simulate(Chain(size=10), warmup=1e9, progress=False, checkpoint=tmp_path / "state")


@pytest.mark.compiled
@pytest.mark.posix
@pytest.mark.parametrize("number", range(1, 5))
def test_ctrl_c_may_come_while_the_lock_of_the_threads_is_being_taken(number, monkeypatch):
    """An error between the taking and the block that frees it would leave it held for ever."""
    enter, entries = threading.Condition.__enter__, []

    def and_interrupted(self):
        entered = enter(self)
        if threading.get_ident() == threading.main_thread().ident:
            entries.append(self)
            if len(entries) == number:
                signal.raise_signal(signal.SIGINT)
        return entered

    monkeypatch.setattr(threading.Condition, "__enter__", and_interrupted)
    with suppress(KeyboardInterrupt):  # nothing was measured yet
        run = simulate(Chain(size=10), duration=1e9, replicas=4, threads=2, progress=False)
        assert run.attrs["status"] == "interrupted"
    assert len(entries) >= number


@pytest.mark.compiled
@pytest.mark.posix
def test_ctrl_c_acts_in_a_step_with_very_many_collisions(tmp_path):
    """Here 10^10 pi of them. The checkpoint of the beginning stays."""
    two = Chain(size=2, amplitude=0, damping=0, stiffness=0, box=60, mass_ratio=1e20)
    start, state = given_start(two, [-27, -24], [0, -1]), tmp_path / "state"
    how = {"every": 1, "time_step": 1, "start": start, "observe": "collisions", "progress": False}
    simulate(two.replace(mass_ratio=1), duration=20, **how)  # compiles
    threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
    with pytest.warns(RuntimeWarning, match="no checkpoint written: a time step takes very many"):
        run = simulate(two, duration=20, checkpoint=state, checkpoint_interval=0.03, **how)
    assert run.attrs["status"] == "interrupted"
    assert 0 < run.attrs["end_time"] < 4
    assert read_sealed(state)


HANDLERS = {  # what a program does at a signal, how it then ends, and how many runs it gets
    "default": (signal.SIG_DFL, None, 0),
    "like Ctrl-C": (signal.default_int_handler, 0, 2),
    "exits": (lambda number, _: sys.exit(7), 7, 0),
}


@pytest.mark.compiled
@pytest.mark.posix
@pytest.mark.parametrize(("name", "how"), [*product(["SIGTERM"], HANDLERS), ("SIGHUP", "default")])
def test_a_loop_ends_at_a_signal_after_the_checkpoint_unless_it_asks_for_the_result(
    name, how, tmp_path, monkeypatch
):
    number, (handler, status, runs) = getattr(signal, name), HANDLERS[how]
    state, observe, calls = tmp_path / "state", Widths.observe, []

    def and_signal(self, *arguments):
        observe(self, *arguments)
        calls.append(self)
        if len(calls) == 20:
            signal.pthread_kill(threading.main_thread().ident, number)

    def job():
        signal.signal(number, handler)
        for _ in range(2):
            calls.clear()
            run = simulate(Chain(size=10), duration=1e9, progress=False, **checkpoint)
            print(run.attrs["status"], flush=True)

    checkpoint = {"checkpoint": state, "checkpoint_interval": 1e9}
    monkeypatch.setattr(Widths, "observe", and_signal)
    done = forked(job)
    assert done.returncode == (-number if status is None else status)
    assert done.stdout == runs * "interrupted\n"
    # The first checkpoint, before any work, has measured nothing.
    assert np.load(io.BytesIO(read_sealed(state)))["0/steps"] > 0
