"""Densities: the paper's binning against a slow twin, and how far two of them are apart."""

import numpy as np
import pytest
import xarray as xr

from crazybilliards.comparison import coverage_density, deviation, smooth
from crazybilliards.kinetic import (
    displaced,
    equilibrium,
    equilibrium_states,
    force_balance,
    hydrodynamics,
)
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import Density


def coverage_slowly(positions, x, radius):
    """Sum the share of each bin that each rod covers; per sample and per 2R."""
    h = x[1] - x[0]
    left, right = x - h / 2, x + h / 2
    covered = np.zeros(x.size)
    for state in positions:
        for centre in state:
            overlap = np.minimum(right, centre + radius) - np.maximum(left, centre - radius)
            covered += np.maximum(overlap, 0) / h
    return covered / len(positions) / (2 * radius)


@pytest.mark.parametrize("radius", [1.0, 0.3])
@pytest.mark.parametrize("gap", [0.0, 0.7])
def test_states_are_binned_like_the_slow_twin(gap, radius):
    chain = Chain(size=6, gap=gap, radius=radius)
    states = equilibrium_states(chain, 20, seed=1)
    density = coverage_density(states)
    expected = coverage_slowly(states.position.values, density.x.values, radius)
    np.testing.assert_allclose(density.density, expected, atol=1e-12)
    n = round(2 * radius / float(density.x[1] - density.x[0]))
    averaged = np.convolve(expected, np.full(n, 1 / n), "same")
    np.testing.assert_allclose(smooth(states).density, averaged, atol=1e-12)


def test_a_theory_with_unresolved_spikes_is_binned_right():
    """All but motionless rods on a grid coarser than their motion: covered, or not."""
    chain = Chain(size=1000, gap=1, amplitude=1e-3)
    exact = equilibrium(chain)
    density = coverage_density(exact)
    h = float(density.x[1] - density.x[0])
    assert h > 10 * chain.thermal_length
    # Anchors lie at the half-odd multiples of 3.
    distance = np.abs(density.x.values % 3 - 1.5)
    within = np.abs(density.x.values) < chain.anchors[-1] + 1
    np.testing.assert_allclose(
        density.density.values[within & (distance < 1 - 2 * h)], 0.5, rtol=1e-6
    )
    np.testing.assert_allclose(density.density.values[distance > 1 + 2 * h], 0, atol=1e-9)
    assert (density.density >= 0).all()
    assert float(density.density.sum() * h) == pytest.approx(1000, rel=1e-9)


def test_the_error_of_a_convolved_density_is_that_of_its_blocks():
    run = simulate(Chain(size=5), duration=49 * 2 * 17, every=1.0, progress=False)
    convolved = smooth(run)
    blocks = convolved.density_block
    assert blocks.sizes["block"] == 49
    error = blocks.std("block", ddof=1) / 7
    np.testing.assert_allclose(convolved.density_error, error, atol=1e-15)
    np.testing.assert_allclose(blocks.mean("block"), convolved.density, atol=1e-12)
    assert smooth(convolved) is convolved
    # Convolution takes out noise: the naive, unsmoothed error bar would be far too large.
    assert convolved.density_error.max() < run.density_error.max()


def _with_parts():
    """Yield results whose density is known on their whole grid, with the rods that it has."""
    chain = Chain(size=20, gap=0.3)
    yield simulate(chain, duration=200, progress=False), 20
    raw = {"duration": 4, "average": "ensemble", "observe": "density", "progress": False}
    yield simulate(chain, **raw), 20
    yield equilibrium(chain), 20
    yield force_balance(chain).drop_vars("label"), 20
    yield hydrodynamics(chain, displaced(chain, 1.0), 2.0, progress=False), 20
    narrow, far = Density(reach=0.1), chain.replace(amplitude=6)
    with pytest.warns(UserWarning, match="outside the grid"):
        run = simulate(far, duration=200, observe=narrow, progress=False)
    yield run, 20
    yield coverage_density(equilibrium(chain)), 20
    yield coverage_density(equilibrium_states(chain, 5).isel(particle=[1, 18])), 2


@pytest.mark.compiled
def test_a_grid_that_was_cut_or_thinned_is_not_smoothed():
    for each, rods in _with_parts():
        end, whole, ways = float(each.x[-1]), smooth(each), [smooth]
        if "smoothed" not in each.attrs:
            ways.append(coverage_density)
        if "outside" not in each or each.outside == 0:
            for way in ways:
                held = way(each).density.sum("x") * (whole.x[1] - whole.x[0])
                np.testing.assert_allclose(held, rods, rtol=1e-6)
        for part in (slice(-9.0, 9.0), slice(-100, 5.0), slice(-3.0, 100)):
            for way in ways:
                with pytest.raises(
                    ValueError, match=rf"grid of x holds .* of .* {rods} rods: .*cut what"
                ):
                    way(each.sel(x=part))
        for way in ways:
            with pytest.raises(ValueError, match="x must be even and ascend"):
                way(each.isel(x=slice(None, None, -1)))
            with pytest.raises(ValueError, match="x must have an odd number of nodes"):
                way(each.isel(x=slice(None, None, 2)))
            with pytest.raises(ValueError, match="density must be over x"):
                way(each.isel(x=3))
        xr.testing.assert_allclose(smooth(each.transpose("x", ...)), whole)
        if rods == 20 and "outside" not in each:  # where there is nothing
            less = each.sel(x=slice(-end + 1.0, end - 1.0))
            xr.testing.assert_allclose(smooth(less).density, whole.density.sel(x=less.x))


# -- deviations --------------------------------------------------------------------------------


def flat(chain, height, width, error=None, spacing=0.5):
    x = spacing * np.arange(-width, width + 1)
    variables = {"density": ("x", np.full(x.size, height))}
    if error is not None:
        variables["density_error"] = ("x", np.full(x.size, error))
    found = result(chain, variables, source="theory", method={}, coordinates={"x": x})
    return found.assign_attrs(smoothed="coverage, running average")


def test_densities_that_were_cut_are_compared_where_both_are_known():
    chain = Chain(size=50)
    one, other = smooth(equilibrium(chain)), smooth(force_balance(chain))
    whole = deviation(one, other)
    middle = deviation(one.sel(x=slice(-20, 20)), other.sel(x=slice(-20, 20)))
    assert 0 < middle.integrated < whole.integrated
    less = one.sel(x=slice(-20, 20))
    for end in (19.8, 20.5):  # a hundredth of the rods, which was 0 in one and 1/2 in the other
        with pytest.raises(ValueError, match="rods; their grids end at other places"):
            deviation(less, other.sel(x=slice(-20, end)))
    with pytest.raises(ValueError, match="grids with other nodes"):
        deviation(one.isel(x=slice(0, None, 3)), other.isel(x=slice(1, None, 3)))
    with pytest.raises(ValueError, match="even and ascend"):
        deviation(one.isel(x=slice(None, None, -1)), other)
    tails = one.sel(x=slice(-56, 56))
    assert deviation(tails, other).maximum == pytest.approx(whole.maximum)


def test_deviation_in_both_units_and_outside_a_grid_where_the_density_is_zero():
    chain = Chain(size=10)
    d = deviation(flat(chain, 0.31, 4, error=0.003), flat(chain, 0.3, 4, error=0.004))
    assert (d.maximum, d.rms, d.integrated) == pytest.approx((0.02, 0.02, 9 * 0.5 * 0.01 / 10))
    assert (d.maximum_in_errors, d.rms_in_errors) == pytest.approx((2, 2))
    d = deviation(flat(chain, 0.39, 4), flat(chain, 0.27, 6))  # equally many rods
    assert d.maximum == pytest.approx(0.54)
    assert d.integrated == pytest.approx((9 * 0.12 + 4 * 0.27) * 0.5 / 10)
    assert d.maximum_in_errors is None
    d = deviation(flat(chain, 0.0, 4), flat(chain, 0.0, 4))
    assert (d.maximum, d.rms, d.integrated) == (0, 0, 0)
    exact = equilibrium(chain)
    assert deviation(exact, exact, raw=True).maximum == 0


def test_densities_over_other_times_are_not_compared():
    chain = Chain(size=10)
    times = [flat(chain, 0.3, 4).assign_coords(time=t) for t in (0.0, 1.0, 2.0)]
    one, other = (xr.concat([times[0], each], "time") for each in times[1:])
    assert deviation(one, one.transpose("x", ...)).maximum == 0
    for reference in (other, times[0]):
        with pytest.raises(ValueError, match="choose one of each"):
            deviation(one, reference)
    with pytest.raises(ValueError, match="different spacing"):
        deviation(times[0], flat(chain, 0.3, 4, spacing=0.4))
