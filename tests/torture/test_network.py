"""Nothing at run time asks the network for anything, and no page that is written does.

A hook in every Python process, workers included, takes down each connection, datagram and look-up
of a name that goes beyond the loopback address, and refuses it.
"""

import re
import sys

import pytest
from installation import run

# Python imports this by itself at every start. Addresses: a name or (name or address, port, ...).
GUARD = """
import os, socket, sys

ASKING = {
    "socket.connect": 1, "socket.sendto": 1, "socket.sendmsg": 1,
    "socket.getaddrinfo": 0, "socket.gethostbyname": 0, "socket.gethostbyaddr": 0,
}

HERE = (None, "", "localhost", b"localhost", "127.0.0.1", "::1", socket.gethostname())

def guard(event, arguments):
    if event not in ASKING:
        return
    address = arguments[ASKING[event]]
    if isinstance(address, tuple):
        address = address[0]
    elif ASKING[event]:
        return  # a Unix socket
    if address not in HERE:
        with open(os.environ["NETWORK_LOG"], "a") as log:
            log.write(f"{event} {address} {sys.argv}\\n")
        raise OSError(f"no network: {event} {address}")

sys.addaudithook(guard)
"""
MAIN = "from crazybilliards.apps.commands.line import main; main()"
SWEEP = """
[grid]
restitution = [0.9, 1.0]
[chain]
size = 10
[simulate]
duration = 100
"""
PYTHON = """
import importlib, pkgutil
for room in ("model", "particles", "kinetic", "comparison", "reproduction", "apps"):
    package = importlib.import_module(f"crazybilliards.{room}")
    for info in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        importlib.import_module(info.name)
import crazybilliards as cb
chain = cb.Chain(size=10)
cb.load(cb.save(cb.simulate(chain, duration=100.0), "o/run.nc"))
cb.equilibrium(chain), cb.force_balance(chain)
cb.steady_state(chain.replace(restitution=0.95))
"""
PAGE = f"""
import signal, subprocess, sys
from urllib.request import ProxyHandler, build_opener
script = "import sys; sys.argv[1:] = ['explore', '--no-browser', '--port', '0']; {MAIN}"
page = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
address = page.stdout.readline().split()[0]
answer = build_opener(ProxyHandler({{}})).open(address, timeout=600).read().decode()
page.send_signal(signal.SIGINT)
assert page.wait(600) == -signal.SIGINT
assert '_static/controls.js' in answer
open('o/page.html', 'w').write(answer)
"""
COMMANDS = """
compare --size 10 --duration 1000 --amplitude 1,5
theory --size 10 --restitution 0.95
relax --size 10 --duration 4 --replicas 8 --film
reproduce arctanh --processes 2
sweep grid.toml --processes 2
"""
LINES = [f"{line} --output o".split() for line in COMMANDS.strip().splitlines()]
CALLS = {line[0]: (MAIN, *line) for line in LINES}
CALLS |= {"every module": (PYTHON,), "explore": (PAGE,)}


@pytest.fixture
def guarded(tmp_path, monkeypatch):
    """Return what runs a script in a folder, and tells what it asked of the network."""
    (tmp_path / "sitecustomize.py").write_text(GUARD)
    log = tmp_path / "log"
    log.touch()
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setenv("NETWORK_LOG", str(log))

    def guarded(*words):
        run(sys.executable, "-c", *words, cwd=tmp_path)
        return log.read_text()

    return guarded


def test_the_guard_refuses_what_is_asked(guarded):
    attempt = "with suppress(OSError): socket.create_connection(('192.0.2.1', 80), 5)"
    asked = guarded(f"import socket; from contextlib import suppress\n{attempt}")
    assert asked.startswith("socket.getaddrinfo 192.0.2.1")


@pytest.mark.parametrize("name", CALLS)
def test_nothing_is_asked_of_the_network(name, guarded, tmp_path):
    """Nor by a browser that shows what was written."""
    results = tmp_path / "o"
    results.mkdir()
    (tmp_path / "grid.toml").write_text(SWEEP)
    assert guarded(*CALLS[name]) == ""
    assert list(results.rglob("*.*"))
    for page in results.rglob("*.html"):
        assert loaded(page.read_text()) == []


def loaded(page):
    """Return the addresses on other hosts that a browser loads of a page by itself."""
    return re.findall(r"""\w+://[^\s"'`)<]+|["'(=]//\w[^\s"'`)]+""", page)
