"""Measure the page of ``crazybilliards explore``: frames, reaction to a number, memory.

    PYTHONPATH=docs/figures python benchmarks/page.py

Frames a second, and how long it takes from a number typed to the new theory, are
counted in a headless Chromium. Memory is that of the server: after a first round of pages, which
loads what is loaded once, by how much it grows when as many are opened and closed again. The
allocator of the C library makes it vary by 30 MB from round to round, hence several rounds.
"""

import asyncio
import re
import time
from itertools import product
from pathlib import Path
from urllib.request import urlopen

import numpy as np
from browser import SOURCE, Server, chromium, column, elements, press, served, until, visit
from selenium.webdriver.common.keys import Keys
from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

SIZES = (100, 300, 1000)
PAGES, ROUNDS = 50, 5
THEORIES = ["balance density", "exact density"]  # in the order in which they arrive
AMPLITUDES = ("3", "5", "8", "10", "12", "7", "9")
_FORGOTTEN = 45  # s after which Bokeh has thrown away a page that is closed


def frames(browser) -> float:
    """Frames a second that arrive in the browser, and that it paints, whichever is less."""
    count = f"""
    window.arrived = window.painted = 0;
    {SOURCE}.properties.data.change.connect(() => {{ window.arrived++; }});
    const paint = () => {{ window.painted++; requestAnimationFrame(paint); }};
    requestAnimationFrame(paint);
    """
    browser.execute_script(count, "rods")
    look = "return [window.arrived, window.painted, performance.now() / 1000]"
    before = np.array(browser.execute_script(look))
    time.sleep(10)
    *counted, seconds = np.array(browser.execute_script(look)) - before
    return float(min(counted) / seconds)


def reaction(browser, amplitude: str) -> list[float]:
    """Seconds from an amplitude typed to each of its theories' densities."""
    note = f"""const drawn = window.drawn = {{}}; for (const name of arguments[0]) {{
      const source = {SOURCE.replace("arguments[0]", "name")};
      source.properties.data.change.connect(() => {{
        if (source.data.x.length) drawn[name] ??= performance.now(); }}); }}"""
    field = elements(browser, "input[aria-label^='noise']")[0]
    browser.execute_script(note, THEORIES)
    browser.execute_script(
        "arguments[0].addEventListener('change', () => { window.typed = performance.now(); })",
        field,
    )
    field.send_keys(Keys.END, *[Keys.BACKSPACE] * 8, amplitude, Keys.ENTER)
    until(lambda: len(browser.execute_script("return window.drawn")) == len(THEORIES))
    drawn = browser.execute_script("return window.drawn")
    typed = browser.execute_script("return window.typed")
    return [(drawn[name] - typed) / 1000 for name in THEORIES]


def open_and_close(address: str) -> None:
    """Open a page without a browser, wait for what it sends first, and close it."""
    token = re.search(r'"token":"([^"]+)"', urlopen(address).read().decode())[1]
    request = HTTPRequest(
        address.replace("http", "ws") + "ws", headers={"Origin": address.rstrip("/")}
    )

    async def connect() -> None:
        socket = await websocket_connect(request, subprotocols=["bokeh", token])
        await asyncio.wait_for(socket.read_message(), 60)
        socket.close()

    asyncio.run(connect())


def memory(server: Server) -> float:
    """Memory of the server, when what is closed has been forgotten [MB]."""
    time.sleep(_FORGOTTEN)
    status = Path(f"/proc/{server.process.pid}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024


def main() -> None:
    with served() as address, chromium() as browser:
        for size, speed in product(SIZES, ("30", "3")):
            visit(browser, address, f"?size={size}&amplitude=1&gap=0&damping=1")
            until(lambda: column(browser, "exact density", "x"))
            press(browser, speed)
            time.sleep(3)
            shown = frames(browser)
            print(f"{size} rods, {speed} T per second: {shown:.1f} frames a second", flush=True)
            found = [reaction(browser, amplitude) for amplitude in AMPLITUDES]
            balance, exact = np.median(found, axis=0)
            print(
                f"  from a number typed: {balance:.2f} s to the force balance, "
                f"{exact:.2f} s to the exact density",
                flush=True,
            )
    with served() as address:
        rounds = []
        for _ in range(ROUNDS):
            for _ in range(PAGES):
                open_and_close(address)
            rounds.append(memory(address))
            print(f"{rounds[-1]:.0f} MB after {PAGES * len(rounds)} pages", flush=True)
        growth = (rounds[-1] - rounds[0]) / (ROUNDS - 1)
        print(f"{growth:.1f} MB for {PAGES} pages, on average after the first {PAGES}")


if __name__ == "__main__":
    main()
