"""Bars: where somebody looks, with the time left, and nowhere else."""

import io
import time
from contextlib import redirect_stderr

import nbclient
import nbformat
import pytest

from crazybilliards.model import progress
from crazybilliards.model.progress import progress_bar, silent, waiting_for


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture(autouse=True)
def _impatient(monkeypatch):
    monkeypatch.setattr(progress, "_PATIENCE", 0.05)
    monkeypatch.setattr(progress, "_LOOK", 0.01)


def test_a_long_wait_is_shown_on_a_terminal_with_what_it_may_take():
    terminal = Terminal()
    with redirect_stderr(terminal), waiting_for("solving", seconds=3.0), waiting_for("within"):
        time.sleep(0.3)
    assert "solving:" in terminal.getvalue()
    assert "of about 00:03" in terminal.getvalue()
    assert "within" not in terminal.getvalue()


def test_a_short_wait_and_a_silent_one_show_nothing():
    with redirect_stderr(Terminal()) as terminal:
        with waiting_for("quick"):
            pass
        with silent(), waiting_for("solving"):
            time.sleep(0.2)
        with waiting_for("solving", progress=False):
            time.sleep(0.2)
    assert terminal.getvalue() == ""


def test_nothing_is_written_where_nobody_looks():
    with redirect_stderr(io.StringIO()) as file, waiting_for("solving"):
        assert list(progress_bar(True, range(3))) == [0, 1, 2]
        time.sleep(0.2)
    assert file.getvalue() == ""


CELL = """
{before}
import time
from crazybilliards.model import progress
progress._PATIENCE = 0.1
import crazybilliards as cb
for each in progress.progress_bar(True, range(10), desc="simulating"):
    time.sleep(0.05)
with progress.waiting_for("solving", seconds=60):
    time.sleep(0.5)
"""


@pytest.mark.parametrize(
    ("before", "kind"),
    [("", "display_data"), ("import sys; sys.modules['ipywidgets'] = None", "stream")],
    ids=["widgets", "text"],
)
def test_a_notebook_shows_bars_and_keeps_them_when_it_is_saved(before, kind):
    if kind == "display_data":
        pytest.importorskip("ipywidgets")
    cell = nbformat.v4.new_code_cell(CELL.format(before=before))
    notebook = nbformat.v4.new_notebook(cells=[cell])
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    outputs = [each for each in cell.outputs if each.output_type == kind]
    shown = nbformat.writes(notebook)
    assert outputs
    assert "simulating" in shown
    assert "100%" in shown
