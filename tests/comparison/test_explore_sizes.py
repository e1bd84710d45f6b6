"""The page's panel of central widths against the number of rods."""

import re
from pathlib import Path

import pytest

from crazybilliards.comparison.explore.presets import PRESETS
from crazybilliards.comparison.explore.session import Session
from crazybilliards.comparison.explore.sizes import Sizes
from crazybilliards.model import Chain

TABLE = Path(__file__).parents[2] / "docs" / "central_width.md"


def test_the_limit_is_that_of_the_table():
    text = TABLE.read_text(encoding="utf-8").split("## Longer chains")[0]
    rows = re.findall(r"^\| ([\d ]+) \| ([\d.]+) ± [\d.]+ \| [\d.]+ % \|", text, re.MULTILINE)
    table = {int(size.replace(" ", "")): float(width) for size, width in rows}
    panel = Sizes()
    panel.begin(Chain(size=30, restitution=0.0, amplitude=3.0))
    free = Chain(size=30).free_velocity_width
    shown = zip(panel.limit.data["size"], panel.limit.data["width"], strict=True)
    assert {size: width * free for size, width in shown} == pytest.approx(table)


@pytest.mark.compiled
def test_points_stay_while_only_the_number_of_rods_changes():
    panel = Sizes()
    for size in (10, 5):
        chain = Chain(size=size, restitution=0.5)
        session = Session(chain)
        panel.begin(chain)
        session.advance(200.0)
        panel.show(session, session.measured())
    assert panel.measured.data["size"] == [5, 10]
    assert all(0 < width < 1 for width in panel.measured.data["width"])
    assert panel.limit.data["size"] == []  # of e = 0 only
    panel.begin(Chain(size=5, restitution=0.6))
    assert panel.measured.data["size"] == []


def test_what_runs_away_is_not_solved():
    solved = {preset.figure: preset.solved for preset in PRESETS}
    assert not solved["energy"]
    assert solved["widths-size"]
    assert not solved["central-width"]
