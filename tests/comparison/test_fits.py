"""Fits find the parameters that data were made with, and their errors are those of the scatter."""

import numpy as np
import pytest
from scipy.stats import laplace, norm

from crazybilliards.comparison import fit_arctanh, fit_border_power_law
from crazybilliards.comparison import fits as fitting
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.reproduction.fits import (
    fit_avalanches,
    fit_exponential,
    fit_growth,
    fit_scaling,
    fit_singularity,
    tail_length,
)

TRIALS = 200


def calibrated(values, errors, true):
    """Mean within 5 standard errors of the truth, and the errors quoted are the scatter."""
    values, errors = np.array(values), np.array(errors)
    scatter = values.std(ddof=1)
    assert abs(values.mean() - true) < 5 * scatter / len(values) ** 0.5
    # The scatter of 200 values is itself good to 5 %, that of 100 to 7 %.
    assert abs(np.mean(errors) / scatter - 1) < 0.25


def test_avalanche_exponents_are_unbiased_and_their_errors_right():
    generator = np.random.default_rng(1)
    sizes = np.arange(1, 201)
    p = sizes**-2.2
    fits = [
        fit_avalanches(generator.multinomial(2000, p / p.sum()), smallest=5, largest=100)
        for _ in range(TRIALS)
    ]
    calibrated([fit.exponent for fit in fits], [fit.exponent_error for fit in fits], 2.2)
    assert all(fit.distance < 3 / fit.count**0.5 for fit in fits)
    assert (fits[0].smallest, fits[0].largest) == (5, 100)


def test_an_exponential_distribution_is_seen_not_to_be_a_power_law():
    counts = np.round(1e6 * np.exp(-np.arange(1, 60) / 3))
    fit = fit_avalanches(counts)
    assert fit.distance > 30 / fit.count**0.5


def test_scaling_exponents_are_unbiased_and_their_errors_right():
    generator = np.random.default_rng(2)
    x = np.geomspace(10, 1e4, 8)
    error = 0.05 * 3 * x**-0.38
    fits = [fit_scaling(x, generator.normal(3 * x**-0.38, error), error) for _ in range(TRIALS)]
    calibrated([f.exponent for f in fits], [f.exponent_error for f in fits], -0.38)
    calibrated([f.scale for f in fits], [f.scale_error for f in fits], 3.0)
    assert abs(np.mean([f.chi_square for f in fits]) - 1) < 0.2


def test_scaling_errors_grow_where_the_points_scatter_more_than_they_say():
    x = np.geomspace(1, 100, 6)
    y = x**0.5 * [1, 1.2, 0.8, 1.2, 0.8, 1.0]
    honest, wrong = fit_scaling(x, y, 0.2 * y), fit_scaling(x, y, 0.01 * y)
    assert wrong.chi_square > 100
    assert wrong.exponent_error > 0.7 * honest.exponent_error


def test_exponential_of_the_restitution():
    generator = np.random.default_rng(3)
    e = np.array([0.0, 0.5, 0.75, 0.85, 0.92, 0.95])
    true = 0.3 * np.exp(-5 * (1 - e)) + 0.45
    fits = [
        fit_exponential(e, generator.normal(true, 0.003), np.full(6, 0.003)) for _ in range(TRIALS)
    ]
    # The errors include the enlargement by chi-square, so they are on the large side.
    assert abs(np.mean([f.rate for f in fits]) - 5) < 0.1
    assert 0.7 < np.mean([f.rate_error for f in fits]) / np.std([f.rate for f in fits]) < 1.8
    np.testing.assert_allclose(fits[0](e), true, atol=0.01)


def test_singularity_is_found_under_noise():
    generator = np.random.default_rng(4)
    t = np.linspace(30, 39.8, 200)
    for _ in range(5):
        energy = 1e5 * (40 - t) ** -6.0 * np.exp(generator.normal(0, 0.1, t.size))
        fit = fit_singularity(t, energy)
        assert abs(fit.time - 40) < 5 * fit.time_error
        assert abs(fit.exponent - 6) < 5 * fit.exponent_error
        assert abs(fit.misfit - 0.1) < 0.02
        assert fit.exponent_error < 0.2


def test_exponential_growth_is_no_singularity():
    t = np.linspace(0, 10, 50)
    with pytest.raises(ValueError, match="no finite-time singularity"):
        fit_singularity(t, np.exp(t))
    fit = fit_growth(t, 2 * np.exp(0.7 * t))
    assert (fit.rate, fit.scale) == pytest.approx((0.7, 2.0))


def test_points_of_any_kind_are_fitted_or_refused_without_a_numerical_warning():
    """The search for the parameters may overflow on its way. Warnings are errors here."""
    generator = np.random.default_rng(8)
    chain = Chain(size=9)
    for _ in range(20):
        spread = 10 ** generator.uniform(0, 30)
        t, energy = np.sort(generator.normal(size=(1, 9))[0]), spread ** generator.random(9)
        displacement = generator.normal(size=9) + 3 * np.sign(chain.anchors)
        displaced = result(
            chain, {"mean_displacement": ("particle", displacement)}, source="theory", method={}
        )
        for fit in (
            lambda t=t, y=energy: fit_singularity(t, y),
            lambda t=t, y=energy: fit_exponential(t, y, 1e-3 * y),
            lambda source=displaced: fit_arctanh(source),
        ):
            try:
                found = fit()
            except ValueError:
                continue
            assert np.isfinite([*found.parameters.values(), *found.errors.values()]).all()


@pytest.mark.parametrize("beyond", [2.0, 3.0, 4.1, 5.0, 6.3])
def test_tail_lengths_do_not_depend_on_the_bins(beyond):
    """The bins of simulate are a quarter of w wide there, wider than the tail of a Gaussian."""
    last = np.arcsinh(1000 / 0.05)
    edges = 0.05 * np.sinh(np.linspace(-last, last, 402))
    v, width = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
    exponential = np.diff(laplace.cdf(edges)) / width
    assert tail_length(v, exponential, beyond) == pytest.approx(1, rel=1e-3)
    assert tail_length(v[v < 0], exponential[v < 0], beyond) == pytest.approx(1, rel=1e-3)
    gauss = np.diff(norm.cdf(edges)) / width
    exact = norm.pdf(beyond) / norm.sf(beyond) - beyond
    assert tail_length(v[v < 0], gauss[v < 0], beyond) == pytest.approx(exact, rel=5e-3)


def test_the_tail_of_a_single_bin_is_half_of_it():
    v = np.arange(-3.0, 4.0)
    assert tail_length(v, (v == 3) * 1.0, 2.5) == pytest.approx(0.5)
    assert tail_length(v, (np.abs(v) == 3) * 0.5, 2.75) == pytest.approx(0.375)


def profile(width, error=None):
    chain = Chain(size=len(width), restitution=0)
    variables = {"velocity_width": ("particle", width)}
    if error is not None:
        variables["velocity_width_error"] = ("particle", error)
    return result(chain, variables, source="simulation", method={})


def power_laws(size, scale, nu, c):
    i = np.arange(1.0, size + 1)
    return scale * ((i - c) ** nu + (size + 1 - c - i) ** nu)


@pytest.mark.parametrize(("size", "unit"), [(20, 1e-3), (300, 1e4)])
@pytest.mark.parametrize(("nu", "c"), [(-0.46, -0.5), (-0.46, 0.7), (-1.5, -4.0), (-0.1, 0.0)])
def test_two_power_laws_are_found_exactly(size, unit, nu, c):
    width = power_laws(size, 0.3 * unit, nu, c)
    for weighted in (False, True):
        fit = fit_border_power_law(profile(width), weighted=weighted)
        found = fit.scale / unit, fit.exponent, fit.origin
        assert found == pytest.approx((0.3, nu, c), rel=1e-3, abs=1e-3)
        assert fit.misfit < 1e-4
    np.testing.assert_allclose(fit(np.arange(1, size + 1)), width, rtol=1e-3)


@pytest.mark.validate
def test_the_errors_of_two_power_laws_are_those_of_the_scatter(monkeypatch):
    """Ordinary least squares for equal noise, weighted for noise in proportion to the width."""
    monkeypatch.setattr(fitting, "_STARTS", fitting._STARTS[:1])  # all lead to the same fit
    generator = np.random.default_rng(6)
    true = power_laws(100, 0.3, -0.46, -0.4)
    for noise, weighted in ((np.full(100, 2e-3), False), (0.01 * true, True)):
        fits = [
            fit_border_power_law(profile(generator.normal(true, noise), noise), weighted=weighted)
            for _ in range(TRIALS // 2)
        ]
        nu, c = ([getattr(fit, name) for fit in fits] for name in ("exponent", "origin"))
        calibrated(nu, [fit.exponent_error for fit in fits], -0.46)
        calibrated(c, [fit.origin_error for fit in fits], -0.4)
        within = [abs(f.exponent + 0.46) < f.exponent_error for f in fits]
        assert abs(np.mean(within) - 0.683) < 5 * (0.683 * 0.317 / len(fits)) ** 0.5
        claimed = np.mean([fit.correlation for fit in fits])
        assert claimed == pytest.approx(np.corrcoef(nu, c)[0, 1], abs=0.05)
        assert claimed > 0.8


def test_dropping_c_flattens_the_exponent():
    width = power_laws(100, 0.3, -0.46, -0.4)
    fit = fit_border_power_law(profile(width), shifted=False)
    assert (fit.origin, fit.origin_error, fit.correlation) == (0, 0, 0)
    assert -0.44 < fit.exponent < -0.41
    exact = fit_border_power_law(profile(power_laws(100, 0.3, -0.46, 0.0)), shifted=False)
    assert (exact.scale, exact.exponent) == pytest.approx((0.3, -0.46), rel=1e-5)


def test_weighted_widths_count_by_their_errors():
    """One wrong rod with a large error bar does no harm; in ordinary least squares it does."""
    width = power_laws(100, 0.3, -0.5, -0.4)
    error = 0.01 * width
    width[0], error[0] = width[0] / 3, 1e4 * width[0]
    weighted = fit_border_power_law(profile(width, error), weighted=True)
    assert weighted.exponent == pytest.approx(-0.5, 1e-3)
    assert abs(fit_border_power_law(profile(width, error)).exponent + 0.5) > 0.01


# -- arctanh -----------------------------------------------------------------------------------


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
