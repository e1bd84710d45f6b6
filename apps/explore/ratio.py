"""How much hotter the outermost rods of the running chain are than the middle ones."""

from __future__ import annotations

import math

import numpy as np

from crazybilliards.apps.explore.session import Session
from crazybilliards.model import Chain
from crazybilliards.model.chain import middle_tenth
from crazybilliards.particles.scales import relaxation_time

_STRETCHES = 20  # independent stretches of time that an average needs


class EnergyRatio:
    """Mean kinetic energy of the two outermost rods over that of the middle ones.

    Averages over stretches of time that are independent of each other give a standard error.
    """

    def __init__(self) -> None:
        self._begin(Chain(), math.inf)

    def _begin(self, chain: Chain, since: float) -> None:
        self._chain, self._since = chain, since
        # Energies are forgotten in m/(2 gamma).
        self._stretch = max(4 * chain.mass / chain.damping, relaxation_time(chain))
        self._ends = 0.0
        self._snapshots, self._squares = 0, np.zeros(chain.size)
        self._found: list[tuple[float, float]] = []  # mean v^2 at the border and in the middle

    def follow(self, session: Session) -> None:
        """Take in what was measured since the last stretch."""
        if (session.chain, session.measured_from) != (self._chain, self._since):
            self._begin(session.chain, session.measured_from)
        if session.measured_duration < self._ends + self._stretch:
            return
        snapshots, squares = session.sums.snapshots, session.sums.squares.copy()
        of_stretch = (squares - self._squares) / max(snapshots - self._snapshots, 1)
        self._snapshots, self._squares = snapshots, squares
        self._ends = session.measured_duration
        border = float(of_stretch[[0, -1]].mean())
        middle = float(of_stretch[middle_tenth(self._chain.size)].mean())
        self._found.append((border, middle))

    @property
    def known(self) -> tuple[float, float] | None:
        """The ratio and its standard error, once there are enough stretches."""
        if len(self._found) < _STRETCHES:
            return None
        found = np.array(self._found)
        border, middle = found.mean(axis=0)
        scatter = found[:, 0] / border - found[:, 1] / middle
        ratio = float(border / middle)
        return ratio, ratio * float(scatter.std() / math.sqrt(len(found) - 1))

    def say(self, session: Session) -> str:
        """Say what is known of the ratio."""
        waiting = session.measured_from - session.time
        if session.diverged:
            return "the chain has run away"
        if session.holds:
            return "you hold a rod"
        if waiting > 0:
            return f"settling for another {math.ceil(waiting)} T"
        if self.known is None:
            return (
                f"measuring: {len(self._found)} of {_STRETCHES} stretches of {self._stretch:.0f} T"
            )
        ratio, error = self.known
        duration = session.measured_duration
        return f"border over centre: {ratio:.2f} ± {error:.2f}, measured for {duration:.0f} T"
