"""The command ``simulate``: what the function returns, in a file."""

import pytest
import xarray as xr

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
def test_a_chain_that_diverges_ends_with_status_1(run, tmp_path):
    options = ["--size", 50, "--restitution", 2, "--damping", 0.01, "--duration", 1e5]
    done = run("simulate", *options, "--output", tmp_path)
    assert done.returncode == 1
    assert "diverged at t = " in done.stdout
    assert "warning" not in done.stderr
    assert "the simulation diverged: collisions bring in more energy" in done.stderr
    result = load(tmp_path / "simulation-diverged.nc")
    assert (result.attrs["status"], chain_of(result).size) == ("diverged", 50)
