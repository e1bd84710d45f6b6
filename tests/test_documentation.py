"""Formulas are set as they are meant, and the code for a class leads to the documentation."""

import re
import runpy
from html import escape
from pathlib import Path

import pytest
import qr_code

DOCS = Path(__file__).parent.parent / "docs"


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
