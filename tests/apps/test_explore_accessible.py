"""Everybody can use the page: an audit by axe-core, colours in dark mode, no need for a mouse."""

import signal
from contextlib import contextmanager
from itertools import pairwise

import pytest
from accessibility import audit, tabbed
from browser import SOURCE, elements, press, show_as, texts, until, visit

from crazybilliards.apps.explore.challenges import CHALLENGES
from crazybilliards.apps.explore.controls import HISTORIES, MORE, SPEEDS
from crazybilliards.apps.explore.setting import Setting

FILTER = "return getComputedStyle(document.documentElement).filter"
WIDE, NARROW = (1400, 1260), (390, 844)
TAKES_LONG = "?size=300&restitution=0.5&amplitude=1&gap=0&damping=1"
RUNS_AWAY = "?size=100&restitution=1.01&damping=0.4&amplitude=1&gap=0"
SAME_LINE = 5.0  # pixels by which boxes in lines one below the other may overlap
# Panel announces other names of arguments, which the oldest version that we allow does not know.
pytestmark = [pytest.mark.validate, pytest.mark.filterwarnings("ignore::PendingDeprecationWarning")]


def sliders():
    """Return the names of the sliders."""
    return [each.name for each in Setting().widgets()[:-1]]


def settled(browser):
    """Wait until the page is whole and page.js has named it; return the help."""
    details = until(lambda: elements(browser, "details"))[0]
    number = len(sliders())
    until(lambda: len(elements(browser, ".noUi-handle[aria-label]")) == number)
    until(lambda: elements(browser, "[role=main]"))
    unnamed = "select:not([aria-label]), .bk-Figure:not([aria-label])"
    until(lambda: not elements(browser, unnamed))
    return details


@contextmanager
def standing_still(server):
    """Stop the server's process, so that its pages stay as they are."""
    server.process.send_signal(signal.SIGSTOP)
    try:
        yield
    finally:
        server.process.send_signal(signal.SIGCONT)


def in_the_dark(colour):
    """Return a colour as the filter of page.css shows it: invert(0.92) hue-rotate(180deg)."""
    red, green, blue = (0.92 - 0.84 * int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
    turned = (
        -0.574 * red + 1.430 * green + 0.144 * blue,
        0.426 * red + 0.430 * green + 0.144 * blue,
        0.426 * red + 1.430 * green - 0.856 * blue,
    )
    return [min(max(channel, 0.0), 1.0) for channel in turned]


def contrast(one, other):
    """Return the ratio of two colours' brightness, as the WCAG define it."""

    def luminance(colour):
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    darker, lighter = sorted(luminance(each) + 0.05 for each in (one, other))
    return lighter / darker


def too_faint(colours):
    """Return the pairs of colours that dark mode leaves too faint, with their contrast."""
    found = []
    for pair in colours:
        ratio = contrast(in_the_dark(pair["fgColor"]), in_the_dark(pair["bgColor"]))
        if ratio < float(pair["expectedContrastRatio"].removesuffix(":1")):
            found.append((pair["fgColor"], pair["bgColor"], ratio))
    return found


@pytest.mark.compiled
@pytest.mark.parametrize("screen", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("helped", [False, True], ids=["plain", "unfolded"])
def test_no_serious_finding_of_axe(browser, address, screen, helped):
    """Axe knows of no filter: what it finds of colours in light mode is turned over for dark.

    ``in_the_dark`` does this, if the filter is the one that it is written for.
    """
    show_as(browser, *screen)
    visit(browser, address)
    details = settled(browser)
    browser.execute_script("arguments[0].open = arguments[1]", details, helped)
    if helped and screen == NARROW:
        press(browser, MORE)
        until(lambda: elements(browser, "[aria-expanded=true]"))
    serious, colours = audit(browser)
    assert serious == []
    assert too_faint(colours) == []
    show_as(browser, *screen, dark=True)
    assert browser.execute_script(FILTER) == "invert(0.92) hue-rotate(180deg)"


@pytest.mark.compiled
def test_no_serious_finding_of_axe_in_messages(browser, address):
    """They have colours of their own, as has the button while it solves."""
    show_as(browser, *WIDE)
    visit(browser, address, RUNS_AWAY)
    settled(browser)
    press(browser, "300")
    until(lambda: "runs away" in " ".join(texts(browser, ".alert")))
    serious, colours = audit(browser)
    assert serious == []
    assert too_faint(colours) == []
    visit(browser, address, TAKES_LONG)
    settled(browser)
    press(browser, "Solve")
    until(lambda: elements(browser, ".bk-btn-warning"))
    with standing_still(address):
        assert elements(browser, ".bk-btn-warning")
        serious, colours = audit(browser)
    assert serious == []
    assert too_faint(colours) == []


@pytest.mark.compiled
def test_every_control_is_reached_by_tab_named_and_seen(browser, address):
    show_as(browser, *NARROW)
    visit(browser, address)
    details = settled(browser)
    press(browser, "Pause")  # what moves may change the lines that texts take
    until(lambda: "Play" in texts(browser, "button"))
    press(browser, MORE)
    until(lambda: elements(browser, "[aria-expanded=true]"))
    browser.execute_script("arguments[0].open = true; scrollTo(0, 0)", details)
    reached = tabbed(browser)
    names = [each.accessible_name for each, *_ in reached]
    fields = [name for each in sliders() for name in (f"{each}, as a number", each)]
    expected = [f"{number} {each.title}" for number, each in enumerate(CHALLENGES, 1)]
    expected += ["Play", "Step", "Reset", "Push the left end"]
    expected += [f"speed {speed:g} T per second" for speed in SPEEDS]
    expected += [*fields[:6], MORE, "what the paper's figures show", *fields[6:], "spring"]
    expected += ["Solve the kinetic equation", "measured", "in time"]
    expected += ["Help: the model, the controls, further reading"]
    assert names[: len(expected)] == expected
    links = reached[len(expected) :]
    assert all(each.tag_name == "a" and each.accessible_name for each, *_ in links)
    assert [names[k] for k, (_, outline, *_) in enumerate(reached) if outline < 3] == []
    # From top to bottom, and from left to right in a row.
    for (*_, left, top, bottom), (*_, next_left, next_top, next_bottom) in pairwise(reached):
        in_a_row = min(bottom, next_bottom) - max(top, next_top) > SAME_LINE
        assert next_left > left if in_a_row else next_top >= bottom - SAME_LINE


@pytest.mark.compiled
def test_keys_alone_change_numbers_lists_and_speed(browser, address):
    from selenium.webdriver.common.keys import Keys

    show_as(browser, *WIDE)
    visit(browser, address)
    settled(browser)
    elements(browser, "input.bk-input")[1].send_keys(Keys.ARROW_UP)
    until(lambda: "size=21" in browser.current_url)
    elements(browser, ".noUi-handle")[0].send_keys(Keys.ARROW_LEFT)
    until(lambda: "restitution=0.99" in browser.current_url)
    [button] = [each for each in elements(browser, "button") if each.text == "0.02"]
    button.send_keys(Keys.SPACE)
    height = f"return {SOURCE}.data.height[0]"
    until(lambda: browser.execute_script(height, "strip") < 1)
    elements(browser, "select")[-1].send_keys(list(HISTORIES)[1][0])
    until(lambda: elements(browser, "select")[-1].get_attribute("value") == list(HISTORIES)[1])
