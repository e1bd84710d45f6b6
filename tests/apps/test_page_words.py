"""What the chain's page says, in numbers for everybody, and that its colours are the films'."""

import re
from pathlib import Path

import pytest
from browser import errors
from driven_page import CHAIN, SCREENS, challenges, control, press, rows, slide, text, turn, visit
from matplotlib.colors import to_hex

from crazybilliards.comparison.drawing import DIRECTIONS

ROOT = Path(__file__).parents[2]
LABEL = "return document.querySelector('[data-chain=second]').ariaLabel"
FRAME = """const done = arguments[0];
requestAnimationFrame(() => done(document.querySelector('[data-chain=second]').ariaLabel))"""
WORDS = """
const words = [], kept = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (text) { words.push(text); };
dispatchEvent(new Event('resize'));
arguments[0].dispatchEvent(new Event('change', {bubbles: true}));
CanvasRenderingContext2D.prototype.fillText = kept;
return words;
"""


def test_orange_moves_right_and_blue_left_in_page_and_film():
    style = (ROOT / "apps/explore/page/chain.css").read_text(encoding="utf-8")
    for name, end in (("left", 0.0), ("right", 1.0)):
        assert re.search(rf"--{name}: (#\w+);", style)[1] == to_hex(DIRECTIONS(end))
    assert to_hex(DIRECTIONS(0.0)) == "#0072b2"
    assert to_hex(DIRECTIONS(1.0)) == "#e69f00"
    film = (ROOT / "comparison/rod_film.py").read_text(encoding="utf-8")
    assert "cmap=DIRECTIONS" in film
    page = (ROOT / "apps/explore/page/chain.html").read_text(encoding="utf-8")
    for words in (film, page, (ROOT / "docs/howto/pictures.md").read_text(encoding="utf-8")):
        assert re.search(r"\bbars?\b", words)
        assert not re.search(r"\bstars?\b", words)


@pytest.mark.validate
@pytest.mark.parametrize("screen", SCREENS)
def test_rod_noise_and_unit_are_explained_above_what_uses_them(browser, address, screen):
    visit(browser, address, screen, quiet=True)
    explained = browser.find_element("css selector", ".chain .units")
    for word in ("rod", "Noise", "W is the usual speed", "T = √(M/k)"):
        assert word in explained.text
    for name in ("ask", "stage"):
        assert explained.rect["y"] < control(browser, name).rect["y"]


@pytest.mark.validate
def test_each_picture_is_said_in_numbers(browser, address):
    visit(browser, address + "#size=20&restitution=0.9&speed=100", quiet=True)
    rows(browser, 200)
    for option, said in (
        ("density", r"Density, measured: rods .* \d+ % of the time, from x = -?\d+ to \d+ R\."),
        ("widths", r"Velocity widths .*, measured: 0\.\d+, 0\.\d+, 0\.\d+ W; theory: 0.*\."),
        ("velocities", r"Velocities, measured: .* \d\.\d W in the middle and \d\.\d W at .*"),
        ("energy", r"Energy: from [\d.]+ to [\d.]+ times that of free rods within \d+ T\."),
    ):
        script = "arguments[0].value = arguments[1]"
        browser.execute_script(script, control(browser, "second-picture"), option)
        rows(browser, 1)
        assert re.fullmatch(said, browser.execute_script(LABEL))
    stage = control(browser, "stage").get_attribute("aria-label")
    assert re.search(r"The rods, .* Now \d+ of 20 rods move to the right\.$", stage, re.DOTALL)
    visit(browser, address + "#size=20&speed=100")  # it moves
    assert len({browser.execute_async_script(FRAME) for _ in range(30)}) <= 2


@pytest.mark.validate
def test_pictures_name_the_gaussian_and_their_units(browser, address):
    visit(browser, address, quiet=True)
    for setting, words, status in (
        ("", ["exact", "velocity v [W], at the ends outward"], "W = 0.35 R/T."),
        ("&restitution=0.9", ["free rod"], "W = 0.35 R/T."),
        ("&amplitude=0", ["p(v) [T/R]", "velocity width [R/T]"], "no W."),
    ):
        turn(browser, f"#first=velocities{setting}")
        written = browser.execute_script(WORDS, control(browser, "first-picture"))
        assert set(words) <= set(written)
        assert status in text(browser, "status")
    assert not {"exact", "free rod"} & set(written)
    assert errors(browser) == []


@pytest.mark.validate
def test_a_push_that_is_broken_off_says_so_and_the_next_one_meets_a_calm_chain(browser, address):
    visit(browser, address, quiet=True)
    press(browser, challenges(browser)[0])
    press(browser, control(browser, "push"))
    slide(browser, restitution=0.9)
    said = "The restitution e changed, which broke off the push under way."
    assert text(browser, "note") == said
    press(browser, control(browser, "push"))
    assert text(browser, "note") == ""
    assert browser.execute_script("return ChainRunning.world.pushed.settled")
    assert browser.execute_script(CHAIN)["restitution"] == 0.9
    assert "e = 0.9: 1 of 3 pushes" in rows(browser, 400)


@pytest.mark.validate
def test_questions_come_before_their_answers_and_pictures_fill_their_axes(browser, address):
    """What is measured takes half of the height or more, where it differs from rod to rod."""
    visit(browser, address, quiet=True)
    ids = browser.execute_script("return ChainPresets.list.map(({ id }) => id)")
    assert len(ids) == len(set(ids)) == 9
    for name in ids:
        turn(browser, f"#preset={name}")
        assert text(browser, "ask").count("?") >= 1
        assert text(browser, "answer") == ""
        browser.execute_script("arguments[0].click()", control(browser, "reveal"))
        assert len(text(browser, "answer")) > 50
    for widths in ([0.87, 0.9, 0.87], [1.08, 1.12, 1.08], [0.64, 0.22, 0.64], [1.36, 1.15, 1.2]):
        low, high = browser.execute_script("return ChainPlots.around(arguments[0], 0.2)", widths)
        assert low <= min(widths) <= max(widths) <= high
        assert high - low <= 2 * max(0.2, max(widths) - min(widths))
