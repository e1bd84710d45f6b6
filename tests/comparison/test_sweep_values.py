"""What a sweep takes as values, and what tells which of its files holds which case."""

import functools
import operator
import os
import signal
import sys

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from small_sweeps import AtOnce

import crazybilliards as cb
from crazybilliards.comparison.sweeps import Case
from crazybilliards.comparison.sweeps.index import write_index
from crazybilliards.model.checks import as_written

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
    for name in ("restitution", "amplitude"):
        with pytest.raises(ValueError, match=f"the values of {name} must differ"):
            cb.compare(cb.Chain(size=3), {name: [*values, 0.3]})


def test_common_parameters_need_not_be_a_chain_alone():
    """A box for few rods would hold no chain of the default size, and walls need a box."""
    few = cb.Sweep({"size": [2, 3]}, chain={"box": 7})
    walls = cb.Sweep({"box": [7, 9], "size": [2]}, chain={"wall_restitution": 0.5})
    assert [case.chain.box for case in [*few, *walls]] == [7, 7, 7, 9]
    with pytest.raises(ValueError, match="box must be above 8"):
        cb.Sweep({"size": [2, 4]}, chain={"box": 7}).cases()


def test_only_errors_of_rounding_are_taken_away():
    for value in (1 / 3, np.pi * 1e-30, 0.123456789012, 0.3 + 1e-9, 7, "text", None, True):
        assert repr(as_written(value)) == repr(value)
    total = functools.reduce(operator.add, [0.1] * 1000)  # sum() of Python 3.12 rounds once
    assert (total, as_written(total)) != (100.0, total)
    assert as_written(total) == 100.0


def test_a_coordinate_is_found_as_it_is_printed(tmp_path):
    grid = {"restitution": np.arange(0.1, 0.35, 0.1), "seed": np.arange(2), "size": range(2, 4)}
    assert cb.run_cases(cb.Sweep(grid, settings=SHORT), tmp_path, AtOnce(), progress=False) == {}
    loaded = cb.load_sweep(tmp_path)
    assert loaded.velocity_width.sel(restitution=0.3, seed=1, size=3).notnull().all()
    # One that was computed before the values of sweeps were rounded.
    case = Case("simulate", cb.Chain(size=2, restitution=0.1 + 0.6), SHORT)
    cb.run_cases([case], tmp_path, AtOnce(), progress=False)
    assert cb.load_sweep(tmp_path).file.sel(restitution=0.7, seed=0, size=2) == f"{case.key}.nc"


def index(folder):
    return pd.read_csv(folder / "index.csv")


def test_an_index_tells_which_file_holds_which_case(tmp_path):
    sweep = cb.Sweep(
        {"size": [3, 2], "observe": [["widths"], ["widths", "collisions"]]},
        settings={"duration": 100},
    )
    cases = sweep.cases()
    cb.run_cases(cases[:3], tmp_path, AtOnce(), progress=False)
    assert list(index(tmp_path)) == ["size", "observe", "file"]
    assert set(index(tmp_path).file) == {f"{case.key}.nc" for case in cases[:3]}
    before = os.stat(tmp_path / "index.csv").st_mtime_ns
    cb.run_cases(cases[:3], tmp_path, AtOnce(), progress=False)
    assert os.stat(tmp_path / "index.csv").st_mtime_ns == before
    cb.run_cases(sweep, tmp_path, AtOnce(), progress=False)
    table = index(tmp_path)
    assert table["size"].is_monotonic_increasing
    for case in cases:
        text = str([*case.settings["observe"]]).replace("'", '"')
        [found] = table[(table["size"] == case.chain.size) & (table.observe == text)].file
        assert found == case.file(tmp_path).name
    loaded = cb.load_sweep(tmp_path)
    assert set(loaded.file.values.ravel()) == set(table.file)


def test_a_sweep_that_is_interrupted_has_an_index(tmp_path):
    class Stopped(AtOnce):
        def submit(self, function, /, case, source):
            if case.chain.size == 4:
                raise KeyboardInterrupt
            return super().submit(function, case, source)

    sweep = cb.Sweep({"size": [4, 3, 2]}, settings=SHORT)
    with pytest.raises(KeyboardInterrupt):
        cb.run_cases(sweep, tmp_path, Stopped(), progress=False)
    assert index(tmp_path)["size"].tolist() == [2, 3]
    (tmp_path / "damaged.nc").write_bytes(b"no result")
    cb.save(cb.equilibrium(cb.Chain(size=3)), tmp_path / "foreign.nc")
    write_index(tmp_path)
    assert index(tmp_path)["size"].tolist() == [2, 3]
    write_index(tmp_path / "nowhere")
    assert not (tmp_path / "nowhere").exists()


def test_ctrl_c_while_the_index_is_made_is_not_lost(tmp_path):
    """Numpy drops an error in this function, which it calls for some kinds of data of pandas."""

    def interrupt(frame, event, _):
        if event == "call" and not came and frame.f_code.co_name == "npy_ctypes_check":
            came.append(True)
            signal.raise_signal(signal.SIGINT)

    came = []
    cases = cb.Sweep({"size": [2, 3]}, "equilibrium")
    assert cb.run_cases(cases, tmp_path, AtOnce(), progress=False) == {}
    interrupted = []
    sys.setprofile(interrupt)
    try:
        write_index(tmp_path)
    except KeyboardInterrupt:
        interrupted.append(True)
    finally:
        sys.setprofile(None)
    if not came:
        pytest.skip("this pandas does not call it")
    assert interrupted
