"""A run, finished or not, is made longer by its checkpoint, to the bits of one long run."""

import signal
import sys
import time

import numpy as np
import pytest
import xarray as xr
from described_runs import observers_of
from killed import begin, end, until

from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.observers.base import Averaged


@pytest.mark.filterwarnings("ignore:.*spectra are NaN")
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="forks, reads /proc")
@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize("copies", [2, 1])
def test_made_longer_and_killed_and_resumed_it_is_one_long_run(copies, tmp_path):
    how = {"observe": ("widths", "density", "energy", "velocities", "time-correlations")}
    how |= {"seed": 4, "replicas": copies, "threads": copies, "progress": False}
    chain, long = Chain(size=40, restitution=0.7, gap=0.1), 4000 // copies
    undisturbed = simulate(chain, duration=long, **how)
    state = tmp_path / "job" / "state"
    state.parent.mkdir()
    how |= {"checkpoint": state, "checkpoint_interval": 0.05}
    assert simulate(chain, duration=1111.1 / copies, **how).attrs["status"] == "completed"
    written = state.stat().st_mtime_ns
    child = begin(lambda _: simulate(chain, duration=long, **how), state.parent)
    until(lambda: state.stat().st_mtime_ns != written)
    time.sleep(0.1)
    number = signal.SIGKILL if copies == 2 else signal.SIGTERM
    assert end(child, number) == -number
    xr.testing.assert_identical(simulate(chain, duration=long, **how), undisturbed)


@pytest.mark.compiled
@pytest.mark.parametrize("e", [0.8, 1.0])
@pytest.mark.parametrize(("size", "replicas", "box"), [(1, 3, 0), (3, 1, 0), (3, 1, 8)])
def test_all_observers_measure_in_parts_what_they_measure_at_once(size, replicas, box, e, tmp_path):
    """From before the first blocks are full until after they were added up twice."""
    how = {"replicas": replicas, "seed": 2, "progress": False, "every": 1.0, "time_step": 0.25}
    chain = Chain(size=size, restitution=e, damping=10, box=box)
    how["observe"] = observers_of(chain)
    whole = simulate(chain, duration=4000 // replicas, **how)
    for duration in (150, 151, 400, 1333, 4000 // replicas):
        run = simulate(chain, duration=duration, checkpoint=tmp_path / "state", **how)
        assert run.attrs["status"] == "completed"
    xr.testing.assert_identical(run, whole)


def test_a_chunk_that_the_end_cuts_is_measured_again_as_a_whole(tmp_path):
    """Chunks are many snapshots here, because a chain of two rods is fast."""
    chain, how = Chain(size=2), {"observe": ("widths", "energy"), "progress": False}
    whole = simulate(chain, duration=9000, **how)
    for duration in (2000.7, 5000.3, 9000):
        run = simulate(chain, duration=duration, checkpoint=tmp_path / "state", **how)
        xr.testing.assert_identical(run, simulate(chain, duration=duration, **how))
    xr.testing.assert_identical(run, whole)


@pytest.mark.compiled
def test_blocks_are_added_up_in_pairs_and_stay_longer_than_the_memory():
    """The error of a mean is right, from 33 to 64 blocks, as that of a known process."""
    chain = Chain(size=1, damping=2)
    for duration in (2000, 40_000):
        run = simulate(chain, duration=duration, replicas=2, observe="density", progress=False)
        assert 32 <= run.sizes["block"] <= 64
    # The mean of a displacement over a time t has the variance 2 tau <d^2>/t, tau = gamma/k.
    how = {"duration": 5000, "observe": "widths", "progress": False, "replicas": 2}
    runs = [simulate(chain, seed=seed, **how) for seed in range(40)]
    found = np.mean([run.mean_displacement_error.item() ** 2 for run in runs])
    known = 2 * chain.damping / chain.stiffness * chain.temperature / chain.stiffness / 10_000
    assert found == pytest.approx(known, rel=5 * np.sqrt(2 / 40 / 32))


@pytest.mark.filterwarnings("ignore:stiffness=0")
@pytest.mark.parametrize(
    ("observe", "reason"), [("density", "'density' cannot continue, because its x"), (None, "held")]
)
def test_what_depends_on_the_duration_cannot_continue(observe, reason, tmp_path):
    class Late(Averaged):
        name = "late"
        gives = ("outside",)

        def prepare(self, run, copies):
            super().prepare(run, copies)
            self.held = run.schedule.snapshots / 2

        def observe(self, snapshots):
            pass

        def report(self, counts):
            return {"outside": ((), self.held)}

    chain = Chain(size=2, stiffness=0)
    how = {"observe": observe or Late(), "progress": False, "warmup": 200, "time_step": 0.5}
    simulate(chain, duration=1000, checkpoint=tmp_path / "state", **how)
    with pytest.raises(ValueError, match=reason):
        simulate(chain, duration=9000, checkpoint=tmp_path / "state", **how)


@pytest.mark.parametrize(("e", "speed"), [(0.1, "below which its rods merge"), (1.05, "above")])
def test_a_speed_that_depends_on_the_duration_stays_as_it_was(e, speed, tmp_path):
    """Noise without damping makes rods faster for ever, and thresholds follow a typical speed."""
    chain = Chain(size=20, restitution=e, damping=0)
    how = {"observe": "snapshots", "progress": False, "time_step": 0.05, "merging": 0}
    simulate(chain, duration=6, checkpoint=tmp_path / "state", **how)
    with pytest.raises(ValueError, match=f"longer: the speed {speed}"):
        simulate(chain, duration=20, checkpoint=tmp_path / "state", **how)
    # The usual threshold is one of the noise of a step.
    chain, how["merging"] = chain.replace(restitution=0.1), None
    simulate(chain, duration=6, checkpoint=tmp_path / "other", **how)
    longer = simulate(chain, duration=20, checkpoint=tmp_path / "other", **how)
    xr.testing.assert_identical(longer, simulate(chain, duration=20, **how))


def test_an_ensemble_is_not_made_longer(tmp_path):
    how = {"average": "ensemble", "every": 1.0, "checkpoint": tmp_path / "state"}
    simulate(Chain(size=2), duration=10, progress=False, **how)
    with pytest.raises(ValueError, match="duration is 10 there and 20 here"):
        simulate(Chain(size=2), duration=20, progress=False, **how)
