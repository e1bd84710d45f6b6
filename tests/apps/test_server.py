"""Who may open the page of ``crazybilliards explore``, and which theories its server solves."""

import re
import socket
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from http.client import HTTPConnection

import pytest

from crazybilliards.apps.explore import server, theory
from crazybilliards.apps.explore.server import serve
from crazybilliards.comparison.stationary_theories import THEORIES

THEORY = {"X-Requested-With": "chain", "Sec-Fetch-Site": "same-origin"}


def port_of(address):
    return int(address.rstrip("/").rpartition(":")[2])


def get(address, path="/", host="localhost", method="GET", **headers):
    """Return status and text of the answer to a request under a host's name."""
    connection = HTTPConnection("127.0.0.1", port_of(address), timeout=300)
    connection.putrequest(method, path, skip_host=True)
    for name, value in {"Host": host, **headers}.items():
        connection.putheader(name, value)
    connection.endheaders()
    response = connection.getresponse()
    assert "default-src 'self'" in response.headers["Content-Security-Policy"]
    text = response.read().decode()
    connection.close()
    return response.status, text


def ask(address):
    """Return the connection of a visitor who waits for a theory that takes long."""
    visitor = socket.create_connection(("127.0.0.1", port_of(address)))
    visitor.sendall(b"GET /theory?size=200&restitution=0 HTTP/1.1\r\nHost: localhost\r\n")
    visitor.sendall(b"X-Requested-With: chain\r\n\r\n")
    return visitor


def test_an_open_or_impossible_address_and_a_port_that_is_taken_are_refused(address):
    for port, name, reason in (
        (0, "192.0.2.1", "add --open-to-network"),
        (0, "0.0.0.0", "all addresses"),
        (0, "", "all addresses"),
        (0, "::1", "cannot serve at"),
        (0, "no name", "cannot serve at"),
        (port_of(address), "127.0.0.1", r"cannot serve at 127\.0\.0\.1"),
    ):
        with pytest.raises(ValueError, match=reason):
            serve(port, name)


@pytest.mark.parametrize(
    ("host", "status"),
    [
        *((name, 200) for name in ("localhost", "LocalHost:1", "127.0.0.1:6099", "[::1]:5006")),
        *((name, 421) for name in ("hub.org:80", "localhost.evil.org", "127.0.0.2", "localhost.")),
        *((name, 421) for name in ("", "a b", "localhost:x", "localhost, evil.org", "<b>")),
    ],
)
def test_only_names_of_this_machine_are_answered_under_any_port(address, host, status):
    assert get(address, host=host)[0] == status
    if status == 421:
        assert "--allow-host" in get(address, "/_static/chain.css", host)[1]
        assert get(address, "/theory?size=3", host, **THEORY)[0] == 421


@pytest.mark.parametrize("path", ["/server.py", "/_static/../server.py", "/_static/around.html"])
def test_nothing_else_is_served(address, path):
    assert get(address, path) == (404, "Nothing is here.\n")
    assert get(address, "//[")[0] == get(address, f"/%2e%2e{path}")[0] == 404
    assert get(address, method="POST")[0] == get(address, method="HEAD")[0] == 501
    assert get(address, "/" + "a" * 70_000)[0] == 414


def test_theories_are_for_the_page_alone_and_for_its_chains(address):
    for headers in ({}, THEORY | {"Sec-Fetch-Site": "none"}):
        assert get(address, "/theory?size=3", **headers)[0] == 403
    for query in ("size=x", "size=201", "size=", "os=1", "radius=2"):
        assert list(theory.answer(query)) == ["refused"]


def require_words(answer, said):
    """Check that a class understands why there is no theory."""
    assert answer["refused"].startswith(said)
    assert not re.search(r"--|_|\bcells\b|Python|simulate|iteration", answer["refused"])


@pytest.mark.parametrize(
    ("chain", "said"),
    [
        ("size=40&restitution=1.05", "by the theory its energy grows without bound"),
        ("size=40&restitution=1.05&amplitude=0", "without noise there is no steady"),
        ("size=20&restitution=1.02", None),
        ("size=30&restitution=0&damping=0.3&gap=0.5", None),
        ("size=1&restitution=0.9&spring=quadratic", None),
    ],
)
def test_energy_grows_only_if_the_solver_has_found_so(chain, said):
    answer = theory.answer(chain)
    assert list(answer) == (["refused"] if said else ["best"])
    if said:
        require_words(answer, said)


def test_what_could_not_be_solved_is_not_said_to_run_away(monkeypatch):
    def fail(chain):
        raise ValueError("no agreement after 60 iterations")

    failing = replace(THEORIES["steady_state"], solve=fail)
    monkeypatch.setitem(THEORIES, "steady_state", failing)
    said = "its equations could not be solved for this chain; fewer rods"
    require_words(theory.answer("restitution=1.05&gap=0.5"), said)


def test_a_body_is_no_second_request(address):
    with socket.create_connection(("127.0.0.1", port_of(address))) as visitor:
        visitor.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\nGET / HT\n")
        text = b"".join(iter(lambda: visitor.recv(65536), b""))
    assert text.count(b"HTTP/1.1 ") == 1


@pytest.mark.validate
def test_a_hundred_wait_for_one_theory_and_the_page_is_served_meanwhile(address):
    """Nothing is computed for visitors that have gone."""
    visitors = [ask(address) for _ in range(100)]
    with ThreadPoolExecutor(20) as threads:
        assert set(threads.map(lambda _: get(address)[0], range(100))) == {200}
    for visitor in visitors:
        visitor.close()
    assert "best" in get(address, "/theory?size=3", **THEORY)[1]


def test_a_visitor_does_not_wait_for_ever_for_the_theories_of_others(monkeypatch):
    monkeypatch.setattr(server, "_PATIENCE", 0.1)
    visited = server._Server(("127.0.0.1", 0), partial(server._Handler, server._LOCAL))
    with server._TURN, visited, ThreadPoolExecutor(1) as threads:
        threads.submit(visited.serve_forever)
        answer = get(f"http://localhost:{visited.server_port}/", "/theory?size=3", **THEORY)[1]
        visited.shutdown()
    assert "of others" in answer
