"""A headless Chromium that opens the page of ``crazybilliards explore``, for pictures and tests."""

import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

CHROMIUM, DRIVER = Path("/usr/bin/chromium"), Path("/usr/bin/chromedriver")
# Without the last flag a page that is driven by a script may change its address 20 times a second.
FLAGS = (
    "--headless=new --no-sandbox --disable-gpu --disable-quic --no-first-run "
    "--disable-background-networking --disable-component-update --disable-sync "
    "--window-size=1400,1040 --hide-scrollbars --disable-ipc-flooding-protection"
)
COMMAND = [sys.executable, "-c", "from crazybilliards.apps.commands.line import main; main()"]


class Server(str):
    """The address of a page that is served, and the process that serves it."""

    process: subprocess.Popen[str]


@contextmanager
def served() -> Iterator[Server]:
    """Serve the page at a free port; Ctrl-C ends it."""
    process = subprocess.Popen(
        [*COMMAND, "explore", "--no-browser", "--port", "0"], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        server = Server(process.stdout.readline().split()[0])
        server.process = process
        yield server
        process.send_signal(signal.SIGINT)
        assert process.wait(300) == -signal.SIGINT
    finally:
        process.kill()
        process.stdout.close()


@contextmanager
def chromium() -> Iterator[Any]:
    """Start a headless Chromium."""
    from selenium import webdriver

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = webdriver.ChromeOptions()
        options.binary_location = str(CHROMIUM)
        for flag in (*FLAGS.split(), f"--user-data-dir={profile}"):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        service = webdriver.ChromeService(executable_path=str(DRIVER))
        driver = webdriver.Chrome(options=options, service=service)
        try:
            yield driver
        finally:
            driver.quit()


def until(condition: Callable[[], Any], seconds: float = 300.0) -> Any:
    """Wait for a condition to be true; return what it returned."""
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end, "waited for too long"
        time.sleep(0.01)
    return found


def show_as(browser: Any, width: int, height: int, *, dark: bool = False) -> None:
    """Show pages as on a screen of so many pixels, in light or dark mode."""
    scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)


def errors(browser: Any) -> list[str]:
    """Return what the browser's console says of errors."""
    return [line["message"] for line in browser.get_log("browser") if line["level"] == "SEVERE"]
