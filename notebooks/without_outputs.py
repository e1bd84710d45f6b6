"""Write copies of the lessons for learners, without outputs and without solutions.

Outputs answer what **Predict** asks, and solutions answer the tasks. The expected answers lie
beside the copies in the package ``solutions``, with which the lessons compare the learner's.

``make lessons`` calls this file, and the documentation offers the copies for download.
"""

import re
import shutil
import sys
import tomllib
from pathlib import Path

import nbformat

HERE = Path(__file__).parent
PROJECT = tomllib.loads((HERE.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PAGES = PROJECT["urls"]["Documentation"]  # a copy lies elsewhere than the pages that it links to

SOLUTION = re.compile(r"<details><summary>Solution</summary>.*?</details>\n*", re.DOTALL)


def for_learners(path):
    """Return a notebook as it is before its first run; folded cells stay folded.

    It lacks the solutions and the cells in which the authors check their own lesson.
    """
    notebook = nbformat.read(path, as_version=4)
    notebook.metadata = {"kernelspec": notebook.metadata.kernelspec}  # not paired with a script
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
        else:
            cell.source = SOLUTION.sub("", cell.source).strip()
            cell.source = re.sub(r"\.\./docs/([\w/]+)\.md", rf"{PAGES}\1.html", cell.source)
    notebook.cells = [
        cell
        for cell in notebook.cells
        if cell.source and "remove-cell" not in cell.metadata.get("tags", [])
    ]
    return notebook


def write_copies(folder):
    """Write all lessons and the modules that they share; keep every lesson that is there."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE / "teaching.py", folder)
    compiled = shutil.ignore_patterns("__pycache__")
    shutil.copytree(HERE / "solutions", folder / "solutions", ignore=compiled, dirs_exist_ok=True)
    paths = sorted(HERE.glob("[!.]*.ipynb"))
    new = [path for path in paths if not (folder / path.name).exists()]
    for path in new:
        nbformat.write(for_learners(path), folder / path.name)
    if kept := len(paths) - len(new):
        print(f"{kept} lessons were there and stay; to start one anew, remove its file first")


if __name__ == "__main__":
    write_copies(Path(sys.argv[1]))
