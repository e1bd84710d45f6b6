"""Signals: which are taken, what they do afterwards; bars and what else is said meanwhile."""

import io
import signal
import time
from contextlib import redirect_stderr

import pytest
from forked import forked

from crazybilliards.kinetic import displaced, hydrodynamics
from crazybilliards.model import Chain, progress
from crazybilliards.model.kernels import announced, kernel
from crazybilliards.model.process import (
    interrupts_deferred,
    interrupts_noted,
    terminated_like_interrupted,
)
from crazybilliards.model.progress import progress_bar
from crazybilliards.particles import simulate

ENDING = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


@pytest.fixture
def handle():
    """Set the handler of a signal for the time of the test."""
    before = []

    def handle(number, handler):
        before.append((number, signal.signal(number, handler)))

    yield handle
    for number, handler in reversed(before):
        signal.signal(number, handler)


@pytest.mark.posix
@pytest.mark.parametrize("number", ENDING)
def test_a_signal_that_ends_programs_does_so_after_the_block(number):
    def job():
        signal.signal(number, signal.SIG_DFL)  # for example nohup ignores SIGHUP
        with interrupts_noted():
            signal.raise_signal(number)
            print("went on", flush=True)
        print("survived", flush=True)

    done = forked(job)
    assert (done.returncode, done.stdout) == (-number, "went on\n")


@pytest.mark.parametrize("number", [signal.SIGINT, *ENDING])
def test_a_signal_that_the_program_handles_or_ignores_stays_its_own(number, handle):
    own = []
    for handler in (signal.SIG_IGN, lambda number, _: own.append(number)):
        handle(number, handler)
        for taken in (interrupts_noted, terminated_like_interrupted):
            if taken is terminated_like_interrupted and number == signal.SIGINT:
                continue  # Ctrl-C is left alone there
            with taken() as came:
                signal.raise_signal(number)
            assert came == []
    assert own.count(number) == (1 if number == signal.SIGINT else 2)


@pytest.mark.parametrize("number", ENDING)
def test_a_command_is_terminated_like_interrupted_and_only_once(number, handle):
    handle(number, signal.SIG_DFL)
    with terminated_like_interrupted() as came:
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(number)
        signal.raise_signal(number)  # while results are written
    assert came == [number, number]
    with terminated_like_interrupted() as came:
        with interrupts_noted():
            signal.raise_signal(number)
        signal.raise_signal(number)
    assert came == [number, number]
    assert signal.getsignal(number) is signal.SIG_DFL


@pytest.mark.parametrize("number", [signal.SIGINT, *ENDING])
def test_a_deferred_signal_takes_its_effect_after_the_block(number, handle):
    went_on = []

    def block():
        with interrupts_deferred():
            signal.raise_signal(number)
            went_on.append(number)

    handle(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    with terminated_like_interrupted(), pytest.raises(KeyboardInterrupt):
        block()
    assert went_on == [number]


@pytest.mark.posix
def test_progress_needs_no_open_standard_error():
    """A program in the background may have closed its streams; tqdm cannot write then."""

    def job():
        simulate(Chain(size=2), duration=100)
        hydrodynamics(Chain(size=5), displaced(Chain(size=5), 1.0), 1.0)

    done = forked(job, closed=(1, 2))
    assert done.returncode == 0


@pytest.mark.compiled
def test_compiling_is_said_once_and_only_to_those_who_asked(capsys, tmp_path, monkeypatch):
    for asked, said in ((False, 0), (True, 1)):
        monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path / str(said)))
        first, second, third = (kernel(lambda x: x + 1) for _ in range(3))
        with announced(asked):
            first(1)
            second(1.0)
        third(1j)
        assert capsys.readouterr().err.count("compiling the kernels") == said


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize(
    ("stream", "progress", "shown"),
    [(Terminal(), True, True), (Terminal(), False, False), (io.StringIO(), True, False)],
    ids=["terminal", "silenced", "file"],
)
def test_a_bar_is_shown_on_a_terminal_only(stream, progress, shown):
    with redirect_stderr(stream):
        assert list(progress_bar(progress, range(3), desc="simulating")) == [0, 1, 2]
    assert ("simulating: 100%" in stream.getvalue()) == shown
    assert shown or stream.getvalue() == ""


def test_a_log_gets_a_line_now_and_then_also_while_nothing_advances(monkeypatch):
    monkeypatch.setattr(progress, "_PAUSE", 0.02)
    with redirect_stderr(io.StringIO()) as log, progress_bar(True, total=4, desc="sweep") as bar:
        bar.update(3)
        while log.getvalue().count("\n") < 2:
            time.sleep(0.01)
    assert {line[:27] for line in log.getvalue().splitlines()} == {"crazybilliards: sweep:  75%"}
