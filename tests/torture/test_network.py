"""Nothing at run time asks the network for anything, and no page that is written does.

A hook in every Python process, workers included, takes down each connection, datagram and look-up
of a name that goes beyond the loopback address, and refuses it.
"""

import json
import os
import re
import signal
import subprocess
import sys

import pytest

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
cb.load(cb.save(cb.simulate(chain, duration=100.0), "run.nc"))
cb.equilibrium(chain), cb.force_balance(chain)
cb.steady_state(chain.replace(restitution=0.95))
"""


@pytest.fixture
def guarded(tmp_path):
    """Return a function that runs Python in a folder, and afterwards see that nothing was asked."""
    site, log, folder = tmp_path / "site", tmp_path / "log", tmp_path / "work"
    site.mkdir()
    folder.mkdir()
    (site / "sitecustomize.py").write_text(GUARD)
    log.touch()
    environment = {**os.environ, "PYTHONPATH": str(site), "NETWORK_LOG": str(log)}

    def start(*arguments, **options):
        command = [sys.executable, *arguments]
        return subprocess.Popen(command, cwd=folder, env=environment, text=True, **options)

    start.log, start.folder = log, folder
    yield start
    assert log.read_text() == ""


def run(start, *arguments):
    process = start(*arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    output, errors = process.communicate(timeout=600)
    assert process.returncode == 0, errors
    return output


def test_the_guard_refuses_what_is_asked(guarded):
    attempt = "import socket; socket.create_connection(('192.0.2.1', 80), 5)"
    done = guarded("-c", attempt, stderr=subprocess.PIPE)
    assert "OSError: no network" in done.communicate(timeout=600)[1]
    assert guarded.log.read_text().startswith("socket.getaddrinfo 192.0.2.1")
    guarded.log.write_text("")


def test_every_module_and_the_python_interface(guarded):
    run(guarded, "-c", PYTHON)
    assert (guarded.folder / "run.nc").exists()


COMMANDS = """
compare --size 10 --duration 1000 --amplitude 1,5
theory --size 10 --restitution 0.95
relax --size 10 --duration 4 --replicas 8 --film
reproduce arctanh --processes 2
sweep grid.toml --processes 2
"""


@pytest.mark.parametrize("line", COMMANDS.strip().splitlines())
def test_every_command(guarded, line):
    (guarded.folder / "grid.toml").write_text(SWEEP)
    run(guarded, "-c", MAIN, *line.split(), "--output", "o")
    assert list((guarded.folder / "o").rglob("*.*"))
    for page in guarded.folder.rglob("*.html"):
        assert loaded(page.read_text()) == []


def loaded(page):
    """Return the addresses on other hosts that a browser loads of a page by itself."""
    return re.findall(r"""\w+://[^\s"'`)<]+|["'(=]//\w[^\s"'`)]+""", page)


def test_the_page_loads_from_its_own_server(guarded):
    script = f"import sys; sys.argv[1:] = ['explore', '--no-browser', '--port', '0']; {MAIN}"
    reader = f"""
import json, subprocess, sys
from urllib.request import ProxyHandler, build_opener
page = subprocess.Popen([sys.executable, "-c", {script!r}], stdout=subprocess.PIPE, text=True)
address = page.stdout.readline().split()[0]
answer = build_opener(ProxyHandler({{}})).open(address, timeout=600).read().decode()
page.send_signal({int(signal.SIGINT)})
assert page.wait(600) == -{int(signal.SIGINT)}
print(json.dumps(answer))
"""
    answer = json.loads(run(guarded, "-c", reader))
    assert "_static/controls.js" in answer
    assert loaded(answer) == []
