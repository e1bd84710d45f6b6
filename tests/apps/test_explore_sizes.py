"""The page's panel of central widths against the number of rods."""

import csv
from pathlib import Path

import pytest
from bokeh.models import DataRange1d

from crazybilliards.apps.explore.pictures import Pictures
from crazybilliards.apps.explore.presets import PRESETS
from crazybilliards.apps.explore.session import Session
from crazybilliards.apps.explore.sizes import Sizes
from crazybilliards.model import Chain
from crazybilliards.particles.scales import relaxation_time

TABLE = Path(__file__).parents[2] / "docs" / "tables" / "central_width.csv"


def test_the_limit_is_that_of_the_table():
    _, *rows = csv.reader(TABLE.read_text(encoding="utf-8").splitlines())
    table = {int(size.replace(" ", "")): float(width.split(" ±")[0]) for size, width, *_ in rows}
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
        panel.show(session, session.observed())
    assert panel.measured.data["size"] == [5, 10]
    assert all(0 < width < 1 for width in panel.measured.data["width"])
    assert panel.limit.data["size"] == []  # of e = 0 only
    panel.begin(Chain(size=5, restitution=0.6))
    assert panel.measured.data["size"] == []


def test_the_range_follows_the_points_and_shows_all_of_the_table():
    """In the centre driven chains can be more than five times as fast as a free rod."""
    panel = Sizes()
    assert isinstance(panel.plot.y_range, DataRange1d)
    panel.begin(Chain(restitution=0.0))
    assert panel.plot.x_range.end > max(panel.limit.data["size"])


def measured(panel, session, relaxations):
    """Measure a session until it has been measured for so many relaxation times, and show it."""
    already = session.measured_duration / relaxation_time(session.chain)
    begins = max(session.measured_from - session.time, 0.0)
    session.advance(begins + (relaxations - already) * relaxation_time(session.chain))
    panel.show(session, session.observed())
    return panel.measured.data


@pytest.mark.compiled
def test_a_point_takes_a_measurement_and_a_longer_one_is_never_replaced_by_a_shorter():
    chain = Chain(size=10, restitution=0.5)
    session, panel = Session(chain), Sizes()
    panel.begin(chain)
    assert measured(panel, session, 9)["size"] == []
    first = measured(panel, session, 11)["width"]
    longer = measured(panel, session, 40)["width"]
    assert len(first) == len(longer) == 1
    assert first != longer
    session.push(0, 8.0)
    assert measured(panel, session, 1)["width"] == longer
    assert measured(panel, session, 30)["width"] == longer
    assert measured(panel, session, 50)["width"] != longer


@pytest.mark.compiled
def test_a_chain_that_has_run_away_has_no_point():
    # It grows so slowly that it was measured for long before.
    chain = Chain(size=20, restitution=1.05, damping=0.6)
    session, pictures = Session(chain), Pictures(lambda x: None)
    pictures.begin(session)
    assert measured(pictures.sizes, session, 11)["size"] == [20]
    session.advance(1e4)
    assert session.diverged
    pictures.show_divergence(session)
    pictures.sizes.show(session, session.observed())
    assert pictures.sizes.measured.data["size"] == []


def test_what_runs_away_is_not_solved():
    solved = {preset.figure: preset.solved for preset in PRESETS}
    assert not solved["energy"]
    assert solved["widths-size"]
    assert not solved["central-width"]
