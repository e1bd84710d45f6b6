"""The best theory of a chain for the page, solved in a process of its own, one at a time."""

from __future__ import annotations

import math
import multiprocessing
import signal
import time
import warnings
from collections.abc import Callable, Mapping
from contextlib import closing
from multiprocessing.connection import Connection
from threading import BoundedSemaphore, Lock
from typing import Any

from crazybilliards.model.checks import shown
from crazybilliards.model.parameters import Parameters
from crazybilliards.model.process import end_with_parent

_TURN = Lock()  # one computes at a time, for all pages
_PLACES = BoundedSemaphore(10)  # that compute or wait
_LOOK = 0.2  # s between two looks whether somebody still waits
_PATIENCE = 120  # s
_MOST_RODS = 200  # of the page
_MOST_POINTS = 500  # of a curve
_TOLERANCE = {"tolerance": 0.01}  # of a velocity width, less than a line is thick
_NUMBERS = {"size": int, "restitution": float, "amplitude": float, "damping": float, "gap": float}

Answer = dict[str, Any]


def solve(query: Mapping[str, str], is_gone: Callable[[], bool]) -> Answer | None:
    """Solve the best theory of the chain in a query; None as soon as nobody waits for it.

    Returns ``best`` and, at e = 1, the force balance as ``other``: each with its ``title``, the
    errors that it states (null: not measured) of W_v inside (``error``), at the ``border`` and of
    the density (``density_error``), ``widths`` in free widths, and the ``density`` as pairs of x
    and the share of time that a rod covers x, smoothed as in the paper. Or why there is none,
    ``refused``, with ``busy`` if too many wait.
    """
    try:
        parameters = read(query)
    except ValueError as error:
        return {"refused": str(error)}
    if not _PLACES.acquire(blocking=False):
        return {"refused": "too many theories are waiting", "busy": True}
    try:
        while not _TURN.acquire(timeout=_LOOK):
            if is_gone():
                return None
        try:
            return _solve_in_process(parameters, is_gone)
        finally:
            _TURN.release()
    finally:
        _PLACES.release()


def read(query: Mapping[str, str]) -> Parameters:
    """Return the chain of a query."""
    values: dict[str, Any] = dict(query)
    for name, text in query.items():
        if name not in (*_NUMBERS, "spring"):
            raise ValueError(f"{shown(name)} is none of {', '.join(_NUMBERS)}, spring")
        try:
            values[name] = _NUMBERS.get(name, str)(text)
        except ValueError:
            raise ValueError(f"{name} must be a number, got {shown(text)}") from None
    parameters = Parameters(**values)
    if parameters.size > _MOST_RODS:
        raise ValueError(f"size must be at most {_MOST_RODS}, got {parameters.size}")
    return parameters


def _solve_in_process(parameters: Parameters, is_gone: Callable[[], bool]) -> Answer | None:
    """Solve in a process, which is killed when nobody waits or it takes too long."""
    context = multiprocessing.get_context("spawn")
    answer, there = context.Pipe(duplex=False)
    process = context.Process(target=_compute, args=(parameters, there), daemon=True)
    process.start()
    there.close()
    until = time.monotonic() + _PATIENCE
    with closing(answer):
        try:
            while not answer.poll(_LOOK):
                if is_gone():
                    return None
                if time.monotonic() > until:
                    return {"refused": f"it takes longer than {_PATIENCE} s"}
            found: Answer = answer.recv()
        except (EOFError, OSError):
            found = {"refused": "the computation ended without an answer"}
        finally:
            process.kill()
            process.join()
    return found


def _compute(parameters: Parameters, there: Connection) -> None:
    """Send the answer for a chain from a process that ends with the server."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server ends this process
    end_with_parent()
    there.send(compute(parameters))


def compute(parameters: Parameters) -> Answer:
    """Return the theories of a chain, or why there is none, in this process."""
    from dataclasses import asdict

    from crazybilliards.comparison.stationary_theories import THEORIES, choose_theory
    from crazybilliards.kinetic.accuracy import UnmeasuredWarning
    from crazybilliards.model import Chain

    chain = Chain(**asdict(parameters))
    other = THEORIES["force_balance"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnmeasuredWarning)  # the page shows what is not known
        try:
            best = choose_theory(chain).theory
            coarse = {} if best.refusal(chain, _TOLERANCE) else _TOLERANCE
            answer = {"best": _result(best, best.solve(chain, **coarse))}
            if not other.refusal(chain):
                answer["other"] = _result(other, other.solve(chain))
        except ValueError as error:
            return {"refused": _why_none(parameters, str(error))}
    return answer


def _why_none(chain: Parameters, error: str) -> str:
    """Return why there is no theory of a chain, in words for a class."""
    if chain.amplitude == 0:
        return "without noise there is no steady motion"
    if error.startswith("no steady state"):  # the solver has found out
        bounds = "fewer rods, a smaller e or more damping bound it"
        return f"by the kinetic equation its energy grows without bound; {bounds}"
    way = "; fewer rods, a smaller gap or more noise may help" if chain.gap > 0 else ""
    return f"its equations could not be solved for this chain{way}"


def _result(theory: Any, solved: Any) -> Answer:
    """Return what the page draws and says of a solved theory."""
    from crazybilliards.comparison.coverage import smooth
    from crazybilliards.model import chain_of

    chain = chain_of(solved)
    accuracy = theory.accuracy(chain)
    density = smooth(solved).density
    points = density[:: -(-density.x.size // _MOST_POINTS)] * 2 * chain.radius
    widths = solved.velocity_width.values / chain.free_velocity_width
    errors = {"error": accuracy.velocity_width, "border": accuracy.border}
    errors["density_error"] = accuracy.density
    return {
        "title": theory.title,
        **{name: None if math.isnan(error) else error for name, error in errors.items()},
        "widths": widths.round(4).tolist(),
        "density": list(
            zip(points.x.values.tolist(), points.values.round(5).tolist(), strict=True)
        ),
    }
