"""Serve the page of ``crazybilliards explore``, and the theory of its chain on request.

Other machines, and other sites in the same browser, could reach an open port. The server therefore
listens on the loopback address unless a flag allows another one, and answers only under names of
this machine and those that it was given, under any port, which may have been forwarded. Theories
are solved for the page alone: a page of another site cannot send its header. A fixed list of files
is served, nothing is written, and nothing is kept of a visitor.
"""

from __future__ import annotations

import ipaddress
import json
import re
import selectors
import socket
import sys
import webbrowser
from collections.abc import Collection
from functools import cache, partial
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from threading import Thread
from typing import Any
from urllib.parse import parse_qsl, urlsplit

from crazybilliards.apps.explore.theory import solve
from crazybilliards.model.checks import shown

_PAGE = files("crazybilliards.apps.explore") / "page"
_KINDS = {"css": "text/css", "js": "text/javascript"}
_LOCAL = frozenset({"localhost", "127.0.0.1", "[::1]"})
_NAME = re.compile(r"(\[[0-9a-f:.]+\]|[a-z0-9._-]+)(:\d{1,5})?")
_HEADERS = {
    "Content-Security-Policy": "default-src 'self'; img-src 'self' data:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'; object-src 'none'",
    "X-Content-Type-Options": "nosniff",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}


@cache
def _contents() -> dict[str, tuple[str, bytes]]:
    """Return the kind and the content of everything that is served, by its path."""
    chain = (_PAGE / "chain.html").read_text("utf-8")
    chain = chain.replace('id="chain"', 'id="chain" data-theory="theory"')
    page = (_PAGE / "around.html").read_text("utf-8").replace("<!-- chain -->", chain)
    served = {"/": ("text/html; charset=utf-8", page.encode())}
    for each in _PAGE.iterdir():
        if kind := _KINDS.get(each.name.rpartition(".")[2]):
            served[f"/_static/{each.name}"] = f"{kind}; charset=utf-8", each.read_bytes()
    return served


class _Handler(BaseHTTPRequestHandler):
    """Answer one visitor; ``names`` are the hosts under which it answers."""

    protocol_version = "HTTP/1.1"
    timeout = 30  # s that a visitor may be silent
    disable_nagle_algorithm = True  # the content follows the headers without a wait of 40 ms
    server_version, sys_version = "crazybilliards", ""

    def __init__(self, names: Collection[str], *arguments: Any) -> None:
        self._names = names
        super().__init__(*arguments)

    def do_GET(self) -> None:
        """Send the page, a file of it, or a theory."""
        if "Content-Length" in self.headers or "Transfer-Encoding" in self.headers:
            self.close_connection = True  # nobody reads a body, which is no second request
        if not self._is_named_rightly():
            return
        try:
            path, query = urlsplit(self.path)[2:4]
        except ValueError:
            path = query = ""
        if path == "/theory":
            self._send_theory(query)
        elif path in _contents():
            self._send(HTTPStatus.OK, *_contents()[path])
        else:
            self._say(HTTPStatus.NOT_FOUND, "Nothing is here.")

    def _is_named_rightly(self) -> bool:
        """Return whether the request names a host that is answered; otherwise say which ones."""
        named = _NAME.fullmatch(",".join(self.headers.get_all("Host", [])).lower())
        if named is None:
            self._say(HTTPStatus.BAD_REQUEST, "The request does not name one host.")
            return False
        if named[1] in self._names:
            return True
        self._say(
            HTTPStatus.MISDIRECTED_REQUEST,
            f"The page answers at http://localhost{named[2] or ''}/ and not under the name "
            f"{named[1]}. If that is the name of your hub, start it with: crazybilliards "
            f"explore --allow-host {named[1]}",
        )
        return False

    def _send_theory(self, query: str) -> None:
        sender = self.headers.get("X-Requested-With"), self.headers.get("Sec-Fetch-Site")
        if sender not in (("chain", "same-origin"), ("chain", None)):
            self._say(HTTPStatus.FORBIDDEN, "Theories are solved for the page only.")
            return
        answer = solve(dict(parse_qsl(query, keep_blank_values=True)), self._is_gone)
        if answer is None:
            self.close_connection = True  # nobody waits for it
        else:
            busy = answer.pop("busy", False)
            status = HTTPStatus.SERVICE_UNAVAILABLE if busy else HTTPStatus.OK
            self._send(status, "application/json", json.dumps(answer).encode())

    def _is_gone(self) -> bool:
        """Return whether the browser has closed the connection."""
        with selectors.DefaultSelector() as looking:
            looking.register(self.connection, selectors.EVENT_READ)
            return bool(looking.select(0)) and not self.connection.recv(1, socket.MSG_PEEK)

    def _say(self, status: HTTPStatus, text: str) -> None:
        self._send(status, "text/plain", f"{text}\n".encode())

    def _send(self, status: HTTPStatus, kind: str, content: bytes) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def end_headers(self) -> None:
        """Send the headers that every answer has, errors too."""
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def log_message(self, *_: object) -> None:
        """Print nothing."""


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 128

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print nothing of visitors that have gone; other errors are shown."""
        if not isinstance(sys.exception(), OSError):
            super().handle_error(request, client_address)


def serve(
    port: int,
    address: str,
    open_browser: bool = False,
    open_to_network: bool = False,
    hosts: Collection[str] = (),
) -> None:
    """Serve the page until Ctrl-C, which raises KeyboardInterrupt; port 0 is any that is free.

    ``address`` is an IPv4 address or a name of this machine, which other machines may reach only if
    it is ``open_to_network``. ``hosts`` are more names under which the page answers, such as that
    of a hub that forwards requests. A ValueError says which of them is impossible.
    """
    number = _look_up(address)
    if not 0 <= port <= 65535:
        raise ValueError(f"port must be between 0 and 65535, got {port}")
    for host in hosts:
        if not re.fullmatch(r"[a-zA-Z0-9._-]+", host):
            raise ValueError(f"allow-host must be a name without a port, got {shown(host)}")
    if not number.is_loopback and not open_to_network:
        raise ValueError(
            f"other machines reach {address}, and the page asks for no password: if that is meant, "
            "add --open-to-network"
        )
    names = _LOCAL | {name.lower() for name in (address, str(number), *hosts)}
    try:
        server = _Server((str(number), port), partial(_Handler, names))
    except OSError as error:
        raise ValueError(f"cannot serve at {address}:{port}: {error.strerror}") from error
    if not number.is_loopback:
        warning = (
            f"whoever reaches {address} can use this machine's processor; there is no password"
        )
        print(f"crazybilliards: warning: {warning}", file=sys.stderr)
    with server:
        url = f"http://{address.lower()}:{server.server_port}/"
        print(f"{url}  (Ctrl-C ends it)", flush=True)
        if open_browser:
            # Some browsers return when they are closed, and the page must be served before.
            Thread(target=webbrowser.open, args=(url,), daemon=True).start()
        server.serve_forever()


def _look_up(address: str) -> ipaddress.IPv4Address:
    """Return the address as a number."""
    try:
        number = ipaddress.IPv4Address(socket.gethostbyname(address))
    except (OSError, UnicodeError) as error:
        needed = "an IPv4 address or a name is needed"
        raise ValueError(f"cannot serve at {address} ({needed}): {error}") from error
    if number.is_unspecified:
        raise ValueError(f"address must be one of this machine, got {address!r}: all of them")
    return number
