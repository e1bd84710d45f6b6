"""The page takes a prediction before it shows anything, and says how far it was off."""

import re

import pytest
from browser import errors
from driven_page import control, press, rows, show, slide, text, turn, visit
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.pointer_input import PointerInput

pytestmark = pytest.mark.validate

# Whatever takes a prediction, and the words that show what is measured before it.
ASKED = """
const link = location.hash, found = [];
for (const { kind, id, predict } of [...ChainChallenges.list, ...ChainPresets.list]) {
  turn(`#${kind}=${id}`);
  for (let k = 0; k < 100; k++) ChainRunning.goOn();
  ChainFrames.draw();
  const said = ['said', 'answer', 'gauge', 'theory', 'compared'].map((name) =>
    document.querySelector(`[data-chain=${name}]`).textContent);
  const label = document.querySelector('[data-chain=second]').ariaLabel;
  found.push([id, predict?.picture ?? predict?.numbers.length, said.join(''), label]);
}
return found;
"""
TURN = "const turn = (hash) => { history.replaceState(null, '', hash);"
TURN += "dispatchEvent(new Event('hashchange')); };"


def draw(browser, heights, way="mouse"):
    """Draw through heights [pixels above the middle] at equal distances over the second picture."""
    canvas = control(browser, "second")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
    hand = ActionBuilder(browser, mouse=PointerInput(way, way), duration=0)
    left, right = 46 - canvas.size["width"] / 2, canvas.size["width"] / 2 - 14
    for k, height in enumerate(heights):
        x = left + k * (right - left) / (len(heights) - 1)
        hand.pointer_action.move_to(canvas, int(x), -int(height))
        if k == 0:
            hand.pointer_action.pointer_down()
    hand.pointer_action.pointer_up()
    hand.perform()


def test_every_challenge_and_question_takes_a_prediction_and_shows_nothing_before(browser, address):
    visit(browser, address, quiet=True)
    asked = browser.execute_script(TURN + ASKED)
    assert len(asked) == 15
    for name, takes, said, label in asked:
        assert takes, name
        assert said == "", name
        assert name == "push" or re.match("Draw what|Shown after", label), name
    assert errors(browser) == []


@pytest.mark.parametrize(("screen", "way"), [("wide", "mouse"), ("narrow", "touch")])
def test_a_curve_is_drawn_handed_in_and_compared(browser, address, screen, way):
    visit(browser, f"{address}#challenge=ends", screen, quiet=True)
    assert text(browser, "reveal") == "Skip the prediction"
    draw(browser, [20, -10, -10, -10, 20], way)
    handed_in = browser.current_url
    drawn = [float(each) for each in handed_in.rpartition("prediction=")[2].split("_")]
    assert len(drawn) == 9
    assert drawn[0] == pytest.approx(drawn[-1], rel=0.1)
    assert drawn[0] > 1.3 * drawn[4]
    visit(browser, handed_in, screen, quiet=True)  # by somebody else
    assert text(browser, "reveal") == "Show"
    assert text(browser, "compared") == ""
    show(browser)
    rows(browser, 600)
    assert re.match(r"Your curve is .*in the middle", text(browser, "compared"))
    assert browser.current_url == handed_in


def test_the_distance_is_that_of_the_chain_that_was_asked_for(browser, address):
    """At e = 0.95 the middle of 100 rods has .43 W, here drawn .86 and, in thirds, right."""
    curve = "_".join(["0.86"] * 9)
    visit(browser, f"{address}#preset=loss&prediction={curve}", quiet=True)
    show(browser)
    rows(browser, 1)
    assert text(browser, "compared") == "Your curve is for e = 0.95."
    slide(browser, restitution=0.95)
    rows(browser, 1000)
    middle = r"Your curve is \d+ % too high at both sides, 2 times too high in the middle\."
    assert re.match(middle, text(browser, "compared"))


def test_keys_draw_and_numbers_are_typed(browser, address):
    visit(browser, f"{address}#preset=gap", quiet=True)
    canvas = control(browser, "second")
    browser.execute_script("arguments[0].focus()", canvas)
    canvas.send_keys("\ue013" * 3 + "\ue014" * 2 + "\ue015")
    assert canvas.get_attribute("aria-valuetext") == "point 7 of 9: 0.75"
    level = ["0.81"] * 4
    assert browser.current_url.endswith("_".join([*level, "0.93", "0.81", "0.75", *level[:2]]))
    turn(browser, "#challenge=count")
    for box, value in zip(
        browser.find_elements("css selector", "[data-chain=guesses] input"),
        (3, 30, 300),
        strict=True,
    ):
        box.send_keys(str(value))
    assert browser.current_url.endswith("#challenge=count&prediction=3_30_300")
    press(browser, control(browser, "reveal"))
    assert re.match(r"Counted: [3?] with 1", rows(browser, 100))


def test_a_gas_moves_its_gauge_within_two_seconds(browser, address):
    """The shortest link is a gas; two seconds are 120 rows of its strip."""
    visit(browser, f"{address}#spring=none", quiet=True)
    rows(browser, 120)
    now = re.match(r"Force on a wall \[M R/t₀²\]: now ([\d.]+), mean", text(browser, "gauge"))
    assert 1 < float(now[1]) < 4
    assert text(browser, "note") == ""
    turn(browser, "#size=100")
    slide(browser, spring="none")
    rows(browser, 120)
    assert re.search(r"now [1-3]\.", text(browser, "gauge"))
    assert errors(browser) == []
