"""The force balance and the hydrodynamics between walls, against exact laws and each other."""

import math

import numpy as np
import pytest
import xarray as xr
from scipy.linalg import expm
from scipy.stats import truncnorm

from crazybilliards import deviation, smooth
from crazybilliards.kinetic import equilibrium, force_balance, hydrodynamics, rod_by_rod
from crazybilliards.kinetic.fluids.stated_errors import wave_model_error
from crazybilliards.kinetic.gas.collision_moments import decay_of_two_masses
from crazybilliards.kinetic.starts import gathered, wave
from crazybilliards.model import Chain


def in_a_box(room, **parameters):
    """Return a chain whose reduced coordinates have this room."""
    chain = Chain(**{"size": 20, "amplitude": 5} | parameters)
    return chain.replace(box=room + 2 * chain.radius * chain.size)


def gas(damping, room=20.0, **parameters):
    """Return a gas without springs, with T = 1 and the mean mass 1."""
    ratio = parameters.get("mass_ratio", 1.0)
    parameters |= {"stiffness": 0, "mass": 2 / (1 + ratio), "damping": damping}
    return in_a_box(room, amplitude=math.sqrt(2 * damping), **parameters)


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
def test_without_gap_the_points_and_their_pressure_are_exact(spring):
    chain = in_a_box(5.0, spring=spring)
    found, exact = force_balance(chain), equilibrium(chain)
    np.testing.assert_allclose(found.wall_force, exact.wall_force, rtol=1e-8)
    assert found.attrs["wall_force_model_error"] == 0
    if spring == "linear":
        s = chain.thermal_length
        places = truncnorm(-2.5 / s, 2.5 / s, scale=s).ppf((np.arange(20) + 0.5) / 20)
        np.testing.assert_allclose(found.mean_displacement, places, atol=1e-9)


@pytest.mark.parametrize(
    ("size", "gap", "room", "spring"), [(20, 0.3, 10.0, "quadratic"), (1000, 2.0, 1990.0, "linear")]
)
def test_the_walls_carry_what_the_springs_push(size, gap, room, spring):
    """The forces of the springs on half the fluid are the change of its pressure."""
    chain = in_a_box(room, size=size, gap=gap, spring=spring)
    found = force_balance(chain)
    half = (found.x >= 0) & (found.x <= chain.box / 2)
    rho = found.density[half]
    force = np.trapezoid(rho * chain.force(found.displacement[half]), found.x[half])
    middle = chain.temperature * float(rho[0] / (1 - 2 * rho[0]))
    at_wall = chain.temperature * float(rho[-1] / (1 - 2 * rho[-1]))
    assert middle - at_wall == pytest.approx(force, rel=5e-3, abs=1e-3 * middle)
    assert found.wall_force[1] == pytest.approx(at_wall, rel=0.05)
    assert found.residual < 1e-6


@pytest.mark.parametrize(
    ("size", "filling", "others"),
    [(7, 0.3, {}), (100, 0.9, {"stiffness": 0, "gap": 0.4}), (20, 0.6, {"spring": "quadratic"})],
)
def test_rod_by_rod_has_the_layers_at_the_walls_and_the_fluid_states_its_error(
    size, filling, others
):
    chain = in_a_box(2 * size * (1 / filling - 1), size=size, **others)
    fluid, exact = force_balance(chain), smooth(equilibrium(chain))
    assert fluid.attrs["density_model_error"] == 0.18 > deviation(smooth(fluid), exact).maximum
    rods = rod_by_rod(fluid)
    assert rods.attrs["density_model_error"] == 0
    assert deviation(smooth(rods), exact).maximum < 1e-3


@pytest.mark.compiled
def test_the_rods_of_a_fluid_at_rest_do_not_depend_on_the_masses():
    """The fluid has T = m W^2 with the mean mass, and with a gap its rods depend on T."""
    chain = in_a_box(10.0, gap=0.3, mass_ratio=5.0)
    rest = force_balance(chain)
    flow = rod_by_rod(hydrodynamics(chain, rest, 1.0, every=1.0, progress=False))
    off = flow.displacement_width[0] / rod_by_rod(rest).displacement_width - 1
    assert np.abs(off).max() < 0.01


def test_a_constant_given_temperature_and_a_given_displacement_change_nothing():
    for chain in (in_a_box(5.0), in_a_box(10.0, gap=0.3), in_a_box(20.0, stiffness=0, gap=0.4)):
        plain, variance = force_balance(chain), chain.free_velocity_width**2
        warm = force_balance(chain, velocity_variance=lambda x, w=variance: w + 0 * np.asarray(x))
        np.testing.assert_allclose(warm.density, plain.density, atol=1e-8)
        np.testing.assert_allclose(warm.wall_force, plain.wall_force, rtol=1e-8)
        given = plain.x.values, plain.displacement.values
        if chain.stiffness == 0:
            continue
        pushed = force_balance(chain, displacement=given)
        np.testing.assert_allclose(pushed.density, plain.density, atol=1e-6)
        np.testing.assert_allclose(pushed.wall_force, plain.wall_force, rtol=1e-4)


def test_without_springs_the_pressure_is_the_same_everywhere_at_any_temperature():
    chain = in_a_box(20.0, stiffness=0, restitution=0.9, mass_ratio=3)

    def variance(x):
        return 0.5 + 0.3 * np.tanh(np.asarray(x) / 10)

    found = force_balance(chain, velocity_variance=variance)
    inside = found.sel(x=slice(-29.9, 29.9))
    pressure = inside.density * variance(inside.x) / (1 - 2 * inside.density) * chain.mean_mass
    np.testing.assert_allclose(pressure, found.wall_force[0], rtol=1e-9)
    assert found.label[-1] == pytest.approx(20, rel=1e-9)


def waved(chain, height, mode=1, *, adiabatic=False):
    """Return a standing wave of the points, y = l (nu + 1/2) + height sin(pi q (nu + 1/2))."""
    nu, room = np.linspace(-0.5, 0.5, 8001), 2 * chain.walls[1]
    y = room * nu + height * np.sin(np.pi * mode * (nu + 0.5))
    x, N = y + 2 * chain.radius * chain.size * nu, chain.size * (nu + 0.5)
    denser = room / np.gradient(y, nu, edge_order=2)
    variance = chain.temperature / chain.mean_mass * denser ** (2.0 if adiabatic else 0.0)
    density = chain.size / np.gradient(x, nu, edge_order=2)
    fields = {"density": density, "label": N, "velocity_variance": variance}
    return xr.Dataset({name: ("x", values) for name, values in fields.items()}, {"x": x})


@pytest.mark.compiled
@pytest.mark.filterwarnings("ignore:equal elastic rods")
@pytest.mark.parametrize(
    ("frame", "kind", "ratio", "damping"),
    [
        ("label", None, 1, 0.3),
        ("label", "evolving", 1, 1e-6),
        ("label", "evolving", 3, 1e-6),
        ("eulerian", None, 1, 0.3),
        ("eulerian", "evolving", 3, 1e-6),
    ],
)
def test_standing_waves_are_those_of_the_linear_equations(frame, kind, ratio, damping):
    """Of density, flow, temperature and, on labels, heat flux, which collisions of two masses damp.

    Without it omega is sqrt(3) k W, and with it, of one mass, k W sqrt(3 +- sqrt(6)).
    """
    k = math.pi / 20
    chain = gas(damping * k, mass_ratio=float(ratio))
    moments = 2 if kind is None else 4 if frame == "label" else 3
    mixing = decay_of_two_masses(ratio) * 19 / 20
    rates = np.array([[0, -k, 0, 0], [k, 0, k, 0], [0, -2 * k, 0, -k], [0, 0, 3 * k, -mixing]])
    rates = (rates - damping * k * np.diag([0, 1, 2, 3]))[:moments, :moments]
    period = 2 * math.pi / (k * math.sqrt(3))
    how = {"velocity_variance": kind, "frame": frame, "progress": False}
    start = waved(chain, 0.02, adiabatic=kind is not None)
    flow = hydrodynamics(chain, start, period, every=period / 20, **how)
    rods = flow.mean_displacement.values + chain.reduced_anchors - chain.rank
    wave = rods @ np.sin(np.pi * (np.arange(20) + 0.5) / 20)
    exact = [(expm(rates * t) @ [1, 0, 2, 0][:moments])[0] for t in flow.time.values]
    np.testing.assert_allclose(wave / wave[0], exact, atol=0.004 if frame == "label" else 0.03)
    np.testing.assert_allclose(flow.rods, 20, rtol=1e-12)


@pytest.mark.compiled
def test_heat_relaxes_with_the_mean_of_the_inverse_masses():
    """A gas that is too hot everywhere cools as exp(-2 gamma <1/m> t)."""
    slow = 0.2
    chain = gas(slow, mass_ratio=30.0)
    hot = waved(chain, 0.0)
    hot["velocity_variance"] *= 2
    for frame in ("label", "eulerian"):
        flow = hydrodynamics(
            chain, hot, 2.0, velocity_variance="evolving", every=0.5, frame=frame, progress=False
        )
        inside = flow.velocity_variance.sel(x=slice(-20, 20)).mean("x")
        rate = 2 * slow * (1 / chain.rod_masses).mean()
        np.testing.assert_allclose(inside - 1, np.exp(-rate * flow.time), atol=2e-3)


@pytest.mark.compiled
def test_a_gas_at_rest_stays_and_comes_back_to_rest_on_springs():
    chain = in_a_box(10.0, gap=0.3)
    hot = force_balance(chain.replace(amplitude=8))
    for frame, cells in (("label", 50), ("eulerian", None)):
        how = {"frame": frame, "cells": cells, "progress": False}
        rest = hydrodynamics(chain, force_balance(chain), 10.0, every=10.0, **how)
        assert rest.residual < 0.02
        quench = hydrodynamics(chain, hot, 40.0, every=40.0, **how)
        np.testing.assert_allclose(quench.rods, 20, rtol=1e-12)
        off = quench.mean_displacement[-1] - force_balance(chain).mean_displacement
        assert np.abs(off).max() < 0.01


@pytest.mark.compiled
def test_a_fluid_of_equal_rods_says_how_wrong_it_is():
    """Of the slowest wave: at weak damping half its height or more, at strong damping nothing."""
    k = math.pi / 20
    slow = gas(0.2 * k)
    for moments, least, most in ((2, 0.7, 0.8), (3, 0.5, 0.6), (4, 0.35, 0.4)):
        assert least <= wave_model_error(slow, 7 / k, moments=moments) <= most
    assert wave_model_error(gas(10 * k), 7 / k, moments=2) < 0.02
    wave, evolving = waved(slow, 0.02), {"velocity_variance": "evolving", "progress": False}
    for frame, moments in (("label", 4), ("eulerian", 3)):
        with pytest.warns(UserWarning, match="are no fluid"):
            flow = hydrodynamics(slow, wave, 3 / k, every=3 / k, frame=frame, **evolving)
        error = wave_model_error(slow, 3 / k, moments=moments)
        assert flow.attrs["wave_model_error"] == pytest.approx(error)
    # At strong damping nothing is warned of, nor with two masses.
    once = {"duration": 1.0, "every": 1.0, "progress": False}
    flow = hydrodynamics(gas(10 * k), waved(gas(10 * k), 0.02), **once)
    assert flow.attrs["wave_model_error"] < 0.02
    two = gas(0.2 * k, mass_ratio=3.0)
    assert "wave_model_error" not in hydrodynamics(two, waved(two, 0.02), **once).attrs


@pytest.mark.parametrize(("size", "box"), [(4, 20.0), (3, 7.0), (5, 10.5)])
@pytest.mark.parametrize("start", [gathered, wave])
def test_starts_whose_density_jumps_at_a_wall_between_nodes_hold_all_rods(size, box, start):
    chain = Chain(size=size, box=box, stiffness=0.0)
    flow = hydrodynamics(chain, start(chain, 0.5), 0.2, every=0.1, frame="eulerian", progress=False)
    np.testing.assert_allclose(flow.rods, size, rtol=1e-9)


def test_two_streams_that_a_fluid_does_not_let_through_each_other_are_told_of():
    chain = Chain(size=20, amplitude=3.0, damping=0.1)
    x = np.linspace(-150, 150, 2001)
    density = np.exp(-(((np.abs(x) - 60) / 20) ** 2))
    density *= 20 / np.trapezoid(density, x)
    profiles = {"density": ("x", density), "flow_velocity": ("x", -60 * np.tanh(x / 20))}
    start, how = xr.Dataset(profiles, {"x": x}), {"velocity_variance": 400.0, "progress": False}
    with pytest.warns(UserWarning, match="pass through one another"):
        flow = hydrodynamics(chain, start, 1.0, every=0.5, **how)
    assert flow.attrs["label_model_error"] > 0.15
    with pytest.warns(UserWarning, match="two streams meet at"):
        hydrodynamics(chain.replace(gap=0.1), start, 0.1, every=0.1, **how)
