"""The page of ``crazybilliards explore`` in a browser."""

from urllib.parse import quote

import numpy as np
import pytest
from browser import column, elements, errors, has, press, texts, until, visit

from crazybilliards.apps.explore.presets import PRESETS
from crazybilliards.model import Chain

pytestmark = pytest.mark.validate


def type_number(browser, name, text):
    """Type into the number beside the slider of this name and press Enter."""
    from selenium.webdriver.common.keys import Keys

    [field] = until(lambda: elements(browser, f"input[aria-label^='{name}']"))
    field.send_keys(Keys.END, *[Keys.BACKSPACE] * 8, text, Keys.ENTER)


def positions(browser):
    return np.array(column(browser, "rods", "x"))


def choose(browser, option):
    """Choose what a list offers."""
    from selenium.webdriver.support.ui import Select

    for each in elements(browser, "select"):
        if option in [shown.text for shown in Select(each).options]:
            Select(each).select_by_visible_text(option)
            return
    raise AssertionError(f"no list offers {option}")


def said(browser):
    return " ".join(texts(browser, ".alert"))


def pause(browser):
    """Pause the chain; return where its rods stand."""
    press(browser, "Pause")
    # The server names the button anew when it has paused, after the last frame.
    until(lambda: "Play" in texts(browser, "button"))
    return positions(browser)


def step(browser):
    """Press Step until two rods have met; return what the page says of it."""
    words = said(browser)
    while True:
        before = words
        press(browser, "Step")
        words = until(lambda: (now := said(browser)) != before and now)  # noqa: B023
        if " met." in words:
            return words


LONG = "?size=100&amplitude=1&gap=0&damping=1"


@pytest.mark.compiled
def test_page_moves_with_nothing_from_elsewhere(browser, address):
    visit(browser, address, LONG)
    press(browser, "30")
    x = positions(browser)
    assert len(x) == 100
    until(lambda: not np.array_equal(positions(browser), x))
    loaded = browser.execute_script(
        "return performance.getEntriesByType('resource').map(entry => entry.name)"
    )
    assert loaded
    assert all(name.startswith((address, "blob:", "data:")) for name in loaded)
    assert errors(browser) == []


@pytest.mark.compiled
def test_a_number_typed_changes_theory_and_address_and_opens_again(browser, address):
    visit(browser, address, LONG)
    pause(browser)  # a busy browser falls behind the moving rods, and shows the answer ever later
    before = max(until(lambda: column(browser, "exact density", "x")))
    type_number(browser, "noise amplitude A", "10")
    until(lambda: max(column(browser, "exact density", "x"), default=0) > before + 10)
    free = Chain(amplitude=10).free_velocity_width
    assert column(browser, "free width", "width") == pytest.approx([free, free])
    type_number(browser, "restitution e", "0.9")
    until(lambda: "restitution=0.9" in browser.current_url)
    assert "amplitude=10" in browser.current_url
    # Off e = 1 there is no exact density.
    until(lambda: not column(browser, "exact density", "x"))
    query = browser.current_url.removeprefix(address)
    visit(browser, address, query)
    values = [each.get_attribute("value") for each in elements(browser, "input.bk-input")]
    assert [float(value) for value in values[:5]] == [0.9, 100, 1, 10, 0]
    assert errors(browser) == []


@pytest.mark.compiled
def test_a_slider_that_is_moved_changes_the_chain(browser, address):
    from selenium.webdriver.common.keys import Keys

    visit(browser, address)
    handles = elements(browser, ".noUi-handle")
    assert len(handles) == 5
    handles[1].send_keys(*[Keys.ARROW_RIGHT] * 3)
    until(lambda: "size=23" in browser.current_url)
    until(lambda: len(column(browser, "rods", "x")) == 23)
    assert errors(browser) == []


@pytest.mark.compiled
def test_a_preset_shows_its_panel_and_solves_the_kinetic_equation(browser, address):
    visit(browser, address)
    [small] = [preset for preset in PRESETS if preset.figure == "widths-size"]
    choose(browser, small.label)
    until(lambda: len(positions(browser)) == small.chain.size)
    until(lambda: "size=25" in browser.current_url and "damping=4" in browser.current_url)
    # A picture that is chosen later shows what was solved before.
    until(lambda: max(column(browser, "kinetic density", "x"), default=0) > 0)
    choose(browser, "velocity width of each rod")
    until(lambda: has(browser, "kinetic widths"))
    widths = until(lambda: column(browser, "kinetic widths", "width"))
    assert len(widths) == 25
    # Short driven chains are hottest in the middle.
    assert widths[12] > widths[0] > small.chain.free_velocity_width
    # Bokeh would lay out the whole page for each new datum of a picture that is hidden.
    assert not has(browser, "velocity distribution")
    [tails] = [preset for preset in PRESETS if preset.figure == "velocities-elastic"]
    choose(browser, tails.label)
    # All v are likely that were seen, and a Gaussian reaches no further than this.
    until(lambda: has(browser, "velocity distribution"))
    v = np.array(until(lambda: column(browser, "velocity distribution", "v")))
    assert 1 < abs(v).max() < 5.9
    assert errors(browser) == []


@pytest.mark.compiled
def test_solving_can_be_cancelled_and_asked_for_again(browser, address):
    def solving():
        return [text for text in texts(browser, "button") if "olv" in text]

    # A chain that takes long, so that the button still cancels when it is pressed.
    visit(browser, address, "?size=300&restitution=0.5&amplitude=1&gap=0&damping=1")
    press(browser, "Solve")
    until(lambda: solving()[0].startswith("Solving"))
    press(browser, "Solving")
    until(lambda: solving() == ["Solve the kinetic equation"])
    assert not column(browser, "kinetic density", "x")
    visit(browser, address, "?size=100&restitution=0.95&amplitude=1&gap=0&damping=1")
    press(browser, "Solve")
    until(lambda: column(browser, "kinetic density", "x"))
    assert errors(browser) == []


@pytest.mark.compiled
def test_an_address_is_taken_whole_or_not_at_all(browser, address):
    visit(browser, address, "?size=30&amplitude=100&spring=quadratic")
    until(lambda: "amplitude=100" in said(browser))
    assert "amplitude 0.1 to 30" in said(browser)
    assert "size" not in said(browser)
    assert len(positions(browser)) == 20
    until(lambda: "size=20" in browser.current_url and "amplitude=1&" in browser.current_url)
    fields = [each.get_attribute("value") for each in elements(browser, "input.bk-input")]
    assert [float(value) for value in fields[:5]] == [1, 20, 0.3, 1, 0.5]
    assert errors(browser) == []


@pytest.mark.compiled
def test_what_an_address_asks_for_is_shown_as_text(browser, address):
    script = "<script>window.ran=1</script><img src=x onerror='window.ran=1'>"
    visit(browser, address, f"?amplitude={quote(script)}&gap={quote(script[26:])}")
    until(lambda: "amplitude=<script>" in said(browser))
    assert not elements(browser, ".alert script, .alert img")
    assert browser.execute_script("return window.ran") is None


@pytest.mark.compiled
def test_a_chain_that_runs_away_says_so_with_its_growth(browser, address):
    visit(browser, address, "?size=100&restitution=1.01&damping=0.4&amplitude=1&gap=0")
    press(browser, "300")
    until(lambda: "runs away" in said(browser))
    assert "The energy grew like exp(" in said(browser)
    assert len(column(browser, "growth", "time")) == 2
    assert errors(browser) == []


@pytest.mark.compiled
def test_no_anchor_remains_where_it_was_on_a_former_axis(browser, address):
    visit(browser, address, "?size=20&amplitude=1&gap=0&damping=1")
    pause(browser)
    # Whether there is ink beside the anchors when the axis has doubled.
    ink = """
    const done = arguments[0];
    const models = [...Bokeh.documents[0]._all_models.values()];
    const plot = models.find(each => each.type === 'Figure'
      && each.renderers.some(drawn => drawn.data_source?.name === 'rods'));
    const {start, end} = plot.x_range;
    plot.x_range.setv({start: 2 * start, end: 2 * end});
    const find = root => [...root.querySelectorAll('*')].flatMap(each => [
      ...(each.matches('canvas') ? [each] : []),
      ...(each.shadowRoot ? find(each.shadowRoot) : []),
    ]);
    setTimeout(() => {
      const canvas = find(document)[0];
      const inner = [canvas.width * 0.72, canvas.height * 0.9, canvas.width * 0.23, 1];
      done(canvas.getContext('2d').getImageData(...inner).data.some(value => value > 0));
    }, 1000);
    """
    assert not browser.execute_async_script(ink)


@pytest.mark.compiled
def test_step_goes_on_to_a_collision_and_says_which(browser, address):
    visit(browser, address)
    # Where the rods are shown in the very moment in which the words arrive.
    note = """
    const shown = Bokeh.documents[0].get_model_by_name('rods');
    for (const each of Bokeh.documents[0]._all_models.values())
      each.properties.text?.change.connect(() => {
        if (each.text.includes(' met')) window.then = Array.from(shown.data.x);
      });
    """
    browser.execute_script(note)
    words = step(browser)
    contact = int(words.split("rods ")[1].split(" and ")[0]) - 1
    x = browser.execute_script("return window.then")
    # In contact, but for what they moved since, within one five-hundredth of a time step.
    assert x[contact + 1] - x[contact] == pytest.approx(2.0, abs=0.01)
    assert step(browser) != words
    assert errors(browser) == []


@pytest.mark.compiled
def test_a_rod_that_is_dragged_stays_with_the_mouse_until_it_is_let_go(browser, address):
    from selenium.webdriver import ActionChains

    visit(browser, address)
    x = pause(browser)
    frame = elements(browser, ".bk-Canvas")[0]
    mouse = ActionChains(browser).move_to_element(frame).click_and_hold()
    mouse.move_by_offset(-150, 0).perform()

    # The nearest rod was taken. It moves as far as the mouse, and pushes all that are in its way.
    until(lambda: (positions(browser) < x - 5).any())
    held = positions(browser)
    moved = np.flatnonzero(abs(held - x) > 1e-9)
    assert set(moved) <= set(range(12))
    assert held[moved[-1]] < x[moved[-1]] - 5
    assert (np.diff(held) >= 2 - 1e-9).all()
    ActionChains(browser).move_by_offset(150, 0).perform()
    until(lambda: positions(browser)[moved[-1]] == pytest.approx(x[moved[-1]], abs=1e-6))
    ActionChains(browser).release().perform()
    held = positions(browser)
    press(browser, "Play")
    until(lambda: not np.array_equal(positions(browser), held))
    assert errors(browser) == []
