"""Calls of the hydrodynamics: equal ones, wrong ones, interrupted ones."""

from functools import partial

import numpy as np
import pytest
from pde import MemoryStorage
from scipy.optimize import elementwise

from crazybilliards.kinetic import displaced, force_balance, hydrodynamics
from crazybilliards.kinetic.fluids import eulerian_frame
from crazybilliards.kinetic.fluids.pde_solver import make_state, solve
from crazybilliards.model import Chain

QUIET = {"progress": False}


@pytest.mark.compiled
def test_the_number_of_cells_that_is_called_enough_is():
    """Their centre is right to a hundredth of a thermal length."""
    chain = Chain(size=20)
    start = displaced(chain, chain.thermal_length)
    arguments = {"duration": 6.0, "every": 1.0, "frame": "eulerian"} | QUIET
    with pytest.raises(ValueError, match="give cells=") as caught:
        hydrodynamics(chain, start, cells=60, **arguments)
    cells = int(str(caught.value).rpartition("=")[2])
    rough = hydrodynamics(chain, start, cells=cells, **arguments)
    fine = hydrodynamics(chain, start, **arguments)
    np.testing.assert_allclose(rough.centre, fine.centre, atol=0.01 * chain.thermal_length)


@pytest.mark.parametrize("call", [(), (100.0,), (None, 100.0)])
def test_a_missing_start_is_explained(call):
    """A duration in its place is the usual mistake."""
    with pytest.raises(ValueError, match="start must be a result with density over x") as caught:
        hydrodynamics(Chain(size=5), *call, **QUIET)
    for name in ("displaced(", "compressed(", "force_balance"):
        assert name in str(caught.value)
    with pytest.raises(ValueError, match="duration must be a number, got None"):
        hydrodynamics(Chain(size=5), displaced(Chain(size=5), 1.0), **QUIET)


@pytest.mark.compiled
def test_ctrl_c_keeps_the_times_before(ctrl_c):
    chain = Chain(size=100)
    start = force_balance(chain)
    ctrl_c(MemoryStorage, "append", lambda storages: len(storages) == 5)
    flow = hydrodynamics(chain, start, 20, every=0.02, frame="eulerian", cells=3000, **QUIET)
    assert flow.attrs["status"] == "interrupted"
    assert flow.attrs["end_time"] == flow.time[-1]
    assert 5 <= flow.sizes["time"] < 1001
    assert np.isfinite(flow.density).all()


@pytest.mark.compiled
@pytest.mark.parametrize("variance", [None, "evolving"])
def test_what_ctrl_c_ended_is_not_solved_again(variance, monkeypatch):
    """It has the times that its steps resolve, whatever came after."""
    chain, whole, calls = Chain(size=5), eulerian_frame.solve, []
    change = {"factor": 1.0, "first": 6}

    def interrupted(*arguments, **how):
        calls.append(how["dt"])
        part = whole(*arguments, **how)[:6]
        part[change["first"] :, 1] *= change["factor"]
        return part

    monkeypatch.setattr(eulerian_frame, "solve", interrupted)
    arguments = {"duration": 1.0, "every": 0.1, "frame": "eulerian", "velocity_variance": variance}
    for factor, left in ((1.0, 6), (np.nan, 4), (1e5, 2)):
        calls.clear()
        change.update(factor=factor, first=left)
        flow = hydrodynamics(chain, displaced(chain, 1.0), **arguments, **QUIET)
        assert flow.attrs["status"] == "interrupted"
        assert flow.sizes["time"] == left
        assert flow.attrs["end_time"] == pytest.approx(0.1 * (left - 1))
        assert len(calls) == 1
    change.update(factor=np.nan, first=0)
    with pytest.raises(KeyboardInterrupt, match="nothing was computed"):
        hydrodynamics(chain, displaced(chain, 1.0), **arguments, **QUIET)


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("variance", [None, "evolving"])
def test_rods_that_are_too_fast_are_refused_before_any_work(spring, variance, monkeypatch):
    monkeypatch.setattr(eulerian_frame, "solve", lambda *_, **__: pytest.fail("it works"))
    chain = Chain(size=10, spring=spring)
    arguments = {"velocity_variance": variance, "frame": "eulerian"} | QUIET
    moving = displaced(chain, 0.0)
    moving = moving.assign(flow_velocity=moving.flow_velocity + 100.0)
    for start in (displaced(chain, 200.0), displaced(chain, -80.0), moving):
        with pytest.raises(ValueError, match=r"up to .* times the free velocity .*frame='label'"):
            hydrodynamics(chain, start, 6.0, **arguments)
    if variance and spring == "linear":
        with pytest.raises(ValueError, match="too fast"):
            hydrodynamics(chain, displaced(chain, 30.0), 6.0, **arguments)


@pytest.mark.compiled
def test_the_first_steps_resolve_what_the_springs_draw(monkeypatch):
    chain, whole, calls = Chain(size=5), eulerian_frame.solve, []
    monkeypatch.setattr(
        eulerian_frame, "solve", lambda *a, **how: calls.append(how["dt"]) or whole(*a, **how)
    )
    flow = hydrodynamics(chain, displaced(chain, 25.0), 4.0, every=1.0, frame="eulerian", **QUIET)
    assert len(calls) == 1
    exact = hydrodynamics(chain, displaced(chain, 25.0), 4.0, every=1.0, **QUIET)
    np.testing.assert_allclose(flow.centre, exact.centre, atol=0.02 * 25)


def test_a_label_that_is_not_found_is_an_error(monkeypatch):
    """The middle of a cell is the position only where the cell is empty."""
    chain = Chain(size=20)
    start = displaced(chain, 1.0)
    hasty = partial(elementwise.find_root, maxiter=1)
    monkeypatch.setattr(elementwise, "find_root", hasty)
    with pytest.raises(ValueError, match="labels could not be inverted"):
        hydrodynamics(chain, start, 1, **QUIET)


def test_a_plain_density_profile_is_a_start():
    """Any profile of the user: no label, no velocity, no provenance."""
    chain = Chain(size=20, amplitude=5)
    own = displaced(chain, 3.0)[["density"]].drop_attrs()
    flow = hydrodynamics(chain, own, 5, every=1, **QUIET)
    reference = hydrodynamics(chain, displaced(chain, 3.0), 5, every=1, **QUIET)
    np.testing.assert_allclose(flow.centre, reference.centre, atol=1e-3)


@pytest.mark.compiled
@pytest.mark.parametrize("frame", ["label", "eulerian"])
@pytest.mark.parametrize("duration", [1e-12, 1e-50])
def test_the_shortest_duration_is_not_taken_for_ctrl_c(frame, duration):
    """py-pde drops outputs that are close together; a missing output is no sign of Ctrl-C."""
    chain = Chain(size=5)
    flow = hydrodynamics(chain, displaced(chain, 2.0), duration, frame=frame, **QUIET)
    assert flow.attrs["status"] == "completed"
    assert flow.sizes["time"] == 101
    assert float(flow.time[-1]) == pytest.approx(duration)
    # A shifted state at rest begins to move with the acceleration -k/m times its shift.
    speed = -2.0 * chain.stiffness / chain.mass * duration
    np.testing.assert_allclose(flow.mean_velocity[-1].mean(), speed, rtol=0.02)


@pytest.mark.compiled
@pytest.mark.parametrize("fluid", [None, "evolving"])
def test_trackers_of_py_pde_see_positions_and_named_fields(fluid, monkeypatch):
    """In the units of the chain: the fields add up to the rods and to their moments."""
    chain, seen = Chain(size=20, amplitude=5), []
    append = MemoryStorage.append

    def watched(storage, field, time):
        seen.append((time, field.copy()))
        append(storage, field, time)

    monkeypatch.setattr(MemoryStorage, "append", watched)
    arguments = {"every": 2.0, "frame": "eulerian", "velocity_variance": fluid} | QUIET
    flow = hydrodynamics(chain, displaced(chain, 3.0), 4.0, **arguments)
    np.testing.assert_allclose([time for time, _ in seen], flow.time)
    for (_, state), width, rods in zip(seen, flow.cloud_width, flow.mean_velocity, strict=True):
        assert state.labels == ["rho", "rho V", "E"][: 2 if fluid is None else 3]
        (left, right), *_ = state.grid.axes_bounds
        assert left == -right
        assert right > chain.anchors[-1] + 9 * width
        assert state["rho"].integral == pytest.approx(chain.size)
        assert state["rho V"].integral == pytest.approx(float(rods.sum()), abs=0.02)
    x = seen[0][1].grid.axes_coords[0]
    there = np.interp(x, flow.x, flow.density[0])
    np.testing.assert_allclose(seen[0][1]["rho"].data, there, atol=2e-3)


def test_an_output_that_py_pde_drops_is_an_error():
    state, times = make_state({"field": np.ones(8)}, (0, 8)), 1e-12 * np.arange(11.0)
    with pytest.raises(RuntimeError, match="outputs of 11"):
        solve(lambda x, _: -x, state, times, solver="scipy", backend="numpy", **QUIET)
