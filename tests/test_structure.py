"""The four rooms stand on one another in one direction only, and their docstrings are true."""

import ast
import doctest
import importlib
import pkgutil

import pytest

STANDS_ON = {
    "model": {"model"},
    "particles": {"model", "particles"},
    "kinetic": {"model", "kinetic"},
    "comparison": {"model", "particles", "kinetic", "comparison"},
}


def modules():
    for room in STANDS_ON:
        package = importlib.import_module(f"crazybilliards.{room}")
        yield package.__name__, package.__file__
        for info in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            yield info.name, importlib.import_module(info.name).__file__


@pytest.mark.parametrize(("name", "path"), list(modules()), ids=lambda value: value.split("/")[-1])
def test_no_room_imports_what_stands_above_it(name, path):
    with open(path, encoding="utf-8") as file:
        tree = ast.parse(file.read())
    imported = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    imported |= {
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.Import)
        for alias in node.names
    }
    rooms = {each.split(".")[1] for each in imported if each and each.startswith("crazybilliards.")}
    assert rooms <= STANDS_ON[name.split(".")[1]]


@pytest.mark.compiled
@pytest.mark.parametrize("name", [name for name, _ in modules()])
def test_examples_in_docstrings(name):
    outcome = doctest.testmod(importlib.import_module(name))
    assert outcome.failed == 0
