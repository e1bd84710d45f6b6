r"""The chain: L hard rods on springs, its parameters and the scales that follow from them.

Between collisions rod i = 1..L obeys (arXiv:1404.7460, eq. ``eq:model``)

    m x'' = -gamma x' - F(x - x0_i) + A xi(t),

with white noise of unit strength and F(d) = k d (linear) or k d |d| (quadratic spring). The
anchors x0_i are spaced 2R + g. A collision conserves momentum and reverses the relative
velocity, v1' - v2' = -e (v1 - v2) (eq. ``eq:rest``).

**The reduced coordinate** takes the rods' own length out:

    y_i = x_i - 2R (i - (L+1)/2).

Rods become points that may touch but not pass, y_1 <= ... <= y_L, with anchors spaced g. The
displacement from the anchor is the same in both. The whole package computes in y.

Units: length R, mass M, time t_0. With the defaults a rod has the radius 1 R and the mass 4 pi/3 M,
and a linear spring has the stiffness 1 M/t_0^2.
"""

import math
from collections.abc import Collection
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import spring
from crazybilliards.model.arrays import check_numbers
from crazybilliards.model.checks import check_arguments, shown, with_hints
from crazybilliards.model.parameters import KNOWN, Parameters

_TAIL = 40.0  # exp(-40) = 4e-18: nothing that double precision sees lies beyond U(d) = 40 T


@dataclass(frozen=True, kw_only=True)
class Chain(Parameters):
    """The checked parameters of one chain; the defaults are the paper's reference at e = 1.

    Parameters
    ----------
    size
        Number of rods L, 1 to 10^9.
    restitution
        e >= 0: below 1 dissipative, 1 elastic, above 1 anti-dissipative (flippers).
    amplitude
        Noise amplitude A >= 0 [M R /t_0^(3/2)].
    damping
        gamma >= 0 [M/t_0]. With 0 there is no steady state.
    stiffness
        k >= 0 [M/t_0^2], for a quadratic spring [M/(R t_0^2)]. With 0 only a box has a steady
        state.
    gap
        g >= 0, the free distance between neighbouring rods at their anchors [R].
    radius, mass
        Half a rod's length R > 0 and its mass m > 0; 4 pi/3 is a sphere of unit density.
    spring
        ``"linear"``: F = k d; ``"quadratic"``: F = k d |d|.
    box
        X, the distance between two hard walls at -X/2 and X/2, above 2RL [R]; 0: no walls.
    wall_restitution
        Restitution of the walls, >= 0, which are rods of infinite mass; 1 without walls.
    mass_ratio
        Mass of the rods 2, 4, ... over that of the rods 1, 3, ..., which have ``mass``.

    Raises
    ------
    ValueError
        For the first wrong parameter. The error names it, its value and what it accepts.

    Examples
    --------
    >>> chain = Chain(size=10, amplitude=3)
    >>> round(chain.free_velocity_width, 4)
    1.0365
    >>> chain.replace(gap=0.5).anchors[:2]
    array([-11.25,  -8.75])
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        least = 2 * self.radius * self.size
        if 0 < self.box <= least:
            raise ValueError(
                f"box must be above {least:g}, the length of all rods, or 0 for no walls, got "
                f"{shown(self.box)}"
            )
        if self.wall_restitution != 1 and not self.box:
            raise ValueError(
                "wall_restitution: without walls it must be 1; box=... gives a chain two walls"
            )

    def replace(self, **changes: Any) -> Self:
        """Return the same chain with some parameters changed (and all checked again)."""
        check_arguments("Chain", changes, self.parameters())
        return replace(self, **changes)

    def parameters(self) -> dict[str, int | float | str]:
        """Return all parameters as a plain dictionary; ``Chain(**parameters)`` is the inverse."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def require_known(self, by: str, also: Collection[str] = ()) -> None:
        """Raise a ValueError unless all parameters but the known ones have their default values.

        ``by`` names the method, for the error, and ``also`` what it knows beside the parameters
        that everybody knows.
        """
        for name, default in self.unknown().items():
            if name not in also:
                raise ValueError(
                    f"{by} does not know the chain's {name}: it must be {shown(default)}, "
                    f"got {shown(getattr(self, name))}"
                )

    def unknown(self) -> dict[str, Any]:
        """Return the parameters beside the known ones that are not as by default: the defaults."""
        return {
            field.name: field.default
            for field in fields(self)
            if field.name not in KNOWN and getattr(self, field.name) != field.default
        }

    @property
    def rank(self) -> NDArray[np.float64]:
        """Labels counted from the middle, i - (L+1)/2 for i = 1..L; shape (L,)."""
        return np.arange(1.0, self.size + 1) - (self.size + 1) / 2

    @property
    def anchors(self) -> NDArray[np.float64]:
        """Anchors x0_i = (2R + g)(i - (L+1)/2) [R], shape (L,)."""
        return (2 * self.radius + self.gap) * self.rank

    @property
    def reduced_anchors(self) -> NDArray[np.float64]:
        """Anchors in the reduced coordinate, y0_i = g (i - (L+1)/2) [R], shape (L,)."""
        return self.gap * self.rank

    @property
    def walls(self) -> tuple[float, float]:
        """Where the walls are in the reduced coordinate, -+(X/2 - RL) [R]; -+inf without walls."""
        end = self.box / 2 - self.radius * self.size if self.box else math.inf
        return -end, end

    @property
    def rod_masses(self) -> NDArray[np.float64]:
        """Masses of the rods [M], shape (L,)."""
        return self.mass * np.where(np.arange(self.size) % 2, self.mass_ratio, 1.0)

    @property
    def mean_mass(self) -> float:
        """The mean mass of the rods [M], which a fluid of them has."""
        return self.mass if self.mass_ratio == 1 else float(self.rod_masses.mean())

    @property
    def exchangeable(self) -> bool:
        """Whether the springs treat all rods alike, because there is no gap or no spring."""
        return self.lattice_gap * self.stiffness == 0

    @property
    def lattice_gap(self) -> float:
        """The gap g that theories of a fluid use; 0 for one rod, which has no neighbours."""
        return self.gap if self.size > 1 else 0.0

    def reduced(self, x: ArrayLike) -> NDArray[np.float64]:
        """Reduced coordinates y of rod centres ``x``, shape (..., L)."""
        return check_numbers("x", x) - 2 * self.radius * self.rank

    def physical(self, y: ArrayLike) -> NDArray[np.float64]:
        """Rod centres x of reduced coordinates ``y``, shape (..., L)."""
        return check_numbers("y", y) + 2 * self.radius * self.rank

    @property
    def close_packed_density(self) -> float:
        """The largest density of the rods, 1/(2R) [1/R]."""
        return 1 / (2 * self.radius)

    @property
    def potential_exponent(self) -> int:
        """The n of the spring's potential U(d) = k |d|^n / n: 2 linear, 3 quadratic."""
        return 2 if self.spring == "linear" else 3

    def force(self, displacement: ArrayLike) -> NDArray[np.float64]:
        """Restoring force F(d) = k d or k d |d|, with the sign of d [M R/t_0^2]."""
        d = check_numbers("displacement", displacement)
        return self.stiffness * spring.force(d, self.potential_exponent)

    def potential(self, displacement: ArrayLike) -> NDArray[np.float64]:
        """Spring energy U(d) = k |d|^n / n [M R^2/t_0^2]."""
        d = check_numbers("displacement", displacement)
        return self.stiffness * spring.potential(d, self.potential_exponent)

    def reach(self, energy: float) -> float:
        """Displacement at which a spring has this energy, U(d) = energy [R]; inf if k = 0."""
        if self.stiffness == 0:
            return math.inf if energy > 0 else 0.0
        return float(spring.reach(energy / self.stiffness, self.potential_exponent))

    @property
    def relative_damping(self) -> float:
        """Gamma/sqrt(k m) of linear springs; beyond 2 a free rod does not oscillate."""
        return self.damping / math.sqrt(self.stiffness * self.mass) if self.stiffness else math.inf

    @property
    def temperature(self) -> float:
        """Temperature T = m W^2 = A^2 / (2 gamma) [M R^2/t_0^2]; inf without damping."""
        if self.amplitude == 0:
            return 0.0
        return math.inf if self.damping == 0 else self.amplitude**2 / (2 * self.damping)

    @property
    def free_velocity_width(self) -> float:
        """W = A / sqrt(2 m gamma), the velocity width without collisions (eq. ``free``) [R/t_0]."""
        return math.sqrt(self.temperature / self.mass)

    @property
    def thermal_length(self) -> float:
        """(T/k)^(1/n), the natural length of the spring: sqrt(T/k) if linear [R]."""
        if self.temperature == 0:
            return 0.0
        if self.stiffness == 0:
            return math.inf
        return float(spring.root(self.temperature / self.stiffness, self.potential_exponent))

    @property
    def thermal_reach(self) -> float:
        """Displacement whose spring energy is 40 T, beyond which no thermal rod is found [R]."""
        return self.reach(_TAIL * self.temperature)

    @property
    def spreads(self) -> bool:
        """Whether noise drives the rods ever farther, without a spring or without damping."""
        return self.amplitude > 0 == self.damping * (self.stiffness + self.box)

    @property
    def why_unsteady(self) -> str:
        """The reason why this chain has no steady state; empty if it has one."""
        if self.amplitude == 0 < self.damping:
            return "amplitude=0: without noise the rods come to rest, the density is singular"
        if self.stiffness == 0 and not self.box:
            return "stiffness=0: nothing ties the rods, they spread for ever"
        if self.damping == 0:
            return (
                "damping=0: the chain never forgets its start, because only damping takes energy "
                "out of every motion"
            )
        if self.restitution > (critical := self._critical_restitution()):
            return (
                f"restitution={self.restitution:g}: above e_c = {critical:.4g} or so, collisions "
                "give a gas in this box more energy than the damping takes out"
            )
        return ""

    def _critical_restitution(self) -> float:
        """Largest e with a steady state of a gas in a box, inf of other chains.

        The energy balance of uncorrelated rods, w^2 - 1 = (e^2 - 1) w^3 W m/(sqrt(pi) gamma s) with
        w = W_v/W, s = l/(L - 1) and the harmonic mean m of the masses, has no root above it.
        """
        if not self.box or self.stiffness > 0 or self.size == 1:
            return math.inf
        mass = 2 / (1 + 1 / self.mass_ratio) * self.mass
        room = 2 * self.walls[1] / (self.size - 1)
        drag = self.damping * room / math.sqrt(mass * self.temperature)
        return math.sqrt(1 + 2 / (3 * math.sqrt(3)) * math.sqrt(math.pi) * drag)

    def require_steady_state(self) -> None:
        """Raise a ValueError with the reason if this chain has no steady state."""
        if reason := self.why_unsteady:
            raise ValueError(f"this chain has no steady state: {reason}")


# A dataclass makes its own ``__init__``.
Chain.__init__ = with_hints(Chain.__init__)  # type: ignore[method-assign]
