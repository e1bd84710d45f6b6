"""The grid of positions of :mod:`.eulerian_frame`, and the fields that it starts from."""

import math

import numpy as np

from crazybilliards.kinetic.starts import Start
from crazybilliards.kinetic.statics.label_closure import length_unit
from crazybilliards.model import Array, Chain

# Widths of a cell, by default and at most, over what it has to resolve. With the widest cells the
# scheme's error is 0.01 to 0.03 of s.
_CELL, _WIDEST_CELL = 0.1, 0.5
_MOST_BY_DEFAULT = 50_000
MOST_CELLS = 100_000
_POPULATED = 1e-12  # of the largest density; how far thinner places swing does not matter
_ROOM = 9.5  # beyond the lattice of anchors, in thermal lengths
_MARGIN = 3.0  # beyond the farthest swing


def make_faces(
    chain: Chain, start: Start, duration: float, number: int | None, wider: float
) -> Array:
    """Return the positions [R] of the cells' faces, beyond the farthest swing."""
    s, W, L = length_unit(chain), chain.free_velocity_width, chain.size
    density = start.label(start.x, 1)
    populated = density > _POPULATED * density.max()
    label = start.label(start.x)
    u = (start.x - (2 * chain.radius + chain.lattice_gap) * (label - L / 2))[populated] / s
    swing = float(np.hypot(u, start.velocity(start.x)[populated] / W).max())
    half = (chain.radius + chain.lattice_gap / 2) * L / s + wider * max(_ROOM, swing + _MARGIN)
    half = min(half, chain.box / (2 * s) if chain.box else math.inf)
    # Cells resolve the thermal length or, if shorter, all rods or the waves of a steep start.
    rods = float(np.ptp(start.x[populated]))
    most, slope = (np.abs(start.label(start.x[populated], order)).max() for order in (1, 2))
    steep = float(most / slope) if slope > 0 else math.inf
    finest = min(s, rods / 20, max(W * duration, steep, rods / 100)) / s
    if number is None:
        number = min(math.ceil(2 * half / (_CELL * finest)), _MOST_BY_DEFAULT)
    enough = 2 * half / (_WIDEST_CELL * finest)
    if number < enough:
        advice = f"give cells={math.ceil(enough)}" if enough <= MOST_CELLS else "use frame='label'"
        raise ValueError(
            f"frame='eulerian' with {number} cells: each is {2 * half / number:.3g} thermal "
            f"lengths wide, {_WIDEST_CELL * finest:.3g} at most resolve the flow; {advice}"
        )
    return s * np.linspace(-half, half, number + 1)


def starting_fields(chain: Chain, start: Start, faces: Array, *, thermal: bool) -> dict[str, Array]:
    """Return the means of rho, rho V and, if wanted, E over the cells, by these names."""
    at = np.clip(faces, start.x[0], start.x[-1])
    middle = np.clip((faces[1:] + faces[:-1]) / 2, start.x[0], start.x[-1])
    h = faces[1] - faces[0]
    rho = np.maximum(np.diff(start.label(at)) / h, 0.0)
    rho[0] += start.label(at[0]) / h
    if chain.box:
        rho[-1] += (chain.size - start.label(at[-1])) / h
    rho *= chain.size / (h * rho.sum())  # cubics between nodes may overshoot at a jump
    v = start.velocity(middle)
    fields = {"rho": rho, "rho V": rho * v}
    if thermal:
        fields["E"] = rho * (v**2 + start.variance(middle)) / 2
    return fields
