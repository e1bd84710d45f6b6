"""``import crazybilliards as cb``: all public names, loaded late, from wherever it is installed."""

import pydoc
import sys
import tomllib
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest
import yaml
from installation import EXPECTED, ROOT, run

import crazybilliards as cb

ROOMS = [f"crazybilliards.{room}" for room in cb._ROOMS]  # those with public names


def test_all_names_of_all_rooms_are_there():
    names = [(room, name) for room in ROOMS for name in import_module(room).__all__]
    assert len({name for _, name in names}) == len(names), "two rooms share a name"
    assert {name for _, name in names} == set(cb.__all__) < set(dir(cb))
    for room, name in names:
        assert getattr(cb, name) is getattr(import_module(room), name)
    assert set(EXPECTED) <= set(cb.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        cb.nonsense  # noqa: B018


@pytest.mark.parametrize("name", ["crazybilliards", *ROOMS])
def test_a_public_name_is_no_module(name):
    """Importing a module of that name would put it in the place of the function."""
    package = import_module(name)
    for public in package.__all__:
        assert not any(list(Path(folder).glob(f"{public}*")) for folder in package.__path__)


def test_help_tells_of_everything():
    text = pydoc.render_doc(cb, renderer=pydoc.plaintext)
    for name in cb.__all__:
        assert name in text
    assert version("crazybilliards") in text


def test_the_import_is_quick():
    script = "import time; t = time.process_time(); import crazybilliards; "
    script += "print(time.process_time() - t)"
    assert min(float(run(sys.executable, "-c", script).stdout) for _ in range(3)) < 0.05


def test_citation_and_recipe_follow_the_project():
    """The version is defined in pyproject.toml, and so is what the package needs."""
    files = (ROOT / "CITATION.cff", ROOT / ".conda" / "recipe.yaml")
    citation, recipe = (yaml.safe_load(file.read_text(encoding="utf-8")) for file in files)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert citation["version"] == recipe["context"]["version"] == project["version"]
    needed = [each.replace(" ", "") for each in recipe["requirements"]["run"]]
    needed = {
        each.replace("matplotlib-base", "matplotlib") for each in needed if each[:6] != "python"
    }
    assert needed == set(project["dependencies"])


def test_no_folder_shadows_the_package():
    assert not (ROOT / "crazybilliards").exists()
