"""Measure the page of ``crazybilliards explore``: frames, reaction to a number, memory.

    PYTHONPATH=docs/figures python benchmarks/page.py

Frames a second at L = 100, and how long it takes from a number typed to the new theory, are
counted in a headless Chromium. Memory is that of the server: after a first round of pages, which
loads what is loaded once, by how much it grows when as many are opened and closed again.
"""

import asyncio
import re
import time
from pathlib import Path
from urllib.request import urlopen

import numpy as np
from browser import SOURCE, Server, chromium, column, elements, press, served, until, visit
from selenium.webdriver.common.keys import Keys
from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

PAGES = 50
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


def reaction(browser, amplitude: str) -> float:
    """Seconds from an amplitude typed to its exact density."""
    note = f"""window.drawn = null; {SOURCE}.properties.data.change.connect(function () {{
      if ({SOURCE}.data.x.length) window.drawn = performance.now(); }});"""
    field = elements(browser, "input.bk-input")[2]
    browser.execute_script(note.replace("arguments[0]", "'exact density'"))
    browser.execute_script(
        "arguments[0].addEventListener('change', () => { window.typed = performance.now(); })",
        field,
    )
    field.send_keys(Keys.END, *[Keys.BACKSPACE] * 8, amplitude, Keys.ENTER)
    until(lambda: browser.execute_script("return window.drawn"))
    return float(browser.execute_script("return window.drawn - window.typed")) / 1000


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
        visit(browser, address, "?size=100&amplitude=1&gap=0")
        for speed in ("30", "3"):
            press(browser, speed)
            time.sleep(3)
            print(f"{frames(browser):.1f} frames a second at {speed} T per second", flush=True)
        until(lambda: column(browser, "exact density", "x"))
        found = [reaction(browser, amplitude) for amplitude in ("3", "5", "8", "10", "12")]
        print(f"{np.median(found):.2f} s from a number to the new theory", flush=True)
    with served() as address:
        rounds = []
        for _ in range(3):
            for _ in range(PAGES):
                open_and_close(address)
            rounds.append(memory(address))
            print(f"{rounds[-1]:.0f} MB after {PAGES * len(rounds)} pages", flush=True)
        print(f"{rounds[-1] - rounds[-2]:.1f} MB for the last {PAGES} pages")


if __name__ == "__main__":
    main()
