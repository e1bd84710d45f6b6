"""The hydrodynamics: against exact solutions, the stationary theory, and frame against frame."""

import numpy as np
import pytest
import xarray as xr
from pde import MemoryStorage

from crazybilliards.kinetic import compressed, displaced, equilibrium, force_balance, hydrodynamics
from crazybilliards.kinetic.exact.motion import breathing_cloud
from crazybilliards.kinetic.fluids import eulerian_frame
from crazybilliards.model import Chain

QUIET = {"progress": False}


def density_on(flow, x):
    return np.array([np.interp(x, flow.x, row, left=0, right=0) for row in flow.density.values])


def l1_distance(one, other):
    """Distance of two densities at every time, over the number of rods."""
    spacing = float(one.x[1] - one.x[0])
    difference = np.abs(one.density.values - density_on(other, one.x))
    return difference.sum(axis=1) * spacing / one.rods.values


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("frame", "fluid", "stretch"),
    [
        ("label", None, 0.3),
        ("label", "evolving", 0.6),
        ("label", "evolving", 2.0),
        ("eulerian", "evolving", 0.6),
    ],
)
def test_a_breathing_cloud_is_exact_and_so_is_its_kinetic_energy(frame, fluid, stretch):
    chain = Chain(size=20, amplitude=5)
    how = {"velocity_variance": fluid, "frame": frame} | QUIET
    flow = hydrodynamics(chain, compressed(chain, stretch), 10, every=1, **how)
    fine = breathing_cloud(chain, 10, every=1e-3, stretch=stretch, evolving=fluid is not None)
    speed = np.gradient(fine.cloud_width, fine.time)[::1000]
    exact = fine.isel(time=slice(None, None, 1000))
    energy = chain.size * chain.mass / 2 * (exact.velocity_variance + speed**2)
    np.testing.assert_allclose(flow.kinetic_energy, energy, rtol=2e-3)
    assert (flow.attrs.get("kinetic_energy_model_error") == 0) == (fluid == "evolving")
    if frame == "label":
        s = chain.thermal_length
        np.testing.assert_allclose(flow.cloud_width, exact.cloud_width, atol=2e-5 * s)
        middle = flow.velocity_variance.isel(x=flow.sizes["x"] // 2)
        np.testing.assert_allclose(middle, exact.velocity_variance, rtol=1e-4)
    if frame == "label" and fluid:
        flight = 20 / s * chain.temperature * chain.free_velocity_width
        assert np.abs(flow.heat_flux).max() < 3e-5 * flight


@pytest.mark.compiled
@pytest.mark.parametrize("frame", ["label", "eulerian"])
def test_a_shift_swings_as_one_oscillator(frame):
    chain = Chain(size=20, gap=0.3, amplitude=3)
    start = displaced(chain, 2.0)
    flow = hydrodynamics(chain, start, 8, every=1, frame=frame, **QUIET)
    half = chain.damping / (2 * chain.mass)
    swing = np.sqrt(chain.stiffness / chain.mass - half**2)
    t = flow.time
    exact = 2 * np.exp(-half * t) * (np.cos(swing * t) + half / swing * np.sin(swing * t))
    np.testing.assert_allclose(flow.centre, exact, atol=2e-3)
    np.testing.assert_allclose(flow.cloud_width, flow.cloud_width[0], rtol=2e-3)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("size", "amplitude", "gap", "spring"),
    [(10, 30, 0.0, "linear"), (20, 1, 0.2, "linear"), (20, 10, 0.2, "quadratic")],
)
def test_relaxation_ends_in_the_force_balance(size, amplitude, gap, spring):
    chain = Chain(size=size, amplitude=amplitude, gap=gap, spring=spring)
    # Quadratic springs are soft near their anchors: a plateau takes ages to relax.
    hotter = 1.5 if spring == "linear" else 1.0
    start = force_balance(chain.replace(amplitude=hotter * amplitude))
    flow = hydrodynamics(chain, start, 75, every=75, velocity_variance="evolving", **QUIET)
    theory = force_balance(chain)
    difference = np.abs(density_on(flow, theory.x)[-1] - theory.density.values).max()
    assert difference / chain.close_packed_density < 1e-4
    np.testing.assert_allclose(flow.rods, size, rtol=1e-12)
    np.testing.assert_allclose(
        flow.mean_displacement[-1], theory.mean_displacement, atol=3e-4 * chain.thermal_length
    )
    if spring == "linear":
        assert flow.attrs["residual"] < 1e-3


@pytest.mark.parametrize(
    ("amplitude", "gap"), [pytest.param(1, 0.2, marks=pytest.mark.compiled), (30, 0.0), (30, 1.0)]
)
def test_the_eulerian_frame_rests_in_the_force_balance(amplitude, gap):
    chain = Chain(size=10, amplitude=amplitude, gap=gap)
    theory = force_balance(chain)
    flow = hydrodynamics(chain, theory, 12, every=12, frame="eulerian", **QUIET)
    difference = np.abs(density_on(flow, theory.x)[-1] - theory.density.values).max()
    assert difference / chain.close_packed_density < 1e-3
    np.testing.assert_allclose(flow.rods, 10, rtol=1e-10)


@pytest.mark.compiled
@pytest.mark.parametrize("fluid", [None, "evolving"], ids=["isothermal", "evolving"])
def test_the_eulerian_frame_is_of_second_order(fluid):
    """L1 distance to the label frame, which is exact for a breathing cloud."""
    chain = Chain(size=100, amplitude=10)
    arguments = {"duration": 3, "every": 1, "velocity_variance": fluid} | QUIET
    start = compressed(chain, 0.6)
    exact = hydrodynamics(chain, start, **arguments)
    errors = []
    for cells in (300, 600):
        flow = hydrodynamics(chain, start, frame="eulerian", cells=cells, **arguments)
        errors.append(l1_distance(flow, exact)[1:].max())
    assert np.log2(errors[0] / errors[1]) > 1.8
    assert errors[1] < 2e-4


@pytest.mark.compiled
@pytest.mark.parametrize(("gap", "fluid"), [(0.2, "evolving"), (1.0, None)])
def test_the_two_frames_agree_with_a_gap(gap, fluid):
    chain = Chain(size=20, amplitude=5, gap=gap)
    arguments = {"duration": 6, "every": 1, "velocity_variance": fluid} | QUIET
    start = compressed(chain, 0.6)
    label = hydrodynamics(chain, start, **arguments)
    eulerian = hydrodynamics(chain, start, frame="eulerian", **arguments)
    assert l1_distance(eulerian, label).max() < 0.01
    s = chain.thermal_length
    np.testing.assert_allclose(label.cloud_width, eulerian.cloud_width, atol=0.01 * s)


def cold_centre(x):
    return Chain(amplitude=10).free_velocity_width ** 2 * (1 - 0.5 * np.exp(-((x / 40) ** 2)))


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("e", "prescribed"),
    [
        (1.0, {"displacement": equilibrium(Chain(size=50, amplitude=10))}),
        (0.9, {"velocity_variance": cold_centre}),
    ],
)
def test_what_is_prescribed_keeps_its_own_stationary_density(e, prescribed):
    chain = Chain(size=50, amplitude=10, restitution=e)
    theory = force_balance(chain, **prescribed)
    flow = hydrodynamics(chain, theory, 8, every=8, frame="eulerian", **prescribed, **QUIET)
    difference = np.abs(density_on(flow, theory.x)[-1] - theory.density.values).max()
    assert difference / chain.close_packed_density < 2e-3
    if "velocity_variance" in prescribed:
        np.testing.assert_allclose(flow.velocity_variance[-1], cold_centre(flow.x), rtol=1e-2)


@pytest.mark.parametrize("frame", ["label", "eulerian"])
def test_a_number_is_the_velocity_variance_of_the_isothermal_fluid(frame):
    """The fluid of the elastic chain with that temperature, whatever restitution and amplitude."""
    chain = Chain(size=10, gap=0.1)
    hotter = chain.replace(amplitude=1.5)
    start = displaced(chain, 1.0)
    arguments = {"duration": 3, "every": 1, "frame": frame, "cells": 100} | QUIET
    expected = hydrodynamics(hotter, start, **arguments)
    flow = hydrodynamics(
        chain.replace(restitution=0.8),
        start,
        velocity_variance=hotter.free_velocity_width**2,
        **arguments,
    )
    np.testing.assert_allclose(flow.density, expected.density, rtol=1e-6, atol=1e-9)
    assert np.abs(expected.cloud_width / chain.thermal_length - 1)[-1] > 0.1


@pytest.mark.compiled
def test_a_shock_does_not_depend_on_a_very_soft_spring():
    """The cells resolve the rods and the waves, which are short against the thermal length.

    A shock tube: rods of the density 0.6 to the left of 0, and 0.2 to the right of it.
    """
    damping = 1e-4
    chain = Chain(size=60, radius=0.5, mass=1.0, stiffness=1e-5, damping=damping)
    chain = chain.replace(amplitude=np.sqrt(2 * damping))
    x = np.linspace(-55, 155, 20_001)
    left, middle, right = (np.tanh((x - place) / 0.5) for place in (-50, 0, 150))
    density = 0.3 * (left - middle) + 0.1 * (middle - right)
    start = xr.Dataset({"density": ("x", 60 * density / np.trapezoid(density, x))}, {"x": x})
    how = {"every": 10, "velocity_variance": 1.0, "frame": "eulerian"} | QUIET
    flow = hydrodynamics(chain, start, 10, **how).isel(time=-1)
    behind = (flow.x > 1) & (flow.x < 4)
    assert float(flow.flow_velocity[behind].median()) == pytest.approx(0.908, abs=0.01)
    assert float(flow.density[behind].median()) == pytest.approx(0.378, abs=0.005)


@pytest.mark.compiled
def test_a_short_time_does_not_need_narrower_cells_than_the_rods():
    chain = Chain(size=500)
    start = compressed(chain, 0.9)
    flow = hydrodynamics(chain, start, 0.01, every=0.01, frame="eulerian", **QUIET)
    assert flow.attrs["status"] == "completed"


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
def test_what_ctrl_c_ended_is_not_solved_again(monkeypatch):
    """It has the times that its steps resolve, whatever came after."""
    chain, whole, calls = Chain(size=5), eulerian_frame.solve, []
    change = {"factor": 1.0, "first": 6}

    def interrupted(*arguments, **how):
        calls.append(how["dt"])
        part = whole(*arguments, **how)[:6]
        part[change["first"] :, 1] *= change["factor"]
        return part

    monkeypatch.setattr(eulerian_frame, "solve", interrupted)
    arguments = {"duration": 1.0, "every": 0.1, "frame": "eulerian"} | QUIET
    arguments["velocity_variance"] = "evolving"
    for factor, left in ((1.0, 6), (np.nan, 4), (1e5, 2)):
        calls.clear()
        change.update(factor=factor, first=left)
        flow = hydrodynamics(chain, displaced(chain, 1.0), **arguments)
        assert flow.attrs["status"] == "interrupted"
        assert flow.sizes["time"] == left
        assert flow.attrs["end_time"] == pytest.approx(0.1 * (left - 1))
        assert len(calls) == 1
    change.update(factor=np.nan, first=0)
    with pytest.raises(KeyboardInterrupt, match="nothing was computed"):
        hydrodynamics(chain, displaced(chain, 1.0), **arguments)


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
