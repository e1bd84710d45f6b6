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


@pytest.mark.compiled
def test_the_first_steps_resolve_what_the_springs_draw(monkeypatch):
    chain, whole, calls = Chain(size=5), eulerian_frame.solve, []
    monkeypatch.setattr(
        eulerian_frame, "solve", lambda *a, **how: calls.append(how["dt"]) or whole(*a, **how)
    )
    flow = hydrodynamics(chain, displaced(chain, 25.0), 2.0, every=1.0, frame="eulerian", **QUIET)
    assert len(calls) == 1
    exact = hydrodynamics(chain, displaced(chain, 25.0), 2.0, every=1.0, **QUIET)
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
def test_the_shortest_duration_is_not_taken_for_ctrl_c(frame):
    """py-pde drops outputs that are close together; a missing output is no sign of Ctrl-C."""
    chain, duration = Chain(size=5), 1e-50
    flow = hydrodynamics(chain, displaced(chain, 2.0), duration, frame=frame, **QUIET)
    assert flow.attrs["status"] == "completed"
    assert flow.sizes["time"] == 101
    assert float(flow.time[-1]) == pytest.approx(duration)
    # A shifted state at rest begins to move with the acceleration -k/m times its shift.
    speed = -2.0 * chain.stiffness / chain.mass * duration
    np.testing.assert_allclose(flow.mean_velocity[-1].mean(), speed, rtol=0.02)


def test_an_output_that_py_pde_drops_is_an_error():
    state, times = make_state({"field": np.ones(8)}, (0, 8)), 1e-12 * np.arange(11.0)
    with pytest.raises(RuntimeError, match="outputs of 11"):
        solve(lambda x, _: -x, state, times, solver="scipy", backend="numpy", **QUIET)
