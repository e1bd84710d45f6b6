"""The page docs/chain.md in a browser: everybody can use it, and it knows what is achieved."""

import json
import re

import chain_curves
import numpy as np
import pytest
from accessibility import audit, tabbed
from browser import errors, show_as, until
from chain_pictures import DOCS, page, written

from crazybilliards.apps.explore.challenges import CHALLENGES, KICK, SENTENCE, TURNS_AT
from crazybilliards.apps.explore.motion import COLOURS
from crazybilliards.model import Chain

FILES = sorted((DOCS / "chain").iterdir())
WIDE, NARROW = (1280, 900), (390, 844)
SAID = "return document.querySelector('[data-chain=said]').textContent"
TIME = "return ChainControls.world.state.time"


@pytest.fixture(scope="module")
def address():
    with written() as address:
        yield address


def visit(browser, address, screen=WIDE, *, dark=False, quiet=False):
    """Open the page; ``quiet``: for a reader who wants nothing to move."""
    show_as(browser, *screen, dark=dark)
    if quiet:
        features = [{"name": "prefers-reduced-motion", "value": "reduce"}]
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
    browser.get(address)


def control(browser, name):
    return browser.find_element("css selector", f"[data-chain='{name}']")


def slide(browser, **values):
    """Set sliders as a reader does, who moves them one after the other."""
    for name, value in values.items():
        browser.execute_script(
            "const slider = document.querySelector(`[data-chain=${arguments[0]}]`);"
            "slider.value = arguments[1]; slider.dispatchEvent(new Event('input'));",
            name,
            value,
        )


def rows(browser, number):
    """Let the chain go on by so many rows of its strip, and the challenge look at it."""
    browser.execute_script(
        "const chain = ChainControls; for (let row = 0; row < arguments[0]; row++)"
        "{ if (!chain.world.ranAway) chain.goOn(); } chain.draw();",
        number,
    )
    return browser.execute_script(SAID)


def choose(browser, number):
    """Choose a challenge, in a chain that moves only when it is asked to."""
    browser.execute_script("ChainControls.pause()")
    browser.find_elements("css selector", "[aria-pressed]")[number - 1].click()


def done(browser):
    return [each.text for each in browser.find_elements("css selector", "[aria-pressed].done")]


# -- files -----------------------------------------------------------------------------------------


def test_the_files_are_small_plain_and_ask_nobody_else():
    texts = {file.name: file.read_text(encoding="utf-8") for file in FILES}
    assert sum(len(text.encode()) for text in texts.values()) < 60_000
    assert {file.suffix for file in FILES} == {".js", ".css"}
    assert all(len(text.splitlines()) < 300 for text in texts.values())
    for text in [*texts.values(), page()]:
        assert "http" not in text
        assert "import " not in text
        assert "export " not in text
    # Scripts of one page share their names: each adds one.
    for name, text in texts.items():
        if name.endswith(".js"):
            names = [line.split()[1] for line in text.splitlines() if line.startswith("const ")]
            assert names == [f"Chain{name.removesuffix('.js').title()}"]
    assert all(f"_static/{name}" in (DOCS / "chain.md").read_text("utf-8") for name in texts)


def curves():
    """Return what is stored, by chain."""
    text = chain_curves.CURVES.read_text(encoding="utf-8")
    rows = [json.loads(row) for row in re.findall(r"^    (\{.*\}),$", text, re.MULTILINE)]
    found = {Chain(**{name: row[name] for name in chain_curves.SHOWN}): row for row in rows}
    return found, float(re.findall(r"turning: \{ damping: ([\d.]+) \}", text)[0])


@pytest.mark.validate
@pytest.mark.compiled
def test_the_stored_curves_are_those_of_the_best_theories():
    """All are for chains that the challenges begin with or lead to."""
    found, turn = curves()
    turning = {g: chain_curves.TURNING.replace(damping=g) for g in chain_curves.DAMPINGS}
    assert set(found) == {*turning.values(), chain_curves.PUSHED, *chain_curves.DISSIPATIVE}
    solved = {g: chain_curves.solve(chain) for g, chain in turning.items()}
    assert chain_curves.turning(solved) == pytest.approx(turn, abs=0.051)
    solved = {turning[g]: theory for g, theory in solved.items()}
    for chain in (chain_curves.PUSHED, Chain(size=20, restitution=0.5)):
        solved[chain] = chain_curves.solve(chain)
    for chain, theory in solved.items():
        stored = found[chain]["half"]
        np.testing.assert_allclose(stored, chain_curves.stored(chain, theory)["half"], atol=0.0015)


# -- everybody can use it --------------------------------------------------------------------------


@pytest.mark.validate
@pytest.mark.parametrize("screen", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_no_serious_finding_of_axe(browser, address, screen, dark):
    visit(browser, address, screen, dark=dark, quiet=True)
    show_as(browser, *screen, dark=dark)
    serious, _ = audit(browser)
    assert serious == []
    assert browser.execute_script("return document.documentElement.scrollWidth") <= screen[0]


@pytest.mark.validate
def test_every_control_is_reached_by_tab_named_and_seen(browser, address):
    visit(browser, address, NARROW, quiet=True)
    reached = tabbed(browser)
    names = [each.accessible_name for each, *_ in reached]
    challenges = ["1 A push", "2 Run away", "3 Hot ends", "4 Convex or concave"]
    sliders = ["restitution e", "damping", "noise A", "gap g", "number of rods L"]
    expected = ["Play", "Push rod", "rod to push", "Restart", "speed", *challenges, *sliders]
    assert len(names) == len(expected)
    assert all(name.startswith(begin) for name, begin in zip(names, expected, strict=True)), (
        "|".join(names)
    )
    assert [outline for _, outline, *_ in reached if outline < 3] == []


@pytest.mark.validate
def test_keys_alone_push_pause_and_change(browser, address):
    from selenium.webdriver.common.keys import Keys

    visit(browser, address, quiet=True)
    fast = "return ChainControls.world.state.v[arguments[0]]"
    free = Chain(damping=0.3).free_velocity_width
    for keys, before in ((Keys.SPACE, "push"), ("p", "play")):
        speed = browser.execute_script(fast, 0)
        control(browser, before).send_keys(keys)
        assert browser.execute_script(fast, 0) == pytest.approx(speed + 8 * free)
    control(browser, "rod").send_keys(*[Keys.ARROW_UP] * 6)
    speed = browser.execute_script(fast, 6)
    control(browser, "push").send_keys(Keys.ENTER)
    assert browser.execute_script(fast, 6) == pytest.approx(speed + 8 * free)
    control(browser, "restitution").send_keys(Keys.ARROW_LEFT)
    assert browser.execute_script("return ChainControls.world.state.chain.restitution") == 0.99
    control(browser, "play").send_keys(Keys.SPACE)
    time = browser.execute_script(TIME)
    until(lambda: browser.execute_script(TIME) > time, 20)


@pytest.mark.validate
def test_it_starts_paused_for_reduced_motion_and_loads_nothing_from_elsewhere(browser, address):
    visit(browser, address, quiet=True)
    time = browser.execute_script(TIME)
    until(lambda: browser.execute_script("return performance.now()") > 1000, 20)
    assert browser.execute_script(TIME) == time
    visit(browser, address)
    time = browser.execute_script(TIME)
    until(lambda: browser.execute_script(TIME) > time, 20)
    named = browser.execute_script(
        "return [...document.querySelectorAll('[src], [href]')].map(each => each.src || each.href)"
    )
    assert sorted(named) == [file.as_uri() for file in FILES]
    assert errors(browser) == []


@pytest.mark.validate
@pytest.mark.parametrize("e", [0, 1])
def test_a_rod_follows_the_pointer_and_pushes_the_others(browser, address, e):
    from selenium.webdriver import ActionChains

    visit(browser, address)
    slide(browser, restitution=e)
    stage = control(browser, "stage")
    position = "return Array.from(ChainControls.world.state.y)"
    held = "return ChainControls.world.state.held"
    first = browser.execute_script(
        "const {world} = ChainControls, box = arguments[0].getBoundingClientRect();"
        "const half = ChainDrawing.reach(world.state.chain);"
        "return ChainPhysics.position(world.state, 0) / half * box.width / 2;",
        stage,
    )
    up = -stage.size["height"] / 2 + 40
    mouse = ActionChains(browser, duration=0)
    mouse.move_to_element_with_offset(stage, int(first), int(up)).click_and_hold()
    mouse.move_by_offset(300, 0).perform()
    assert browser.execute_script(held) >= 0
    until(lambda: browser.execute_script(position)[0] > 3, 30)
    y = browser.execute_script(position)
    assert (np.diff(y) >= -1e-9).all()
    ActionChains(browser).release().perform()
    assert browser.execute_script(held) == -1
    assert errors(browser) == []


# -- the challenges know when they are done --------------------------------------------------------


@pytest.mark.validate
def test_a_push_arrives_at_restitution_one_only(browser, address):
    visit(browser, address)
    choose(browser, 1)
    for e in (1, 0.9):
        slide(browser, restitution=e)
        assert not done(browser)
        for _ in range(3):
            browser.execute_script("ChainControls.push(0)")
            said = rows(browser, 200)
    assert "e = 0.9: 0 of 3 arrived" in said
    assert done(browser) == ["1 A push ✓"]


@pytest.mark.validate
def test_a_chain_runs_away_with_few_rods_only_if_it_is_weakly_damped(browser, address):
    visit(browser, address)
    choose(browser, 2)
    slide(browser, size=15, restitution=1.05)
    assert "run away" not in rows(browser, 2000).replace("Now", "")
    slide(browser, damping=0.2)
    control(browser, "play").click()
    until(lambda: control(browser, "play").text == "Start again", 120)
    until(lambda: done(browser) == ["2 Run away ✓"], 5)
    assert "15 rods have run away" in browser.execute_script(SAID)


@pytest.mark.validate
def test_hot_ends_need_dissipative_collisions(browser, address):
    visit(browser, address)
    choose(browser, 3)
    for values, expected in (
        ({}, []),
        ({"restitution": 1}, []),
        ({"size": 60, "restitution": 0.5}, ["3 Hot ends ✓"]),
    ):
        slide(browser, **values)
        rows(browser, 400)
        assert done(browser) == expected


@pytest.mark.validate
def test_the_profile_turns_between_two_dampings(browser, address):
    visit(browser, address)
    choose(browser, 4)
    browser.set_script_timeout(300)
    for damping in (5, 3.5):
        slide(browser, damping=damping)
        rows(browser, 1000)
        assert not done(browser)
    slide(browser, damping=2.5)
    said = rows(browser, 1500)
    assert re.search(r"convex at \S+ = 2.5, concave at \S+ = 3.5", said)
    assert done(browser) == ["4 Convex or concave ✓"]


def test_explore_has_the_same_sentence_challenges_and_colours(browser, address):
    visit(browser, address, quiet=True)
    told = browser.execute_script(
        "return ChainChallenges.list.map(({title, ask, chain}) => [title, ask, chain])"
    )
    assert [each[:2] for each in told] == [[each.title, each.ask] for each in CHALLENGES]
    assert [Chain(**each[2]) for each in told] == [each.chain for each in CHALLENGES]
    assert browser.execute_script("return ChainCurves.turning.damping") == TURNS_AT
    texts = [file.read_text(encoding="utf-8") for file in (DOCS / "chain.md", *FILES)]
    assert SENTENCE in " ".join(texts[0].split())
    everything = "".join(texts)
    assert f"const KICK = {KICK:g};" in everything
    for name, colour in zip(("left", "rest", "right"), COLOURS, strict=True):
        assert f"--{name}: {' '.join(map(str, colour))};" in everything
