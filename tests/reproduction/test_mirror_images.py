"""A rod and its mirror image are averaged: half the variance where they are independent."""

import numpy as np
import pytest

from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.reproduction.mirror_images import mirrored
from crazybilliards.reproduction.power_laws import fits_in_plot

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
    return exact, result(
        Chain(size=SIZE, restitution=0.0), variables, source="simulation", method={}
    )


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
    assert run[name].attrs == mean[name].attrs


def test_opposite_deviations_of_mirror_images_are_no_misfit():
    exact, run = noisy(1)
    run["velocity_width"] = run.velocity_width.copy(data=exact["velocity_width"])
    square = exact["velocity_width"] ** 2
    square[[10, -11]] *= 1.3, 0.7
    apart = run.assign(velocity_width=run.velocity_width.copy(data=np.sqrt(square)))
    (near, _), (same, _) = fits_in_plot([run]), fits_in_plot([apart])
    assert same.value == pytest.approx(near.value, abs=1e-3)
    before, after = fit_border_power_law(run), fit_border_power_law(mirrored(apart))
    assert after.exponent == pytest.approx(before.exponent, abs=1e-6)
