"""The house stands: nothing imports upwards, no file is long, the front door has all names."""

import ast
import doctest
import graphlib
import pydoc
import sys
import tomllib
from importlib import import_module
from importlib.metadata import version

import architecture
import pytest
from installation import EXPECTED, ROOMS, ROOT

import crazybilliards as cb

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
        {"start", "timing"},
        {"run"},
        {"observers"},
        {"running"},
        {"simulation"},
    ),
    "kinetic": (
        {"accuracy", "requirements"},
        {"statics", "exact"},
        {"rods"},
        {"starts"},
        {"gas"},
        {"fluids"},
    ),
    "comparison": (
        {"combining", "coverage", "curves", "distances", "drawing", "fits", "stationary_theories"},
        {"sweeps"},
        {"side_by_side"},
        {"films"},
    ),
    "reproduction": ({"claims", "fits"}, {"chains", "distributions", "profiles"}, {"figures"}),
    "apps": ({"explore"}, {"commands"}),
}
LINES = 300
VALIDATED = {"kinetic": pytest.mark.validate}  # its examples take seconds
MODULES = architecture.modules()


def test_rooms_import_modules_of_the_rooms_that_they_stand_on():
    """Not the names of their own room, which would hide from which floor they come."""
    for name, imported in architecture.imports().items():
        room = name.split(".")[0]
        assert {each.split(".")[0] for each in imported} <= STANDS_ON[room], name
        assert room not in imported, name


@pytest.mark.parametrize("room", FLOORS)
def test_no_folder_imports_what_stands_above_it(room):
    graph = architecture.unit_imports(room)
    floor = {f"{room}.{unit}": at for at, units in enumerate(FLOORS[room]) for unit in units}
    assert set(graph) == set(floor), "every module and folder of a room has its floor"
    for name, targets in graph.items():
        assert not [target for target in targets if floor[target] > floor[name]], name


@pytest.mark.parametrize("room", STANDS_ON)
def test_nothing_imports_in_a_circle(room):
    graphlib.TopologicalSorter(architecture.unit_imports(room)).prepare()
    graphlib.TopologicalSorter(architecture.imports()).prepare()


def test_nothing_is_named_like_its_module():
    """Importing the module would hide the function or class behind it, and so would a folder."""
    assert not (ROOT / "crazybilliards").exists()
    for name, path in MODULES.items():
        body = ast.parse(path.read_text(encoding="utf-8")).body
        assert name.split(".")[-1] not in {getattr(node, "name", "") for node in body}, path


def test_no_file_is_long():
    for folder in (*STANDS_ON, "api", "benchmarks", "docs", "studies", "tests"):
        for path in (ROOT / folder).rglob("*.py"):
            short = len(path.read_text(encoding="utf-8").splitlines()) < LINES
            assert short or "docs/notebooks" in path.as_posix(), path


def test_the_picture_of_the_architecture_shows_the_imports():
    """If it does not, draw it again: python docs/figures/architecture.py."""
    assert architecture.described() in architecture.PICTURE.read_text(encoding="utf-8")


@pytest.mark.compiled
@pytest.mark.parametrize(
    "room", [pytest.param(each, marks=VALIDATED.get(each, ())) for each in ("", *STANDS_ON)]
)
def test_examples_in_docstrings(room):
    # The names that a room hands out have their examples where they are defined.
    names = [name for name in MODULES if name.split(".")[0] == room and name not in ROOMS]
    modules = [f"crazybilliards.{name}".removesuffix(".") for name in names or [""]]
    failed = {name: doctest.testmod(import_module(name)).failed for name in modules}
    assert not any(failed.values()), failed


# -- ``import crazybilliards as cb``: all public names, loaded late -----------------------------

PUBLIC = [f"crazybilliards.{room}" for room in (*ROOMS, "particles.observers")]


def test_the_front_door_has_the_names_that_most_users_need():
    names = {
        name: getattr(import_module(room), name)
        for room in PUBLIC
        for name in import_module(room).__all__
    }
    for name in cb.__all__:
        assert getattr(cb, name) is names.get(name, sys.modules.get(f"crazybilliards.{name}"))
    assert set(EXPECTED) <= set(cb.__all__)
    assert len(cb.__all__) <= 40
    described = pydoc.render_doc(cb, renderer=pydoc.plaintext)
    assert not [name for name in (*cb.__all__, version("crazybilliards")) if name not in described]
    with pytest.raises(AttributeError, match="nonsense"):
        cb.nonsense  # noqa: B018


@pytest.mark.parametrize("name", [*" ".join(cb._MOVED.values()).split(), *cb._GONE])
def test_an_old_name_says_where_it_is(name):
    with pytest.raises(AttributeError, match=f"{name} is ") as caught:
        getattr(cb, name)
    place = str(caught.value).partition(" is ")[2]
    assert place.startswith("gone: ") or eval(place).__name__ == name


def test_the_citation_has_the_version_of_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()
    assert f"version: {project['version']}" in citation
