"""The commands ``simulate`` and ``theory``: what the functions return, in a file."""

import pytest
import xarray as xr

from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.model import Chain, chain_of, load
from crazybilliards.particles import simulate


def test_simulate_writes_what_the_function_returns(run, tmp_path):
    file = tmp_path / "new" / "simulation.nc"
    options = ["--size", 6, "--restitution", 0.9, "--duration", 30, "--warmup", 3, "--seed", 7]
    options += ["--time-step", 0.01, "--every", 0.5, "--replicas", 2, "--particles", "1,6"]
    options += ["--observe", "widths, energy", "--threads", 1]
    options += ["--method", "contact-dynamics", "--checkpoint", tmp_path / "state"]
    done = run("simulate", *options, "--output", file.parent)
    assert done.returncode == 0, done.stderr
    how = {"duration": 30.0, "warmup": 3.0, "time_step": 0.01, "every": 0.5, "replicas": 2}
    how |= {"particles": [1, 6], "observe": ["widths", "energy"], "seed": 7, "progress": False}
    expected = simulate(Chain(size=6, restitution=0.9), method="contact-dynamics", **how)
    xr.testing.assert_identical(load(file), expected)
    assert f"completed at t = {expected.attrs['end_time']:g} t_0, time step 0.01 t_0" in done.stdout
    assert "error of the smallest W_v due to the time step" in done.stdout
    assert "_error" not in done.stdout
    first = expected.isel(particle=0)
    assert f"{first.velocity_width:.4g} +- {first.velocity_width_error:.1g}" in done.stdout
    assert {path.name for path in tmp_path.iterdir()} == {"new", "state"}


def test_simulate_an_ensemble_without_a_file(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options = ["--average", "ensemble", "--size", 3, "--replicas", 2, "--duration", 1]
    done = run("simulate", *options)
    assert done.returncode == 0, done.stderr
    assert "Nothing was written" in done.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.compiled  # uncompiled, an overflow warns
@pytest.mark.filterwarnings("always:.* chain diverged")
def test_a_chain_that_diverges_ends_with_status_1(run, tmp_path):
    options = ["--size", 50, "--restitution", 2, "--damping", 0.01, "--duration", 1e5]
    options += ["--warmup", 0, "--every", 0.01, "--observe", "energy"]
    done = run("simulate", *options, "--output", tmp_path)
    assert done.returncode == 1
    assert "diverged at t = " in done.stdout
    assert "the chain diverged after t = " in done.stderr
    assert done.stderr.count("diverged") == 1
    result = load(tmp_path / "simulation-diverged.nc")
    assert (result.attrs["status"], chain_of(result).size) == ("diverged", 50)


@pytest.mark.usefixtures("sketched")
@pytest.mark.parametrize("name", THEORIES)
def test_every_theory_by_its_name(name, run, tmp_path):
    done = run("theory", name, "--size", 4, "--amplitude", 5, "--output", tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    result = THEORIES[name].solve(Chain(size=4, amplitude=5))
    assert load(tmp_path / "theory.nc").identical(result)
    written = {"density.png", "profile.png", "theory.nc"}
    assert {path.name for path in tmp_path.iterdir()} == written
    assert THEORIES[name].title.capitalize() in " ".join(done.stdout.split())
    assert f"{result.velocity_width[0]:.4g}" in done.stdout


@pytest.mark.parametrize(
    ("chain", "title", "walls"),
    [
        ("--size 4 --restitution 0.5", "Gas, L = 4, e = 0.5", False),
        ("--size 4 --box 20 --stiffness 0", "Exact equilibrium, L = 4, e = 1", True),
    ],
)
def test_without_a_name_it_is_the_theory_of_the_chain_and_says_so(run, chain, title, walls):
    """In a box the error of the force on the walls is stated as well."""
    done = run("theory", *chain.split())
    assert done.returncode == 0
    assert done.stdout.startswith(title)
    assert ("force on" in done.stdout) == walls
