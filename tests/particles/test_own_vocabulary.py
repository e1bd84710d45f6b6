"""Meanings and units that an observer of another package brings."""

from typing import ClassVar

import numpy as np
import pytest
import xarray as xr

from crazybilliards.model import Chain, load, save
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.particles import simulate, simulate_limit
from crazybilliards.particles.observers.base import Averaged


def test_an_observer_brings_the_meanings_of_its_own_names(tmp_path):
    class Fast(Averaged):
        name = "fast"
        gives = ("share_fast",)
        vocabulary: ClassVar = {
            "share_fast": ("share of the time in which |v| > W", "1"),
            "velocity_width": ("something else", "1"),
        }

        def observe(self, snapshots):
            fast = np.abs(snapshots.v) > Chain().free_velocity_width
            self.sums[snapshots.block] += fast.sum(axis=0)

        def report(self, counts):
            return self.averages({"share_fast": lambda share: share}, counts, "particle")

    before = dict(VOCABULARY)
    how = {"duration": 400, "observe": [Fast(), "widths"], "progress": False}
    run = simulate(Chain(size=2), **how)
    save(run, tmp_path / "run.nc")
    xr.testing.assert_identical(load(tmp_path / "run.nc"), run)
    assert run.share_fast.attrs == {"long_name": Fast.vocabulary["share_fast"][0], "units": "1"}
    assert run.share_fast_error.attrs["long_name"].startswith("standard error of share of the time")
    assert run.velocity_width.attrs["long_name"] == VOCABULARY["velocity_width"][0]
    assert dict(VOCABULARY) == before
    limit = simulate_limit(Chain(size=2), accuracy=0.1, observe=how["observe"], progress=False)
    assert limit.share_fast.attrs == run.share_fast.attrs


class Mean(Averaged):
    name = "mean"
    gives = ("my_mean",)
    vocabulary: ClassVar = {"my_mean": ("mean velocity", "R/T")}

    def observe(self, snapshots):
        self.sums[snapshots.block] += snapshots.v.sum(axis=0)

    def report(self, counts):
        return self.averages({self.gives[0]: lambda mean: mean}, counts, "particle")


HOW = {"duration": 200, "progress": False}


@pytest.mark.parametrize(
    ("vocabulary", "said"),
    [
        ({"my_mean": "velocity"}, r"must be {name: \(meaning, unit\)}, all of them texts"),
        ({"my_mean": ("velocity",)}, "all of them texts, .*got"),
        ({"my_mean": ("velocity", 3)}, "all of them texts, .*got"),
        ({3: ("velocity", "R")}, "all of them texts, .*got"),
        (["my_mean"], r"all of them texts, .*got \['my_mean'\]"),
        (None, "all of them texts, .*got None"),
        ({}, "gives 'my_mean', which has no meaning and unit"),
        ({"my_mean": ("velocity", "m/s")}, "units of R, M and T, .*got .*'m/s'"),
    ],
)
def test_a_wrong_vocabulary_is_refused_where_the_class_is_defined(vocabulary, said):
    with pytest.raises(ValueError, match=f"Wrong.*{said}"):
        type("Wrong", (Mean,), {"vocabulary": vocabulary})


def test_what_an_observer_says_of_its_variables_counts_more_than_what_another_says():
    other = type(
        "Other",
        (Mean,),
        {
            "name": "other",
            "gives": ("your_mean",),
            "vocabulary": {"your_mean": ("yours", "1"), "my_mean": ("not mine", "M")},
        },
    )
    for observe in ([Mean(), other()], [other(), Mean()]):
        run = simulate(Chain(size=2), observe=observe, **HOW)
        assert run.my_mean.attrs == {"long_name": "mean velocity", "units": "R_0/T_0"}


def test_a_run_is_not_lost_if_an_observer_reports_what_it_does_not_give():
    class Surprising(Mean):
        def report(self, counts):
            return {**super().report(counts), "surprise": ((), 1.0), "odd": (("odd_bin",), [2.0])}

        def coordinates(self):
            return {"odd_bin": [3.0]}

    with pytest.warns(UserWarning, match="'mean' reports 'odd', 'odd_bin', 'surprise', which it"):
        run = simulate(Chain(size=2), observe=[Surprising(), "widths"], **HOW)
    assert run.surprise == 1
    assert run.odd.sel(odd_bin=3) == 2
    assert run.surprise.attrs == {"long_name": "reported by 'mean' without a meaning", "units": ""}
    assert {"my_mean", "velocity_width"} <= {*run}


@pytest.mark.parametrize("name", ["velocity_width", "velocity_width_error", "particle"])
def test_an_observer_takes_no_name_of_another_one_and_not_of_every_result(name):
    class Surprising(Mean):
        def report(self, counts):
            return super().report(counts) | {name: ((), 7.0)}

    for observe in ([Surprising(), "widths"], ["widths", Surprising()]):
        with pytest.raises(
            ValueError, match=f"^observe: 'mean' reports '{name}', which the result"
        ):
            simulate(Chain(size=2), observe=observe, **HOW)


@pytest.mark.parametrize("reported", [None, [1], {"a": 3.0}, {3: ((), 1.0)}, {"a": ((), 1.0, {})}])
def test_a_report_that_holds_no_variables_is_an_error_that_names_the_observer(reported):
    wrong = type("Wrong", (Mean,), {"report": lambda *_: reported})
    with pytest.raises(TypeError, match=r"^observe: 'mean' must report {name: \(dimensions, val"):
        simulate(Chain(size=2), observe=wrong(), **HOW)


@pytest.mark.parametrize(
    "wrong", [{"gives": "my_mean"}, {"gives": None}, {"along": "x"}, {"along": [3]}, {"name": None}]
)
def test_names_that_are_no_names_are_refused_where_the_class_is_defined(wrong):
    [what] = wrong
    with pytest.raises(ValueError, match=rf"^{what} of Wrong must be a t.*, got"):
        type("Wrong", (Mean,), wrong)


def test_a_base_of_observers_has_no_name():
    class Base(Averaged):
        def observe(self, snapshots):
            """Do nothing."""

        def report(self, counts):
            return {}

    with pytest.raises(ValueError, match="observe: Base must have a name"):
        simulate(Chain(size=2), observe=Base(), **HOW)


@pytest.mark.parametrize("array", ["y", "v", "collisions"])
def test_an_observer_cannot_change_what_the_others_see(array):
    class Careless(Mean):
        single_collisions = True

        def observe(self, snapshots):
            getattr(snapshots, array)[...] = 0

    with pytest.raises(ValueError, match="read-only"):
        simulate(Chain(size=2), observe=[Careless(), "widths"], **HOW)
