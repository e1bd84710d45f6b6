"""The house stands: nothing imports upwards, nothing is hidden by its module, no file is long."""

import ast
import doctest
import graphlib
import importlib
from pathlib import Path

import architecture
import pytest

import crazybilliards as cb

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
        {"scales", "noise", "laws"},
        {"dynamics", "stepping"},
        {"schedule", "start"},
        {"run"},
        {"observers"},
        {"running"},
        {"simulation"},
        {"limit"},
    ),
    "kinetic": (
        {"accuracy", "requirements"},
        {"statics", "exact"},
        {"rods"},
        {"starts"},
        {"fluids", "kinetic_equation"},
        {"correlations"},
    ),
    "comparison": (
        {"combining", "coverage", "distances", "drawing", "fits", "layout", "widths"}
        | {"curves", "encoding", "rod_film", "stationary_theories", "symbols"},
        {"sweeps"},
        {"side_by_side"},
    ),
    "reproduction": (
        {"claims"},
        {"chains", "distributions", "power_laws", "vanishing_step"},
        {"predictions"},
        {"elastic_gaps", "figures"},
        {"reproducible"},
    ),
    "apps": ({"explore"}, {"commands"}),
}
LINES = 300
VALIDATED = {"kinetic": pytest.mark.validate}  # its examples take seconds
MODULES = architecture.modules()


def test_no_room_imports_what_stands_above_it():
    upwards = [
        (name, each)
        for name, imported in architecture.imports().items()
        for each in imported
        if each.split(".")[0] not in STANDS_ON[name.split(".")[0]]
    ]
    assert not upwards


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


def test_within_a_room_modules_import_modules():
    """Not the names of the room, which would hide from which floor they come."""
    imports = architecture.imports().items()
    assert not [name for name, imported in imports if name.split(".")[0] in imported]


def test_nothing_is_named_like_its_module():
    """Importing the module would hide the function or class behind it."""
    definitions = (ast.FunctionDef, ast.ClassDef)
    hidden = [
        name
        for name, path in MODULES.items()
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, definitions) and node.name == name.split(".")[-1]
    ]
    assert not hidden


def test_no_file_is_long():
    folders = (*STANDS_ON, "api", "benchmarks", "docs", "studies", "tests")
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
@pytest.mark.parametrize(
    "room", [pytest.param(each, marks=VALIDATED.get(each, ())) for each in ("", *STANDS_ON)]
)
def test_examples_in_docstrings(room):
    # The names that a room hands out have their examples where they are defined.
    names = [name for name in MODULES if name.split(".")[0] == room and name not in cb._ROOMS]
    modules = [f"crazybilliards.{name}".removesuffix(".") for name in names or [""]]
    failed = {name: doctest.testmod(importlib.import_module(name)).failed for name in modules}
    assert not any(failed.values()), failed
