"""Reproducing the paper: every figure is found, nothing is computed twice, the page is whole."""

import json
import re
from collections import Counter
from contextlib import nullcontext
from typing import get_args

import pytest
from small_sweeps import AtOnce

from crazybilliards.comparison import sweeps
from crazybilliards.comparison.sweeps import Case, run_cases
from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.report import all_cases, describe, markdown, reproduce
from crazybilliards.reproduction.claims.study import Runs, effort
from crazybilliards.reproduction.claims.verdicts import EYE, Verdict
from crazybilliards.reproduction.figures import FIGURES, elastic, find_figures


def test_figures_are_in_order_and_found_by_number_name_or_group():
    assert [figure.number for figure in FIGURES] == list(range(1, 20))
    assert len({figure.name for figure in FIGURES} | {"all", "analytics"}) == len(FIGURES) + 2
    assert find_figures("17") == find_figures("density") == [FIGURES[16]]
    assert find_figures("16, density,17") == [FIGURES[15], FIGURES[16]]
    assert find_figures("all") == list(FIGURES)
    assert [figure.number for figure in find_figures("analytics")] == [8, 16, 17]
    for nothing in ("colour", "20", "", "fig20", "17th"):
        with pytest.raises(ValueError, match=f"no figure '{nothing}'.* 19 gap"):
            find_figures(nothing)


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_every_case_can_be_carried_out_and_shared_ones_count_once(quality):
    cases = all_cases(FIGURES, quality)
    assert len(cases) == len({case.canonical for case in cases}) > 100
    assert len(cases) < sum(len(figure.cases(quality)) for figure in FIGURES)


def test_parameters_are_described_by_what_is_not_the_default():
    runs = Runs("a", Chain(size=30, restitution=0.0), effort((3, 100), (3, 100)), {})
    theory = Case("steady_state", Chain(restitution=0.9), {"correlations": False})
    assert describe([*runs.cases("quick").values(), theory]) == [
        "simulate: size 30, restitution 0, duration 100 (3 runs)",
        "steady_state: restitution 0.9, correlations False",
    ]


def require_a_row_with_the_verdicts_of_each_part(page):
    first, *parts = re.split("^## ", page, flags=re.MULTILINE)
    rows = []
    for part in parts:
        heading = part.splitlines()[0]
        anchor = "".join(c for c in heading.lower() if c.isalnum() or c in " -").replace(" ", "-")
        counts = Counter(re.findall(r"^\* verdict: (.*)", part, re.MULTILINE))
        counted = [f"{counts[name]} {name}" for name in get_args(Verdict) if counts[name]]
        rows.append([f"[{heading}](#{anchor})", ", ".join(counted)])
    table = re.findall(r"^\| (\[.*) \|$", first, re.MULTILINE)
    assert [line.split(" | ") for line in table] == rows


@pytest.mark.compiled
def test_figures_their_claims_and_the_page(run, tmp_path, monkeypatch):
    """With short runs of figures 16 and 17, in this process."""
    monkeypatch.setattr(sweeps, "process_pool", lambda *_: nullcontext(AtOnce()))
    for runs in elastic._RUNS.values():
        monkeypatch.setitem(runs.effort, "quick", (1, {"duration": 2000.0}))
    monkeypatch.chdir(tmp_path)
    status, facts, errors = run("reproduce", "16", "--vector", "svg", "--processes", "1", "--json")
    assert status == 0, errors
    folder = tmp_path / "reproduced"
    names = {"cases", "fig16_arctanh.png", "fig16_arctanh.svg"}
    assert {path.name for path in folder.iterdir()} == names
    [claim] = json.loads(facts)["claims"]
    assert (claim["figure"], claim["verdict"]) == ("arctanh", "reproduced")
    number = claim["number"]
    assert 0 < number["value"] + 3 * number["error"] < EYE
    assert claim["within"] == [-EYE, EYE]
    # Again: nothing is computed, and the picture is the same file.
    before = [path.stat().st_mtime_ns for path in folder.glob("cases/*")]
    picture = (folder / "fig16_arctanh.svg").read_bytes()
    assert run("reproduce", "arctanh", "--vector", "svg", "--json") == (status, facts, "")
    assert [path.stat().st_mtime_ns for path in folder.glob("cases/*")] == before
    assert (folder / "fig16_arctanh.svg").read_bytes() == picture
    studies, cases = find_figures("model,arctanh,density"), folder / "cases"
    run_cases(all_cases(studies, "quick"), cases, progress=False)
    page = markdown(list(reproduce(studies, "quick", cases)), "quick")
    require_a_row_with_the_verdicts_of_each_part(page)
    assert page.count("* verdict: ") == 1 + 4
    assert "amplitude 10" in page
    assert len(re.findall(r"vertically up to [\d.]+ % of close packing apart", page)) == 4
    assert "**&lt;dx&gt; is described by B arctanh(C x)**" in page
    assert "* in the paper: section seq:analytics, fig:atan" in page
    pictures = re.findall(r"!\[.*\]\((.*)\)", page)
    assert pictures == ["fig01_model.png", "fig16_arctanh.png", "fig17_density.png"]
