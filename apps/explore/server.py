"""Serve the page of ``crazybilliards explore``, and the theory of its chain on request.

Other machines, and other sites in the same browser, could reach an open port. The server therefore
listens on the loopback address unless a flag allows another one, and answers only under names of
this machine and those that the user added, under any port, which may have been forwarded. Theories
are solved for the page alone, one at a time: a page of another site cannot send its header. A fixed
list of files is served, nothing is written, and nothing is kept of a visitor.
"""

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
from threading import Lock, Thread
from typing import Any

_KINDS = {"css": "text/css", "js": "text/javascript"}
_TURN = Lock()  # one theory is solved at a time, for all pages
_PATIENCE = 60  # s that a visitor waits for the theories of others
_LOCAL = frozenset({"localhost", "127.0.0.1", "[::1]"})
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
    folder = files("crazybilliards.apps.explore") / "page"
    chain = (folder / "chain.html").read_text("utf-8")
    chain = chain.replace('id="chain"', 'id="chain" data-theory="theory"')
    page = (folder / "around.html").read_text("utf-8").replace("<!-- chain -->", chain)
    contents = {"/": ("text/html; charset=utf-8", page.encode())}
    for file in folder.iterdir():
        if file.name[0] != "." and (kind := _KINDS.get(file.name.rpartition(".")[2])):
            contents[f"/_static/{file.name}"] = f"{kind}; charset=utf-8", file.read_bytes()
    return contents


def _without_port(host: str) -> str:
    return re.sub(r":\d{1,5}$", "", host.lower())


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
        path, _, query = self.path.partition("?")
        if _without_port(",".join(self.headers.get_all("Host", []))) not in self._names:
            self._send_text(
                HTTPStatus.MISDIRECTED_REQUEST,
                "The page answers under the name localhost. For it to answer under the name of "
                "your hub, start it with: crazybilliards explore --allow-host NAME",
            )
        elif path == "/theory":
            self._send_theory(query)
        elif path in _contents():
            self._send(HTTPStatus.OK, *_contents()[path])
        else:
            self._send_text(HTTPStatus.NOT_FOUND, "Nothing is here.")

    def _send_theory(self, query: str) -> None:
        sender = self.headers.get("X-Requested-With"), self.headers.get("Sec-Fetch-Site")
        if sender not in (("chain", "same-origin"), ("chain", None)):
            self._send_text(HTTPStatus.FORBIDDEN, "Theories are solved for the page only.")
            return
        from crazybilliards.apps.explore.theory import answer  # the page comes before its imports

        found = {"refused": "the theories of others are being solved"}
        if _TURN.acquire(timeout=_PATIENCE):
            try:
                if self._is_gone():
                    self.close_connection = True
                    return
                found = answer(query)
            finally:
                _TURN.release()
        self._send(HTTPStatus.OK, "application/json", json.dumps(found).encode())

    def _is_gone(self) -> bool:
        """Return whether the browser has closed the connection."""
        with selectors.DefaultSelector() as selector:
            selector.register(self.connection, selectors.EVENT_READ)
            return bool(selector.select(0)) and not self.connection.recv(1, socket.MSG_PEEK)

    def _send_text(self, status: HTTPStatus, text: str) -> None:
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
    of a hub that forwards requests. A ValueError says why it cannot be served at the address.
    """
    try:
        number = ipaddress.IPv4Address(socket.gethostbyname(address))
        if number.is_unspecified:
            raise ValueError("it stands for all addresses of this machine")
        if not number.is_loopback and not open_to_network:
            raise ValueError(
                "other machines reach it, and the page asks for no password: if that is meant, "
                "add --open-to-network"
            )
        names = _LOCAL | {_without_port(name) for name in (address, str(number), *hosts)}
        server = _Server((str(number), port), partial(_Handler, names))
    except (OSError, ValueError) as error:
        raise ValueError(f"cannot serve at {address}:{port}: {error}") from error
    if not number.is_loopback:
        print(
            f"crazybilliards: warning: whoever reaches {address} can use this machine's processor; "
            "there is no password",
            file=sys.stderr,
        )
    with server:
        url = f"http://{address.lower()}:{server.server_port}/"
        print(f"{url}  (Ctrl-C ends it)", flush=True)
        if open_browser:
            # Some browsers return when they are closed, and the page must be served before.
            Thread(target=webbrowser.open, args=(url,), daemon=True).start()
        server.serve_forever()
