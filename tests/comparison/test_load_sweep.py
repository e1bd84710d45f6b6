"""Reading a sweep: one dataset over the grid, with every number about its cases."""

import io
import json
import numbers

import numpy as np
import pytest
import xarray as xr
from small_sweeps import sweep

from crazybilliards.comparison import load_sweep
from crazybilliards.comparison.sweeps import Case, run_cases
from crazybilliards.comparison.sweeps.case import JOBS, compute
from crazybilliards.model import Chain, load, save
from crazybilliards.model.vocabulary import ATTRIBUTES


def test_loading_gives_one_dataset_over_the_grid(tmp_path):
    cases = sweep().cases()
    run_cases(cases[:3], tmp_path, progress=False)  # the last one is missing
    grid = load_sweep(tmp_path)
    assert grid.velocity_width.dims == ("size", "restitution", "particle")
    assert grid.velocity_width.attrs["units"] == "R_0/t_0"
    for case in cases[:3]:
        own = case.load(tmp_path)
        here = grid.sel(size=case.chain.size, restitution=case.chain.restitution)
        widths = here.velocity_width.values
        np.testing.assert_array_equal(widths[: case.chain.size], own.velocity_width)
        assert np.isnan(widths[case.chain.size :]).all()
        places = own.sizes["x"]
        np.testing.assert_array_equal(here.density.values[:places], own.density)
        np.testing.assert_array_equal(here.x.values[:places], own.x)
        assert here.status == "completed"
    nothing = grid.sel(size=5, restitution=1.0)
    assert nothing.status == ""
    assert np.isnan(nothing.velocity_width).all()
    assert json.loads(grid.attrs["parameters"])["damping"] == 2
    # A sweep of one case has no grid.
    assert load_sweep_of_one(tmp_path / "one").velocity_width.dims == ("particle",)


def test_numbers_about_a_case_are_variables_over_the_grid(tmp_path):
    grid = {"size": [3, 5], "restitution": [0.5, 1.0]}
    cases = sweep(grid=grid).cases()
    run_cases(cases[:3], tmp_path, progress=False)
    loaded = load_sweep(tmp_path)
    for case in cases[:3]:
        own = case.load(tmp_path).attrs
        here = loaded.sel(size=case.chain.size, restitution=case.chain.restitution)
        for name in ("time_step_error", "end_time"):
            assert float(here[name]) == pytest.approx(own.get(name, np.nan), nan_ok=True)
    assert np.isfinite(loaded.time_step_error.sel(restitution=0.5)).all()
    assert (loaded.time_step_error.sel(restitution=1.0)[:1] == 0).all()  # exact there
    assert loaded.time_step_error.attrs["units"] == "1"
    assert loaded.end_time.attrs == {"long_name": "time reached, warm-up included", "units": "t_0"}
    assert not {"status", "end_time", "case"} & loaded.attrs.keys()
    save(loaded, tmp_path / "grid" / "all.nc")
    xr.testing.assert_identical(
        load(tmp_path / "grid" / "all.nc").time_step_error, loaded.time_step_error
    )


def test_errors_of_a_theory_are_variables_and_texts_that_differ_too(tmp_path):
    cases = [Case("steady_state", Chain(size=8, restitution=e), {}) for e in (0.95, 1.0)]
    for number, case in enumerate(cases):
        result = case_result(case)
        result.attrs["package_version"] = f"0.{number}"
        if number:
            result.attrs["note"] = "by hand"
        save(result, case.file(tmp_path))
    loaded = load_sweep(tmp_path)
    for name in ("velocity_width_model_error", "border_model_error", "residual", "iterations"):
        own = [case.load(tmp_path).attrs[name] for case in cases]
        np.testing.assert_array_equal(loaded[name], own)
        assert loaded[name].attrs["units"] == "1"
    assert loaded.border_model_error.dims == ("restitution",)
    assert loaded.package_version.values.tolist() == ["0.0", "0.1"]
    assert loaded.note.values.tolist() == ["", "by hand"]
    assert loaded.attrs["source"] == "theory"


def test_every_number_about_a_result_has_a_meaning_and_a_unit():
    for job in JOBS:
        e, settings = (0.5, {"duration": 100}) if job == "simulate" else (1.0, {})
        result = case_result(Case(job, Chain(size=10, restitution=e), settings))
        found = {name for name, value in result.attrs.items() if isinstance(value, numbers.Real)}
        assert found <= ATTRIBUTES.keys(), job
        assert found


def test_folders_that_hold_no_sweep(tmp_path):
    (tmp_path / "._hidden.nc").write_bytes(b"macOS writes such files beside others")
    with pytest.raises(ValueError, match="no case"):
        load_sweep(tmp_path)
    case = sweep().cases()[0]
    run_cases([case, Case("equilibrium", Chain(size=3), {})], tmp_path, progress=False)
    with pytest.raises(ValueError, match="different jobs"):
        load_sweep(tmp_path)


def case_result(case):
    return xr.load_dataset(io.BytesIO(compute(case, case.source)))


def load_sweep_of_one(folder):
    run_cases(sweep().cases()[:1], folder, progress=False)
    return load_sweep(folder)
