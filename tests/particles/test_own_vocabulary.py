"""Observers of another package: their own names, their mistakes, and what they cannot spoil."""

from typing import ClassVar

import numpy as np
import pytest
import xarray as xr

from crazybilliards.model import Chain, load, save
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.particles import simulate
from crazybilliards.particles.observers.base import Averaged

HOW = {"duration": 200, "progress": False}


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


def test_an_observer_brings_the_meanings_of_its_own_names(tmp_path):
    before = dict(VOCABULARY)
    run = simulate(Chain(size=2), observe=[Fast(), "widths"], **HOW)
    save(run, tmp_path / "run.nc")
    xr.testing.assert_identical(load(tmp_path / "run.nc"), run)
    assert run.share_fast.attrs == {"long_name": Fast.vocabulary["share_fast"][0], "units": "1"}
    assert run.share_fast_error.attrs["long_name"].startswith("standard error of share of the time")
    assert run.velocity_width.attrs["long_name"] == VOCABULARY["velocity_width"][0]
    assert dict(VOCABULARY) == before


@pytest.mark.parametrize(("name", "error"), [("surprise", KeyError), ("velocity_width", TypeError)])
def test_a_variable_without_a_meaning_or_of_another_observer_is_an_error(name, error):
    class Surprising(Fast):
        def report(self, counts):
            return super().report(counts) | {name: ((), 7.0)}

    for observe in ([Surprising(), "widths"], ["widths", Surprising()]):
        with pytest.raises(error, match=name):
            simulate(Chain(size=2), observe=observe, **HOW)


@pytest.mark.parametrize("array", ["y", "v", "collisions"])
def test_an_observer_cannot_change_what_the_others_see(array):
    class Careless(Fast):
        single_collisions = True

        def observe(self, snapshots):
            getattr(snapshots, array)[...] = 0

    with pytest.raises(ValueError, match="read-only"):
        simulate(Chain(size=2), observe=[Careless(), "widths"], **HOW)


def test_what_a_checkpoint_cannot_hold_is_an_error_before_any_work(tmp_path):
    """Otherwise a resumed run would go on without it."""

    class Holding(Fast):
        def prepare(self, run, copies):
            super().prepare(run, copies)
            self.places = {}

        def observe(self, snapshots):
            pytest.fail("it works")

    with pytest.raises(ValueError, match=r"holds arrays and numbers, .*places is none"):
        simulate(Chain(size=2), observe=Holding(), checkpoint=tmp_path / "state", **HOW)
