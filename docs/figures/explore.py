"""Take pictures of the page of ``crazybilliards explore`` in a headless Chromium.

    python docs/figures/explore.py FOLDER [NAME ...]

writes one PNG for each: the page at three widths, light and dark; each preset; a chain that runs
away; slow motion, which is ``explore.png`` of this folder; a chain for which the kinetic equation
was solved. It also lists what can be operated, and fails if something of that has no name.
"""

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from browser import chromium, column, elements, press, served, show_as, texts, until, visit
from selenium.webdriver.support.ui import Select

from crazybilliards.apps.explore.presets import PRESETS

WIDTHS = {"wide": 1400, "middle": 1024, "phone": 390}
SOLVED = "?size=100&restitution=0.95&amplitude=1&gap=0&damping=1"
RUNS_AWAY = "?size=100&restitution=1.01&damping=0.4&amplitude=1&gap=0"
INTERACTIVE = {
    "button",
    "slider",
    "spinbutton",
    "combobox",
    "textbox",
    "link",
    "DisclosureTriangle",
}


class Album:
    """Pictures of a page in a browser, into a folder."""

    def __init__(self, browser: Any, address: str, folder: Path) -> None:
        self.browser, self.address, self.folder = browser, address, folder
        folder.mkdir(parents=True, exist_ok=True)

    def open(self, query: str = "", *, width: int = 1400, dark: bool = False) -> None:
        """Open the page in a window of this width, tall enough for all of it."""
        show_as(self.browser, width, 1260 if width > 1100 else 1900, dark=dark)
        self.shown = width, dark
        visit(self.browser, self.address, query)

    def keep(self, name: str) -> None:
        """Take a picture of all of the page."""
        # The page itself ends here, and the window further down or further up.
        end = "return document.querySelector('[role=main]').getBoundingClientRect().bottom"
        width, dark = self.shown
        show_as(self.browser, width, int(self.browser.execute_script(end)) + 8, dark=dark)
        time.sleep(1)
        size = self.browser.execute_cdp_cmd("Page.getLayoutMetrics", {})["cssContentSize"]
        if size["width"] > width:
            print(f"{name}: {size['width']} pixels wide, on a screen of {width}")
        self.browser.get_screenshot_as_file(str(self.folder / f"{name}.png"))
        print(self.folder / f"{name}.png", flush=True)

    def choose(self, option: str) -> None:
        """Choose a preset."""
        Select(elements(self.browser, "select")[0]).select_by_visible_text(option)


def looks(album: Album) -> dict[str, Callable[[], None]]:
    """Return what there is to look at, by name."""

    def whole(width: int, dark: bool) -> None:
        album.open(width=width, dark=dark)
        time.sleep(8)

    def runs_away() -> None:
        album.open(RUNS_AWAY)
        press(album.browser, "300")
        until(lambda: "runs away" in " ".join(texts(album.browser, ".alert")), 120)

    def slow() -> None:
        album.open()
        press(album.browser, "0.5")
        until(lambda: column(album.browser, "strip", "height")[0] < 5, 120)
        time.sleep(2)
        press(album.browser, "Push")
        time.sleep(4)

    def solved() -> None:
        album.open(SOLVED)
        press(album.browser, "30")
        press(album.browser, "Solve")
        until(lambda: column(album.browser, "kinetic density", "x"), 120)
        until(lambda: "measured for" in " ".join(texts(album.browser, ".progress")), 120)
        time.sleep(5)

    def preset(label: str) -> None:
        album.open()
        album.choose(label)
        time.sleep(15)

    return {
        **{
            f"{name}-{'dark' if dark else 'light'}": lambda w=width, d=dark: whole(w, d)
            for name, width in WIDTHS.items()
            for dark in (False, True)
        },
        "solved": solved,
        "runs-away": runs_away,
        "slow-motion": slow,
        **{
            f"preset-{number:02d}-{each.figure}": lambda label=each.label: preset(label)
            for number, each in enumerate(PRESETS, 1)
        },
    }


def named(browser: Any) -> list[tuple[str, str]]:
    """Return role and name of all that can be operated."""
    tree = browser.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]
    found = []
    for node in tree:
        role, name = (node.get(key, {}).get("value", "") for key in ("role", "name"))
        if role in INTERACTIVE and not node.get("ignored"):
            found.append((role, name))
    return found


def main(folder: Path, *names: str) -> None:
    """Take the pictures, all or those named, and check the names of the controls."""
    with served() as address, chromium() as browser:
        album = Album(browser, address, folder)
        known = looks(album)
        if unknown := set(names) - set(known):
            raise SystemExit(f"no picture {', '.join(unknown)}; there are {', '.join(known)}")
        for name in names or known:
            known[name]()
            album.keep(name)
        album.open()
        time.sleep(3)
        controls = named(browser)
        for role, name in controls:
            print(f"{role}: {name}")
        if not all(name for _, name in controls):
            raise SystemExit("something has no name")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", metavar="NAME")
    given = parser.parse_args()
    main(given.folder, *given.names)
