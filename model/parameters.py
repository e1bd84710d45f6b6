"""The parameters of a chain, each with its default, meaning, unit and check.

numpy is not imported, so that ``--help`` of the command line lists the parameters without a delay.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import partial
from typing import Any, Literal, get_args

from crazybilliards.model.checks import check_choice, check_integer, check_real

Spring = Literal["linear", "quadratic"]

# Whatever reads a chain refuses any other parameter, unless its own ``knows`` names it.
KNOWN = frozenset(
    {"size", "restitution", "amplitude", "damping", "stiffness", "gap", "radius", "mass", "spring"}
)
# For the ``knows`` of what has been made sure of with walls and two masses.
WALLS_AND_MASSES = frozenset({"box", "wall_restitution", "mass_ratio"})

_positive = partial(check_real, positive=True)


def _parameter(
    default: Any, meaning: str, unit: str = "", *, check: Callable[[str, Any], Any] = check_real
) -> Any:
    """Return a field; ``check(name, value)`` returns the value to keep, or raises a ValueError."""
    return field(default=default, metadata={"meaning": meaning, "unit": unit, "check": check})


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """The parameters of a chain, each checked in turn; :class:`Chain` documents them."""

    size: int = _parameter(  # of which an array takes 8 GB at most
        100, "Number of rods L", check=partial(check_integer, least=1, most=10**9)
    )
    restitution: float = _parameter(
        1.0, "Restitution e: below 1 dissipative, above 1 anti-dissipative"
    )
    amplitude: float = _parameter(1.0, "Noise amplitude A", "M R/t_0^(3/2)")
    damping: float = _parameter(1.0, "Damping gamma", "M/t_0")
    stiffness: float = _parameter(
        1.0, "Stiffness k of the springs", "M/t_0^2, quadratic M/(R t_0^2)"
    )
    gap: float = _parameter(0.0, "Gap g between rods at their anchors", "R")
    radius: float = _parameter(1.0, "Half a rod's length", "R", check=_positive)
    mass: float = _parameter(4 * math.pi / 3, "Mass m of a rod", "M", check=_positive)
    spring: Spring = _parameter(  # noqa: RUF009
        "linear",
        "Force of the springs: linear or quadratic",
        check=partial(check_choice, choices=get_args(Spring)),
    )
    box: float = _parameter(0.0, "Distance between two walls; 0: there are none", "R")
    wall_restitution: float = _parameter(1.0, "Restitution of the walls")
    mass_ratio: float = _parameter(
        1.0, "Mass of every second rod over that of the others", check=_positive
    )

    def __post_init__(self) -> None:
        for parameter in fields(self):
            name, check = parameter.name, parameter.metadata["check"]
            object.__setattr__(self, name, check(name, getattr(self, name)))
