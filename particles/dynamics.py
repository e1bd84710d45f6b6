"""What the kernels need of a run: the chain and the scheme of the time steps as plain numbers."""

import math
from typing import Literal, NamedTuple

import numpy as np

from crazybilliards.model import WALLS_AND_MASSES, Array, Chain
from crazybilliards.particles.laws import law as laws
from crazybilliards.particles.laws.closed_contacts import CLOSED_KICK, CRITICAL_RESTITUTION
from crazybilliards.particles.laws.exact_flight import Propagator, make_propagator
from crazybilliards.particles.scales import spring_rate

# In velocity kicks of one step: rods that separate more slowly move as one. Below the critical
# restitution a larger threshold adds energy, because the noise of closed contacts is stronger.
_MERGING, _MERGING_OF_CLOSED = 0.1, 0.03
# In typical speeds. In the steady states for e > 1 rods reach some tens of them.
_DIVERGED = 1e6

Stepper = Literal["splitting", "euler"]

# Parameters beside ``KNOWN`` with which the steps of springs, damping and noise are right. Exact
# flight has its own (``laws/law.py``).
knows: frozenset[str] = WALLS_AND_MASSES


class Step(NamedTuple):
    """The plain numbers of the chain and the scheme that a kernel needs."""

    time_step: float
    decay: float  # factor on v from the damping
    noise: float  # standard deviation of the velocity kick
    outer_decay: float  # the same for the first kick of successive steps (and the last one)
    outer_noise: float
    kick: float  # velocity kick per unit of F/k, one half of it for the splitting
    exponent: int  # of the spring's potential
    symmetric: bool  # splitting: half kicks of spring and noise after the drift
    closed: float  # strength of the noise that opens closed contacts; 1: as all other noise
    closed_outer: float  # the same for the half kick after a snapshot


class Dynamics(NamedTuple):
    """Everything that the kernels need of a run; it is the same for all replicas."""

    anchors: Array  # reduced, (L,)
    step: Step
    second: Step  # of the rods 2, 4, ..., whose mass may be another one
    law: laws.Law
    propagator: Propagator  # of a step, if the law is EXACT
    fastest: float  # with a faster rod the chain has diverged
    inverse: Array  # 1/m of the rods, and of the walls around them; see ``Scratch``


def make_dynamics(
    chain: Chain,
    time_step: float,
    *,
    speed: float,
    method: laws.Method = "event-driven",
    stepper: Stepper = "splitting",
    merging: float | None = None,
    counted: bool = False,
    struck: bool = False,
) -> Dynamics:
    """Return the numbers and arrays that the kernels need of a chain; see ``simulate``.

    ``speed`` is typical of the rods [R/t_0]. ``counted``: every collision is to be recorded at its
    contact, and ``struck`` every impulse on a wall.
    """
    second = chain.replace(mass=chain.mass * chain.mass_ratio, mass_ratio=1.0)
    one, other = (make_step(sort, time_step, stepper, method) for sort in (chain, second))
    halves = stepper == "splitting"
    operator = laws.choose_operator(chain, method, counted=counted, struck=struck, halves=halves)
    if operator == laws.TURN:  # which has the springs in its flight
        one, other = one._replace(kick=0.0), other._replace(kick=0.0)
    merging = default_merging(chain) if merging is None else merging
    law = laws.make_law(chain, time_step, operator, merging, speed, halves=halves)
    speed *= math.sqrt(max(chain.mass_ratio, 1 / chain.mass_ratio))  # a heavy rod hits a light one
    fastest = _DIVERGED * speed if speed > 0 else math.inf
    propagator, inverse = make_propagator(chain, time_step), np.zeros(0)
    if chain.box or chain.mass_ratio != 1:
        rods = chain.mass / chain.rod_masses
        inverse = np.array([0.0, *rods, 0.0]) if chain.box else rods
    return Dynamics(chain.reduced_anchors, one, other, law, propagator, fastest, inverse)


def default_merging(chain: Chain) -> float:
    """Return the threshold of merging at this restitution, in velocity kicks of one step."""
    return _MERGING_OF_CLOSED if rods_stick(chain) else _MERGING


def rods_stick(chain: Chain) -> bool:
    """Return whether rods that meet each other or a wall come to rest in contact."""
    return min(chain.restitution, chain.wall_restitution) < CRITICAL_RESTITUTION


def make_step(
    chain: Chain, time_step: float, stepper: Stepper, method: laws.Method = "event-driven"
) -> Step:
    """Return the numbers of one step of the chain under the named scheme."""
    m, gamma = chain.mass, chain.damping
    full_kick = chain.stiffness * time_step / m
    exponent = chain.potential_exponent
    if stepper == "euler":
        decay = 1 - gamma * time_step / m
        noise = chain.amplitude / m * math.sqrt(time_step)
        return Step(time_step, decay, noise, decay, noise, full_kick, exponent, False, 1.0, 1.0)
    inner, outer = (_ornstein_uhlenbeck(chain, duration) for duration in (time_step, time_step / 2))
    # Contact Dynamics has no stronger noise for closed contacts, as in the paper.
    strength = CLOSED_KICK if rods_stick(chain) and method == "event-driven" else 1.0
    # The half kick before a snapshot is left as it is. The one after it is so much stronger that
    # both together have strength^2 times the variance, which is 1 + decay^2 times that of one.
    outer_strength = math.sqrt(strength**2 + outer[0] ** 2 * (strength**2 - 1))
    return Step(time_step, *inner, *outer, full_kick / 2, exponent, True, strength, outer_strength)


def longest_step(chain: Chain, stepper: Stepper) -> float:
    """Return the limit of stability: with longer steps the energy of a rod grows without bound.

    It is 2/w0 for the splitting and 4/(g + sqrt(g^2 + 4 w0^2)), g = gamma/m, for euler. It is not
    known, inf, for a quadratic spring without damping, which has no rate.
    """
    if chain.spring == "quadratic" and math.isinf(chain.temperature):
        return math.inf
    damping = chain.damping / chain.mass if stepper == "euler" else 0.0
    slowest = damping + math.hypot(damping, 2 * spring_rate(chain))
    return 4 / slowest if slowest > 0 else math.inf


def _ornstein_uhlenbeck(chain: Chain, duration: float) -> tuple[float, float]:
    """Return the exact decay and noise of the velocity under damping and noise alone."""
    rate = 2 * chain.damping * duration / chain.mass
    # (1 - c^2)/rate -> 1 without damping: the noise alone, variance A^2 dt/m^2.
    share = -math.expm1(-rate) / rate if rate > 0 else 1.0
    return math.exp(-rate / 2), chain.amplitude / chain.mass * math.sqrt(duration * share)
