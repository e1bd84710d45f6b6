"""Disks that are full, read-only, or no place at all.

What cannot be written is one clear error that names the place: before any work where it shows
then; in the middle of a simulation a warning, and the run goes on. What was written before stays
whole and valid, no half file is left, and when there is room again the same call goes on.

A disk that is full or read-only is a small file system in memory, which takes root to mount;
without, a limit to the size of a file does for a full one.
"""

import os
import subprocess

import numpy as np
import pytest

from crazybilliards.comparison import film
from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain, load, save
from crazybilliards.particles import simulate

resource = pytest.importorskip("resource")  # not on Windows
torture = pytest.mark.torture

GRID = """
[grid]
size = [4, 10, 30]
restitution = [0.5, 1.0]
[simulate]
duration = {duration}
"""
COMMANDS = {
    "sweep": ["grid.toml"],
    "compare": ["--size", "30", "--duration", "2000"],
    "theory": [],
    "reproduce": ["1"],
}
RUN = {"duration": 500.0, "replicas": 2, "progress": False}


def mount(*arguments):
    done = subprocess.run(["mount", *map(str, arguments)], capture_output=True, check=False)
    if done.returncode:
        pytest.skip("needs to mount a file system")


@pytest.fixture
def small(tmp_path):
    """Give a file system of 1 MB."""
    folder = tmp_path / "small"
    folder.mkdir()
    mount("-t", "tmpfs", "-o", "size=1m", "tmpfs", folder)
    yield folder
    subprocess.run(["umount", "--lazy", str(folder)], check=True)


@pytest.fixture(params=[pytest.param("no room", marks=torture), "file too large"])
def squeeze(request, tmp_path):
    """Give a folder, what leaves some bytes to write there, and how often to try."""
    if request.param == "no room":
        folder = request.getfixturevalue("small")
        filler = folder / "filler"

        def leave(number):
            filler.unlink(missing_ok=True)
            free = os.statvfs(folder).f_bavail * os.statvfs(folder).f_bsize
            if number is not None:
                filler.write_bytes(b"x" * max(free - number, 0))

        yield folder, leave, 100
        return
    before = resource.getrlimit(resource.RLIMIT_FSIZE)

    def leave(number):
        limit = before[0] if number is None else number
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))

    yield tmp_path, leave, 12
    leave(None)


def test_wherever_the_room_ends_the_old_file_stays(squeeze):
    folder, leave, attempts = squeeze
    old, new = (equilibrium(Chain(size=size))[["velocity_width"]] for size in (3, 100))
    most = save(new, folder / "run.nc").stat().st_size
    path = save(old, folder / "run.nc")
    failures = set()
    for room in [0, *np.random.default_rng(1).integers(0, 1.2 * most, attempts - 1)]:
        leave(int(room))
        try:
            save(new, path)
            expected = new
        except OSError as error:
            failures.add((error.filename, error.strerror, int(room)))
            expected = old
        assert load(path).identical(expected)
        assert {each.name for each in folder.iterdir()} <= {"run.nc", "filler", "small"}
        leave(None)
        save(old, path)
    assert len(failures) > attempts / 10
    reasons = {"No space left on device", "File too large"}
    assert all(name == str(path) and reason in reasons for name, reason, _ in failures)


@pytest.mark.compiled
def test_a_disk_full_in_the_middle_of_a_run(squeeze, monkeypatch):
    """The checkpoint from before the disk was full stays valid, and the run loses nothing."""
    folder, leave, _ = squeeze
    chain = Chain(size=20, restitution=0.9)
    undisturbed = simulate(chain, **RUN)
    replace = os.replace

    def then_fill(source, target):
        replace(source, target)
        leave(0)

    monkeypatch.setattr(os, "replace", then_fill)
    arguments = RUN | {"checkpoint": folder / "state", "checkpoint_interval": 0}
    with pytest.warns(RuntimeWarning, match="state: no checkpoint written: (No space|File too)"):
        assert simulate(chain, **arguments).identical(undisturbed)
    monkeypatch.undo()
    with pytest.raises(OSError, match="state"):  # full from the start: before any work
        simulate(chain, **arguments)
    leave(None)
    assert simulate(chain, **arguments).identical(undisturbed)


@torture
@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_that_finds_no_place_says_so_and_goes_on_where_there_is_one(
    name, small, tmp_path, run, monkeypatch
):
    """On a read-only disk it ends before any work."""
    monkeypatch.chdir(tmp_path)

    def require_refused(folder, reason=""):
        done = run(name, *COMMANDS[name], "--output", folder)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
        assert f"{reason}: '{small}" in done.stderr
        return done

    (tmp_path / "grid.toml").write_text(GRID.format(duration=1e9))
    mount("-o", "remount,ro", small)
    for folder in (small, small / "new"):
        assert require_refused(folder).stdout == ""
    with pytest.raises(OSError, match=r"Read-only file system: '.*state"):
        simulate(Chain(), duration=1e9, checkpoint=small / "state", progress=False)
    (tmp_path / "grid.toml").write_text(GRID.format(duration=300))
    mount("-o", "remount,rw", small)
    (small / "filler").write_bytes(b"x" * (800_000 if name == "sweep" else 1_040_000))
    require_refused(small, "No space left on device")
    assert [path.name for path in small.iterdir() if path.suffix == ".part"] == []
    (small / "filler").unlink()
    kept = {path: path.read_bytes() for path in small.glob("*.nc")}
    mount("-o", "remount,size=10m", small)
    done = run(name, *COMMANDS[name], "--output", small)
    assert (done.returncode, done.stderr) == (0, "")
    assert kept.items() <= {path: path.read_bytes() for path in small.glob("*.nc")}.items()
    if name == "sweep":
        assert 0 < len(kept) < 6


@pytest.mark.parametrize("name", ["file/state", "file/deep/state", "folder", "x" * 300, "a\0b"])
def test_no_place_for_a_checkpoint_is_an_error_before_any_work(name, tmp_path):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "folder").mkdir()
    with pytest.raises((OSError, ValueError)) as caught:
        simulate(Chain(), duration=1e9, checkpoint=tmp_path / name, progress=False)
    assert "\n" not in str(caught.value)
    with pytest.raises(OSError, match=r"Not a directory: .*rods.gif"):
        film(Chain(), tmp_path / "file" / "rods.gif", duration=1e9, progress=False)
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["file", "folder"]
