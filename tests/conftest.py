"""Shared by all tests."""

import gc
import os
import signal
import sys
import threading

import matplotlib as mpl
import matplotlib.pyplot as plt
import pytest
from forked import Ended
from hypothesis import settings

from crazybilliards.apps.commands.line import main

mpl.use("Agg")

# The first example of a kernel compiles it, which is no sign of a slow test.
settings.register_profile("crazybilliards", deadline=None, derandomize=True)
settings.load_profile("crazybilliards")


# Started in the background of a script, a process ignores Ctrl-C, and so do those that it starts.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(config, items):
    """Leave out the torture unless it is asked for; skip what Windows cannot do."""
    if "torture" not in " ".join([config.option.markexpr, *config.args]):
        torture = [item for item in items if item.get_closest_marker("torture")]
        config.hook.pytest_deselected(items=torture)
        items[:] = [item for item in items if item not in torture]
    if os.name == "nt":
        for item in items:
            if item.get_closest_marker("posix"):
                item.add_marker(pytest.mark.skip(reason="needs signals, streams, links of POSIX"))


def pytest_collection_finish():
    """Keep what was imported out of each search for garbage."""
    gc.freeze()


def pytest_itemcollected(item):
    """Mark what lies in the folder of the torture."""
    if item.path.parent.name == "torture":
        item.add_marker("torture")


@pytest.fixture(autouse=True)
def close_figures():
    """Close the figures of each test."""
    yield
    plt.close("all")


@pytest.fixture
def ctrl_c(monkeypatch):
    """Let Ctrl-C come when a method was called often enough, however long a busy machine takes."""

    def ctrl_c(owner, name, enough):
        """``enough(callers)``: of these objects the method was called, in this order."""
        method, callers, sent = getattr(owner, name), [], []

        def watched(self, *arguments, **settings):
            result = method(self, *arguments, **settings)
            callers.append(self)
            if not sent and enough(callers):
                sent.append(True)
                if hasattr(signal, "pthread_kill"):  # wakes the main thread if it is waiting
                    signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
                else:
                    signal.raise_signal(signal.SIGINT)
            return result

        monkeypatch.setattr(owner, name, watched)

    return ctrl_c


@pytest.fixture
def run(monkeypatch, capsys):
    """Run a command in this process."""

    def run(*arguments):
        monkeypatch.setattr("sys.argv", ["crazybilliards", *map(str, arguments)])
        monkeypatch.setattr("sys.excepthook", sys.excepthook)
        with pytest.raises((SystemExit, KeyboardInterrupt)) as caught:
            main()
        return Ended(getattr(caught.value, "code", 130) or 0, *capsys.readouterr())

    return run
