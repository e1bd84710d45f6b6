"""What a sweep takes as values, and reading it: one dataset with every number about its cases."""

import functools
import json
import numbers
import operator

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from small_sweeps import sweep

import crazybilliards as cb
from crazybilliards.comparison import load_sweep
from crazybilliards.comparison.sweeps import Case, read_sweep, run_cases
from crazybilliards.comparison.sweeps.case import JOBS, compute
from crazybilliards.model import Chain, load, save
from crazybilliards.model.checks import as_written
from crazybilliards.model.vocabulary import ATTRIBUTES

SHORT = {"duration": 100, "observe": ["widths"]}


@pytest.mark.parametrize(
    "values",
    [
        np.arange(0.1, 0.35, 0.1),
        np.array([0.1, 0.2, 0.3], dtype=np.float32),
        pd.DataFrame({"e": [0.1, 0.2, 0.1 + 0.2]}).e,
        pd.Index([0.1, 0.2, 0.3]),
        xr.DataArray([0.1, 0.2, 0.1 + 0.2], dims="e"),
        (0.1, np.float64(0.2), np.float32(0.3)),
    ],
)
def test_values_are_those_that_a_person_writes(values):
    assert cb.Sweep({"restitution": values}).grid == {"restitution": [0.1, 0.2, 0.3]}
    with pytest.raises(ValueError, match="over: restitution holds a value twice"):
        cb.compare(cb.Chain(size=3), {"restitution": [*values, 0.3]})


def test_common_parameters_need_not_be_a_chain_alone():
    """A box for few rods would hold no chain of the default size, and walls need a box."""
    few = cb.Sweep({"size": [2, 3]}, chain={"box": 7})
    walls = cb.Sweep({"box": [7, 9], "size": [2]}, chain={"wall_restitution": 0.5})
    assert [case.chain.box for case in [*few, *walls]] == [7, 7, 7, 9]
    assert len(few) == len(walls) == 2
    with pytest.raises(ValueError, match="box must be above 8"):
        cb.Sweep({"size": [2, 4]}, chain={"box": 7}).cases()


def test_only_errors_of_rounding_are_taken_away():
    for value in (1 / 3, np.pi * 1e-30, 0.123456789012, 0.3 + 1e-9, 7, "text", None, True):
        assert repr(as_written(value)) == repr(value)
    total = functools.reduce(operator.add, [0.1] * 1000)  # sum() of Python 3.12 rounds once
    assert (total, as_written(total)) != (100.0, total)
    assert as_written(total) == 100.0


def test_a_coordinate_is_found_as_it_is_printed(tmp_path):
    grid = {"restitution": np.arange(0.1, 0.35, 0.2), "size": np.arange(2, 4)}
    assert cb.run_cases(cb.Sweep(grid, settings=SHORT), tmp_path, progress=False) == {}
    loaded = cb.load_sweep(tmp_path)
    assert loaded.velocity_width.sel(restitution=0.3, size=3).notnull().all()
    # One that was computed before the values of sweeps were rounded.
    case = Case("simulate", cb.Chain(size=2, restitution=0.1 + 0.6), SHORT)
    cb.run_cases([case], tmp_path, progress=False)
    loaded = cb.load_sweep(tmp_path)
    assert loaded.file.sel(restitution=0.7, size=2) == case.file(tmp_path).name


def test_the_mark_that_some_editors_write_before_a_text_is_left_out(tmp_path):
    (tmp_path / "grid.toml").write_bytes(b"\xef\xbb\xbf[grid]\nsize = [3, 4]\n[simulate]\n")
    assert read_sweep(tmp_path / "grid.toml").grid == {"size": [3, 4]}


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """Return a folder with all cases of a sweep but the last, these cases, and what is loaded."""
    folder, cases = tmp_path_factory.mktemp("swept"), sweep().cases()[:3]
    run_cases(cases, folder, progress=False)
    return folder, cases, load_sweep(folder)


def test_loading_gives_one_dataset_over_the_grid(swept, tmp_path):
    folder, cases, grid = swept
    assert grid.velocity_width.dims == ("size", "restitution", "particle")
    assert grid.velocity_width.attrs["units"] == "R_0/t_0"
    for case in cases:
        own = case.load(folder)
        here = grid.sel(size=case.chain.size, restitution=case.chain.restitution)
        widths = here.velocity_width.values
        np.testing.assert_array_equal(widths[: case.chain.size], own.velocity_width)
        assert np.isnan(widths[case.chain.size :]).all()
        places = own.sizes["x"]
        np.testing.assert_array_equal(here.density.values[:places], own.density)
        np.testing.assert_array_equal(here.x.values[:places], own.x)
        assert here.status == "completed"
        for name in ("time_step_error", "end_time"):
            assert float(here[name]) == pytest.approx(own.attrs.get(name, np.nan), nan_ok=True)
    nothing = grid.sel(size=5, restitution=1.0)
    assert nothing.status == ""
    assert np.isnan(nothing.velocity_width).all()
    assert json.loads(grid.attrs["parameters"])["damping"] == 2
    # A sweep of one case has no grid.
    save(cases[0].load(folder), cases[0].file(tmp_path))
    assert load_sweep(tmp_path).velocity_width.dims == ("particle",)


def test_numbers_about_a_case_are_variables_over_the_grid(swept, tmp_path):
    *_, grid = swept
    assert grid.time_step_error.attrs["units"] == "1"
    assert grid.end_time.attrs == {"long_name": "time reached, warm-up included", "units": "t_0"}
    assert not {"status", "end_time", "case"} & grid.attrs.keys()
    stored = load(save(grid, tmp_path / "all.nc"))
    xr.testing.assert_identical(stored.time_step_error, grid.time_step_error)


def test_errors_of_a_theory_are_variables_and_texts_that_differ_too(tmp_path):
    cases = [Case("steady_state", Chain(size=4, restitution=e), {}) for e in (0.95, 1.0)]
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
    return xr.load_dataset(compute(case, case.source))
