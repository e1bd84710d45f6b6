"""What the page says and draws, without a browser."""

import asyncio
from concurrent.futures import ThreadPoolExecutor
from threading import Lock

import pytest
from panel.links import Callback

from crazybilliards.apps.explore.density import Density
from crazybilliards.apps.explore.motion import Rods
from crazybilliards.apps.explore.page import Page
from crazybilliards.apps.explore.plots import BLACK, GREY
from crazybilliards.apps.explore.presets import PRESETS
from crazybilliards.comparison.coverage import smooth
from crazybilliards.kinetic import force_balance
from crazybilliards.model import Chain

# Panel announces other names of arguments, which the oldest version that we allow does not know.
pytestmark = pytest.mark.filterwarnings("ignore::PendingDeprecationWarning")


@pytest.fixture
def page():
    """Return a page whose clock stands still."""

    async def make(threads):
        return Page(threads, Lock())  # in an event loop, as where it is served

    with asyncio.Runner() as runner, ThreadPoolExecutor(1) as threads:
        yield runner.run(make(threads))


def test_why_a_chain_ran_away_is_not_replaced_by_a_refusal_of_the_theory(page):
    page.session.diverged = True
    page.controls.say("The chain runs away.")
    page._solving.show(page.session.chain, ValueError("no steady state"))
    assert "The chain runs away." in page.controls.message.object
    page.session.diverged = False
    page._solving.show(page.session.chain, ValueError("no steady state"))
    assert "No theory for this chain: no steady state" in page.controls.message.object


def test_a_chain_that_diverges_in_a_step_says_why(page):
    page.session.v[0] = 1e9
    page._step(None)
    assert page.session.diverged
    assert "the time step cannot follow it" in page.controls.message.object


@pytest.mark.parametrize(
    "preset",
    [each for each in PRESETS if each.figure in ("energy", "gap")],
    ids=lambda preset: preset.figure,
)
def test_a_preset_without_a_steady_state_is_shown_from_its_start_with_its_energy(page, preset):
    page.controls.history.value = "rate"
    page.session.time = 1.0
    page.setting.take(preset.chain)
    page.react()
    page.session.time = 1.0
    page.controls.preset.value = preset.label
    page.react()
    assert page.controls.history.value == ("rate" if preset.steady else "energy")
    assert page.session.time == (1.0 if preset.steady else 0.0)
    # These are the presets of figure 15, whose chains run away.
    assert preset.steady == (preset.figure != "energy")


def test_an_empty_density_has_the_axes_of_rods_at_their_anchors():
    def drawn():
        return [
            each.data_source.data
            for each in picture.plot.renderers
            if len(each.data_source.data["x"])
        ]

    chain, picture = Chain(size=20, gap=0.5), Density(Rods(lambda x: None))
    picture.begin(chain)
    [axes] = drawn()
    assert list(axes["x"]) == pytest.approx(chain.anchors[[0, -1]])
    assert axes["density"] == pytest.approx([1 / 2.5] * 2)
    # What was measured has its own range, which may be lower than that.
    picture.show(smooth(force_balance(chain)))
    assert drawn() == [picture.measured.data]
    picture.begin(chain)
    assert len(drawn()) == 1
    assert drawn() != [picture.measured.data]


def test_panel_keeps_nothing_of_a_page_that_is_closed(page):
    # Other tests may have left pages of theirs.
    fields = {part for widget in page.controls.setting_widgets for part in widget.select()}
    assert fields & set(Callback.registry)
    page._close(None)
    assert not fields & set(Callback.registry)


@pytest.mark.parametrize("quantity", ["widths", "velocities"])
def test_what_is_seen_before_a_chain_has_settled_is_grey(page, quantity):
    page.setting.restitution = 0.5
    page.controls.quantity.value = quantity
    page.react()
    pictures, panel = page.pictures, page.pictures.panels[quantity]

    def shown(plot):
        simulated = [each for each in plot.renderers if each.name == "simulation"]
        labels = [each.label.value for each in plot.legend.items]
        return {each.glyph.line_color for each in simulated}, labels

    page._advance(10.0)
    page._keep(0.0, 0)
    page._draw()
    assert not page.session.settled
    for picture in (pictures.density, panel):
        assert all(len(values) for values in picture.measured.data.values())
        colours, labels = shown(picture.plot)
        assert colours == {GREY}
        assert labels[0].endswith(", settling")
    page.session.advance(page.session.measured_from - page.session.time + 50.0)
    page._keep(0.0, 0)
    page._draw()
    for picture in (pictures.density, panel):
        colours, labels = shown(picture.plot)
        assert BLACK in colours
        assert GREY not in colours
        assert not labels[0].endswith(", settling")
