"""Reproducing the paper: verdicts follow from numbers, every figure is there, the page is whole."""

import json
import pickle
import re
from collections import Counter
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from typing import get_args

import pytest
from small_sweeps import AtOnce

from crazybilliards.apps.commands import reproduce as reproduce_command
from crazybilliards.comparison.sweeps import Case, process_pool, run_cases
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.repetition import Runs
from crazybilliards.reproduction.claims.report import all_cases, describe, html, markdown, reproduce
from crazybilliards.reproduction.claims.verdicts import EYE, Verdict
from crazybilliards.reproduction.figures import FIGURES, fig17_density
from crazybilliards.reproduction.reproducible import GROUPS, find_studies

# -- figures ----------------------------------------------------------------------------------


def test_all_nineteen_figures_are_there_in_order_and_everything_has_a_name_of_its_own():
    assert [figure.number for figure in FIGURES] == list(range(1, 20))
    for names in ({each.name for each in FIGURES}, {each.file_name for each in FIGURES}):
        assert len(names) == len(FIGURES)
        assert not GROUPS.keys() & names
    assert all(study.title and study.caption for study in FIGURES)
    assert set(reproduce_command._REPORTS) == set(GROUPS)
    reports = [name for pair in reproduce_command._REPORTS.values() for name in pair]
    assert len(set(reports)) == 2 * len(GROUPS)


def test_figures_and_studies_are_found_by_number_name_or_group():
    assert find_studies("17") == find_studies("density") == [FIGURES[16]]
    assert find_studies("16, density,17") == [FIGURES[15], FIGURES[16]]
    assert find_studies("all") == list(FIGURES)
    assert [study.number for study in find_studies("analytics")] == [8, 16, 17]
    for nothing in ("colour", "20", "", "fig20", "17th"):
        with pytest.raises(ValueError, match=f"no figure '{nothing}'.* 19 gap"):
            find_studies(nothing)


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_every_case_can_be_carried_out_and_shared_ones_count_once(quality):
    cases = all_cases(FIGURES, quality)
    assert len(cases) == len({case.key for case in cases}) > 100
    assert len(cases) < sum(len(figure.cases(quality)) for figure in FIGURES)


def test_parameters_are_described_by_what_is_not_the_default():
    runs = Runs("a", Chain(size=30, restitution=0.0), {"quick": (3, {})}, {"duration": 100.0})
    both = [
        *runs.cases("quick").values(),
        Case("phase_space", Chain(restitution=0.9), {"cells": 16}),
    ]
    assert describe(both) == [
        "simulate: size 30, restitution 0, duration 100 (3 runs)",
        "phase_space: restitution 0.9, cells 16",
    ]


# -- the command ------------------------------------------------------------------------------


@pytest.fixture
def command(run, tmp_path, monkeypatch):
    """Call the command in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return partial(run, "reproduce")


def test_list_needs_no_folder(command, tmp_path):
    status, lines, _ = command("--list")
    assert status == 0
    lines = lines.splitlines()
    assert len(lines) == 19
    assert lines[16].split()[:2] == ["17", "density"]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.compiled
@pytest.mark.validate
def test_other_processes_draw_the_same(tmp_path):
    studies = find_studies("model,arctanh")
    assert run_cases(all_cases(studies, "quick"), tmp_path, AtOnce(), progress=False) == {}
    here = list(reproduce(studies, "quick", tmp_path))
    with process_pool(2) as pool:
        there = list(reproduce(studies, "quick", tmp_path, executor=pool))
    for one, other in zip(here, there, strict=True):
        assert (one.study.name, one.pictures) == (other.study.name, other.pictures)
        assert [each.details for each in one.claims] == [each.details for each in other.claims]


@pytest.mark.parametrize("study", FIGURES, ids=lambda study: study.name)
def test_every_study_can_be_sent_to_another_process(study):
    assert pickle.loads(pickle.dumps(study)).cases("quick") == study.cases("quick")


def test_pictures_come_in_other_widths_and_as_vector_graphics(command, tmp_path):
    """Figure 1, which has no claims, so that no table is printed."""
    wrote = "wrote reproduced/fig01_model"
    assert command("1") == (0, f"{wrote}.png\n", "")
    sizes = {}
    for columns in ("1", "2"):
        done = command("1", "--columns", columns, "--vector", "svg")
        assert done == (0, f"{wrote}.png\n{wrote}.svg\n", "")
        svg = (tmp_path / "reproduced" / "fig01_model.svg").read_text()
        sizes[columns] = float(re.search(r'width="([0-9.]+)pt"', svg)[1]) / 72
    assert sizes == pytest.approx({"1": 3.4, "2": 7.0})
    # Drawn again, it is the same file.
    assert command("1", "--columns", "2", "--vector", "svg")[0] == 0
    assert (tmp_path / "reproduced" / "fig01_model.svg").read_text() == svg


@pytest.mark.compiled
def test_a_figure_its_claims_and_nothing_computed_twice(command, tmp_path, monkeypatch):
    monkeypatch.setattr(fig17_density, "_DURATION", 5000.0)
    monkeypatch.setattr(reproduce_command, "engine", lambda *_: nullcontext(AtOnce()))
    status, printed, errors = command("arctanh")
    assert status == 0, errors
    assert "1 cases, 0 of them" in printed
    folder = tmp_path / "reproduced"
    assert {path.name for path in folder.iterdir()} == {"cases", "fig16_arctanh.png"}
    assert "Statements of the paper: 1 reproduced" in printed
    # Again: nothing is computed, the same claims come out.
    status, again, _ = command("16")
    assert status == 0
    assert "1 cases, 1 of them" in again
    assert again.splitlines()[1:] == printed.splitlines()[2:]
    # The same for programs, with the number that decides.
    status, facts, _ = command("16", "--json")
    claim, *_ = json.loads(facts)["claims"]
    assert (claim["figure"], claim["verdict"]) == ("arctanh", "reproduced")
    assert claim["elsewhere"] == {}
    number = claim["number"]
    assert 0 < number["value"] + 3 * number["error"] < EYE
    assert claim["within"] == [-EYE, EYE]
    # After an edit of the simulation it is computed anew.
    other = replace(JOBS["simulate"], source="other source code")
    monkeypatch.setitem(JOBS, "simulate", other)
    status, printed, errors = command("16")
    assert status == 0
    assert "1 cases, 0 of them" in printed
    assert "other source code of crazybilliards computed 1 cases" in errors


def assert_table_counts_verdicts(page):
    """Assert that the table of a report has a line for each study, with the counts of its part."""
    first, *parts = re.split("^## ", page, flags=re.MULTILINE)
    expected = []
    for part in parts:
        heading = part.splitlines()[0]
        anchor = "".join(c for c in heading.lower() if c.isalnum() or c in " -").replace(" ", "-")
        found = Counter(re.findall(r"^\* verdict: (.*)", part, re.MULTILINE))
        counts = [f"{found[verdict]} {verdict}" for verdict in get_args(Verdict) if found[verdict]]
        expected.append([f"[{heading}](#{anchor})", ", ".join(counts)])
    lines = re.findall(r"^\| (\[.*) \|$", first, re.MULTILINE)
    assert [line.split(" | ") for line in lines] == expected
    assert "|" not in "".join(parts)


@pytest.mark.compiled
def test_the_report_is_one_page_and_the_table_markdown(tmp_path, monkeypatch):
    monkeypatch.setattr(fig17_density, "_DURATION", 5000.0)
    studies = find_studies("model,arctanh,density")
    run_cases(all_cases(studies, "quick"), tmp_path, AtOnce(), progress=False)
    reproduced = list(reproduce(studies, "quick", tmp_path))
    page = html(reproduced, "quick")
    # Self-contained: the only address in it is the paper's.
    assert set(re.findall(r'(?:src|href)="(?!data:|#)([^"]*)"', page)) == {
        "https://arxiv.org/abs/1404.7460"
    }
    assert page.count("data:image/png;base64,") == 3
    assert "amplitude 10" in page
    assert "&lt;dx&gt; is described by B arctanh(C x)" in page
    targets = re.findall(r'href="#([^"]*)"', page)
    assert len(targets) == 3
    assert targets == re.findall(r'<h2 id="([^"]*)">', page)
    assert page.count("<li>verdict: ") == 1 + 4
    text = markdown(reproduced, "quick")
    assert re.findall("^## ([^. ]*)", text, re.MULTILINE) == ["1", "16", "17"]
    assert_table_counts_verdicts(text)
    assert text.count("* verdict: ") == 1 + 4
    assert "**&lt;dx&gt; is described by B arctanh(C x)**" in text
    assert "* in the paper: section seq:analytics, fig:atan" in text
    assert "\n* Statements of the paper: " in text
    pictures = re.findall(r"!\[.*\]\((.*)\)", text)
    assert pictures == ["fig01_model.png", "fig16_arctanh.png", "fig17_density.png"]
    assert pictures == [each.study.file_name for each in reproduced]
