"""The package as it is handed out, and run where users run it.

The wheel is installed into an environment of its own, which borrows all other packages, and where
nobody may write. There the command of `make run` runs in another folder: as whoever runs the tests,
and as a user who may write nowhere but into that folder, like one of a container, a batch node or a
service.
"""

import os
import re
import subprocess
import sys
import tempfile
import zipfile
from email import message_from_bytes
from importlib.metadata import version
from pathlib import Path
from shutil import copy, copytree, ignore_patterns

import pytest
from installation import FOLDERS, ROOT, TRY, run
from readme_renderer import markdown

PIP = (sys.executable, "-m", "pip")
BUILD = """
import os, shutil, sys
import setuptools.build_meta as build
there = sys.argv[1]
shutil.unpack_archive(os.path.join(there, build.build_sdist(there)), "unpacked")
[folder] = os.listdir("unpacked")
os.chdir(os.path.join("unpacked", folder))
build.build_wheel(there)
"""
PACKAGES = "import sysconfig; print(sysconfig.get_path('purelib'))"
QUIET = ("--quiet", "--no-deps", "--disable-pip-version-check")


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Build the wheel from the source distribution of a copy and install it; return both."""
    source, there = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("there")
    for folder in FOLDERS:
        copytree(ROOT / folder, source / folder, ignore=ignore_patterns("__pycache__"))
    for file in ("pyproject.toml", "docs/package_index.md", "LICENSE"):
        (source / file).parent.mkdir(exist_ok=True)
        copy(ROOT / file, source / file)
    run(sys.executable, "-c", BUILD, there, cwd=source)
    run(sys.executable, "-m", "venv", "--without-pip", there / "venv")
    binaries = there / "venv" / ("Scripts" if os.name == "nt" else "bin")
    packages = Path(run(binaries / "python", "-c", PACKAGES).stdout.strip())
    borrowed = [path for path in sys.path if path.endswith("-packages")]
    (packages / "borrowed.pth").write_text("\n".join(borrowed), encoding="utf-8")
    [wheel] = there.glob("*.whl")
    run(*PIP, "--python", binaries / "python", "install", *QUIET, "--no-index", wheel)
    return wheel, binaries


PACKED = ("*.py", "*.pyi", "py.typed", "*.mplstyle", "*.css", "*.js", "*.html", "*.csv")


@pytest.mark.validate
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


@pytest.mark.validate
def test_the_page_of_the_package_index_has_no_relative_link(installed):
    """The index shows it alone; its script is that of the README."""
    with zipfile.ZipFile(installed[0]) as archive:
        [name] = [name for name in archive.namelist() if name.endswith("/METADATA")]
        page = message_from_bytes(archive.read(name)).get_payload(decode=True).decode()
    links = re.findall(r'(?:href|src)="([^#"][^"]*)"', markdown.render(page))
    assert links
    assert all(link.startswith("https://") for link in links)
    [script] = re.findall(r"```python\n.*?```", page, re.DOTALL)
    assert script in (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.validate
def test_the_wheel_installed(installed, tmp_path):
    _, binaries = installed
    for folder in (tmp_path, ROOT):
        file = run(binaries / "python", "-c", TRY, cwd=folder).stdout.strip()
        assert file.startswith(str(binaries.parent))
    for command in ((binaries / "crazybilliards",), (binaries / "python", "-m", "crazybilliards")):
        said = run(*command, "--version", cwd=tmp_path).stdout
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
run = cb.simulate(chain, observe=cb.observers.Density(reach=3))
size: int = chain.size
release: str = cb.__version__
force_balance(chain)
cb.nonsense  # type: ignore[attr-defined]
cb.Chain(size="3")  # type: ignore[arg-type]
cb.simulate(chain, duration="1")  # type: ignore[arg-type]
"""


@pytest.mark.validate
def test_type_checkers_see_through(installed, tmp_path):
    """``warn_unused_ignores`` makes mistakes that are not found errors."""
    pytest.importorskip("mypy")
    (tmp_path / "mypy.ini").write_text(MYPY)
    (tmp_path / "user.py").write_text(TYPED)
    python = ("--python-executable", installed[1] / "python")
    run(sys.executable, "-m", "mypy", "--config-file", "mypy.ini", *python, "user.py", cwd=tmp_path)


# -- where users run it ------------------------------------------------------------------------

# `make run`, smaller. Kernels, a theory, pictures and a file.
RUN = ["compare", "--size", "4", "--duration", "300", "--amplitude", "10", "--output", "results"]
WRITTEN = {"cases", "comparison.nc", "density.png", "displacement.png", "widths.png"}
NOBODY = 12345
# A user that no list of users knows. Such a user could not even start a Python that lies in root's
# home, so this one may read everything.
AS_NOBODY = [
    *("setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"),
    *("--inh-caps=+dac_read_search", "--ambient-caps=+dac_read_search"),
]


@pytest.fixture
def folder():
    """Give a folder that is that user's, if there is one."""
    # Not tmp_path: pytest makes folders that only whoever runs the tests may enter.
    with tempfile.TemporaryDirectory() as folder:
        if os.getuid() == 0:
            os.chown(folder, NOBODY, NOBODY)
            if subprocess.run([*AS_NOBODY, sys.executable, "-c", ""], check=False).returncode:
                pytest.skip("cannot become another user here")
        yield Path(folder)


@pytest.mark.torture
def test_a_user_who_may_write_nowhere_else_gets_results_and_one_warning(installed, folder):
    """Neither into the environment nor into a home or a folder for the cache."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA")}
    home = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR"), "/proc/none")
    environment = kept | home | {"MPLCONFIGDIR": str(folder)}
    _, binaries = installed
    command = [*(AS_NOBODY if os.getuid() == 0 else []), binaries / "crazybilliards", *RUN]
    run("chmod", "-R", "a-w", binaries.parent)
    try:
        done = run(*command, cwd=folder, env=environment)
    finally:
        run("chmod", "-R", "u+w", binaries.parent)
    assert {path.name for path in (folder / "results").iterdir()} == WRITTEN
    assert "wrote results/comparison.nc" in done.stdout
    assert done.stderr.count("NUMBA_CACHE_DIR") == 1, done.stderr
