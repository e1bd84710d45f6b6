"""The house stands: nothing imports upwards, nothing is hidden by its module, no file is long."""

import ast
import doctest
import graphlib
import importlib
from pathlib import Path

import architecture
import pytest

ROOT = Path(__file__).parent.parent
STANDS_ON = {
    "model": {"model"},
    "particles": {"model", "particles"},
    "kinetic": {"model", "kinetic"},
    "comparison": {"model", "particles", "kinetic", "comparison"},
    "reproduction": {"model", "particles", "kinetic", "comparison", "reproduction"},
    "apps": {"model", "particles", "kinetic", "comparison", "reproduction", "apps"},
}
# What stands on one floor may import what stands there or below, but never in a circle.
FLOORS = {
    "particles": (
        {"scales", "noise", "stepping", "laws"},
        {"schedule", "start"},
        {"run"},
        {"observers"},
        {"running"},
        {"simulation"},
        {"vanishing_step"},
    ),
    "kinetic": (
        {"requirements", "times"},
        {"statics", "exact"},
        {"starts"},
        {"fluids", "kinetic_equation"},
        {"correlations"},
    ),
    "comparison": (
        {"coverage", "distances", "drawing", "fits", "layout", "theories", "widths"},
        {"side_by_side", "sweeps"},
    ),
    "reproduction": (
        {"claims"},
        {"chains", "distributions", "power_laws", "vanishing_step"},
        {"predictions"},
        {"beyond", "figures"},
        {"reproducible"},
    ),
    "apps": ({"explore"}, {"commands"}),
}
LINES = 300
MODULES = architecture.modules()


@pytest.mark.parametrize("name", MODULES)
def test_no_room_imports_what_stands_above_it(name):
    imported = architecture.imports()[name]
    assert {each.split(".")[0] for each in imported} <= STANDS_ON[name.split(".")[0]]


@pytest.mark.parametrize("room", FLOORS)
def test_no_folder_imports_what_stands_above_it(room):
    graph = architecture.unit_imports(room)
    floor = {
        f"{room}.{unit}": number for number, units in enumerate(FLOORS[room]) for unit in units
    }
    assert set(graph) == set(floor), "every module and folder of a room has its floor"
    upwards = [
        (name, target)
        for name, targets in graph.items()
        for target in targets
        if floor[target] > floor[name]
    ]
    assert not upwards


@pytest.mark.parametrize("room", STANDS_ON)
def test_nothing_imports_in_a_circle(room):
    graphlib.TopologicalSorter(architecture.unit_imports(room)).prepare()
    graphlib.TopologicalSorter(architecture.imports()).prepare()


@pytest.mark.parametrize("name", MODULES)
def test_within_a_room_modules_import_modules(name):
    """Not the names of the room, which would hide from which floor they come."""
    assert name.split(".")[0] not in architecture.imports()[name]


@pytest.mark.parametrize("name", MODULES)
def test_nothing_is_named_like_its_module(name):
    """Importing the module would hide the function or class behind it."""
    tree = ast.parse(MODULES[name].read_text(encoding="utf-8"))
    definitions = (ast.FunctionDef, ast.ClassDef)
    defined = {node.name for node in tree.body if isinstance(node, definitions)}
    assert name.split(".")[-1] not in defined


def test_no_file_is_long():
    folders = (*STANDS_ON, "api", "benchmarks", "docs", "tests")
    files = [path for folder in folders for path in (ROOT / folder).rglob("*.py")]
    lengths = {
        path.relative_to(ROOT).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for path in files
        if "docs/notebooks" not in path.as_posix()
    }
    long = {name: length for name, length in lengths.items() if length >= LINES}
    assert not long


def test_the_picture_of_the_architecture_shows_the_imports():
    """If it does not, draw it again: python docs/figures/architecture.py."""
    assert architecture.described() in architecture.PICTURE.read_text(encoding="utf-8")


@pytest.mark.compiled
@pytest.mark.parametrize("name", ["", *MODULES])
def test_examples_in_docstrings(name):
    module = importlib.import_module(f"crazybilliards.{name}".removesuffix("."))
    assert doctest.testmod(module).failed == 0
