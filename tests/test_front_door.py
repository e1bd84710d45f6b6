"""``import crazybilliards as cb``: all public names, loaded late, from wherever it is installed."""

import os
import pydoc
import re
import subprocess
import sys
import tomllib
import zipfile
from email import message_from_bytes
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from shutil import copy, copytree, ignore_patterns

import pytest
import yaml
from readme_renderer import markdown

import crazybilliards as cb

ROOT = Path(__file__).parent.parent
FOLDERS = {"api": ""} | {room: f".{room}" for room in (*cb._ROOMS, "reproduction", "apps")}
ROOMS = [f"crazybilliards.{room}" for room in cb._ROOMS]  # those with public names
EXPECTED = ["Chain", "simulate", "force_balance", "overlay", "load", "save", "equilibrium"]
# What a user types, by whatever way the package was installed.
TRY = f"""
import sys
import crazybilliards as cb
assert not {{"numpy", "numba", "xarray"}} & set(sys.modules)
assert set({EXPECTED}) <= set(dir(cb))
assert cb.Chain(size=3).size == 3 and cb.__version__ == {version("crazybilliards")!r}
from crazybilliards import kinetic, simulate
print(cb.__file__)
"""


def run(*command, **options):
    done = subprocess.run(
        [*map(str, command)], capture_output=True, text=True, timeout=300, check=False, **options
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


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
    assert min(float(run(sys.executable, "-c", script)) for _ in range(3)) < 0.05


@pytest.mark.parametrize("where", [ROOT, None])
def test_as_it_is_installed_here(where, tmp_path):
    folder = tmp_path if where is None else where
    assert Path(run(sys.executable, "-c", TRY, cwd=folder).strip()).name == "__init__.py"
    assert "Example: crazybilliards" in run(sys.executable, "-m", "crazybilliards", cwd=folder)


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Build the wheel from a copy and install it into an environment that borrows the rest."""
    source, there = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("there")
    for folder in FOLDERS:
        copytree(ROOT / folder, source / folder, ignore=ignore_patterns("__pycache__"))
    for file in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        copy(ROOT / file, source)
    quiet = ("--quiet", "--no-deps", "--disable-pip-version-check")
    pip = (sys.executable, "-m", "pip")
    run(*pip, "wheel", *quiet, "--no-build-isolation", "--wheel-dir", there, source)
    run(sys.executable, "-m", "venv", "--without-pip", there / "venv")
    binaries = there / "venv" / ("Scripts" if os.name == "nt" else "bin")
    python = binaries / "python"
    where = "import sysconfig; print(sysconfig.get_path('purelib'))"
    packages = Path(run(python, "-c", where).strip())
    borrowed = [path for path in sys.path if path.endswith("-packages")]
    (packages / "borrowed.pth").write_text("\n".join(borrowed), encoding="utf-8")
    [wheel] = there.glob("*.whl")
    run(*pip, "--python", python, "install", *quiet, "--no-index", wheel)
    return wheel, binaries


PACKED = ("*.py", "*.pyi", "py.typed", "*.mplstyle", "*.css", "*.js", "*.html", "*.csv")


def test_the_wheel_holds_every_module_and_stub(installed):
    with zipfile.ZipFile(installed[0]) as archive:
        shipped = {name for name in archive.namelist() if not name.split("/")[0].endswith("info")}
    wanted = {
        (Path("crazybilliards" + name.replace(".", "/")) / path.relative_to(ROOT / folder))
        for folder, name in FOLDERS.items()
        for pattern in PACKED
        for path in (ROOT / folder).rglob(pattern)
    }
    assert shipped == {path.as_posix() for path in wanted}


def test_the_page_of_the_package_index_has_no_relative_link(installed):
    """The index shows the README, and nothing beside it."""
    with zipfile.ZipFile(installed[0]) as archive:
        [name] = [name for name in archive.namelist() if name.endswith("/METADATA")]
        page = markdown.render(message_from_bytes(archive.read(name)).get_payload())
    links = re.findall(r'(?:href|src)="([^#][^"]*)"', page)
    assert len(links) > 30
    own = re.compile(rf"https://github\.com/[^/]+/crazybilliards/(blob|raw)/v{cb.__version__}/")
    for link in links:
        assert link.startswith("https://"), link
        if own.match(link):
            assert (ROOT / own.sub("", link).split("#")[0]).exists(), link
    assert sum(bool(own.match(link)) for link in links) > 20


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


def test_the_wheel_installed(installed, tmp_path):
    _, binaries = installed
    for folder in (tmp_path, ROOT):
        file = run(binaries / "python", "-c", TRY, cwd=folder).strip()
        assert file.startswith(str(binaries.parent))
    for command in ((binaries / "crazybilliards",), (binaries / "python", "-m", "crazybilliards")):
        said = run(*command, "--version", cwd=tmp_path)
        assert said == f"crazybilliards {version('crazybilliards')}\n"


# Only this package matters here, and reading the others takes half a minute.
MYPY = """
[mypy]
warn_unused_ignores = True
disable_error_code = import-untyped, import-not-found
[mypy-numpy.*,xarray.*,scipy.*,pandas.*,matplotlib.*,numba.*,h5py.*,dask.*,distributed.*,pde.*,skfem.*,tqdm.*]
follow_imports = skip
follow_imports_for_stubs = True
"""
TYPED = """
import crazybilliards as cb
from crazybilliards.kinetic import force_balance

chain: cb.Chain = cb.Chain(size=3)
run = cb.simulate(chain, seed=1)
size: int = chain.size
release: str = cb.__version__
force_balance(chain)
cb.nonsense  # type: ignore[attr-defined]
cb.Chain(size="3")  # type: ignore[arg-type]
cb.simulate(chain, seed="1")  # type: ignore[arg-type]
"""


def test_type_checkers_see_through(installed, tmp_path):
    """``warn_unused_ignores`` makes mistakes that are not found errors."""
    pytest.importorskip("mypy")
    (tmp_path / "mypy.ini").write_text(MYPY)
    (tmp_path / "user.py").write_text(TYPED)
    python = ("--python-executable", installed[1] / "python")
    run(sys.executable, "-m", "mypy", "--config-file", "mypy.ini", *python, "user.py", cwd=tmp_path)


def test_every_folder_of_the_package_is_shipped():
    with open(ROOT / "pyproject.toml", "rb") as file:
        listed = tomllib.load(file)["tool"]["setuptools"]["packages"]
    there = {
        ".".join([f"crazybilliards{name}", *path.parent.relative_to(ROOT / folder).parts])
        for folder, name in FOLDERS.items()
        for path in (ROOT / folder).rglob("*.py")
    }
    assert sorted(there) == sorted(listed)


def test_no_folder_shadows_the_package():
    assert not (ROOT / "crazybilliards").exists()
