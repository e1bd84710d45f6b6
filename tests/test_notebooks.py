"""Notebooks and the scripts they are paired with say the same, and hold no results."""

from pathlib import Path

import jupytext
import pytest

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def test_they_are_numbered_and_paired():
    names = [path.stem for path in NOTEBOOKS]
    assert [name[:3] for name in names] == [f"{n:02d}_" for n in range(1, len(names) + 1)]
    assert [path.stem for path in sorted(FOLDER.glob("*.py"))] == names


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_its_script(path):
    """Mend with: jupytext --to ipynb notebooks/*.py."""
    notebook, script = (jupytext.read(path.with_suffix(end)) for end in (".ipynb", ".py"))
    assert [(cell.cell_type, cell.source) for cell in notebook.cells] == [
        (cell.cell_type, cell.source) for cell in script.cells
    ]
    for cell in notebook.cells:
        assert not cell.get("outputs")
        assert cell.get("execution_count") is None
