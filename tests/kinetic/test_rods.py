"""From points to rods: exact at restitution 1, and conserved."""

import numpy as np
import pytest

from crazybilliards.comparison import deviation, smooth
from crazybilliards.kinetic import (
    breathing_cloud,
    compressed,
    displaced,
    equilibrium,
    force_balance,
    hydrodynamics,
    rod_by_rod,
    steady_state,
)
from crazybilliards.kinetic import rods as fluids
from crazybilliards.kinetic.exact import places
from crazybilliards.kinetic.exact.places import elastic_rods, over_positions
from crazybilliards.model import Chain, load, save
from crazybilliards.particles import simulate

TWELVE = Chain(size=12)


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize(
    ("size", "amplitude", "gap"), [(1, 1, 0), (7, 30, 0), (100, 0.5, 0), (20, 1, 0.3), (30, 1, 2.0)]
)
@pytest.mark.filterwarnings("ignore::crazybilliards.kinetic.UnmeasuredWarning")
def test_rods_of_the_force_balance_are_exact(size, amplitude, gap, spring):
    """The force balance has the exact points; what is left is the grid."""
    chain = Chain(size=size, amplitude=amplitude, gap=gap, spring=spring)
    exact, rods = equilibrium(chain), rod_by_rod(force_balance(chain))
    assert deviation(smooth(exact), smooth(rods)).maximum < 1e-5
    assert deviation(exact, rods, raw=True).maximum < 1e-3
    moved = np.abs(rods.mean_displacement - exact.mean_displacement)
    assert float(moved.max()) < 1e-6 * chain.thermal_length
    np.testing.assert_allclose(rods.displacement_width, exact.displacement_width, rtol=1e-6)
    assert rods.attrs["density_of"] == "rods"


@pytest.mark.compiled
@pytest.mark.parametrize("frame", ["label", "eulerian"])
def test_rods_of_a_breathing_cloud_are_exact(frame):
    """The points of a released chain stay Gaussian, with the width that is known in closed form."""
    release = {"duration": 6.0, "every": 2.0}
    how = {"velocity_variance": "evolving", "frame": frame, "progress": False}
    flow = hydrodynamics(TWELVE, compressed(TWELVE, 0.5), **release, **how)
    rods, cloud = rod_by_rod(flow), breathing_cloud(TWELVE, **release, stretch=0.5)
    for time in range(flow.sizes["time"]):
        width = float(cloud.cloud_width[time]) / TWELVE.thermal_length
        exact = elastic_rods(TWELVE.replace(amplitude=width * TWELVE.amplitude))
        found = rods.isel(time=time)
        density, label = over_positions(TWELVE, found.x.values, exact)
        known = found.assign(density=("x", density), label=("x", label))
        difference = deviation(smooth(found), smooth(known)).maximum
        assert difference < (2e-4 if frame == "label" else 2e-3)
        moved = found.mean_displacement - (exact.mean() - TWELVE.reduced_anchors)
        assert float(np.abs(moved).max()) < 5e-3 * TWELVE.thermal_length
        np.testing.assert_allclose(found.displacement_width, exact.width(), rtol=0.01)


def test_velocities_are_how_fast_the_rods_move():
    flow = hydrodynamics(TWELVE, compressed(TWELVE, 0.5), 0.02, every=0.01, progress=False)
    rods = rod_by_rod(flow)
    moved = (rods.mean_displacement[2] - rods.mean_displacement[0]) / 0.02
    np.testing.assert_allclose(rods.mean_velocity[1], moved, atol=1e-3, rtol=1e-2)


@pytest.mark.parametrize("gap", [0.0, 0.3])
def test_rods_move_and_stretch_with_the_chain(gap):
    """A shift and a stretch of the exact state are exact, with a gap too."""
    chain = Chain(size=20, gap=gap)
    exact, rest = elastic_rods(chain), chain.reduced_anchors
    shifted, stretched = rod_by_rod(displaced(chain, 2.0)), rod_by_rod(compressed(chain, 0.4))
    np.testing.assert_allclose(shifted.mean_displacement, exact.mean() - rest + 2.0, atol=1e-5)
    np.testing.assert_allclose(shifted.displacement_width, exact.width(), rtol=1e-5)
    np.testing.assert_allclose(stretched.mean_displacement, 0.4 * exact.mean() - rest, atol=1e-5)
    np.testing.assert_allclose(stretched.displacement_width, 0.4 * exact.width(), rtol=1e-5)
    closer = exact._replace(places=0.4 * exact.places, density=exact.density / 0.4)
    density, label = over_positions(chain, stretched.x.values, closer)
    np.testing.assert_allclose(stretched.density, density, atol=1e-4 * density.max())
    np.testing.assert_allclose(stretched.label, label, atol=1e-5)


def test_it_takes_one_time_or_all_and_files(tmp_path):
    flow = hydrodynamics(TWELVE, displaced(TWELVE, 1.0), 2, every=1.0, progress=False)
    save(flow, tmp_path / "flow.nc")
    rods = rod_by_rod(load(tmp_path / "flow.nc"))
    assert rods.density.dims == ("time", "x")
    one = rod_by_rod(flow.isel(time=1))
    for name in ("density", "mean_displacement", "mean_position", "mean_velocity"):
        np.testing.assert_array_equal(one[name], rods[name][1])
    np.testing.assert_allclose(one.mean_position, TWELVE.anchors + one.mean_displacement)
    save(rods, tmp_path / "rods.nc")
    assert flow.attrs["density_of"] == "fluid"
    for found in (equilibrium(TWELVE), steady_state(TWELVE), rods):
        assert rod_by_rod(found) is found


@pytest.mark.parametrize("gap", [0.0, 0.3])
def test_a_start_with_the_density_of_rods_is_that_of_their_fluid(gap):
    """At this amplitude rods have peaks, which no fluid can start from.

    With a gap the gas has no fluid beyond the outermost rods, which the force balance has.
    """
    chain, cold = Chain(size=12, gap=gap), Chain(size=12, gap=gap, amplitude=0.5)
    balance = force_balance(cold)
    known = hydrodynamics(chain, balance, 2, every=1.0, progress=False)
    for start, most in ((rod_by_rod(balance), 0.005), (steady_state(cold), 0.2 if gap else 0.02)):
        assert float(start.density.max()) > chain.close_packed_density
        flow = hydrodynamics(chain, start, 2, every=1.0, progress=False)
        moved = np.abs(flow.mean_displacement - known.mean_displacement)
        assert float(moved.max()) < most * chain.thermal_length


def test_more_rods_than_anybody_resolves_stay_a_fluid(monkeypatch):
    monkeypatch.setattr(places, "MOST_RODS", 11)
    balance = force_balance(TWELVE)
    assert rod_by_rod(balance) is balance
    monkeypatch.setattr(places, "MOST_RODS_WITH_GAP", 11)
    for gap in (0.0, 0.3):
        found = steady_state(TWELVE.replace(gap=gap, restitution=0.9))
        assert found.attrs["density_of"] == "fluid"
        spacing = float(found.x[1] - found.x[0])
        assert float(found.density.sum() * spacing) == pytest.approx(12, rel=1e-3)


@pytest.mark.compiled
@pytest.mark.parametrize("gap", [0.3, 0.0])
def test_rods_of_the_steady_state_are_those_of_a_simulation(gap):
    chain = Chain(size=20, restitution=0.65, gap=gap)
    run = simulate(chain, duration=10_000, observe=("widths", "density"), progress=False, seed=3)
    theory = steady_state(chain)
    assert deviation(smooth(run), smooth(theory)).maximum < 0.03
    off = np.abs(theory.displacement_width / run.displacement_width - 1)
    assert float((off - 5 * run.displacement_width_error / run.displacement_width).max()) < 0.07
    moved = np.abs(theory.mean_displacement - run.mean_displacement)
    assert float(moved.max()) < 0.06 * chain.thermal_length


def test_no_more_equilibria_than_temperatures(monkeypatch):
    """With a gap all times of an isothermal fluid share one exact equilibrium."""
    chain = Chain(size=9, gap=0.123)
    flow = hydrodynamics(chain, displaced(chain, 1.0), 4, every=1.0, progress=False)
    computed = []
    recursion = places.recursion_of
    monkeypatch.setattr(places, "recursion_of", lambda c: computed.append(c) or recursion(c))
    fluids.rod_by_rod(flow)
    assert len(computed) == 1
