"""What a sweep takes as values, and the texts that describe sweeps."""

import functools
import operator

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import crazybilliards as cb
from crazybilliards.comparison.sweeps import Case, read_sweep
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
    with pytest.raises(ValueError, match="over: restitution holds a value twice"):
        cb.compare(cb.Chain(size=3), {"restitution": [*values, 0.3]})


def test_common_parameters_need_not_be_a_chain_alone():
    """A box for few rods would hold no chain of the default size, and walls need a box."""
    few = cb.Sweep({"size": [2, 3]}, chain={"box": 7})
    walls = cb.Sweep({"box": [7, 9], "size": [2]}, chain={"wall_restitution": 0.5})
    assert [case.chain.box for case in [*few, *walls]] == [7, 7, 7, 9]
    with pytest.raises(ValueError, match="box must be above 8"):
        cb.Sweep({"size": [2, 4]}, chain={"box": 7}).cases()


def test_a_sweep_gives_the_cases_of_its_grid():
    sweep = cb.Sweep({"size": [3, 4], "seed": [1, 2, 3]}, "simulate", {"gap": 1}, {"duration": 100})
    assert len(sweep) == 6
    assert [*sweep] == [
        Case("simulate", cb.Chain(size=size, gap=1), {"duration": 100, "seed": seed})
        for size in (3, 4)
        for seed in (1, 2, 3)
    ]


def test_only_errors_of_rounding_are_taken_away():
    for value in (1 / 3, np.pi * 1e-30, 0.123456789012, 0.3 + 1e-9, 7, "text", None, True):
        assert repr(as_written(value)) == repr(value)
    total = functools.reduce(operator.add, [0.1] * 1000)  # sum() of Python 3.12 rounds once
    assert (total, as_written(total)) != (100.0, total)
    assert as_written(total) == 100.0


def test_a_coordinate_is_found_as_it_is_printed(tmp_path):
    grid = {"restitution": np.arange(0.1, 0.35, 0.1), "seed": np.arange(2), "size": range(2, 4)}
    assert cb.run_cases(cb.Sweep(grid, settings=SHORT), tmp_path, progress=False) == {}
    loaded = cb.load_sweep(tmp_path)
    assert loaded.velocity_width.sel(restitution=0.3, seed=1, size=3).notnull().all()
    # One that was computed before the values of sweeps were rounded.
    case = Case("simulate", cb.Chain(size=2, restitution=0.1 + 0.6), SHORT)
    cb.run_cases([case], tmp_path, progress=False)
    loaded = cb.load_sweep(tmp_path)
    assert loaded.file.sel(restitution=0.7, seed=0, size=2) == case.file(tmp_path).name


SWEEP = b"""[grid]
size = [3, 4]
restitution = [0.5, 1.0]

[simulate]
duration = 200
observe = ["widths"]
"""


@pytest.mark.parametrize("flips", [100, pytest.param(1000, marks=pytest.mark.torture)])
def test_a_description_with_flipped_bits_or_cut_is_another_sweep_or_refused(flips, tmp_path):
    """A text without checksum: what is still TOML and makes sense is a sweep."""
    generator, refusals = np.random.default_rng(4), []
    changed = [SWEEP[: cut * len(SWEEP) // 50] for cut in range(50)]
    for _ in range(flips):
        text = bytearray(SWEEP)
        text[generator.integers(len(text))] ^= 1 << int(generator.integers(8))
        changed.append(bytes(text))
    for text in changed:
        (tmp_path / "grid.toml").write_bytes(text)
        try:
            read_sweep(tmp_path / "grid.toml").cases()
        except ValueError as error:
            refusals.append(str(error))
    assert flips / 2 < len(refusals) < flips + 50


def test_the_mark_that_some_editors_write_before_a_text_is_left_out(tmp_path):
    (tmp_path / "grid.toml").write_bytes(b"\xef\xbb\xbf" + SWEEP)
    assert read_sweep(tmp_path / "grid.toml").grid
