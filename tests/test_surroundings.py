"""What surrounds a program: home folders, settings of numpy, archives, scripts, units, quotas."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import installation
import numpy as np
import pytest
from every_solver import SOLVERS, Given
from small_sweeps import AtOnce

import crazybilliards as cb
from crazybilliards.comparison.sweeps import read_sweep, run_cases
from crazybilliards.model import process
from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.model.vocabulary import VOCABULARY, described, unit_of

ROOT = installation.ROOT
CHAIN = cb.Chain(size=3)


def test_a_tilde_is_the_home_folder(tmp_path, monkeypatch, run):
    home, here = tmp_path / "home", tmp_path / "here"
    for folder in (home, here):
        folder.mkdir()
    for name in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(name, str(home))
    monkeypatch.chdir(here)
    exact = cb.equilibrium(CHAIN)
    assert cb.save(exact, "~/a/exact.nc") == home / "a" / "exact.nc"
    assert cb.load("~/a/exact.nc").identical(exact)
    cb.simulate(CHAIN, duration=100, checkpoint=Path("~/run.ckpt"), progress=False)
    (home / "grid.toml").write_text("[grid]\nsize = [2, 3]\n[force_balance]\n")
    sweep = read_sweep("~/grid.toml")
    assert not run_cases(sweep, "~/sweep", AtOnce(), progress=False)
    assert cb.load_sweep("~/sweep").sizes["size"] == 2
    done = run("theory", "equilibrium", "--size=3", "--output=~/figures")
    assert done.returncode == 0, done.stderr
    assert (home / "figures" / "theory.nc").exists()
    assert (home / "run.ckpt").exists()
    assert not list(here.iterdir())


@pytest.mark.compiled
@pytest.mark.parametrize("name", ["hydrodynamics, label", "phase_space", "equilibrium", "simulate"])
def test_settings_of_numpy_break_nothing(name):
    chain = cb.Chain(size=6, gap=0.1, **SOLVERS[name].needs)
    times = {"duration": 2.0, "every": 1.0}
    given = Given(start=cb.displaced(chain, 1.0), variance=np.ones_like, number=0.1, times=times)
    plain = SOLVERS[name].solve(chain, given)
    with np.errstate(all="raise"):
        assert SOLVERS[name].solve(chain, given).equals(plain)
        assert set(np.geterr().values()) == {"raise"}


IN_ARCHIVE = """
import sys
sys.meta_path[:] = [each for each in sys.meta_path if "editable" not in repr(each).lower()]
sys.path.insert(0, sys.argv[1])
import crazybilliards as cb
from crazybilliards.model.fingerprint import room_fingerprint
assert cb.__file__.startswith(sys.argv[1]), cb.__file__
assert cb.equilibrium(cb.Chain(size=3)).attrs["status"] == "completed"
print(room_fingerprint("model", "kinetic"), len(cb.__all__))
"""


def test_it_is_imported_from_a_zip_archive(tmp_path):
    archive = tmp_path / "crazybilliards.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for folder in ("api", *cb._ROOMS):
            inside = Path("crazybilliards", "" if folder == "api" else folder)
            for path in [*(ROOT / folder).rglob("*.py*"), *(ROOT / folder).rglob("*.csv")]:
                if "__pycache__" not in path.parts:
                    file.write(path, inside / path.relative_to(ROOT / folder))
    quiet = {**os.environ, "PYTHONWARNINGS": "ignore"}
    done = installation.run(sys.executable, "-c", IN_ARCHIVE, archive, env=quiet, cwd=tmp_path)
    assert done.stdout.split() == [room_fingerprint("model", "kinetic"), str(len(cb.__all__))]


UNGUARDED = """
from crazybilliards.model import Chain
from crazybilliards.comparison.sweeps import Case, process_pool, run_cases

with process_pool(1) as pool:
    run_cases([Case("force_balance", Chain(size=3), {})], "out", pool, progress=False)
"""


def test_a_script_without_a_main_guard_is_told_so(tmp_path):
    (tmp_path / "script.py").write_text(UNGUARDED)
    command = [sys.executable, "script.py"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, timeout=300)
    last = done.stderr.splitlines()[-1]
    assert last.startswith("RuntimeError: no worker process could start")
    assert "if __name__ == '__main__':" in last


def test_units_are_not_those_of_a_unit_library():
    for _, unit in VOCABULARY.values():
        written = described("", unit)["units"]
        for word in written.replace("^", " ").replace("/", " ").split():
            assert word.strip("()").isdecimal() or word in ("R_0", "M_0", "T_0")
    width = cb.equilibrium(CHAIN).velocity_width
    assert width.attrs["units"] == "R_0/T_0"
    assert unit_of(width) == unit_of(width.assign_attrs(units="R/T")) == "R/T"
    assert (
        cb.overlay({"exact": cb.equilibrium(CHAIN)}, "velocity_width").get_ylabel()[-5:] == "[R/T]"
    )


@pytest.mark.parametrize(
    ("files", "cores"),
    [
        ({"cpu.max": "max 100000"}, 8),
        ({"cpu.max": "150000 100000"}, 2),
        ({"a/cpu.max": "10000 100000", "cpu.max": "max 100000"}, 1),
        ({"a/cpu.max": "max 100000", "cpu.max": "400000 100000"}, 4),
        ({}, 8),
    ],
)
def test_a_quota_limits_the_cores(files, cores, tmp_path, monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(8)), raising=False)
    monkeypatch.delenv("SLURM_CPUS_PER_TASK", raising=False)
    files = {f"sys/fs/cgroup/{name}": text for name, text in files.items()}
    for name, text in {**files, "proc/self/cgroup": "4:cpu,cpuacct:/a\n0::/a"}.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(f"{text}\n")
    assert process.cores(tmp_path) == cores
    for task, allowed in (("2", 2), ("16", 8), ("all", 8)):
        monkeypatch.setenv("SLURM_CPUS_PER_TASK", task)
        assert process.cores(tmp_path) == min(cores, allowed)
