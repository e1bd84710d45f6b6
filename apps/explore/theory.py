"""The theory of a chain for the page."""

import math
import warnings
from typing import Any
from urllib.parse import parse_qsl

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.stationary_theories import THEORIES, StationaryTheory, theory_of
from crazybilliards.kinetic.accuracy import UnmeasuredWarning
from crazybilliards.model import Chain

_MOST_RODS = 200  # of the page
_MOST_POINTS = 500  # of a curve
# Errors that a theory states, by what the page calls them.
_ERRORS = {"error": "velocity_width", "border": "border", "density_error": "density"}
_KINDS = {"size": int, "restitution": float, "amplitude": float, "damping": float, "gap": float}


def read(query: str) -> Chain:
    """Return the chain of a query; a TypeError or ValueError says what is wrong with it."""
    texts = dict(parse_qsl(query, keep_blank_values=True))
    chain = Chain(**{name: _KINDS.get(name, str)(text) for name, text in texts.items()})
    if chain.size > _MOST_RODS:
        raise ValueError(f"size must be at most {_MOST_RODS}, got {chain.size}")
    return chain


def answer(query: str) -> dict[str, Any]:
    """Return the theories of the chain in a query, or why there is none, ``refused``.

    The theory is ``best``: the gas or, at e = 1, the exact equilibrium, and then the force balance
    is ``other``. Each has its ``title``, the errors that it states (null: not measured) of W_v
    inside (``error``), at the ``border`` and of the density (``density_error``), ``widths`` in free
    widths, and the ``density`` as pairs of x and the share of time that a rod covers x, smoothed as
    in the paper.
    """
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
        return (
            "by the theory its energy grows without bound; fewer rods, a smaller e or more damping "
            "bound it"
        )
    way = "; fewer rods, a smaller gap or more noise may help" if chain.gap > 0 else ""
    return f"its equations could not be solved for this chain{way}"


def _result(theory: StationaryTheory, chain: Chain) -> dict[str, Any]:
    """Solve a theory, and return what the page draws and says of it."""
    solved = theory.solve(chain)
    density = smooth(solved).density
    points = density[:: -(-density.x.size // _MOST_POINTS)] * 2 * chain.radius
    errors = {key: solved.attrs[f"{name}_model_error"] for key, name in _ERRORS.items()}
    return {
        "title": theory.title,
        **{key: None if math.isnan(error) else error for key, error in errors.items()},
        "widths": (solved.velocity_width.values / chain.free_velocity_width).round(4).tolist(),
        "density": list(
            zip(points.x.values.tolist(), points.values.round(5).tolist(), strict=True)
        ),
    }
