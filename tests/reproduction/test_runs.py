"""Independent runs of one chain give means with errors; rods are averaged with mirror images."""

import numpy as np
import pytest
from scipy.stats import norm, t

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.particles import simulate
from crazybilliards.reproduction.claims.study import Runs, effort, error_of_mean, share_of_runs
from crazybilliards.reproduction.claims.verdicts import POSITIVE, Claim
from crazybilliards.reproduction.distributions import mean_shape
from crazybilliards.reproduction.profiles import fits_in_plot, mirrored


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
    times = [
        {(case.settings["duration"], case.settings["warmup"]) for case in cases.values()}
        for cases in (quick, full)
    ]
    assert times == [{(200, None)}, {(300, 50)}]


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


@pytest.mark.parametrize("name", ["velocity_width", "displacement_width", "mean_displacement"])
def test_averages_are_symmetric_and_their_errors_are_those_of_the_scatter(name):
    deviations = []
    for seed in range(200):
        exact, run = noisy(seed)
        mean = mirrored(run)
        deviations.append(mean[name].values - exact[name])
        sign = -1 if name == "mean_displacement" else 1
        np.testing.assert_allclose(mean[name].values[::-1], sign * mean[name].values)
    stated = mean[f"{name}_error"].values
    scatter = np.std(deviations, axis=0)
    outside = np.abs(2 * np.arange(SIZE) - (SIZE - 1)) > SIZE / 4
    np.testing.assert_allclose(stated[outside] / scatter[outside], 1, atol=5 * 0.05)  # 5 errors
    # The middle quarter may move together: there it is the error of one rod.
    np.testing.assert_allclose(stated[~outside], run[f"{name}_error"].values[~outside])


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
