"""Claims get the verdict that their numbers deserve, which are means of independent runs."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm, t

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.reproduction.claims.study import Runs, effort, error_of_mean, share_of_runs
from crazybilliards.reproduction.claims.verdicts import (
    EYE,
    POSITIVE,
    Claim,
    Estimate,
    around,
    furthest_in_plot,
    in_plot,
    worst,
)
from crazybilliards.reproduction.distributions import mean_shape
from crazybilliards.reproduction.profiles import border_width, central_width, fits_in_plot, mirrored


def every_kind(value, error):
    """Return a claim of each kind about one number; it has to be within 1 of 0, or positive."""
    measured = Estimate(value, error)
    share = Estimate(value * EYE, error * EYE)
    return [
        Claim("it", "is", source="fig.2", number=measured, within=around(0.0, 1.0)),
        Claim("it", source="fig.2", **worst("is", [measured], 1.0)),
        Claim("it", source="fig.2", **in_plot("is", share, 1.0)),
        Claim("it", "is", source="fig.2", number=measured, within=POSITIVE),
    ]


@given(value=st.floats(-5, 5), error=st.floats(0, 2), more=st.floats(1, 10))
def test_all_kinds_of_limits_have_one_rule_and_large_errors_help_no_claim(value, error, more):
    """A verdict with large errors is that with small ones, or undecided."""
    precise, poor = (
        [claim.verdict for claim in every_kind(value, each)] for each in (error, error * more)
    )
    inside, outside = abs(value) + 3 * error < 1, abs(value) - 3 * error > 1
    expected = "reproduced" if inside else "not reproduced" if outside else "undecided"
    assert {*precise[:2]} == {expected}
    assert Estimate(value, np.nan).lies((-1, 1)) is Estimate(np.nan, error).lies((-1, 1)) is None
    assert all(each in (sure, "undecided") for sure, each in zip(precise, poor, strict=True))


def test_a_choice_decides_only_where_it_was_varied_and_changed_the_verdict():
    """The number of figure 6 at one time step, and at others."""

    def verdict(value, *others, **about):
        elsewhere = {f"choice {k}": Estimate(*each) for k, each in enumerate(others)}
        number = {"number": Estimate(*value), "within": around(-2.2, 0.1)}
        return Claim("exponent", **number, elsewhere=elsewhere, **about).verdict

    flat, right, steep, poor = (-1.6, 0.01), (-2.2, 0.01), (-3.0, 0.1), (-2.3, 0.2)
    said = {"source": "fig:trigger", "ours": "the time step"}
    for those in ((flat,), (flat, steep), (flat, poor)):
        assert verdict(*those, **said) == "not reproduced"
    assert verdict(right, poor, **said) == "reproduced"
    assert verdict(poor, right, **said) == "undecided"
    for those in ((flat, right), (right, flat), (flat, poor, right), (poor, right, steep)):
        assert verdict(*those, **said) == "cannot be decided"


def test_the_number_is_told_with_its_limits_and_with_that_at_other_choices():
    number = {"number": Estimate(-1.6, 0.01), "within": around(-2.2, 0.05), "source": "fig:trigger"}
    elsewhere = {"dt = 0.02": Estimate(-2.21, 0.01), "dt = 0.01": Estimate(-2.3, 0.1)}
    claim = Claim("exponent", **number, elsewhere=elsewhere)
    told = "dt = 0.02: -2.210 ± 0.010, reproduced; dt = 0.01: -2.30 ± 0.10"  # which decides nothing
    assert claim.details["at other choices"] == told
    assert "at other choices" not in Claim("it", **number).details
    for value, why in ((-2.2, None), (-2.0, "near"), (-2.16, "near")):
        number["number"] = Estimate(value, 0.01)
        assert Claim("it", **number, reason="near").details.get("why") == why
    measured = Estimate(0.1, 0.02)

    def told(within):
        details = Claim("it", "change", source="fig.2", number=measured, within=within).details
        return details["found here"], details.get("its number")

    assert told(around(0.3, 0.01)) == ("change 0.100 ± 0.020", "0.3")
    assert told(around(0.0, 0.5)) == ("change 0.100 ± 0.020 (limit 0.5)", None)
    assert told(POSITIVE) == ("change 0.100 ± 0.020", None)


@pytest.mark.parametrize(
    ("deviations", "errors", "verdict", "decides"),
    [
        ([0.9, 0.8, 0.1], [0.02, 0.1, 0.2], "undecided", 1),  # a smaller one may be seen
        ([0.9, 0.8, 0.1], [0.02, 0.05, 0.2], "reproduced", 0),
        ([4.0, 3.0, 0.1], [2.0, 0.1, 0.2], "not reproduced", 1),  # the largest may be chance
    ],
)
def test_the_deviation_that_decides_need_not_be_the_largest(deviations, errors, verdict, decides):
    """Limits are 1, in units of what an eye sees."""
    found = furthest_in_plot(EYE * np.array(deviations), EYE * np.array(errors))
    assert found.value == EYE * deviations[decides]
    assert Claim("it fits", **in_plot("rods", found, 5.0), source="fig.2").verdict == verdict


def test_what_is_said_of_a_plot_is_what_was_measured():
    """A steep line an eye does not tell from the symbols, though it is far off beside them."""
    share = Estimate(0.00874, 0.00014)
    assert in_plot("rho(x)", share, 1372.8)["words"] == (
        "rho(x): the symbol that decides is 0.874 ± 0.014 % of the plotted range away from the "
        "nearest point of the line (visible: 2 %); the largest vertical distance is 1372.8 "
        "standard errors"
    )
    assert "standard errors" not in in_plot("p(v)", share)["words"]


def test_sameness_is_confirmed_only_if_a_difference_would_have_been_seen():
    """Chance takes the largest of many beyond three enlarged errors as often as one beyond 3."""
    for number in (1, 4, 1000):
        _, error = worst("both", [Estimate(0.0, 1.0)] * number, 1.0)["number"]
        each = norm.cdf(3 * error) - norm.cdf(-3 * error)
        assert 1 - each**number == pytest.approx(2 * norm.sf(3), rel=2e-3)
    near, poor, off = Estimate(0.01, 0.002), Estimate(0.01, 0.05), Estimate(-0.3, 0.01)

    def verdict(*differences):
        return Claim("equal", source="fig.2", **worst("both", differences, 0.1)).verdict

    assert verdict(near, near) == "reproduced"
    assert verdict(near, poor) == "undecided"  # once it held: its difference is no standard error
    assert verdict(near, poor, off) == "not reproduced"
    assert verdict(near, Estimate(np.nan, 0.1)) == "undecided"
    assert verdict(off, Estimate(np.nan, 0.1)) == "not reproduced"
    words = "both: -0.300 ± 0.010, the worst of 3 (limit 0.1); largest difference 30.0 standard"
    assert worst("both", [near, off, poor], 0.1)["words"] == f"{words} errors"


def test_estimates_are_written_to_the_second_digit_of_the_error():
    assert str(Estimate(-0.46123, 0.00234)) == "-0.4612 ± 0.0023"
    assert str(Estimate(37.512, 1.234)) == "37.5 ± 1.2"
    assert str(Estimate(5.0, 0.0)) == "5.0000 ± 0.0000"
    assert str(Estimate(np.nan, 0.1)) == "not determined"
    difference = Estimate(3.0, 0.3).minus(Estimate(1.0, 0.4))
    assert difference == pytest.approx((2.0, 0.5))


def test_distances_in_a_plot_are_the_shortest_to_the_line():
    x = np.linspace(-2, 3, 26)
    # A circle of radius 1 in the units of the plot; the line is the x-axis, then a tilted one.
    unit = {"x_range": (0.0, 10.0), "y_range": (-5.0, 5.0)}
    y = np.sqrt(np.maximum(9 - x**2, 0))
    far = np.array([-100.0, 100.0])
    np.testing.assert_allclose(distances_in_plot(x, y, far, 0 * far, **unit), y / 10)
    tilted = distances_in_plot(x, y, far, far, **unit)
    np.testing.assert_allclose(tilted, np.abs(y - x) / 10 / 2**0.5, atol=1e-12)
    # Beyond the end of a line the distance is that of its end; a step is seen from aside.
    end = distances_in_plot([4.0], [3.0], [-9.0, 0.0], [0.0, 0.0], **unit)
    assert end == pytest.approx([0.5])
    step = np.array([0.0, 5.0, 5.0, 10.0]), np.array([0.0, 0.0, 4.0, 4.0])
    assert distances_in_plot([5.1], [1.0], *step, **unit) == pytest.approx([0.01])
    # Without ranges those of the symbols.
    bare = distances_in_plot([0.0, 2.0], [0.0, 4.0], [0.0, 2.0], [1.0, 1.0])
    assert bare == pytest.approx([0.25, 0.75])


# -- independent runs -------------------------------------------------------------------------


def test_cases_differ_in_their_seeds_and_qualities_in_their_effort():
    runs = Runs("a", Chain(size=4), effort((3, 200), (5, 300, 50)), {"every": 2.0})
    quick, full = (runs.cases(quality) for quality in ("quick", "full"))
    assert list(quick) == ["a/0", "a/1", "a/2"]
    assert [case.settings["seed"] for case in full.values()] == [0, 1, 2, 3, 4]
    assert all(case.settings["every"] == 2.0 for case in (quick | full).values())
    for cases, *times in ((quick, 200, None), (full, 300, 50)):
        for case in cases.values():
            assert [case.settings[name] for name in ("duration", "warmup")] == times


def test_few_runs_have_an_error_of_student_or_none():
    """Of four the scatter times 1.2; several quantities at once have each their own."""
    factor = t.ppf(norm.cdf(1), 3)
    assert factor == pytest.approx(1.197, abs=1e-3)
    four = [[1.0, 5.0], [3.0, 5.0], [1.0, 5.0], [3.0, 5.0]]
    np.testing.assert_allclose(error_of_mean(four), [factor / 3**0.5, 0.0])
    assert np.isinf(error_of_mean(four[:3])).all()


def test_all_of_few_runs_are_not_all_runs():
    for outcomes, verdict in (([True] * 4, "reproduced"), ([True, *[False] * 3], "undecided")):
        share = share_of_runs(outcomes)
        claim = Claim("they diverge", source="fig.2", number=share, within=POSITIVE)
        assert claim.verdict == verdict
    value, error = share_of_runs([True] * 500 + [False] * 500)
    assert (value, error) == pytest.approx((0.5, 0.5 / 1000**0.5), rel=1e-2)


def test_widths_of_centre_and_border():
    width = np.arange(1.0, 101)
    chain = Chain(size=100)
    run = result(chain, {"velocity_width": ("particle", width)}, source="theory", method={})
    assert border_width(run) == pytest.approx(((1 + 100**2) / 2) ** 0.5)
    assert central_width(run) == pytest.approx((width[45:55] ** 2).mean() ** 0.5)


def test_moments_are_means_over_rods():
    run = xr.Dataset({"velocity_skewness": ("particle", [1, 2, 6])}, {"particle": [1, 2, 3]})
    assert mean_shape(run, [1, 3], "velocity_skewness") == 3.5


# -- mirror images ----------------------------------------------------------------------------

SIZE, NOISE = 200, 1e-2


def noisy(seed):
    """Return a symmetric chain of independent rods, all with the relative error NOISE."""
    i = np.arange(1.0, SIZE + 1)
    width = i**-0.5 + i[::-1] ** -0.5
    exact = {"velocity_width": width, "displacement_width": width, "mean_displacement": i - 100.5}
    normal = np.random.default_rng(seed).normal
    variables = {}
    for name, value in exact.items():
        error = NOISE * np.abs(value)
        variables[name] = ("particle", value + error * normal(size=SIZE))
        variables[f"{name}_error"] = ("particle", error)
    chain = Chain(size=SIZE, restitution=0.0)
    return exact, result(chain, variables, source="simulation", method={})


def test_averages_are_symmetric_and_their_errors_are_those_of_the_scatter():
    runs = [noisy(seed) for seed in range(200)]
    means = [mirrored(run) for _, run in runs]
    outside = np.abs(2 * np.arange(SIZE) - (SIZE - 1)) > SIZE / 4
    for name, exact in runs[0][0].items():
        sign = -1 if name == "mean_displacement" else 1
        values, stated = np.array([each[name] for each in means]), means[-1][f"{name}_error"].values
        np.testing.assert_allclose(values[:, ::-1], sign * values)
        scatter = np.std(values - exact, axis=0)
        np.testing.assert_allclose(stated[outside] / scatter[outside], 1, atol=5 * 0.05)  # 5 errors
        # The middle quarter may move together: there it is the error of one rod.
        own = runs[-1][1][f"{name}_error"].values
        np.testing.assert_allclose(stated[~outside], own[~outside])


def test_opposite_deviations_of_mirror_images_are_no_misfit():
    exact, run = noisy(1)
    run["velocity_width"] = run.velocity_width.copy(data=exact["velocity_width"])
    square = exact["velocity_width"] ** 2
    square[[10, -11]] *= 1.3, 0.7
    apart = run.assign(velocity_width=run.velocity_width.copy(data=np.sqrt(square)))
    near, same = (fits_in_plot("rods", [each])["number"] for each in (run, apart))
    assert same.value == pytest.approx(near.value, abs=1e-3)
    before, after = fit_border_power_law(run), fit_border_power_law(mirrored(apart))
    assert after.exponent == pytest.approx(before.exponent, abs=1e-6)
