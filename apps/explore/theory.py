"""The theory of a chain for the page, solved in a process of its own, one at a time."""

from __future__ import annotations

import json
import math
import signal
import sys
import time
import warnings
from collections.abc import Callable
from contextlib import suppress
from subprocess import PIPE, Popen, TimeoutExpired
from threading import Lock
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qsl

from crazybilliards.model.process import end_with_parent

if TYPE_CHECKING:
    from crazybilliards.comparison.stationary_theories import StationaryTheory
    from crazybilliards.model import Chain

_TURN = Lock()  # one computes at a time, for all pages
_PATIENCE = 120  # s that a theory may take, and that a visitor waits for the theories of others
_LOOK = 0.2  # s between two looks whether the visitor still waits
_MOST_RODS = 200  # of the page
_MOST_POINTS = 500  # of a curve
# Errors that a theory states, by what the page calls them.
_ERRORS = {"error": "velocity_width", "border": "border", "density_error": "density"}
_KINDS = {"size": int, "restitution": float, "amplitude": float, "damping": float, "gap": float}

Answer = dict[str, Any]


def solve(query: str, is_gone: Callable[[], bool]) -> Answer | None:
    """Return the :func:`answer` to a query from another process, None if the visitor is gone.

    The process is killed when the visitor goes, and when it takes too long.
    """
    if not _TURN.acquire(timeout=_PATIENCE):
        return {"refused": "the theories of others are being solved"}
    try:
        if is_gone():
            return None
        command = [sys.executable, "-m", "crazybilliards.apps.explore.theory", query]
        with Popen(command, stdout=PIPE) as process:
            try:
                return _wait_for(process, is_gone)
            finally:
                process.kill()
    finally:
        _TURN.release()


def _wait_for(process: Popen[bytes], is_gone: Callable[[], bool]) -> Answer | None:
    """Return what a process prints, None if the visitor goes before."""
    end = time.monotonic() + _PATIENCE
    while time.monotonic() < end:
        if is_gone():
            return None
        with suppress(TimeoutExpired):
            text, _ = process.communicate(timeout=_LOOK)
            ended: Answer = {"refused": "the computation ended without an answer"}
            return ended if process.returncode else json.loads(text)
    return {"refused": f"it takes longer than {_PATIENCE} s"}


def read(query: str) -> Chain:
    """Return the chain of a query; a TypeError or ValueError says what is wrong with it."""
    from crazybilliards.model import Chain

    texts = dict(parse_qsl(query, keep_blank_values=True))
    chain = Chain(**{name: _KINDS.get(name, str)(text) for name, text in texts.items()})
    if chain.size > _MOST_RODS:
        raise ValueError(f"size must be at most {_MOST_RODS}, got {chain.size}")
    return chain


def answer(query: str) -> Answer:
    """Return the theories of the chain in a query, or why there is none, ``refused``.

    The theory is ``best``: the gas or, at e = 1, the exact equilibrium, and then the force balance
    is ``other``. Each has its ``title``, the errors that it states (null: not measured) of W_v
    inside (``error``), at the ``border`` and of the density (``density_error``), ``widths`` in free
    widths, and the ``density`` as pairs of x and the share of time that a rod covers x, smoothed as
    in the paper.
    """
    from crazybilliards.comparison.stationary_theories import THEORIES, theory_of
    from crazybilliards.kinetic.accuracy import UnmeasuredWarning

    try:
        chain = read(query)
    except (TypeError, ValueError) as error:
        return {"refused": str(error)}
    best = theory_of(chain)
    # The page shows what is not known.
    with warnings.catch_warnings(action="ignore", category=UnmeasuredWarning):
        try:
            theories = {"best": _result(best, chain)}
            if best.name == "equilibrium":
                theories["other"] = _result(THEORIES["force_balance"], chain)
        except ValueError as error:
            return {"refused": _why_none(chain, str(error))}
    return theories


def _why_none(chain: Chain, error: str) -> str:
    """Return why there is no theory of a chain, in words for a class."""
    if chain.amplitude == 0:
        return "without noise there is no steady motion"
    if "collisions give more" in error:  # the solver has found out
        bounds = "fewer rods, a smaller e or more damping bound it"
        return f"by the theory its energy grows without bound; {bounds}"
    way = "; fewer rods, a smaller gap or more noise may help" if chain.gap > 0 else ""
    return f"its equations could not be solved for this chain{way}"


def _result(theory: StationaryTheory, chain: Chain) -> Answer:
    """Solve a theory, and return what the page draws and says of it."""
    from crazybilliards.comparison.coverage import smooth

    solved = theory.solve(chain)
    density = smooth(solved).density
    points = density[:: -(-density.x.size // _MOST_POINTS)] * 2 * chain.radius
    widths = solved.velocity_width.values / chain.free_velocity_width
    errors = {key: solved.attrs[f"{name}_model_error"] for key, name in _ERRORS.items()}
    return {
        "title": theory.title,
        **{key: None if math.isnan(error) else error for key, error in errors.items()},
        "widths": widths.round(4).tolist(),
        "density": list(
            zip(points.x.values.tolist(), points.values.round(5).tolist(), strict=True)
        ),
    }


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server ends this process
    end_with_parent()
    print(json.dumps(answer(sys.argv[1])))
