"""Serve the page on the loopback address.

Other machines and other sites in the browser could reach an open port. The server therefore
listens on the loopback address unless a flag allows another one, accepts websockets only from
pages it served, and answers requests under another host name with the right address.
"""

from __future__ import annotations

import ipaddress
import logging
import os
import re
import socket
import sys
import webbrowser
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Lock

import panel as pn
from bokeh.server.server import Server
from bokeh.settings import settings
from tornado.web import RequestHandler
from tornado.websocket import WebSocketClosedError

from crazybilliards.apps.explore.layout import NOTEBOOKS, prepare
from crazybilliards.apps.explore.page import make_page
from crazybilliards.apps.explore.session import Session
from crazybilliards.model import Chain
from crazybilliards.model.process import announced


def serve(
    port: int, address: str, *, open_browser: bool = False, open_to_network: bool = False
) -> None:
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
    open_to_network
        Whether the address may be one that other machines reach.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C.
    ValueError
        If the address is not one of this machine, if it stands for all addresses, if it needs
        ``open_to_network``, or if the port is taken. The port is not opened in these cases.
    """
    address = address.lower()  # as browsers name it
    number = _look_up(address)
    if not number.is_loopback and not open_to_network:
        raise ValueError(
            f"other machines reach address {address}, and the page asks for no password: if that "
            "is meant, add --open-to-network"
        )
    port = _free_port(address, str(number), port)
    if not number.is_loopback:
        print(
            f"crazybilliards: warning: anybody who can reach {address} can open the page and use "
            "this machine's processor; the page asks for no password",
            file=sys.stderr,
        )
    with announced(True):
        Session(Chain(size=2)).advance(1.0)
    prepare()
    _expect_closed_pages()
    turn = Lock()
    with ThreadPoolExecutor(1) as threads:

        def new_page() -> pn.viewable.Viewable:  # Panel calls functions only, no partial()
            return make_page(threads, turn)

        server = _make_server(new_page, address, str(number), port)
        server.start()
        url = f"http://{address}:{port}/"
        print(f"{url}  (Ctrl-C ends it)", flush=True)
        if open_browser:
            webbrowser.open(url)
        server.io_loop.start()  # until Ctrl-C, which Panel has made stop it
        raise KeyboardInterrupt


def _make_server(
    new_page: Callable[[], pn.viewable.Viewable], address: str, number: str, port: int
) -> Server:
    """Return a server that answers only under these two names of its address."""
    origins = [f"{name}:{port}" for name in (address, number)]
    settings.allowed_ws_origin.set_value(origins)  # whatever BOKEH_ALLOW_WS_ORIGIN says
    server = pn.serve(
        {"/": new_page},
        port=port,
        address=number,
        websocket_origin=origins,
        title="crazybilliards explore",
        show=False,
        start=False,
        verbose=False,
        static_dirs={"notebooks": str(NOTEBOOKS)} if NOTEBOOKS.is_dir() else {},
    )
    others = f"(?!({re.escape(address)}|{re.escape(number)})$).*"
    refusal = (".*", _WrongName, {"url": f"http://{address}:{port}/"})
    # Neither Panel nor Bokeh has a public way to their tornado application.
    server._tornado.add_handlers(others, [refusal])
    return server


def _expect_closed_pages() -> None:
    """Silence errors about frames that were sent to a closed page."""

    def worth_saying(record: logging.LogRecord) -> bool:
        return not (record.exc_info and isinstance(record.exc_info[1], WebSocketClosedError))

    logging.getLogger("asyncio").addFilter(worth_saying)
    logging.getLogger("bokeh.server.views.ws").setLevel(logging.ERROR)


class _WrongName(RequestHandler):
    """Tell a client that used another host name where the page is."""

    def initialize(self, url: str) -> None:
        self._url = url

    def prepare(self) -> None:
        self.set_status(421)
        self.set_header("Content-Type", "text/plain")
        self.finish(f"The page answers only at {self._url}\n")


def _look_up(address: str) -> ipaddress.IPv4Address:
    """Return the address as a number."""
    try:
        number = ipaddress.IPv4Address(socket.gethostbyname(address))
    except (OSError, UnicodeError) as error:
        raise ValueError(
            f"cannot serve at {address} (an IPv4 address or a name is needed): {error}"
        ) from error
    if number.is_unspecified:
        raise ValueError(
            f"address must be one address of this machine, got {address!r}, which is all of them"
        )
    return number


def _free_port(address: str, number: str, port: int) -> int:
    """Return the port, or a free one for 0; raise if it cannot be bound."""
    if not 0 <= port <= 65535:
        raise ValueError(f"port must be between 0 and 65535, got {port}")
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        if os.name == "posix":
            # As the server does: a port that was served a minute ago is not taken.
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((number, port))
        except OSError as error:
            raise ValueError(f"cannot serve at {address}:{port}: {error.strerror}") from error
        return int(probe.getsockname()[1])
