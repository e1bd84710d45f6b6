"""The page on a phone and on a desk: what is seen first, what stays in sight, fingers."""

from contextlib import contextmanager

import numpy as np
import pytest
from browser import column, elements, errors, press, show_as, texts, until, visit

from crazybilliards.apps.explore.challenges import CHALLENGES, SENTENCE
from crazybilliards.apps.explore.controls import MORE
from crazybilliards.apps.explore.presets import PRESETS
from crazybilliards.apps.explore.setting import Setting

WIDE, NARROW = (1280, 900), (390, 844)
# Panel announces other names of arguments, which the oldest version that we allow does not know.
pytestmark = [
    pytest.mark.validate,
    pytest.mark.compiled,
    pytest.mark.filterwarnings("ignore::PendingDeprecationWarning"),
]


def edges(browser, element):
    """Return left, top, right and bottom of an element on the screen."""
    script = "const {left, top, right, bottom} = arguments[0].getBoundingClientRect();"
    return browser.execute_script(f"{script} return [left, top, right, bottom]", element)


def box(browser, selector):
    """Return the edges of the first element that matches."""
    return edges(browser, elements(browser, selector)[0])


def shown(browser, selector):
    """Return the elements that match and are displayed."""
    return [each for each in elements(browser, selector) if each.is_displayed()]


def active(browser):
    """Return what is chosen of buttons that exclude one another."""
    return texts(browser, "button.bk-active")


def look(browser):
    return " ".join(texts(browser, ".look"))


@contextmanager
def without_libraries(browser):
    """Let the browser load no scripts."""
    browser.execute_cdp_cmd("Network.enable", {})
    browser.execute_cdp_cmd("Network.setBlockedURLs", {"urls": ["*.js*"]})
    try:
        yield
    finally:
        browser.execute_cdp_cmd("Network.setBlockedURLs", {"urls": []})


@pytest.mark.parametrize("screen", [WIDE, NARROW], ids=["wide", "narrow"])
def test_rods_and_the_first_sentence_are_drawn_without_any_library(browser, address, screen):
    show_as(browser, *screen)
    with without_libraries(browser):
        browser.get(address)
        first = browser.find_element("id", "first")
        assert first.is_displayed()
        assert SENTENCE in first.text
        rods = first.find_elements("css selector", "rect")
        x = [float(each.get_attribute("x")) for each in rods]
        assert len(x) == 20
        assert (np.diff(x) >= 2 - 2e-3).all()  # they do not overlap, but for rounding
        assert len({each.get_attribute("fill") for each in rods}) > 5
        left, top, right, bottom = box(browser, "#first svg")
        assert 0 <= left < right <= screen[0]
        assert 0 <= top < bottom <= screen[1] / 2
    browser.get_log("browser")  # it complains about the scripts
    visit(browser, address)
    until(lambda: not elements(browser, "#first"))
    assert errors(browser) == []


def test_rods_and_strip_stay_on_top_of_a_phone(browser, address):
    rods, strip = ".bk-Figure[aria-label^='rods']", ".bk-Figure[aria-label^='space']"
    for screen, stays in ((NARROW, True), (WIDE, False)):
        show_as(browser, *screen)
        visit(browser, address)
        until(lambda: elements(browser, strip))
        browser.execute_script("scrollTo(0, 0)")
        before = box(browser, rods)
        # Nothing but the key of the colours stands above the rods of a phone.
        assert (before[1] < 50) == stays
        browser.execute_script("scrollTo(0, document.documentElement.scrollHeight)")
        until(lambda: browser.execute_script("return scrollY") > 300)
        assert (box(browser, rods)[1] >= 0) == stays
        if stays:  # and leave at least two thirds of the screen to what is scrolled
            assert 0 < box(browser, strip)[3] < screen[1] / 3
        assert browser.execute_script("return document.documentElement.scrollWidth") == screen[0]


def test_legends_on_a_phone_are_not_wider_than_the_frames(browser, address):
    show_as(browser, *NARROW)
    visit(browser, address)
    until(lambda: "force balance" in texts(browser, ".bk-label"))
    boxes = [edges(browser, legend) for legend in shown(browser, ".bk-grid")]
    assert len(boxes) == 3
    assert all(84 <= left < right <= NARROW[0] for left, _, right, _ in boxes)


def test_a_phone_shows_three_sliders_and_folds_the_rest(browser, address):
    show_as(browser, *WIDE)
    visit(browser, address)
    until(lambda: len(shown(browser, ".noUi-handle[aria-label]")) == 5)
    assert MORE not in [each.text for each in shown(browser, "button")]
    show_as(browser, *NARROW)
    visit(browser, address)
    until(lambda: len(elements(browser, ".noUi-handle[aria-label]")) == 5)
    names = [each.get_attribute("aria-label") for each in shown(browser, ".noUi-handle")]
    assert names == ["restitution e", "number of rods L", Setting().widgets()[2].name]
    press(browser, MORE)
    until(lambda: len(shown(browser, ".noUi-handle")) == 5)
    press(browser, MORE)
    until(lambda: len(shown(browser, ".noUi-handle")) == 3)


def test_a_challenge_sets_its_chain_and_says_what_was_found(browser, address):
    from selenium.webdriver.support.ui import Select

    show_as(browser, *WIDE)
    visit(browser, address)
    until(lambda: CHALLENGES[0].ask in look(browser))
    press(browser, "2 Run away")
    until(lambda: "size=40" in browser.current_url and "restitution=1.02" in browser.current_url)
    until(lambda: CHALLENGES[1].ask in look(browser))
    until(lambda: "times that of free rods" in look(browser))
    Select(elements(browser, "select")[0]).select_by_visible_text(PRESETS[-1].label)
    until(lambda: PRESETS[-1].look in look(browser))
    visit(browser, address, "?size=15&restitution=1.1&damping=0.1&amplitude=1&gap=0")
    assert CHALLENGES[0].ask not in look(browser)
    assert errors(browser) == []


def test_a_push_in_fast_motion_is_shown_in_slow_motion(browser, address):
    show_as(browser, *WIDE)
    visit(browser, address)
    press(browser, "300")
    until(lambda: "300" in active(browser))
    until(lambda: "measured for" in " ".join(texts(browser, ".progress")))
    press(browser, "Push the left end")
    until(lambda: "e = 1: 1 of 1 arrived" in look(browser))
    assert "3" in active(browser)


def test_two_buttons_may_be_pressed_at_nearly_the_same_time(browser, address):
    """Panel then calls without the lock of the document."""
    show_as(browser, *WIDE)
    visit(browser, address)
    press(browser, "0.5")
    until(lambda: "0.5" in active(browser))
    press(browser, "3", "Push the left end")
    until(lambda: "e = 1: 1 of 1 arrived" in look(browser))
    assert "3" in active(browser)


def test_a_finger_drags_a_rod(browser, address):
    show_as(browser, *NARROW)
    visit(browser, address)
    press(browser, "Pause")
    until(lambda: "Play" in texts(browser, "button"))
    until(lambda: elements(browser, "[role=main]"))
    x = np.array(column(browser, "rods", "x"))
    left, top, right, bottom = box(browser, ".bk-Figure[aria-label^='rods']")

    def finger(event, *points):
        browser.execute_cdp_cmd(
            "Input.dispatchTouchEvent",
            {"type": event, "touchPoints": [{"x": at, "y": (top + bottom) / 2} for at in points]},
        )

    middle = (left + right) / 2
    finger("touchStart", middle)
    for moved in range(10, 70, 10):
        finger("touchMove", middle - moved)
    until(lambda: (np.array(column(browser, "rods", "x")) < x - 5).any())
    until(lambda: "you hold a rod" in " ".join(texts(browser, ".progress")))
    finger("touchEnd")
    until(lambda: "you hold a rod" not in " ".join(texts(browser, ".progress")))
    assert errors(browser) == []
