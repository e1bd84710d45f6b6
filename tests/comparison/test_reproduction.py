"""Reproducing the paper: verdicts follow from numbers, every figure is there, the page is whole."""

import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from crazybilliards.comparison.claims.report import all_cases, describe, html, markdown, reproduce
from crazybilliards.comparison.claims.runs import (
    border_width,
    centre_width,
    estimate,
    pooled,
    runs,
)
from crazybilliards.comparison.claims.verdicts import (
    Estimate,
    number_claim,
    positive_claim,
    same_claim,
    small_claim,
)
from crazybilliards.comparison.paper.distributions import moment
from crazybilliards.comparison.paper.figures import FIGURES, find_figures
from crazybilliards.comparison.sweeps import Case, run_cases
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.particles import simulate

COMMAND = [sys.executable, "-c", "from crazybilliards.comparison.commands.line import main; main()"]


# -- claims -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "error", "verdict"),
    [
        (-0.46, 0.01, "reproduced"),
        (-0.471, 0.002, "reproduced"),  # within precision and three errors
        (-0.49, 0.002, "refuted"),
        (-0.49, 0.01, "reproduced"),
        (-0.46, 0.2, "undecided"),
        (np.nan, 0.01, "refuted"),
        (-0.46, np.nan, "undecided"),
    ],
)
def test_numbers(value, error, verdict):
    claim = number_claim("nu", -0.46, 0.01, Estimate(value, error), reason="why")
    assert claim.verdict == verdict
    assert claim.paper == "-0.46"
    assert claim.reason == ("" if verdict == "reproduced" else "why")


@pytest.mark.parametrize(
    ("value", "error", "positive", "small"),
    [
        (0.5, 0.1, "reproduced", "refuted"),
        (-0.5, 0.1, "refuted", "refuted"),
        (0.02, 0.02, "undecided", "reproduced"),
        (0.1, 0.02, "reproduced", "undecided"),
        (np.nan, 0.1, "undecided", "undecided"),
    ],
)
def test_signs_and_limits(value, error, positive, small):
    measured = Estimate(value, error)
    assert positive_claim("grows", "change", measured).verdict == positive
    assert small_claim("vanishes", "it", measured, 0.1).verdict == small


def test_sameness():
    assert same_claim("equal", "both", 3.2).verdict == "reproduced"
    assert same_claim("equal", "both", 7.0, reason="no").reason == "no"
    assert same_claim("equal", "both", np.nan).verdict == "undecided"


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
    chain = Chain(size=2)
    hits, trials = 0, 300
    for _ in range(trials):
        results = {
            f"a/{k}": result(
                chain,
                {"velocity_width": ("particle", np.full(2, generator.normal(1, 0.1)))},
                source="simulation",
                method={},
            )
            for k in range(3)
        }
        value, error = estimate(results, "a", border_width)
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
    assert centre_width(run) == pytest.approx((width[45:55] ** 2).mean() ** 0.5)


@pytest.mark.compiled
def test_moments_of_a_gaussian():
    """Skewness 0 and kurtosis 3, within 5 errors of 2 x 5e4 nearly independent velocities."""
    run = simulate(
        Chain(size=2), duration=3e5, every=6.0, observe="velocities", progress=False, seed=3
    )
    n = 1e5
    assert abs(moment(run, [1, 2], 3)) < 5 * (6 / n) ** 0.5 * 1.5
    assert abs(moment(run, [1, 2], 4) - 3) < 5 * (24 / n) ** 0.5 * 1.5


# -- figures ----------------------------------------------------------------------------------


def test_all_nineteen_figures_are_there_in_order():
    assert [figure.number for figure in FIGURES] == list(range(1, 20))
    assert len({figure.name for figure in FIGURES}) == 19
    assert all(figure.title and figure.caption for figure in FIGURES)


def test_figures_are_found_by_number_name_or_all():
    assert find_figures("17") == find_figures("density")
    assert len(find_figures("all")) == 19
    with pytest.raises(ValueError, match="no figure 'colour'"):
        find_figures("colour")


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_every_case_can_be_carried_out_and_shared_ones_count_once(quality):
    cases = all_cases(FIGURES, quality)
    assert len(cases) == len({case.key for case in cases}) > 100
    assert len(cases) < sum(len(figure.cases(quality)) for figure in FIGURES)


def test_parameters_are_described_by_what_is_not_the_default():
    cases = runs("a", Chain(size=30, restitution=0.0), 3, duration=100.0).values()
    both = [*cases, Case("phase_space", Chain(restitution=0.9), {"cells": 16})]
    assert describe(both) == [
        "simulate: size 30, restitution 0.0, duration 100 (3 runs)",
        "phase_space: restitution 0.9, cells 16",
    ]


# -- the command ------------------------------------------------------------------------------


def command(*arguments, folder):
    return subprocess.run(
        [*COMMAND, "reproduce", *arguments],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        cwd=folder,
    )


def test_list_needs_no_folder(tmp_path):
    done = command("--list", folder=tmp_path)
    assert done.returncode == 0
    assert len(done.stdout.splitlines()) == 19
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_figure_is_one_line_and_nothing_written(tmp_path):
    done = command("20", folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "no figure '20'" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.compiled
def test_a_figure_its_claims_and_one_page_with_everything(tmp_path):
    done = command("arctanh", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "1 cases, 0 of them" in done.stdout
    folder = tmp_path / "reproduced"
    assert {path.name for path in folder.iterdir()} == {"cases", "fig16_arctanh.png"}
    assert "reproduced" in done.stdout
    # Again: nothing is computed, the same claims come out.
    again = command("16", folder=tmp_path)
    assert again.returncode == 0
    assert "1 cases, 1 of them" in again.stdout
    assert again.stdout.splitlines()[1:] == done.stdout.splitlines()[2:]


@pytest.mark.compiled
def test_the_report_is_one_page_and_the_table_markdown(tmp_path):
    figures = [*find_figures("model"), *find_figures("arctanh")]
    run_cases(all_cases(figures, "quick"), tmp_path, ThreadPoolExecutor(1), progress=False)
    reproduced = list(reproduce(figures, "quick", tmp_path))
    page = html(reproduced, "quick")
    # Self-contained: the only address in it is the paper's.
    assert set(re.findall(r'(?:src|href)="(?!data:|#)([^"]*)"', page)) == {
        "https://arxiv.org/abs/1404.7460"
    }
    assert page.count("data:image/png;base64,") == 2
    assert "amplitude 10" in page
    assert "&lt;dx&gt; = B arctanh(C x)" in page
    table = markdown(reproduced, "quick")
    assert len([line for line in table.splitlines() if "|" in line]) == 2 + len(
        reproduced[1].claims
    )
    assert re.search(r"\*\*(reproduced|refuted|undecided)\*\*", table)
    assert [each.file_name for each in reproduced] == ["fig01_model.png", "fig16_arctanh.png"]
