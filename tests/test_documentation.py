"""The reference lists everything that may be imported."""

import importlib
import re
from pathlib import Path

import pytest

REFERENCE = Path(__file__).parent.parent / "docs" / "api"
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
