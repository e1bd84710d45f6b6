"""Who may open the page of ``crazybilliards explore``, and what is refused."""

import socket
import subprocess
from concurrent.futures import ThreadPoolExecutor
from http.client import HTTPConnection
from select import select

import psutil
import pytest
from browser import COMMAND, until

from crazybilliards.apps.explore.server import serve

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
    answer = connection.getresponse()
    assert "default-src 'self'" in answer.headers["Content-Security-Policy"]
    text = answer.read().decode()
    connection.close()
    return answer.status, text


def ask(address):
    """Return the connection of a visitor who waits for a theory that takes long."""
    visitor = socket.create_connection(("127.0.0.1", port_of(address)))
    visitor.sendall(b"GET /theory?size=200&restitution=0 HTTP/1.1\r\nHost: localhost\r\n")
    visitor.sendall(b"X-Requested-With: chain\r\n\r\n")
    return visitor


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"address": "192.0.2.1"}, "add --open-to-network"),
        ({"hosts": ["hub:80"]}, "must be a name without a port"),
        ({"port": 65536}, "port must be between 0 and 65535"),
        *(({"address": name}, "all of them") for name in ("0.0.0.0", "0", "")),
        *(({"address": name}, "cannot serve at") for name in ("::1", "no name", "a" * 70)),
    ],
)
def test_a_wrong_call_is_refused_in_one_line(arguments, said):
    with pytest.raises(ValueError, match=said) as refused:
        serve(**{"port": 0, "address": "127.0.0.1"} | arguments)
    assert "\n" not in str(refused.value)


def test_a_port_that_is_taken_is_refused(address):
    with pytest.raises(ValueError, match=r"cannot serve at 127\.0\.0\.1"):
        serve(port_of(address), "127.0.0.1")


@pytest.mark.parametrize(
    ("host", "status"),
    [
        *((name, 200) for name in ("localhost", "LocalHost:1", "127.0.0.1:6099", "[::1]:5006")),
        *((name, 421) for name in ("hub.org:80", "localhost.evil.org", "127.0.0.2", "localhost.")),
        *((name, 400) for name in ("", "a b", "localhost:x", "localhost, evil.org", "<b>")),
    ],
)
def test_only_names_of_this_machine_are_answered_under_any_port(address, host, status):
    assert get(address, host=host)[0] == status
    if status == 421:
        refused = get(address, "/theory?size=3", host, **THEORY)
        assert refused == get(address, "/_static/chain.css", host)
        assert refused[1].count("\n") == 1
        assert f"--allow-host {host.partition(':')[0]}" in refused[1]
        assert f"http://localhost{':80' if ':80' in host else ''}/ " in refused[1]


@pytest.mark.parametrize("path", ["/server.py", "/_static/../server.py", "/_static/around.html"])
def test_nothing_else_is_served(address, path):
    assert get(address, path) == (404, "Nothing is here.\n")
    assert get(address, "//[")[0] == get(address, f"/%2e%2e{path}")[0] == 404
    assert get(address, method="POST")[0] == get(address, method="HEAD")[0] == 501
    assert get(address, "/" + "a" * 70_000)[0] == 414


@pytest.mark.parametrize("headers", [{}, {"X-Requested-With": "chain", "Sec-Fetch-Site": "none"}])
def test_theories_are_for_the_page_alone(address, headers):
    assert get(address, "/theory?size=3", **headers)[0] == 403
    for query, said in (("size=x", "a number"), ("size=201", "at most 200"), ("os=1", "none of")):
        assert said in get(address, f"/theory?{query}", **THEORY)[1]


@pytest.mark.validate
def test_a_hundred_at_once_wait_or_are_refused_and_leave_nothing_behind(address, solvers):
    """Visitors go before they are answered, and no process computes for them any more."""
    waiting = [ask(address) for _ in range(100)]
    with ThreadPoolExecutor(20) as threads:
        assert set(threads.map(lambda _: get(address)[0], range(100))) == {200}
    answered = []
    until(lambda: answered.extend(select(waiting, [], [], 0)[0]) or len(set(answered)) == 90, 60)
    assert all(each.recv(4096).startswith(b"HTTP/1.1 503 ") for each in set(answered))
    for each in waiting:
        each.close()
    until(lambda: not solvers(), 10)
    assert get(address)[0] == 200


def test_a_body_is_no_second_request(address):
    with socket.create_connection(("127.0.0.1", port_of(address))) as visitor:
        visitor.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\nGET / HT\n")
        answer = b"".join(iter(lambda: visitor.recv(65536), b""))
    assert answer.count(b"HTTP/1.1 ") == 1


@pytest.mark.validate
def test_a_killed_server_takes_its_solver_along():
    """Nobody is left who could end it."""
    command = [*COMMAND, "explore", "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        visitor = ask(server.stdout.readline().split()[0])
        children = psutil.Process(server.pid).children
        until(lambda: len(children()) > 1, 60)  # the solver, and one that tracks resources
        solvers = children()
        server.kill()
        until(lambda: not any(each.is_running() for each in solvers), 30)
        visitor.close()
