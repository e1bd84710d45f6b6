"""Deviations in both units, and the two fits."""

import numpy as np
import pytest
import xarray as xr

from crazybilliards.comparison import deviation, fit_arctanh, fit_border_power_law, smooth
from crazybilliards.kinetic import equilibrium, force_balance
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.particles import simulate


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


def test_a_transposed_density_deviates_as_before():
    chain = Chain(size=10)
    runs = [
        simulate(
            chain, seed=seed, duration=2, average="ensemble", observe="density", progress=False
        )
        for seed in (1, 2)
    ]
    one, other = map(smooth, runs)
    assert deviation(one.transpose("x", ...), other) == deviation(one, other)


def test_deviation_in_both_units():
    chain = Chain(size=10)
    d = deviation(flat(chain, 0.31, 4, error=0.003), flat(chain, 0.3, 4, error=0.004))
    assert d.maximum == pytest.approx(0.02)
    assert d.rms == pytest.approx(0.02)
    assert d.integrated == pytest.approx(9 * 0.5 * 0.01 / 10)
    assert d.maximum_in_errors == pytest.approx(2)
    assert d.rms_in_errors == pytest.approx(2)


def test_outside_a_grid_the_density_is_zero():
    chain = Chain(size=10)
    d = deviation(flat(chain, 0.39, 4), flat(chain, 0.27, 6))  # equally many rods
    assert d.maximum == pytest.approx(0.54)
    assert d.integrated == pytest.approx((9 * 0.12 + 4 * 0.27) * 0.5 / 10)
    assert d.maximum_in_errors is None


def test_densities_over_other_times_are_not_compared():
    chain = Chain(size=10)
    times = [flat(chain, 0.3, 4).assign_coords(time=t) for t in (0.0, 1.0, 2.0)]
    one, other = (xr.concat([times[0], each], "time") for each in times[1:])
    assert deviation(one, one).maximum == 0
    for reference in (other, times[0]):
        with pytest.raises(ValueError, match="choose one of each"):
            deviation(one, reference)
    with pytest.raises(ValueError, match="different spacing"):
        deviation(times[0], flat(chain, 0.3, 4, spacing=0.4))


def test_a_vanishing_density_deviates_by_nothing():
    chain = Chain(size=10)
    d = deviation(flat(chain, 0.0, 4), flat(chain, 0.0, 4))
    assert (d.maximum, d.rms, d.integrated) == (0, 0, 0)
    exact = equilibrium(chain)
    assert deviation(exact, exact, raw=True).maximum == 0


def test_the_fit_recovers_an_arctanh():
    chain = Chain(size=51)
    mean = np.zeros(51)
    for _ in range(200):  # displacements that lie on the curve at the positions they lead to
        mean = 2.5 * np.arctanh((chain.anchors + mean) / 66)
    variables = {"mean_displacement": ("particle", mean)}
    fit = fit_arctanh(result(chain, variables, source="theory", method={}))
    assert fit.scale == pytest.approx(2.5, rel=1e-6)
    assert 1 / fit.steepness == pytest.approx(66, rel=1e-6)
    assert fit.misfit < 1e-6
    assert fit.support == (-1 / fit.steepness, 1 / fit.steepness)
    np.testing.assert_allclose(fit(chain.anchors + mean), mean, atol=1e-5)


def test_the_fit_of_the_reference_chain():
    """Against the closure by labels at L = 100, g = 0: B/s and 1/C for A = 10."""
    chain = Chain(amplitude=10)
    fit = fit_arctanh(force_balance(chain))
    assert fit.scale / chain.thermal_length == pytest.approx(1.41, abs=0.02)
    assert 1 / fit.steepness == pytest.approx(123.4, abs=1)
    assert fit.scale_error < 0.02 * fit.scale
    assert fit.misfit < 0.05 * chain.thermal_length


def test_a_chain_that_is_pulled_inwards_has_no_arctanh():
    inward = equilibrium(Chain(size=5))
    with pytest.raises(ValueError, match="not displaced outward"):
        fit_arctanh(inward.assign(mean_displacement=-0.1 * inward.mean_displacement))


@pytest.mark.compiled
def test_the_dissipative_chain_follows_a_power_law_from_its_borders():
    """L = 300, e = 0: nu = -0.46, as in the paper. The run tells nu to 0.012."""
    chain = Chain(size=300, restitution=0)
    run = simulate(chain, duration=600, time_step=1e-3, observe="widths", progress=False)
    fit = fit_border_power_law(run)
    assert fit.exponent == pytest.approx(-0.46, abs=0.06)
    assert fit.misfit < 0.03
    # Without c it is flatter: not the paper's exponent.
    assert fit_border_power_law(run, shifted=False).exponent == pytest.approx(-0.436, abs=0.035)
