"""A chain that moves while its parameters are changed: state, stepping in chunks, running sums.

The kernels are those of :func:`crazybilliards.particles.simulate`, as are the default time step
and the collision law. The duration is not known in advance, so the sums have no blocks and no
error bars. They start again when a parameter changes, and six relaxation times later. In slow
motion the steps are shorter and collisions are resolved one by one.
"""

from __future__ import annotations

import math
from collections import deque
from time import perf_counter

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from crazybilliards.apps.explore.sums import Sums
from crazybilliards.kinetic import equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result
from crazybilliards.particles.dynamics import Dynamics, make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally, make_waves
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.scales import default_time_step, relaxation_time, typical_speed
from crazybilliards.particles.stepping import advance, bounded

Array = NDArray[np.float64]

_RELAXATIONS = 6
_STRIDE = 10  # steps from snapshot to snapshot, as in simulate
# Typical speeds beyond which the chain has blown up. Steady states of e > 1 stay within some tens
# of them. simulate allows 1e6, but its steps become slow long before that.
_DIVERGED = 1e3
_MOST_ENERGIES = 20_000
_SINGLE = 1 / 500  # of the usual time step: two collisions hardly ever fall into such a step


class Session:
    """A chain in motion, and what was measured of it.

    At e = 1 it starts in a state of the exact equilibrium, and is measured at once. Any other chain
    starts from rest at its anchors.

    Parameters
    ----------
    chain
        The chain; it must have noise, damping and springs.
    seed
        Seed of the random numbers. The same seed, changes and durations give the same motion.

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
        Whether the chain diverged. It then keeps its last finite state.
    settled
        Whether the time ``measured_from`` has come.
    sums
        What was measured; before the chain has settled, what was seen since the last change.
    energies
        The latest times [T] with the kinetic energy.

    Raises
    ------
    ValueError
        If the chain has no steady state at any restitution. :meth:`change` raises it too.

    Examples
    --------
    >>> session = Session(Chain(size=10))
    >>> session.advance(100.0)
    >>> session.change(Chain(size=10, restitution=0.5))  # the rods stay where they are
    >>> session.advance(100.0)
    >>> session.observed().velocity_width.dims
    ('particle',)
    """

    def __init__(self, chain: Chain, seed: int = 0) -> None:
        self._seed = seed
        self._noise = make_noise(np.random.SeedSequence(seed))
        self._owed = 0.0  # steps
        self._longest, self._resolved, self._waves = math.inf, False, False
        # The rod that is held, its place y [R], and the distance from the mouse to this place [R].
        self._held: tuple[int, float, float] | None = None
        self._prepare(chain)
        self._start()

    def restart(self) -> None:
        """Put the rods at rest at their anchors and measure anew."""
        self._begin(self.chain.reduced_anchors, np.zeros(self.chain.size))
        self.measured_from = self._relaxed()

    def change(self, chain: Chain) -> None:
        """Go on with other parameters and measure anew.

        Rods keep their positions and velocities even if their anchors move. A chain of another
        size, or one that has diverged, starts anew. A rod that was held is let go.
        """
        kept = chain.size == self.chain.size and not self.diverged
        self._prepare(chain)
        if kept:
            self._measure_anew()
        else:
            self._start()

    def pace(self, longest_step: float, *, resolved: bool, avalanches: bool = False) -> None:
        """Take no longer steps than this [T], and resolve collisions one by one or not.

        ``resolved`` is for :meth:`contacts_met`; ``avalanches`` are counted with it, from now on.
        """
        asked = longest_step, resolved or avalanches, avalanches
        if asked != (self._longest, self._resolved, self._waves):
            self._longest, self._resolved, self._waves = asked
            self._prepare(self.chain)

    def advance(self, duration: float, budget: float = math.inf) -> None:
        """Move on by ``duration`` [T], or as far as ``budget`` seconds of computing go.

        Only whole steps are taken; the remaining time is added to the next duration.
        """
        due = duration / self._dynamics.step.time_step + self._owed
        steps, self._owed = int(due), due % 1
        deadline = perf_counter() + budget
        while steps > 0 and not self.diverged:
            self._take(min(_STRIDE, steps), self._dynamics)
            steps -= _STRIDE
            if perf_counter() > deadline:
                return

    def advance_to_collision(self, duration: float) -> list[int]:
        """Move on until rods collide or ``duration`` [T] is over; return the contacts, from 0."""
        end = self.time + duration
        self.contacts_met()
        while self.time < end and not self.diverged:
            self._take(1, self._single)
            if met := self.contacts_met():
                return met
        return []

    def contacts_met(self) -> list[int]:
        """Return the contacts, from 0, where rods met since the last call, if resolved."""
        met = np.flatnonzero(self._tally.contacts)
        self._tally.contacts[met] = 0
        return [int(contact) for contact in met]

    def hold(self, x: float) -> None:
        """Hold the rod that is nearest to x [R], and later move it as far as x moves.

        It pushes other rods aside.
        """
        if self._held is None:
            rod = int(np.abs(self.positions - x).argmin())
            distance = float(self.y[rod]) - x
        else:
            rod, _, distance = self._held
        self._held = rod, x + distance, distance
        self._keep_hold()
        self.measured_from = math.inf

    @property
    def holds(self) -> bool:
        """Whether a rod is held."""
        return self._held is not None

    def release(self) -> None:
        """Let go of the rod that is held, if any, from rest, and measure anew."""
        if self.holds:
            self._measure_anew()

    def push(self, rod: int, speed: float) -> None:
        """Add to the velocity [R/T] of a rod, counted from 0, and measure anew."""
        self.v[rod] += speed
        self._measure_anew()

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

    def observed(self) -> xr.Dataset | None:
        """Return ``velocity_width`` over particle and ``density`` over x; None before any."""
        if self.sums.snapshots == 0:
            return None
        return result(
            self.chain,
            {
                "velocity_width": ("particle", self.sums.velocity_widths()),
                "density": ("x", self.sums.density()),
            },
            source="simulation",
            method={"method": "event-driven", "time_step": self._dynamics.step.time_step},
            coordinates={"x": self.sums.x},
            status="diverged" if self.diverged else "completed",
            end_time=self.time,
        )

    def avalanche_sizes(self) -> NDArray[np.int64]:
        """Return how many hits triggered 0, 1, 2, ... collisions while measured, shape (L,)."""
        return np.asarray(self._tally.triggered.sizes.sum(axis=0))

    def _prepare(self, chain: Chain) -> None:
        """Make what the kernels need for this chain."""
        chain.require_steady_state()
        self.chain = chain
        usual = default_time_step(chain)
        self._dynamics = self._make_dynamics(min(usual, self._longest))
        self._single = self._make_dynamics(usual * _SINGLE)
        self._scratch = make_scratch(chain.size)
        self._silent = make_tally(chain.size, contacts=False)
        self._tally = make_tally(chain.size, contacts=True)
        if self._waves:
            self._tally = self._tally._replace(triggered=make_waves(chain.size))
        self._offsets = chain.physical(np.zeros(chain.size))
        self._owed = 0.0

    def _make_dynamics(self, time_step: float) -> Dynamics:
        rest = self.chain.reduced_anchors, np.zeros(self.chain.size)
        speed = typical_speed(self.chain, math.inf, *rest)
        return make_dynamics(self.chain, time_step, speed=speed, diverged=_DIVERGED, counted=True)

    def _start(self) -> None:
        """Start in equilibrium where it is known, from rest otherwise."""
        if self.chain.restitution != 1:
            self.restart()
            return
        drawn = equilibrium_states(self.chain, 1, self._seed)
        y = drawn.position.values[0] - self._offsets
        self._begin(y, drawn.velocity.values[0].copy())

    def _begin(self, y: Array, v: Array) -> None:
        self.time, self.collisions, self.diverged = 0.0, 0, False
        self.y, self.v = y, v
        self._measure_anew()
        self.measured_from = 0.0

    def _relaxed(self) -> float:
        return self.time + _RELAXATIONS * relaxation_time(self.chain)

    def _measure_anew(self) -> None:
        self._held = None
        self.measured_from = self._relaxed()
        self._tally.triggered.sizes[:] = 0
        self.settled, self.sums = False, Sums(self.chain)
        self.energies: deque[tuple[float, float]] = deque(maxlen=_MOST_ENERGIES)

    def _keep_hold(self) -> None:
        """Put the rod that is held where it is held, and others out of its way."""
        if self._held is None:
            return
        rod, y, _ = self._held
        self.y[rod], self.v[rod] = y, 0.0
        side = np.sign(np.arange(self.chain.size) - rod)
        in_the_way = side * (self.y - y) < 0
        self.y[in_the_way] = y
        self.v[in_the_way & (side * self.v < 0)] = 0.0

    def _take(self, steps: int, dynamics: Dynamics) -> None:
        """Take some steps and a snapshot; restore the previous state if the chain diverges."""
        before = self.y.copy(), self.v.copy()
        state = self.y, self.v, self._noise
        tally = self._tally if dynamics is self._single or self._resolved else self._silent
        met = advance(*state, dynamics, self._scratch, tally, steps)
        if met < 0 or not bounded(self.y, self.v, dynamics.fastest):
            self.y, self.v = before
            self.diverged = True
            return
        self.time += steps * dynamics.step.time_step
        self.collisions += met
        self._keep_hold()
        self.energies.append((self.time, self.kinetic_energy))
        if not self.settled:
            self._tally.triggered.sizes[:] = 0
            if self.time > self.measured_from:
                self.settled, self.sums = True, Sums(self.chain)
        if not self.holds:
            self.sums.add(self.positions, self.v)
