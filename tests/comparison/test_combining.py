"""The mean of runs against the scatter between runs, and against one run with replicas."""

import numpy as np
import pytest
import xarray as xr
from small_sweeps import AtOnce, sweep

from crazybilliards.comparison import combine, deviation, fit_arctanh, load_sweep, overlay, smooth
from crazybilliards.comparison.distances import deviations
from crazybilliards.comparison.sweeps import run_cases
from crazybilliards.kinetic import equilibrium, force_balance
from crazybilliards.model import Chain, DivergedWarning, load, save
from crazybilliards.particles import given_start, simulate

QUIET = {"threads": 1, "progress": False}
CHAIN = Chain(size=5, gap=0.3)


@pytest.fixture(scope="module")
def runs():
    return [simulate(CHAIN, duration=400, seed=s, **QUIET) for s in range(16)]


def test_the_errors_are_those_of_the_mean(runs):
    found = combine(runs)
    several = xr.concat(runs, "seed", coords="minimal", compat="override")
    for name in ("velocity_width", "mean_displacement", "displacement_width", "density"):
        scatter = several[name].std("seed", ddof=1) / 4
        stated = found[f"{name}_error"]
        ratio = np.sqrt(float((stated**2).mean() / (scatter**2).mean()))
        assert 0.75 < ratio < 1.3  # 1 in the limit of many runs; the mean error is at 4
        assert found[name].attrs == runs[0][name].attrs
    pulls = (found.velocity_width - CHAIN.free_velocity_width) / found.velocity_width_error
    assert 0.4 < float(np.sqrt((pulls**2).mean())) < 2
    assert float(found.density.sum() * (found.x[1] - found.x[0])) == pytest.approx(5)
    apart = (found.mean_position - found.mean_displacement).values
    np.testing.assert_allclose(apart, CHAIN.anchors)


def test_runs_are_weighted_by_their_snapshots(runs):
    """A run of its own parts: two runs of 1 and 3 times the length."""
    long = simulate(CHAIN, duration=1200, seed=20, **QUIET)
    found = combine([runs[0], long])
    w = np.array([1, 3]) / 4
    v = [each.velocity_width.values for each in (runs[0], long)]
    e = [each.velocity_width_error.values for each in (runs[0], long)]
    width = np.sqrt(w[0] * v[0] ** 2 + w[1] * v[1] ** 2)
    np.testing.assert_allclose(found.velocity_width, width, rtol=2e-3)
    error = np.hypot(w[0] * v[0] * e[0], w[1] * v[1] * e[1]) / width
    np.testing.assert_allclose(found.velocity_width_error, error, rtol=0.02)


def test_a_combined_density_is_smoothed_with_its_error(runs):
    few = runs[:3]
    found, each = smooth(combine(few)), [smooth(run) for run in few]
    np.testing.assert_allclose(
        found.density, np.mean([run.density for run in each], axis=0), atol=1e-12
    )
    expected = np.sqrt(np.sum([run.density_error**2 for run in each], axis=0)) / 3
    np.testing.assert_allclose(found.density_error, expected, atol=1e-12)


@pytest.mark.parametrize("place", [0, 1, 2])
def test_an_unknown_time_step_error_is_that_of_the_mean(runs, place):
    errors = [0.1, 0.2, 0.3]
    some = [run.assign_attrs(time_step_error=e) for run, e in zip(runs, errors, strict=False)]
    assert combine(some).time_step_error == 0.3
    some[place] = some[place].assign_attrs(time_step_error=np.nan)
    assert np.isnan(combine(some).time_step_error)


def test_one_run_is_itself_and_a_mean_can_be_stored(runs, tmp_path):
    one = combine(runs[:1])
    for name in one.data_vars:
        np.testing.assert_allclose(one[name], runs[0][name], atol=1e-12)
    found = combine(runs)
    xr.testing.assert_identical(load(save(found, tmp_path / "mean.nc")), found)
    ensemble = {"average": "ensemble", "duration": 2, "replicas": 8, **QUIET}
    pair = [simulate(CHAIN, seed=s, **ensemble) for s in (1, 2)]
    assert combine(pair).velocity_width_error.dims == ("time", "particle")


def test_a_sweep_over_seeds(tmp_path):
    cases = sweep(grid={"size": [3, 5], "seed": [1, 2, 3]}).cases()
    run_cases(cases[:-1], tmp_path, AtOnce(), progress=False)
    grid = load_sweep(tmp_path)
    found = combine(grid)
    assert found.velocity_width.dims == ("size", "particle")
    for size in (3, 5):
        own = [c.load(tmp_path) for c in cases[:-1] if c.chain.size == size]
        alone = combine(own)
        nodes = alone.sizes["x"]
        np.testing.assert_array_equal(found.x.sel(size=size).values[:nodes], alone.x)
        for name in ("velocity_width", "velocity_width_error", "displacement_width"):
            here = found[name].sel(size=size).values[:size]
            np.testing.assert_allclose(here, alone[name], rtol=1e-9)


CHANGES = {
    "method": {"method": "contact-dynamics"},
    "stepper": {"stepper": "euler"},
    "merging": {"merging": 0.2},
    "time step": {"time_step": 0.05},
    "every": {"every": 0.5},
    "warm-up": {"warmup": 60.0},
    "start": {"start": given_start(CHAIN, CHAIN.anchors + 5)},
}


@pytest.mark.filterwarnings("ignore:duration=20 is short")
def test_runs_that_differ_in_more_than_the_seed_are_refused_unless_one_goes_on_from_another():
    how = {"duration": 20, "warmup": 50.0, "every": 1.0, "observe": ["widths", "snapshots"]}
    one, two = (simulate(CHAIN, seed=seed, **how, **QUIET) for seed in (1, 2))
    both = combine([one, two])
    for name, change in CHANGES.items():
        other = simulate(CHAIN, seed=3, **{**how, **change}, **QUIET)
        for runs in ([one, other], [other, one], [both, other]):
            with pytest.raises(ValueError, match=f"in the seed only, not in {name}: got"):
                combine(runs)
    assert combine([one.isel(replica=0), two]).equals(both)
    with pytest.raises(ValueError, match="what load_sweep returns, got a Dataset"):
        combine(xr.concat([one, two], "seed"))
    how["warmup"] = 0.0
    on = simulate(CHAIN, seed=3, start=two.isel(time=-1), **how, **QUIET)
    whole, nested = combine([on, one, two]), combine([both, on])
    np.testing.assert_allclose(nested.velocity_width, whole.velocity_width)
    np.testing.assert_allclose(nested.velocity_width_error, whole.velocity_width_error)
    with pytest.raises(ValueError, match="other seeds, got 2 twice"):
        combine([nested, two])


@pytest.mark.filterwarnings("ignore:restitution=")
@pytest.mark.parametrize("grid", [{"seed": [1, 2]}, {"seed": [1, 2], "damping": [1.0, 2.0]}])
def test_a_mean_of_runs_of_which_one_diverged_has_this_status(grid, tmp_path):
    cases = sweep(grid=grid, chain={}).cases()
    run_cases(cases, tmp_path, AtOnce(), progress=False)
    bad = cases[-1].file(tmp_path)
    with pytest.warns(DivergedWarning, match="t = "):
        save(load(bad).assign_attrs(status="diverged"), bad)
    with pytest.warns(DivergedWarning):
        found = combine(load_sweep(tmp_path))
    status = found.get("status", xr.DataArray(found.attrs.get("status")))
    assert status.values.ravel().tolist() == ["completed"] * (status.size - 1) + ["diverged"]


TAKERS = {  # what takes a result, here of a chain that diverged
    "overlay": lambda run: overlay({"fast": run}, "velocity_width"),
    "smooth": smooth,
    "save": lambda run: save(run, "run.nc"),
    "combine": lambda run: combine([run]),
    "fit_arctanh": fit_arctanh,
    "force_balance": lambda run: force_balance(CHAIN, velocity_variance=run),
    "deviation": lambda run: deviation(equilibrium(CHAIN), run, raw=True),
    "deviations": lambda run: deviations(xr.DataTree(children={"simulation": xr.DataTree(run)})),
    "start": lambda run: simulate(CHAIN, start=run, duration=100, **QUIET),
}


@pytest.mark.filterwarnings("ignore:the error of")
@pytest.mark.parametrize("name", TAKERS)
def test_whatever_takes_a_chain_that_diverged_says_so(name, runs, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = runs[0].assign(position=CHAIN.anchors + 0 * runs[0].mean_displacement)
    if name == "start":
        run = run.assign(velocity=run.mean_velocity)[["position", "velocity"]].expand_dims(
            "replica"
        )
    with pytest.warns(DivergedWarning, match=r"a chain diverged \(after t = [\d.]+\)"):
        TAKERS[name](run.assign_attrs(status="diverged"))
