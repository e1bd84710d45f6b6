"""Take pictures of the chain to play with in a headless Chromium.

    python docs/figures/chain_pictures.py FOLDER

writes the page at two widths, light and dark, in its first second and after ten, and the push,
which is ``chain.png`` of this folder. ``crazybilliards explore`` serves the page.
"""

import argparse
import base64
import time
from pathlib import Path
from typing import Any

from browser import chromium, served, show_as

SCREENS = {"desktop": (1280, 900), "phone": (390, 844)}


def keep(browser: Any, file: Path, clip: dict[str, float] | None = None) -> None:
    """Take a picture of the screen, or of a part of it at twice the resolution."""
    if clip is None:
        browser.get_screenshot_as_file(str(file))
    else:
        shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"clip": clip | {"scale": 1}})
        file.write_bytes(base64.b64decode(shot["data"]))
    print(file, flush=True)


def push(browser: Any, file: Path) -> None:
    """Take the picture of a push that has arrived at the last rod."""
    metrics = {"width": 736, "height": 900, "deviceScaleFactor": 2, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    browser.refresh()
    # Time runs here and not in the page, so that every picture is the same.
    browser.execute_script(
        "const chain = ChainControls, { goOn, push } = ChainRunning;"
        "document.querySelector('.stage').style.height = '264px';"
        "chain.pause(); chain.choose(ChainChallenges.list[0]);"
        "for (let row = 0; row < 60; row++) goOn(); push(0);"
        "for (let row = 0; row < 95; row++) goOn(); chain.draw();"
    )
    box = "const box = document.querySelector('.stage').getBoundingClientRect();"
    x, y, width, height = browser.execute_script(
        f"{box} return [box.x, box.y, box.width, box.height]"
    )
    keep(browser, file, {"x": x, "y": y, "width": width, "height": height})


def main(folder: Path) -> None:
    """Take the pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    with served() as address, chromium() as browser:
        for name, screen in SCREENS.items():
            for dark in (False, True):
                show_as(browser, *screen, dark=dark)
                browser.get(address)
                time.sleep(1)
                shade = "dark" if dark else "light"
                keep(browser, folder / f"{name}-{shade}-1s.png")
                browser.execute_script("ChainRunning.push(0)")
                time.sleep(9)
                keep(browser, folder / f"{name}-{shade}-10s.png")
        show_as(browser, *SCREENS["desktop"])
        push(browser, folder / "chain.png")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("folder", type=Path)
    main(parser.parse_args().folder)
