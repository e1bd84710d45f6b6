"""The package as it is handed out, and run where users run it.

The source distribution is built from the tracked files, the wheel from the source distribution, and
the wheel is installed into an environment of its own, which borrows all other packages. There the
command of `make run` runs in another folder: as whoever runs the tests, and as a user who may
write nowhere but into that folder, like one of a container, a batch node or a service.
"""

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="users, mounts")

ROOT = Path(__file__).parents[2]
# `make run`, smaller. Kernels, a theory, pictures and a file.
RUN = ["compare", "--size", "4", "--duration", "300", "--amplitudes", "10", "--output", "results"]
WRITTEN = {"cases", "comparison.nc", "density.png", "displacement.png"}
NOBODY = 12345
# A user that no list of users knows. Such a user could not even start a Python that lies in root's
# home, so this one may read everything.
AS_NOBODY = [
    *("setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"),
    *("--inh-caps=+dac_read_search", "--ambient-caps=+dac_read_search"),
]


def run(*command, **options):
    done = subprocess.run(
        [*map(str, command)], capture_output=True, text=True, check=False, timeout=600, **options
    )
    assert done.returncode == 0, done.stderr
    return done


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """Build the source distribution, and unpack it."""
    git = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    if git.returncode:
        pytest.skip("needs git to tell which files are tracked")
    tree, there = tmp_path_factory.mktemp("tree"), tmp_path_factory.mktemp("sdist")
    tracked = set(git.stdout.splitlines())
    for name in tracked:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tree / name)
    build = f"import setuptools.build_meta as build; build.build_sdist({str(there)!r})"
    run(sys.executable, "-c", build, cwd=tree)
    [archive] = there.glob("*.tar.gz")
    with tarfile.open(archive) as content:
        content.extractall(there, filter="data")
    return tracked, archive.with_name(archive.name.removesuffix(".tar.gz"))


@pytest.fixture(scope="module")
def installed(source, tmp_path_factory):
    """Install the wheel, built from the source distribution, where nobody may write."""
    there = tmp_path_factory.mktemp("installed")
    quiet = ("--quiet", "--no-deps", "--disable-pip-version-check")
    pip = (sys.executable, "-m", "pip")
    run(*pip, "wheel", *quiet, "--no-build-isolation", "--wheel-dir", there, source[1])
    run(sys.executable, "-m", "venv", "--without-pip", there / "venv")
    python = there / "venv/bin/python"
    [packages] = (there / "venv").glob("lib/python*/site-packages")
    borrowed = [path for path in sys.path if path.endswith("-packages")]
    (packages / "borrowed.pth").write_text("\n".join(borrowed))
    [wheel] = there.glob("*.whl")
    run(*pip, "--python", python, "install", *quiet, "--no-index", wheel)
    run("chmod", "-R", "a-w", there)
    yield there / "venv/bin/crazybilliards"
    run("chmod", "-R", "u+w", there)


@pytest.fixture
def nobody():
    """Give what starts a command as a user without rights, and a folder that is that user's."""
    # Not tmp_path: pytest makes folders that only whoever runs the tests may enter.
    with tempfile.TemporaryDirectory() as folder:
        if os.getuid() != 0:
            yield [], Path(folder)
            return
        os.chown(folder, NOBODY, NOBODY)
        if subprocess.run([*AS_NOBODY, sys.executable, "-c", ""], check=False).returncode:
            pytest.skip("cannot become another user here")
        yield AS_NOBODY, Path(folder)


def nowhere(folder, **environment):
    """Return an environment without a home or a cache folder that one may write to."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA")}
    home = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR"), "/proc/none")
    return kept | home | {"MPLCONFIGDIR": str(folder)} | environment


def require_written(done, folder):
    assert {path.name for path in (folder / "results").iterdir()} == WRITTEN
    assert "close packing" in done.stdout
    assert "Traceback" not in done.stderr


def test_the_source_distribution_carries_every_tracked_file(source):
    tracked, there = source
    carried = {str(path.relative_to(there)) for path in there.rglob("*") if path.is_file()}
    made = {name for name in carried if "egg-info" in name} | {"PKG-INFO", "setup.cfg"}
    assert carried - made == tracked


def test_the_tests_of_the_source_distribution_run(source):
    quick = ["tests/test_concordance.py", "tests/model/test_locks.py"]
    run(sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *quick, cwd=source[1])


def test_the_command_runs_in_another_folder(installed, tmp_path):
    require_written(run(installed, *RUN, cwd=tmp_path), tmp_path)


def test_a_user_who_may_write_nowhere_else_gets_results_and_one_warning(installed, nobody):
    become, folder = nobody
    done = run(*become, installed, *RUN, cwd=folder, env=nowhere(folder))
    require_written(done, folder)
    warnings = [line for line in done.stderr.splitlines() if "warning" in line]
    assert len(warnings) == 1, done.stderr
    assert "compiled anew in every process" in warnings[0]


def test_workers_do_not_repeat_the_warning(installed, nobody):
    become, folder = nobody
    (folder / "grid.toml").write_text("[grid]\nsize = [3]\n[simulate]\nduration = 100\n")
    command = [*become, installed, "sweep", "grid.toml", "--output", "results"]
    done = run(*command, cwd=folder, env=nowhere(folder))
    assert done.stderr.count("compiled anew in every process") == 1, done.stderr
    assert len(list((folder / "results").iterdir())) == 1


def test_a_cache_on_a_full_disk_costs_no_run(installed, tmp_path):
    cache = tmp_path / "cache"
    cache.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", cache]
    if subprocess.run([*map(str, mount)], check=False, capture_output=True).returncode:
        pytest.skip("needs to mount a file system")
    try:
        there = nowhere(tmp_path, NUMBA_CACHE_DIR=str(cache))
        # A short command: every kernel is compiled anew.
        simulate = ["simulate", "--size", "4", "--duration", "300", "--output", "run.nc"]
        done = run(installed, *simulate, cwd=tmp_path, env=there)
    finally:
        subprocess.run(["umount", "--lazy", str(cache)], check=True)
    assert (tmp_path / "run.nc").stat().st_size > 1000
    assert "Traceback" not in done.stderr
    assert done.stderr.count("No space left on device") == 1, done.stderr
