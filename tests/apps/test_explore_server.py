"""Who may open the page of ``crazybilliards explore``, and what is refused before it is served."""

import asyncio
import os
import re
import signal
import socket
import subprocess
import sys
from http.client import HTTPConnection

import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from crazybilliards.apps.commands.line import main
from crazybilliards.apps.explore.server import serve

COMMAND = [sys.executable, "-c", "from crazybilliards.apps.commands.line import main; main()"]
EXPLORE = ["explore", "--no-browser"]


@pytest.fixture
def refusal(monkeypatch, capsys):
    """Return what calls the command and gives the one line with which it refuses."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["crazybilliards", *EXPLORE, *arguments])
        with pytest.raises(SystemExit) as done:
            main()
        assert done.value.code == 2
        printed, errors = capsys.readouterr()
        assert printed == ""
        [line] = errors.splitlines()
        return line

    return call


def test_another_address_takes_a_flag(refusal):
    assert "add --open-to-network" in refusal("--address", "192.0.2.1")


def test_a_port_that_is_taken_is_refused(refusal):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        line = refusal("--port", str(taken.getsockname()[1]))
    assert "cannot serve at 127.0.0.1" in line


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("0.0.0.0", "which is all of them"),
        ("0", "which is all of them"),
        ("", "which is all of them"),
        ("::1", "IPv4"),
        ("no name", "cannot serve at no name"),
        ("a" * 70, "cannot serve at aaa"),
        ("192.0.2.1", "cannot serve at 192.0.2.1"),
    ],
)
def test_impossible_addresses_are_refused_whatever_is_allowed(address, message):
    with pytest.raises(ValueError, match=message) as refused:
        serve(0, address, open_to_network=True)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("port", [-1, 65536])
def test_impossible_ports_are_refused(port):
    with pytest.raises(ValueError, match="port must be between"):
        serve(port, "127.0.0.1")


# -- who is answered ------------------------------------------------------------------------


@pytest.fixture(scope="module")
def port():
    """Serve the page on a loopback address, however Bokeh is told to let anybody in."""
    if os.name == "nt":
        pytest.skip("sends a POSIX signal")
    process = subprocess.Popen(
        [*COMMAND, *EXPLORE, "--port", "0", "--address", "LocalHost"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, "BOKEH_ALLOW_WS_ORIGIN": "*"},
    )
    try:
        yield int(re.match(r"http://localhost:(\d+)/", process.stdout.readline())[1])
        process.send_signal(signal.SIGINT)
        assert process.wait(300) == -signal.SIGINT
    finally:
        process.kill()
        process.stdout.close()


def get(port, host, path="/"):
    """Return status and text of the answer to a browser that was sent here by a host's name."""
    connection = HTTPConnection("127.0.0.1", port, timeout=300)
    connection.request("GET", path, headers={"Host": host})
    answer = connection.getresponse()
    text = answer.read().decode()
    connection.close()
    return answer.status, text


def first_message(port, origin):
    """Open the websocket of a new page as a page from ``origin`` would; return what comes first."""
    _, text = get(port, f"localhost:{port}")
    token = re.search(r'"token":"([^"]+)"', text)[1]
    request = HTTPRequest(f"ws://127.0.0.1:{port}/ws", headers={"Origin": origin})

    async def connect():
        socket = await websocket_connect(request, subprotocols=["bokeh", token])
        message = await asyncio.wait_for(socket.read_message(), 300)
        socket.close()
        while await socket.read_message() is not None:
            pass
        return message

    return asyncio.run(connect())


@pytest.mark.parametrize("name", ["localhost", "127.0.0.1"])
def test_pages_from_here_may_open_the_websocket(port, name):
    assert '"ACK"' in first_message(port, f"http://{name}:{port}")


@pytest.mark.parametrize(
    "origin",
    [
        "http://example.org",
        "http://example.org:{port}",
        "http://127.0.0.1.example.org:{port}",
        "http://127.0.0.1:1{port}",
        "null",
        "",
    ],
)
def test_pages_from_elsewhere_may_not(port, origin):
    with pytest.raises(HTTPClientError) as refused:
        first_message(port, origin.format(port=port))
    assert refused.value.code == 403


@pytest.mark.parametrize("host", ["example.org", "127.0.0.1.example.org", "127.0.0.2", "[::1]"])
@pytest.mark.parametrize("path", ["/", "/ws", "/autoload.js", "/static/js/bokeh.min.js"])
def test_a_foreign_name_that_points_here_gets_nothing_but_the_address(port, host, path):
    status, text = get(port, f"{host}:{port}", path)
    assert status == 421
    assert text == f"The page answers only at http://localhost:{port}/\n"


def test_only_loopback_listens(port):
    """No other address of this machine answers, whichever it has."""
    for *_, (address, *_) in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET):
        if not address.startswith("127."):
            with pytest.raises(ConnectionRefusedError):
                socket.create_connection((address, port), timeout=300)
