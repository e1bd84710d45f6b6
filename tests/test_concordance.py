"""The concordance names every equation and figure of the paper, and nothing that does not exist."""

import importlib
import re
from pathlib import Path

import pytest

from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.reproduction.figures import FIGURES

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "paper" / "concordance.md"
TEXT = PAGE.read_text(encoding="utf-8")
EQUATIONS, FIGURE_COUNT = 52, 19
ROOMS = ("model", "particles", "kinetic", "comparison", "reproduction", "apps")
NAMES = sorted(set(re.findall(rf"`((?:{'|'.join(ROOMS)})(?:\.\w+)+)`", TEXT)))


def section(heading):
    return TEXT.split(f"\n## {heading}\n")[1].split("\n## ")[0]


def first_cells(heading):
    rows = [line for line in section(heading).splitlines() if line.startswith("|")][2:]
    return [row.split("|")[1] for row in rows]


def find(name):
    """Import what a dotted name says: a module, or what is found in one by attributes."""
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:length]))
        except ModuleNotFoundError:
            continue
        for part in parts[length:]:
            found = getattr(found, part)
        return found
    raise AttributeError(name)


@pytest.mark.parametrize("name", NAMES)
def test_a_name_exists(name):
    find(f"crazybilliards.{name}")


@pytest.mark.parametrize(
    "variable", sorted(set(re.findall(r"(?:variable|coordinate)s? `(\w+)`", TEXT)))
)
def test_a_variable_stands_in_the_vocabulary(variable):
    assert variable in VOCABULARY


def test_every_equation_has_a_row():
    numbers = []
    for cell in first_cells("Equations"):
        if span := re.fullmatch(r"\((\d+)\) to \((\d+)\)", re.sub(r"`.*`", "", cell).strip()):
            numbers += range(int(span[1]), int(span[2]) + 1)
        else:
            numbers += [int(number) for number in re.findall(r"\((\d+)\)", cell)]
    assert numbers == list(range(1, EQUATIONS + 1))


def test_every_figure_has_a_row_and_a_module():
    numbers = [int(cell.split()[0]) for cell in first_cells("Figures")]
    assert numbers == list(range(1, FIGURE_COUNT + 1))
    modules = re.findall(r"`(fig\d\d_\w+)`", section("Figures"))
    assert modules == [figure.stem.replace("-", "_") for figure in FIGURES]
    assert numbers == [figure.number for figure in FIGURES]


def test_the_sections_of_notebook_11_exist():
    [notebook] = (ROOT / "notebooks").glob("11_*.py")
    headings = re.findall(r"^# ## (\d+)\. ", notebook.read_text(encoding="utf-8"), re.MULTILINE)
    named = re.findall(r"notebook 11[^|.;\n]*?sections? (\d+)(?: (?:and|to) (\d+))?", TEXT)
    assert len(named) > 10
    assert {number for pair in named for number in pair if number} <= set(headings)
