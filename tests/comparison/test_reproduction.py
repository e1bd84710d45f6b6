"""Reproducing the paper: verdicts follow from numbers, every figure is there, the page is whole."""

import re
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest

from crazybilliards.comparison.claims.repetition import (
    border_width,
    central_width,
    estimate,
    pooled,
    repeated,
)
from crazybilliards.comparison.claims.report import (
    OF_PAPER,
    OWN,
    all_cases,
    describe,
    html,
    markdown,
    reproduce,
)
from crazybilliards.comparison.claims.study import PaperFigure
from crazybilliards.comparison.claims.verdicts import (
    Estimate,
    distances_in_plot,
    eye_claim,
    number_claim,
    positive_claim,
    same_claim,
    small_claim,
)
from crazybilliards.comparison.commands.line import main
from crazybilliards.comparison.paper.distributions import moment
from crazybilliards.comparison.paper.figures import FIGURES, fig17_density
from crazybilliards.comparison.paper.reproducible import find_studies
from crazybilliards.comparison.studies import elastic_gaps
from crazybilliards.comparison.studies.found import STUDIES
from crazybilliards.comparison.sweeps import Case, run_cases
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.particles import simulate

# -- claims -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "error", "holds"),
    [
        (-0.46, 0.01, True),
        (-0.471, 0.002, True),  # within precision and three errors
        (-0.49, 0.002, False),
        (-0.49, 0.01, True),
        (-0.46, 0.2, None),
        (np.nan, 0.01, False),
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


def test_figures_and_studies_are_found_by_number_name_or_group():
    assert find_studies("17") == find_studies("density") == [FIGURES[16]]
    assert find_studies("all") == list(FIGURES)
    assert find_studies("studies") == list(STUDIES)
    assert find_studies("elastic-gaps") == [elastic_gaps.STUDY]
    for nothing in ("colour", "20", "", "17 density"):
        with pytest.raises(ValueError, match=f"no figure or study '{nothing}'.* elastic-gaps"):
            find_studies(nothing)


def test_every_study_beyond_the_paper_is_found_and_has_a_name_of_its_own():
    everything = [*FIGURES, *STUDIES]
    assert elastic_gaps.STUDY in STUDIES
    assert not any(isinstance(study, PaperFigure) for study in STUDIES)
    assert len({study.name for study in everything}) == len(everything)
    assert len({study.file_name for study in everything}) == len(everything)
    assert not {"all", "studies"} & {study.name for study in everything}
    assert all(study.title and study.caption for study in everything)


@pytest.mark.compiled
def test_rods_with_gaps_are_where_the_exact_solution_has_them():
    """At quick quality every claim holds; if the rods were those of another gap, none would."""
    [study] = find_studies("elastic-gaps")
    results = {
        name: JOBS[case.job].function(case.chain, **case.settings)
        for name, case in study.cases("quick").items()
    }
    assert [claim.verdict for claim in study.claims(results)] == ["confirmed"] * 6
    drawn = study.draw(results)
    assert len(drawn.axes) == 2
    plt.close(drawn)
    results["rods g=0"], results["rods g=2"] = results["rods g=2"], results["rods g=0"]
    verdicts = [claim.verdict for claim in study.claims(results)]
    assert verdicts == ["refuted"] * 2 + ["confirmed"] * 2 + ["refuted"] * 2


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_every_case_can_be_carried_out_and_shared_ones_count_once(quality):
    cases = all_cases(FIGURES, quality)
    assert len(cases) == len({case.key for case in cases}) > 100
    assert len(cases) < sum(len(figure.cases(quality)) for figure in FIGURES)


def test_parameters_are_described_by_what_is_not_the_default():
    cases = repeated("a", Chain(size=30, restitution=0.0), 3, duration=100.0).values()
    both = [*cases, Case("phase_space", Chain(restitution=0.9), {"cells": 16})]
    assert describe(both) == [
        "simulate: size 30, restitution 0, duration 100 (3 runs)",
        "phase_space: restitution 0.9, cells 16",
    ]


# -- the command ------------------------------------------------------------------------------


@pytest.fixture
def command(tmp_path, monkeypatch, capsys):
    """Return what calls the command in an empty folder and gives its status and what it printed."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["crazybilliards", "reproduce", *arguments])
        with pytest.raises(SystemExit) as done:
            main()
        return done.value.code or 0, *capsys.readouterr()

    return call


def test_list_needs_no_folder(command, tmp_path):
    status, lines, _ = command("--list")
    assert status == 0
    lines = lines.splitlines()
    assert len(lines) == 19 + len(STUDIES)
    assert lines[16].split()[:2] == ["17", "density"]
    assert "elastic-gaps" in [line.split()[0] for line in lines[19:]]
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_figure_is_one_line_and_nothing_written(command, tmp_path):
    status, _, errors = command("20")
    assert status == 2
    assert errors.count("\n") == 1
    assert "no figure or study '20'" in errors
    assert list(tmp_path.iterdir()) == []


@pytest.mark.compiled
def test_a_figure_its_claims_and_nothing_computed_twice(command, tmp_path, monkeypatch):
    monkeypatch.setitem(fig17_density._DURATION, "quick", 5000.0)
    status, printed, errors = command("arctanh", "--processes", "1")
    assert status == 0, errors
    assert "1 cases, 0 of them" in printed
    folder = tmp_path / "reproduced"
    assert {path.name for path in folder.iterdir()} == {"cases", "fig16_arctanh.png"}
    assert "reproduced" in printed
    # Again: nothing is computed, the same claims come out.
    status, again, _ = command("16")
    assert status == 0
    assert "1 cases, 1 of them" in again
    assert again.splitlines()[1:] == printed.splitlines()[2:]
    # After an edit of the simulation: with --keep-old the same, otherwise it is computed anew.
    other = replace(JOBS["simulate"], source="other source code")
    monkeypatch.setitem(JOBS, "simulate", other)
    assert command("16", "--keep-old") == (0, again, "")
    status, printed, errors = command("16", "--processes", "1")
    assert status == 1
    assert "1 cases, 0 of them" in printed
    assert "other source code of crazybilliards computed 1 cases" in errors
    assert "the worker runs other source code" in errors  # as it does: this edit is a pretence


@pytest.mark.compiled
def test_the_report_is_one_page_and_the_table_markdown(tmp_path, monkeypatch):
    monkeypatch.setitem(fig17_density._DURATION, "quick", 5000.0)
    monkeypatch.setitem(elastic_gaps._DURATION, "quick", 5000.0)
    studies = [*find_studies("model"), *find_studies("arctanh"), elastic_gaps.STUDY]
    run_cases(all_cases(studies, "quick"), tmp_path, ThreadPoolExecutor(1), progress=False)
    reproduced = list(reproduce(studies, "quick", tmp_path))
    page = html(reproduced, "quick")
    # Self-contained: the only address in it is the paper's.
    assert set(re.findall(r'(?:src|href)="(?!data:|#)([^"]*)"', page)) == {
        "https://arxiv.org/abs/1404.7460"
    }
    assert page.count("data:image/png;base64,") == 3
    assert "amplitude 10" in page
    assert "&lt;dx&gt; is described by B arctanh(C x)" in page
    assert re.findall(r'<h2 id="[^"]*">([^.<]*)', page) == [
        "1",
        "16",
        "Displacements of elastic chains with gaps",
    ]
    # A figure has both kinds of claims, a study its own; no table is too wide for a telephone.
    assert re.findall("<h3>(.*)</h3>", page) == [OF_PAPER, OWN, OWN]
    assert "<table" not in page
    assert page.count("<article") == 2 + 6
    assert 'class="verdict"' in page
    text = markdown(reproduced, "quick")
    assert re.findall("^## ([^. ]*)", text, re.MULTILINE) == ["1", "16", "Displacements"]
    assert re.findall("^### (.*)", text, re.MULTILINE) == [OF_PAPER, OWN, OWN]
    assert "|" not in text
    assert text.count("* verdict: ") == 2 + 6
    assert "**&lt;dx&gt; is described by B arctanh(C x)**" in text
    assert "* in the paper: section seq:analytics, fig:atan" in text
    assert r"**W\_x of every rod" in text
    assert len(re.findall(rf"^\* {OF_PAPER}: 1 ", text, re.MULTILINE)) == 1
    assert len(re.findall(rf"^\* {OWN}: 7 confirmed", text, re.MULTILINE)) == 1
    pictures = re.findall(r"!\[.*\]\((.*)\)", text)
    assert pictures == ["fig01_model.png", "fig16_arctanh.png", "study_elastic-gaps.png"]
    assert pictures == [each.study.file_name for each in reproduced]
