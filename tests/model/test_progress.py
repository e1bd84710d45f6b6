"""Bars: where somebody looks, and nowhere else."""

import io
from contextlib import redirect_stderr

import pytest

from crazybilliards.model.progress import progress_bar


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
