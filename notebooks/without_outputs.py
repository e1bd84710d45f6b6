"""Write copies of the lessons without outputs, because outputs answer what **Predict** asks.

``make lessons`` calls this file, and the documentation offers the copies for download.
"""

import shutil
import sys
from pathlib import Path

import nbformat

HERE = Path(__file__).parent


def without_outputs(path):
    """Return a notebook as it is before its first run; folded cells stay folded."""
    notebook = nbformat.read(path, as_version=4)
    notebook.metadata = {"kernelspec": notebook.metadata.kernelspec}  # not paired with a script
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    return notebook


def write_copies(folder):
    """Write all lessons and the module that they share; keep every lesson that is there."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE / "teaching.py", folder)
    paths = sorted(HERE.glob("*.ipynb"))
    new = [path for path in paths if not (folder / path.name).exists()]
    for path in new:
        nbformat.write(without_outputs(path), folder / path.name)
    if kept := len(paths) - len(new):
        print(f"{kept} lessons were there and stay; to start one anew, remove its file first")


if __name__ == "__main__":
    write_copies(Path(sys.argv[1]))
