"""A chain that moves while its parameters are changed: state, stepping in chunks, running sums.

The kernels are those of :func:`crazybilliards.particles.simulate`, as are the default time step
and the collision law. What differs is that nobody knows in advance how long it will run: sums
are kept without blocks, hence without error bars, and start anew when a parameter is changed,
after six relaxation times in which the chain forgets what it was.
"""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.grid import deposit, position_grid, thermal_reach
from crazybilliards.model.vocabulary import result
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.scales import default_time_step, relaxation_time, typical_speed
from crazybilliards.particles.stepping import advance, bounded, make_dynamics

Array = NDArray[np.float64]

_RELAXATIONS = 6
_STRIDE = 10  # steps from snapshot to snapshot, as in simulate
# Typical speeds beyond which the chain has blown up. Steady states of e > 1 stay within some tens
# of them. simulate waits for 1e6, but its steps get slower with every collision: nobody wants to
# look at that.
_DIVERGED = 1e3


class Session:
    """A chain in motion, from rest at its anchors, and what was measured of it.

    Parameters
    ----------
    chain
        The chain; it must have noise, damping and springs.
    seed
        Of the random numbers. The same seed, changes and durations give the same motion.

    Attributes
    ----------
    chain
        The chain as it is now.
    time, measured_from
        Time since the start [T], and the time from which on it is or will be measured.
    collisions
        How many there were since the start.
    y, v
        Reduced positions [R] and velocities [R/T], shape (L,).
    diverged
        Whether the chain blew up; it then stands still, in its last good state.

    Raises
    ------
    ValueError
        If the chain has no steady state whatever its restitution; here and in :meth:`change`.

    Examples
    --------
    >>> session = Session(Chain(size=10))
    >>> session.advance(100.0)
    >>> session.change(Chain(size=10, restitution=0.5))  # the rods stay where they are
    >>> session.advance(100.0)
    >>> measured = session.measured()
    >>> measured.velocity_width.dims
    ('particle',)
    """

    def __init__(self, chain: Chain, seed: int = 0) -> None:
        self._noise = make_noise(np.random.SeedSequence(seed))
        self._owed = 0.0  # steps
        self._prepare(chain)
        self.restart()

    def restart(self) -> None:
        """Put the rods at rest at their anchors and measure anew."""
        self.time, self.collisions, self.diverged = 0.0, 0, False
        self.y, self.v = self.chain.reduced_anchors, np.zeros(self.chain.size)
        self._measure_anew()

    def change(self, chain: Chain) -> None:
        """Go on with other parameters and measure anew.

        Rods stay where they are and keep their velocities, whatever becomes of their anchors. A
        chain of another size, or one that has diverged, starts from rest.
        """
        kept = chain.size == self.chain.size and not self.diverged
        self._prepare(chain)
        if kept:
            self._measure_anew()
        else:
            self.restart()

    def advance(self, duration: float, budget: float = math.inf) -> None:
        """Move on by ``duration`` [T], or as far as ``budget`` seconds of computing go.

        Whole steps are taken; what is left over is added to the next duration.
        """
        due = duration / self._dynamics.step.time_step + self._owed
        steps, self._owed = int(due), due % 1
        deadline = perf_counter() + budget
        while steps > 0 and not self.diverged:
            self._take(min(_STRIDE, steps))
            steps -= _STRIDE
            if perf_counter() > deadline:
                return

    @property
    def positions(self) -> Array:
        """Rod centres x_i [R], shape (L,)."""
        return self.y + self._offsets

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy of all rods, sum m v^2/2 [M R^2/T^2]."""
        return float(self.chain.mass / 2 * self.v @ self.v)

    @property
    def measured_duration(self) -> float:
        """How long the chain has been measured with its present parameters [T]."""
        return max(self.time - self.measured_from, 0.0)

    def measured(self) -> xr.Dataset | None:
        """Return ``velocity_width`` over particle and ``density`` over x; None before any."""
        if self._snapshots == 0:
            return None
        density = self._weights / (self._snapshots * self._spacing)
        return result(
            self.chain,
            {
                "velocity_width": ("particle", np.sqrt(self._squares / self._snapshots)),
                "density": ("x", density),
            },
            source="simulation",
            method={"method": "event-driven", "time_step": self._dynamics.step.time_step},
            coordinates={"x": self._x},
            status="diverged" if self.diverged else "completed",
            end_time=self.time,
        )

    def _prepare(self, chain: Chain) -> None:
        """Make what the kernels need for this chain."""
        chain.require_steady_state()
        self.chain = chain
        time_step = default_time_step(chain)
        rest = chain.reduced_anchors, np.zeros(chain.size)
        speed = typical_speed(chain, math.inf, *rest)
        self._dynamics = make_dynamics(chain, time_step, speed=speed, diverged=_DIVERGED)
        self._scratch = make_scratch(chain.size)
        self._tally = make_tally(chain.size, contacts=False)
        self._offsets = chain.physical(np.zeros(chain.size))
        self._owed = 0.0

    def _measure_anew(self) -> None:
        self.measured_from = self.time + _RELAXATIONS * relaxation_time(self.chain)
        # Flippers (e > 1) drive a chain apart by several times the free reach.
        reach = thermal_reach(self.chain) * (5 if self.chain.restitution > 1 else 1)
        self._x = position_grid(self.chain, reach)
        self._spacing = float(self._x[1] - self._x[0])
        self._weights = np.zeros(self._x.size)
        self._squares = np.zeros(self.chain.size)
        self._snapshots = 0

    def _take(self, steps: int) -> None:
        """Take some steps and a snapshot; nothing of it if the chain blows up on the way."""
        before = self.y.copy(), self.v.copy()
        state = self.y, self.v, self._noise
        met = advance(*state, self._dynamics, self._scratch, self._tally, steps)
        if met < 0 or not bounded(self.y, self.v, self._dynamics.fastest):
            self.y, self.v = before
            self.diverged = True
            return
        self.time += steps * self._dynamics.step.time_step
        self.collisions += met
        if self.time > self.measured_from:
            self._squares += self.v * self.v
            deposit(self.positions, self._x[0], self._spacing, self._weights)
            self._snapshots += 1
