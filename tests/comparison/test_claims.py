"""Claims get the verdict that their numbers deserve; independent runs give errors."""

import numpy as np
import pytest
from scipy.stats import norm, t

from crazybilliards.comparison.claims.repetition import (
    border_width,
    central_width,
    estimate,
    normal_deviate,
    pooled,
)
from crazybilliards.comparison.claims.verdicts import (
    Estimate,
    eye_claim,
    number_claim,
    positive_claim,
    same_claim,
    small_claim,
)
from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.explore.sums import Sums
from crazybilliards.comparison.paper.distributions import mean_shape
from crazybilliards.comparison.studies.restitutions import width_deviation
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.particles import simulate, simulate_limit

# -- claims -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "error", "holds"),
    [
        (-0.46, 0.005, True),
        (-0.471, 0.002, True),  # within precision and three errors
        (-0.49, 0.002, False),
        (-0.475, 0.005, True),
        (-0.49, 0.01, None),  # within three errors, but these are large
        (-0.52, 0.01, False),
        (-0.46, 0.2, None),
        (np.nan, 0.01, None),
        (np.nan, np.inf, None),
        (-0.46, np.nan, None),
    ],
)
def test_numbers(value, error, holds):
    measured = Estimate(value, error)
    claim = number_claim("nu", -0.46, 0.01, measured, reason="why")
    assert claim.verdict == {True: "confirmed", False: "refuted", None: "undecided"}[holds]
    assert claim.paper == "-0.46"
    assert claim.reason == ("" if holds else "why")
    assert not claim.of_paper
    # The paper is blamed only for what it says, at parameters that it gives.
    said = number_claim("nu", -0.46, 0.01, measured, source="fig.2")
    assert said.verdict == {True: "reproduced", False: "not reproduced", None: "undecided"}[holds]
    assert said.of_paper
    chosen = number_claim("nu", -0.46, 0.01, measured, source="fig.2", ours="the size")
    expected = {True: "reproduced", False: "cannot be decided", None: "undecided"}
    assert chosen.verdict == expected[holds]


@pytest.mark.parametrize("truth", [0.0, 0.9, 6.0, 30.0])
def test_a_short_simulation_decides_like_a_long_one_or_not_at_all(truth):
    """Of 300 short and long runs with a number off by ``truth`` precisions, errors 9 to 1.

    Numbers that are off by 1 to 5 precisions are left out: they may come out in a short run and not
    in a long one, because a number holds up to 3, and three of its errors are 2 at most.
    """
    rng = np.random.default_rng(5)
    precision, contradicted = 0.01, 0
    for error in rng.uniform(0.02, 2.0, 300) * precision:
        short, long = (
            number_claim("nu", 1.0, precision, Estimate(rng.normal(1 + truth * precision, e), e))
            for e in (error, error / 9)
        )
        contradicted += {short.verdict, long.verdict} == {"confirmed", "refuted"}
    assert contradicted == 0


@pytest.mark.parametrize(
    ("value", "error", "positive", "small"),
    [
        (0.5, 0.1, "confirmed", "refuted"),
        (-0.5, 0.1, "refuted", "refuted"),
        (0.02, 0.02, "undecided", "confirmed"),
        (0.1, 0.02, "confirmed", "undecided"),
        (np.nan, 0.1, "undecided", "undecided"),
    ],
)
def test_signs_and_limits(value, error, positive, small):
    measured = Estimate(value, error)
    assert positive_claim("grows", "change", measured).verdict == positive
    assert small_claim("vanishes", "it", measured, 0.1).verdict == small


def test_the_number_that_decides_is_there_for_programs():
    measured = Estimate(0.1, 0.02)
    assert number_claim("nu", 0.3, 0.01, measured).decisive == (0.1, 0.02, 0.3, 0.01)
    assert small_claim("vanishes", "it", measured, 0.5).decisive == (0.1, 0.02, 0, 0.5)
    assert eye_claim("fits", "rods", measured, 3.0).decisive == (0.1, 0.02, 0, 0.02)
    np.testing.assert_equal(
        positive_claim("grows", "change", measured).decisive, (0.1, 0.02, 0, np.nan)
    )
    np.testing.assert_equal(same_claim("equal", "both", 3.2).decisive, (3.2, np.nan, 0, 5))


def test_errors_of_few_runs_are_uncertain_themselves():
    """Twice the same with 10 000 experiments of two runs each, and the limits of many runs."""
    assert normal_deviate(1.0, 2) == pytest.approx(1)
    assert normal_deviate(5.0, 1000) == pytest.approx(5, rel=0.02)
    runs = np.random.default_rng(1).normal(size=(10_000, 2))
    error = runs.std(axis=1, ddof=1) / 2**0.5 * t.ppf(norm.cdf(1), 1)
    beyond = np.mean(np.abs(runs.mean(axis=1)) > 5 * error)
    assert 2 * norm.sf(normal_deviate(5.0, 2)) == pytest.approx(
        beyond, abs=5 * (beyond / 1e4) ** 0.5
    )


def test_sameness():
    assert same_claim("equal", "both", 3.2).verdict == "confirmed"
    assert same_claim("equal", "both", 7.0, reason="no").reason == "no"
    assert same_claim("equal", "both", np.nan).verdict == "undecided"


@pytest.mark.parametrize(
    ("deviation", "verdict"),
    [
        (Estimate(0.01, 0.003), "reproduced"),
        (Estimate(0.018, 0.003), "undecided"),
        (Estimate(0.03, 0.003), "not reproduced"),
        (Estimate(np.nan, 0.003), "undecided"),
    ],
)
def test_what_the_eye_sees(deviation, verdict):
    """However significant a deviation is: below 2 % of the plot it is not seen."""
    claim = eye_claim("fits", "all rods", deviation, 22.4, source="fig.2", exactly="no arctanh")
    assert claim.verdict == verdict
    assert claim.exactly == "no arctanh"
    assert "22.4 standard errors" in claim.measured


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
    bare = distances_in_plot([0.0, 2.0], [0.0, 4.0], [0.5, 0.5], [-100.0, 100.0])
    assert bare == pytest.approx([0.25, 0.75])


def test_estimates_are_written_to_the_second_digit_of_the_error():
    assert str(Estimate(-0.46123, 0.00234)) == "-0.4612 ± 0.0023"
    assert str(Estimate(37.512, 1.234)) == "37.5 ± 1.2"
    assert str(Estimate(5.0, 0.0)) == "5.0000 ± 0.0000"
    assert str(Estimate(np.nan, 0.1)) == "not determined"
    difference = Estimate(3.0, 0.3).minus(Estimate(1.0, 0.4))
    assert difference == pytest.approx((2.0, 0.5))


# -- independent runs -------------------------------------------------------------------------


def test_errors_of_estimates_cover_the_truth_however_few_the_runs():
    """68 % of the estimates from three runs lie within one error, thanks to Student's factor."""
    generator = np.random.default_rng(5)
    hits, trials = 0, 300
    for _ in range(trials):
        results = {f"a/{k}": generator.normal(1, 0.1) for k in range(3)}  # of runs only the number
        value, error = estimate(results, "a", float)
        hits += abs(value - 1) < error
    assert abs(hits / trials - 0.683) < 5 * (0.683 * 0.317 / trials) ** 0.5


def test_pooling_runs_is_averaging_them():
    chain = Chain(size=4)
    observe = ["widths", "avalanches", "velocities"]
    simulated = {
        f"a/{seed}": simulate(chain, duration=200, seed=seed, observe=observe, progress=False)
        for seed in range(3)
    }
    other = {"ab/0": simulated["a/0"]}
    run = pooled(simulated | other, "a")
    square = np.mean([each.velocity_width.values**2 for each in simulated.values()], axis=0)
    np.testing.assert_allclose(run.velocity_width**2, square)
    errors = np.sqrt(sum(each.velocity_width_error.values**2 for each in simulated.values())) / 3
    np.testing.assert_allclose(run.velocity_width_error, errors)
    counts = sum(each.avalanche_count.values for each in simulated.values())
    np.testing.assert_array_equal(run.avalanche_count, counts)
    middle = np.mean([each.mean_position.values for each in simulated.values()], axis=0)
    np.testing.assert_allclose(run.mean_position, middle)
    assert run.velocity_width.attrs["units"] == "R/T"


def test_widths_of_centre_and_border():
    width = np.arange(1.0, 101)
    chain = Chain(size=100)
    run = result(chain, {"velocity_width": ("particle", width)}, source="theory", method={})
    assert border_width(run) == pytest.approx(((1 + 100**2) / 2) ** 0.5)
    assert central_width(run) == pytest.approx((width[45:55] ** 2).mean() ** 0.5)


@pytest.mark.compiled
def test_moments_of_a_gaussian():
    """Skewness and excess kurtosis are 0, within 5 errors of 1e5 nearly independent velocities."""
    run = simulate(
        Chain(size=2), duration=3e5, every=6.0, observe="velocities", progress=False, seed=3
    )
    n = 1e5
    for name, error in (
        ("velocity_skewness", (6 / n) ** 0.5),
        ("velocity_kurtosis", (24 / n) ** 0.5),
    ):
        assert abs(mean_shape(run, [1, 2], name)) < 5 * error * 1.5
        measured = run[f"{name}_error"].values / 2**0.5
        np.testing.assert_allclose(measured, error, rtol=0.4)  # of the scatter of 64 blocks
    for name in ("velocity_kurtosis", "velocity_skewness"):
        with pytest.raises(ValueError, match=f"the result has no '{name}'"):  # an old one
            mean_shape(run.drop_vars(name), [1, 2], name)


def test_the_centre_is_the_same_rods_everywhere():
    """Four of 30 rods in claims, in comparisons with a theory, and in limits of the step."""
    chain = Chain(size=30, restitution=0.9)
    limit = simulate_limit(chain, accuracy=0.05, progress=False)
    # The sum over levels of roots is not the root of the sum, to second order in the bias.
    assert central_width(limit) == pytest.approx(float(limit.central_velocity_width), rel=1e-3)
    middle = (limit.velocity_width.values[13:17] ** 2).mean()
    assert central_width(limit) == pytest.approx(float(np.sqrt(middle)), rel=1e-12)
    double = limit.assign(velocity_width=2 * limit.velocity_width)
    double.velocity_width[:13], double.velocity_width[17:] = 7.0, 7.0
    assert width_deviation(limit, double).centre == pytest.approx(1.0)
    sums = Sums(chain)
    v = np.zeros(30)
    v[13:17] = 3.0
    sums.add(chain.anchors, v)
    found = sums.distributions()
    assert found.middle[np.abs(found.v) < 1].sum() == 0
