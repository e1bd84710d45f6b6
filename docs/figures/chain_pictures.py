"""Take pictures of the chain to play with in a headless Chromium.

    python docs/figures/chain_pictures.py FOLDER

writes the page at two widths, light and dark, in its first second and after ten, and the push,
which is ``chain.png`` of this folder. ``crazybilliards explore`` serves the page.
"""

import argparse
import time
from pathlib import Path
from typing import Any

from browser import chromium, served, show_as, until

SCREENS = {"desktop": (1280, 900), "phone": (390, 844)}


def push(browser: Any, folder: Path) -> None:
    """Save the picture of a push that has arrived at the last rod, as the page saves it."""
    metrics = {"width": 736, "height": 900, "deviceScaleFactor": 2, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    # Time runs here and not in the page, so that every picture is the same.
    still = {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", still)
    allowed = {"behavior": "allow", "downloadPath": str(folder.resolve())}
    browser.execute_cdp_cmd("Browser.setDownloadBehavior", allowed)
    (folder / "chain.png").unlink(missing_ok=True)  # another name would be taken
    browser.refresh()
    browser.execute_script(
        "const { goOn, push } = ChainRunning, [stage, picture, save] ="
        "['stage', 'first-picture', 'save'].map((name) =>"
        "document.querySelector(`[data-chain=${name}]`));"
        "stage.style.height = '264px';"
        "for (let row = 0; row < 60; row++) goOn(); push(0);"
        "for (let row = 0; row < 95; row++) goOn();"
        "picture.dispatchEvent(new Event('change')); save.click();"
    )
    until((folder / "chain.png").exists, 60)


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
                browser.get_screenshot_as_file(str(folder / f"{name}-{shade}-1s.png"))
                browser.execute_script("ChainRunning.push(0)")
                time.sleep(9)
                browser.get_screenshot_as_file(str(folder / f"{name}-{shade}-10s.png"))
        show_as(browser, *SCREENS["desktop"])
        push(browser, folder)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("folder", type=Path)
    main(parser.parse_args().folder)
