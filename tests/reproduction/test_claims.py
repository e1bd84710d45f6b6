"""Independent runs of one chain give means with errors; distances in a plot are the shortest."""

import numpy as np
import pytest
from scipy.stats import norm, t

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.particles import simulate
from crazybilliards.reproduction.claims.repetition import Runs, error_of_mean, share_of_runs
from crazybilliards.reproduction.claims.study import all_of
from crazybilliards.reproduction.claims.verdicts import POSITIVE, Claim, Estimate
from crazybilliards.reproduction.distributions import mean_shape


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


# -- independent runs -------------------------------------------------------------------------

RUNS = Runs(
    "a",
    Chain(size=4),
    {"quick": (3, {"duration": 200}), "full": (5, {"duration": 300})},
    {"every": 2.0},
)


def test_cases_of_runs_differ_in_their_seeds_and_their_qualities_in_what_each_grants():
    quick, full = (RUNS.cases(quality) for quality in ("quick", "full"))
    assert list(quick) == ["a/0", "a/1", "a/2"]
    assert [case.settings["seed"] for case in full.values()] == [0, 1, 2, 3, 4]
    assert all(case.settings["every"] == 2.0 for case in (quick | full).values())
    assert {case.settings["duration"] for case in quick.values()} == {200}
    assert {case.settings["duration"] for case in full.values()} == {300}
    assert all_of([RUNS], "quick") == quick


def test_few_runs_have_an_error_of_student_or_none():
    """Of four the scatter times 1.2; several quantities at once have each their own."""
    factor = t.ppf(norm.cdf(1), 3)
    assert factor == pytest.approx(1.197, abs=1e-3)
    four = [[1.0, 5.0], [3.0, 5.0], [1.0, 5.0], [3.0, 5.0]]
    np.testing.assert_allclose(error_of_mean(four), [factor / 3**0.5, 0.0])
    assert np.isinf(error_of_mean(four[:3])).all()
    assert "standard error" not in str(Estimate(0.5, np.inf))


def test_all_of_few_runs_are_not_all_runs():
    for diverged, verdict in ((4, "reproduced"), (1, "undecided")):
        share = share_of_runs(diverged, 4)
        assert (
            Claim("they diverge", source="fig.2", found=share, within=POSITIVE).verdict == verdict
        )
    value, error = share_of_runs(500, 1000)
    assert (value, error) == pytest.approx((0.5, 0.5 / 1000**0.5), rel=1e-2)


def test_pooling_runs_is_averaging_them():
    observe = ["widths", "avalanches", "velocities"]
    simulated = {
        f"a/{seed}": simulate(RUNS.chain, duration=200, seed=seed, observe=observe, progress=False)
        for seed in range(3)
    }
    other = {"ab/0": simulated["a/0"]}
    run = RUNS.pooled(simulated | other)
    square = np.mean([each.velocity_width.values**2 for each in simulated.values()], axis=0)
    np.testing.assert_allclose(run.velocity_width**2, square)
    errors = np.sqrt(sum(each.velocity_width_error.values**2 for each in simulated.values())) / 3
    np.testing.assert_allclose(run.velocity_width_error, errors)
    counts = sum(each.avalanche_count.values for each in simulated.values())
    np.testing.assert_array_equal(run.avalanche_count, counts)
    middle = np.mean([each.mean_position.values for each in simulated.values()], axis=0)
    np.testing.assert_allclose(run.mean_position, middle)
    assert run.velocity_width.attrs["units"] == "R_0/T_0"


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
