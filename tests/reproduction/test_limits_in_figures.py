"""Figures draw limits dt -> 0, and their errors hold the remaining error of the time step.

The runs are made up, so that what has to come out is known: W_v(i) is a sum of two power laws.
"""

import matplotlib.pyplot as plt
import numpy as np
import pytest

from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.widths import central_width
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.vocabulary import result
from crazybilliards.reproduction.figures import FIGURES
from crazybilliards.reproduction.vanishing_step import central_limit, limit_estimate, limits

pytestmark = pytest.mark.validate

NOISE = 1e-3
BIAS = 1e-3
WITH_LIMITS = {figure.number: figure for figure in FIGURES if figure.number in (3, 4, 7)}


def exponent_at(restitution):
    """Return nu in the paper's form of its dependence on e."""
    return -(0.46 + 0.2457 * np.exp(-8.65 * (1 - restitution)))


def made_up(chain, job, *, seed=0, scale=1.0, steeper=0.0):
    """Return a result: two power laws, W_v(centre) = scale L^-0.38, and noise on every rod."""
    i = np.arange(1.0, chain.size + 1)
    nu = exponent_at(chain.restitution) + steeper
    profile = i**nu + i[::-1] ** nu
    profile *= scale * chain.size**-0.38 / profile.min()
    name = f"{chain.size} {chain.restitution} {job}".encode()
    normal = np.random.default_rng([seed, *name]).normal(size=2)
    tilt = NOISE * normal[0] * np.log(profile / profile.min())  # of each run, so that nu scatters
    width = profile * (1 + NOISE * normal[1] + tilt)
    error = np.full(chain.size, NOISE) * width
    variables = {"velocity_width": ("particle", width), "velocity_width_error": ("particle", error)}
    if job == "simulate_limit":
        error = np.hypot(NOISE, BIAS) * width.min()
        variables["central_velocity_width"] = ((), width.min())
        variables["central_velocity_width_error"] = ((), error)
    source = "theory" if job.endswith("phase_space") else "simulation"
    run = result(chain, variables, source=source, method={"schedule": {"time_step": 5e-4}})
    if job == "simulate_limit":
        run.attrs["time_step_error"] = BIAS
    return run


def made_up_results(number, **of_limits):
    """Return results of all cases of a figure; ``of_limits``: what is different in its limits."""
    return {
        name: made_up(
            case.chain,
            case.job,
            seed=case.settings.get("seed", 0),
            **(of_limits if case.job == "simulate_limit" else {}),
        )
        for name, case in WITH_LIMITS[number].cases("quick").items()
    }


# -- cases ------------------------------------------------------------------------------------


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_a_case_of_a_figure_is_a_limit_like_any_other_job(quality):
    for figure in WITH_LIMITS.values():
        cases = figure.cases(quality)
        found = {name: case for name, case in cases.items() if case.job == "simulate_limit"}
        assert found
        assert len({case.key for case in found.values()}) == len(found)
        assert all(
            name.startswith(limits(case.chain.size, case.chain.restitution).name)
            for name, case in found.items()
        )


def test_full_quality_asks_for_more():
    for restitution in (0.0, 0.95):
        runs = limits(100, restitution)
        quick, full = (runs.cases(quality) for quality in ("quick", "full"))
        assert len(quick) <= len(full)
        first = f"{runs.name}/0"
        assert full[first].settings["accuracy"] < quick[first].settings["accuracy"] / 2


# -- errors -----------------------------------------------------------------------------------


def test_the_time_step_that_is_left_does_not_average_out():
    """Five limits: a fifth of the variance, all of the bias."""
    chain = Chain(size=100, restitution=0.0)
    runs = [made_up(chain, "simulate_limit", seed=seed) for seed in range(5)]
    five = {f"{limits(100).name}/{seed}": run for seed, run in enumerate(runs)}
    value, error = central_limit(five, 100)
    assert value == pytest.approx(100**-0.38, rel=5 * NOISE)
    assert error / value == pytest.approx((NOISE**2 / 5 + BIAS**2) ** 0.5, rel=1e-2)
    one = {f"{limits(100).name}/0": runs[0]}
    alone = float(runs[0].central_velocity_width_error)
    assert central_limit(one, 100).error == pytest.approx(alone, rel=1e-2)


def exponent(run):
    """Return nu."""
    return fit_border_power_law(run).exponent


def test_an_exponent_is_uncertain_by_scatter_and_by_the_step_that_is_left():
    """Equal limits do not scatter: what is left is the step, whose share b makes nu flatter.

    A centre wider by b, less outside, lowers ln(W_v(border)/W_v(centre)) = 1.4 by some of b, and
    nu by about as large a share.
    """
    chain = Chain(size=100, restitution=0.0)
    first = made_up(chain, "simulate_limit")
    results = {f"{limits(100).name}/{k}": first for k in range(4)}
    found = limit_estimate(results, 100, exponent)
    assert found.value == exponent(first)
    assert 0.5 * BIAS < found.error / abs(found.value) / 0.7 < 2 * BIAS
    width = limit_estimate(results, 100, central_width)
    assert width.error / width.value == pytest.approx(BIAS, rel=1e-2)
    # And the scatter between limits counts, as it does between runs.
    results[f"{limits(100).name}/1"] = made_up(chain, "simulate_limit", steeper=0.04)
    assert limit_estimate(results, 100, exponent).error > 0.01


@pytest.mark.parametrize("number", WITH_LIMITS)
def test_limits_are_drawn(number):
    figure = WITH_LIMITS[number].draw(made_up_results(number))
    figure.canvas.draw()
    plt.close(figure)


# -- theories ---------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [3, 7])
def test_theories_are_drawn_beside_the_runs(number):
    results = made_up_results(number)
    drawn = WITH_LIMITS[number].draw(results)
    shown = [line.get_ydata() for line in drawn.axes[0].lines]
    plt.close(drawn)
    theories = {name: each for name, each in results.items() if name.startswith("theory")}
    assert len(theories) == {3: 1, 7: 2}[number]
    for name, theory in theories.items():
        widths = theory.velocity_width / chain_of(theory).free_velocity_width
        assert any(np.array_equal(each, widths) for each in shown), name
