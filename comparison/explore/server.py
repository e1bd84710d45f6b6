"""Serving the page: on the loopback address, to pages that came from there."""

from __future__ import annotations

import ipaddress
import logging
import os
import socket
import webbrowser
from concurrent.futures import ThreadPoolExecutor

import panel as pn
from tornado.websocket import WebSocketClosedError

from crazybilliards.comparison.explore.page import page
from crazybilliards.comparison.explore.session import Session
from crazybilliards.comparison.sweeps import process_pool
from crazybilliards.model import Chain
from crazybilliards.particles.running import announced


def is_loopback(address: str) -> bool:
    """Whether nobody but this machine reaches an address."""
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return address == "localhost"


def serve(port: int, address: str, *, open_browser: bool) -> None:
    """Serve the page until Ctrl-C.

    Parameters
    ----------
    port
        0 to 65535; 0: any that is free.
    address
        An IPv4 address or a name of this machine. Only pages loaded from this very address may
        open the websocket, so that no other site in the same browser can.
    open_browser
        Whether to open the page.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C.
    ValueError
        If there is no such address here, it stands for all of them, or the port is taken.
    """
    _check_address(address)
    port = _free_port(address, port)
    with announced(True):
        Session(Chain(size=2)).advance(1.0)
    pn.extension()
    _expect_closed_pages()
    # Interrupted, process_pool kills a computation under way; a thread's takes a moment only.
    with ThreadPoolExecutor(1) as threads, process_pool(1) as processes:

        def new_page() -> pn.viewable.Viewable:  # Panel calls functions only, no partial()
            return page(threads, processes)

        server = pn.serve(
            {"/": new_page},
            port=port,
            address=address,
            websocket_origin=[f"{address}:{port}"],
            title="crazybilliards explore",
            show=False,
            start=False,
            verbose=False,
        )
        server.start()
        url = f"http://{address}:{port}/"
        print(f"{url}  (Ctrl-C ends it)", flush=True)
        if open_browser:
            webbrowser.open(url)
        server.io_loop.start()  # until Ctrl-C, which Panel has made stop it
        raise KeyboardInterrupt


def _expect_closed_pages() -> None:
    """Do not report that a frame was not delivered: somebody has closed the page."""

    def worth_saying(record: logging.LogRecord) -> bool:
        return not (record.exc_info and isinstance(record.exc_info[1], WebSocketClosedError))

    logging.getLogger("asyncio").addFilter(worth_saying)
    logging.getLogger("bokeh.server.views.ws").setLevel(logging.ERROR)


def _check_address(address: str) -> None:
    try:
        known = ipaddress.ip_address(address)
    except ValueError:
        return
    if known.version != 4:
        raise ValueError(f"address must be an IPv4 address or a name, got {address}")
    if known.is_unspecified:
        raise ValueError(
            f"address must be one address of this machine, got {address}, which is all of them"
        )


def _free_port(address: str, port: int) -> int:
    """Return the port, or a free one for 0; raise if it cannot be bound."""
    if not 0 <= port <= 65535:
        raise ValueError(f"port must be between 0 and 65535, got {port}")
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        if os.name == "posix":
            # As the server does: a port that was served a minute ago is not taken.
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((address, port))
        except OSError as error:
            raise ValueError(f"cannot serve at {address}:{port}: {error.strerror}") from error
        return int(probe.getsockname()[1])
