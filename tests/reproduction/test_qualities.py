"""Quick quality decides like full quality or not at all, on stored verdicts of both.

``quick_verdicts.json`` holds what a quick run gave. After a change of what is claimed or of the
rules, write it anew from ``crazybilliards reproduce all --json``.
"""

import html
import json
import re
from pathlib import Path

import pytest

QUICK = json.loads(Path(__file__).with_name("quick_verdicts.json").read_text(encoding="utf-8"))
PAGE = Path(__file__).parents[2] / "docs" / "paper" / "claims.md"


@pytest.fixture(scope="module")
def full():
    """Return the verdicts of the committed page of claims, by figure and statement."""
    verdicts = {}
    for part in re.split("^## ", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        claims = re.findall(r"^\*\*(.*)\*\*\n\n\* verdict: (.*)$", part, re.MULTILINE)
        for statement, verdict in claims:
            plain = html.unescape(re.sub(r"\\(.)", r"\1", statement))
            verdicts[f"{part.split('.')[0]}: {plain}"] = verdict
    return verdicts


def test_no_quick_verdict_contradicts_a_full_one(full):
    contradicted = {
        name: (verdict, full[name])
        for name, verdict in QUICK.items()
        if verdict != "undecided" and full[name] != verdict
    }
    assert contradicted == {}


def test_the_quick_claims_are_claims_of_the_page(full):
    assert QUICK.keys() <= full.keys()


def test_every_figure_with_claims_is_among_them(full):
    def figures(verdicts):
        return {name.split(":")[0] for name in verdicts}

    assert figures(QUICK) == figures(full)


def test_most_claims_are_decided_by_a_quick_run():
    assert len(QUICK) > 80
    assert list(QUICK.values()).count("undecided") < len(QUICK) / 2
