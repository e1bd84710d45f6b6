"""Signals: which are taken, what they do afterwards, and that handlers are restored."""

import io
import signal
from types import SimpleNamespace

import pytest
from forked import forked

from crazybilliards.kinetic import displaced, hydrodynamics
from crazybilliards.model import Chain, storage
from crazybilliards.model.process import (
    announce_compilation,
    announced,
    interrupts_noted,
    terminated_like_interrupted,
)
from crazybilliards.model.storage import load, load_attributes, small_netcdf, write_sealed
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


def test_ctrl_c_between_two_restorations_leaves_no_handler_behind(monkeypatch, handle):
    handle(signal.SIGTERM, signal.default_int_handler)
    setting = signal.signal

    def and_interrupt(number, handler):
        earlier = setting(number, handler)
        if number == signal.SIGINT and handler is signal.default_int_handler:
            signal.raise_signal(signal.SIGINT)  # which raises an error again from here on
        return earlier

    monkeypatch.setattr(signal, "signal", and_interrupt)
    numbers = [signal.SIGINT, signal.SIGTERM]
    with pytest.raises(KeyboardInterrupt), interrupts_noted() as came:
        any(map(signal.raise_signal, numbers))
    assert came == numbers
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert signal.getsignal(signal.SIGTERM) is signal.default_int_handler


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


def test_the_end_of_an_outer_block_hears_of_a_signal_in_an_inner_one():
    with interrupts_noted() as outer:
        with interrupts_noted() as inner:
            signal.raise_signal(signal.SIGINT)
        assert inner == outer == [signal.SIGINT]


def test_an_error_does_not_hide_a_signal_that_came():
    """A program that goes on after errors would never end."""

    def fail(*numbers):
        any(map(signal.raise_signal, numbers))
        raise ValueError("an error")

    with pytest.raises(KeyboardInterrupt) as caught, interrupts_noted():
        fail(signal.SIGINT)
    assert str(caught.value.__cause__) == "an error"
    with pytest.raises(ValueError, match="an error"), interrupts_noted():
        fail()


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


@pytest.mark.posix
def test_progress_needs_no_open_standard_error():
    """A program in the background may have closed its streams; tqdm cannot write then."""

    def job():
        simulate(Chain(size=2), duration=100)
        hydrodynamics(Chain(size=5), displaced(Chain(size=5), 1.0), 1.0)

    done = forked(job, closed=(1, 2))
    assert done.returncode == 0


def test_compiling_is_said_once_and_only_to_those_who_asked(capsys):
    announce_compilation()
    with announced(False):
        announce_compilation()
    with announced(True):
        pass  # every kernel was in the cache
    assert capsys.readouterr().err == ""
    with announced(True):
        announce_compilation()
        announce_compilation()
    announce_compilation()
    assert capsys.readouterr().err.count("compiling the kernels") == 1


@pytest.mark.parametrize("read", [load, load_attributes])
def test_ctrl_c_is_not_lost_where_a_file_is_closed(read, tmp_path, monkeypatch):
    """Python ignores an error in ``__del__``, which scipy and xarray have for files."""
    file = tmp_path / "classic.nc"
    write_sealed(file, small_netcdf(displaced(Chain(size=2), 1.0)))
    came = []

    class Dropped(io.BytesIO):
        def __del__(self):
            came.append(True)
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(storage, "io", SimpleNamespace(BytesIO=Dropped))
    with pytest.raises(KeyboardInterrupt):
        read(file)
    assert came
