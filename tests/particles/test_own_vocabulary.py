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
    Fast.vocabulary = {}
    with pytest.raises(ValueError, match="'fast' gives 'share_fast', which has no meaning and uni"):
        simulate(Chain(size=2), **how)
