"""Jobs that are forked and killed, and what they leave in their folders.

Importing and compiling would take most of the time. So this process has done both, and each attempt
is a fork of it. Its workers are started anew. A job may become another program by ``os.execv``.
"""

import faulthandler
import os
import re
import signal
import sys
import time
import traceback
import warnings
from contextlib import suppress
from pathlib import Path

from crazybilliards.model import load
from crazybilliards.model.storage import read_sealed

PATIENCE = 300.0  # for what must come to an end; less than a test may take [s]
STATE = ("wchan", "cmdline")


def begin(job, folder):
    """Fork a process that does the job, in a session of its own; return its number."""
    folder.mkdir(parents=True, exist_ok=True)
    ready, begun = os.pipe()
    # The child has to be able to catch Ctrl-C before it may come.
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads: those of linear algebra
        child = os.fork()
    if child == 0:
        code = 70
        try:
            code = _attempt(job, folder, begun)
        except SystemExit as error:
            code = error.code or 0
        except KeyboardInterrupt:
            code = 130
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(code)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    os.close(begun)
    assert os.read(ready, 1) == b"!"
    os.close(ready)
    return child


def _attempt(job, folder, begun):
    os.setsid()
    log = os.open(folder.parent / "log.txt", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    for stream in (1, 2):
        os.dup2(log, stream)
    sys.stdout = sys.stderr = os.fdopen(log, "w", buffering=1)
    faulthandler.register(signal.SIGUSR1, file=log)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    os.write(begun, b"!")
    job(folder)
    return 0


def until(condition):
    """Wait for a condition to be true, for as long as a busy machine may take."""
    deadline = time.monotonic() + PATIENCE
    while not (found := condition()):
        assert time.monotonic() < deadline, "waited for too long"
        time.sleep(0.002)
    return found


def end(child, how=None, group=False):
    """Send it a signal; wait until it and all its workers are gone; return its exit status."""
    if how is not None:
        (os.killpg if group else os.kill)(child, how)
    try:
        status = until(lambda: (ended := os.waitpid(child, os.WNOHANG))[0] and ended)[1]
        until(lambda: not members(child))
    except AssertionError as error:
        error.add_note(_stop(child))
        raise
    return os.waitstatus_to_exitcode(status)


def _stop(session):
    """Kill what is left of a session; return what it waits for, and the stacks of its leader."""
    lines, left = [f"what is left of session {session}:"], members(session)
    for number in left:
        with suppress(OSError):  # it has just ended
            waits, words = ((Path(f"/proc/{number}") / each).read_text() for each in STATE)
            lines.append(f"{number} in {waits}: {' '.join(words.split(chr(0)))}")
    if session in left:
        os.kill(session, signal.SIGUSR1)
        time.sleep(1)
        lines.append(Path(f"/proc/{session}/fd/2").read_text())
    for number in left:
        with suppress(OSError):
            os.kill(number, signal.SIGKILL)
    return "\n".join(lines)


def members(session):
    """Return the living processes of a session."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            number, rest = path.read_text().split(" (", 1)
        except OSError:
            continue  # it has just ended
        state, _, _, own = rest.rpartition(") ")[2].split()[:4]
        if int(own) == session and state not in "ZX":
            found.append(int(number))
    return found


def contents(folder):
    """Read every file that counts as a result; raises if one is torn."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_dir() or (path.name[0] == "." and path.name.endswith((".part", ".lock"))):
            continue
        if path.suffix == ".nc":
            found[name] = load(path)
        else:
            content = read_sealed(path) if name == "state" else path.read_bytes()
            found[name] = re.sub(rb"\d+ s of computing", b"", content)
    return found


def require_same(found, undisturbed):
    """Compare whatever there is with an undisturbed run; what is interrupted says so."""
    for name, content in found.items():
        if "-interrupted" in name:
            assert name.endswith(".png") or content.attrs["status"] == "interrupted"
        elif name.endswith(".nc"):
            assert content.identical(undisturbed[name])
        elif name != "state":
            assert content == undisturbed[name], name
