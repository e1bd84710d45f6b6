"""The command ``simulate``: what the function returns, in a file."""

import json

import pytest
import xarray as xr

from crazybilliards.model import Chain, chain_of, load
from crazybilliards.particles import simulate


def test_simulate_writes_what_the_function_returns(run, tmp_path):
    file = tmp_path / "new" / "run.nc"
    options = ["--size", 6, "--restitution", 0.9, "--duration", 30, "--warmup", 3, "--seed", 7]
    options += ["--time-step", 0.01, "--every", 0.5, "--replicas", 2, "--particles", "1,6"]
    options += ["--observe", "widths, energy", "--threads", 1]
    options += ["--method", "contact-dynamics", "--checkpoint", tmp_path / "state"]
    done = run("simulate", *options, "--output", file)
    assert done.returncode == 0, done.stderr
    how = {"duration": 30.0, "warmup": 3.0, "time_step": 0.01, "every": 0.5, "replicas": 2}
    how |= {"particles": [1, 6], "observe": ["widths", "energy"], "seed": 7, "progress": False}
    expected = simulate(Chain(size=6, restitution=0.9), method="contact-dynamics", **how)
    xr.testing.assert_identical(load(file), expected)
    assert f"completed at t = {expected.attrs['end_time']:g} T, time step 0.01 T" in done.stdout
    assert "error of the smallest W_v due to the time step" in done.stdout
    first = expected.isel(particle=0)
    assert f"{first.velocity_width:.4g} +- {first.velocity_width_error:.1g}" in done.stdout
    assert {path.name for path in tmp_path.iterdir()} == {"new", "state"}


OBSERVED = {
    "impacts": "contact_force | contact 2 | M R/T^2",
    "energy": "kinetic_energy | mean over time | M R^2/T^2",
    "time-correlations": "wave_displacement_autocorrelation | wave 0, lag 0 | R^2",
    "velocities": "velocity_kurtosis | particle 2 | 1",
    "avalanches": "avalanche_count | particle 2, avalanche size 1 | 1",
    "density": "density | x 0 | 1/R",
}


@pytest.mark.compiled
def test_everything_observed_is_printed_and_in_the_json(run, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    small = ["simulate", "--size", 4, "--duration", 200, "--observe", ",".join(OBSERVED)]
    done = run(*small, "-o", tmp_path)
    result = load(tmp_path / "simulation.nc")
    rows = [[cell.strip() for cell in line.split("│")[1:-1]] for line in done.stdout.splitlines()]
    rows = {row[0]: row[1:] for row in rows if len(row) == 4}
    for name, at, unit in (line.split(" | ") for line in OBSERVED.values()):
        assert (rows[name][0], rows[name][2]) == (at, unit)
    force = result.isel(contact=1)
    said = f"{force.contact_force:.4g} +- {force.contact_force_error:.1g}"
    assert rows["contact_force"][1] == said
    assert rows["kinetic_energy"][1] == f"{result.kinetic_energy.mean():.4g}"
    quantities = {str(name) for name in result if not str(name).endswith("_error")}
    assert set(rows) - {"measured"} == quantities - {"density_block"}
    facts = json.loads(run(*small, "--json").stdout)
    again = xr.Dataset.from_dict(facts["observed"])
    xr.testing.assert_equal(again.map(lambda each: each.astype(float)), result.astype(float))


def test_simulate_writes_to_a_folder_as_all_commands_do(run, tmp_path):
    options = ["--size", 3, "--duration", 50]
    for output, file in (("e0.9", "e0.9/simulation.nc"), ("a/b.nc", "a/b.nc")):
        assert str(tmp_path / file) in run("simulate", *options, "-o", tmp_path / output).stdout
        assert load(tmp_path / file).sizes["particle"] == 3


def test_simulate_an_ensemble_without_a_file(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options = ["--average", "ensemble", "--size", 3, "--replicas", 2, "--duration", 1]
    done = run("simulate", *options)
    assert done.returncode == 0, done.stderr
    assert "at the last time" in done.stdout
    assert "Nothing was written" in done.stdout
    assert "Some rods" not in run("simulate", *options, "--observe", "energy").stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.compiled  # uncompiled, an overflow warns
def test_a_chain_that_diverges_ends_with_status_1(run, tmp_path):
    options = ["--size", 50, "--restitution", 2, "--damping", 0.01, "--duration", 1e5]
    done = run("simulate", *options, "--output", tmp_path / "run.nc")
    assert done.returncode == 1
    assert "diverged at t = " in done.stdout
    assert "warning" not in done.stderr
    assert "L = 50, e = 2: the simulation diverged" in done.stderr
    result = load(tmp_path / "run-diverged.nc")
    assert (result.attrs["status"], chain_of(result).size) == ("diverged", 50)
