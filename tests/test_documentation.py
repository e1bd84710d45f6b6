"""The reference lists everything that may be imported, and formulas are set as they are meant."""

import importlib
import re
import runpy
from html import escape
from pathlib import Path

import pytest
import qr_code

DOCS = Path(__file__).parent.parent / "docs"
REFERENCE = DOCS / "api"
PAGES = {
    "model": "crazybilliards.model",
    "particles": "crazybilliards.particles",
    "kinetic": "crazybilliards.kinetic",
    "comparison": "crazybilliards.comparison",
    "sweeps": "crazybilliards.comparison.sweeps",
}


@pytest.mark.parametrize("page", PAGES)
def test_every_public_name_stands_in_the_reference(page):
    text = (REFERENCE / f"{page}.md").read_text(encoding="utf-8")
    [summary] = re.findall(r"autosummary::\n   :nosignatures:\n\n((?:   \w+\n)+)", text)
    public = importlib.import_module(PAGES[page]).__all__
    assert sorted(summary.split()) == sorted(public)
    described = re.findall(rf"auto(?:function|class):: {PAGES[page]}\.(\w+)\n", text)
    elsewhere = {"load_sweep"} if page == "comparison" else set()
    assert set(described) == set(public) - elsewhere


def test_every_link_of_a_page_is_right_in_the_repository_too():
    pages = [*DOCS.parent.glob("*.md"), *DOCS.rglob("*.md")]
    assert len(pages) > 40
    dead = [
        f"{page.relative_to(DOCS.parent)}: {target}"
        for page in pages
        for target in re.findall(r"\]\((?!https?:|#)([^)#\s]+)", page.read_text(encoding="utf-8"))
        if not (page.parent / target).exists()
    ]
    assert dead == []


def test_a_script_that_a_page_names_exists():
    pages = [*DOCS.parent.glob("*.md"), *DOCS.rglob("*.md")]
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    named = set(re.findall(r"python\s+((?:benchmarks|docs/figures)/\S+?\.py)", text))
    named |= {f"studies/{name}.py" for name in re.findall(r"python\s+-m\s+studies\.(\w+)", text)}
    assert len(named) > 20
    assert not [script for script in named if not (DOCS.parent / script).exists()]


@pytest.mark.parametrize("short", [r"\tfrac12 x", r"\dfrac 12 x", r"\frac12 x"])
def test_a_short_fraction_is_set_like_a_long_one(short):
    pytest.importorskip("sphinx")
    from docutils.nodes import math

    mathml = runpy.run_path(str(DOCS / "conf.py"))["mathml"]
    long = re.sub(r"(frac) ?12", r"\1{1}{2}", short)
    assert mathml(math("", short)) == mathml(math("", long))
    assert "<mfrac" in mathml(math("", short))


@pytest.mark.parametrize("power", [r"\lvert v - u\rvert^3", "|d|^n"])
def test_a_power_of_a_modulus_is_of_all_of_it(power):
    pytest.importorskip("sphinx")
    from docutils.nodes import math

    written = runpy.run_path(str(DOCS / "conf.py"))["mathml"](math("", power))
    assert re.search(r"<msup>\s*<mrow>.*\|.*\|.*</mrow>", written, re.DOTALL)


def test_the_qr_code_leads_to_the_documentation_that_the_project_names():
    """If it does not, draw it again: python docs/figures/qr_code.py."""
    picture = (DOCS / "figures" / "qr_code.svg").read_text(encoding="utf-8")
    assert f"<title>{escape(qr_code.address())}</title>" in picture
