r"""The physical scales of a chain, from which a run is planned.

**Time step.** The step is 0.05 / max(w0, gamma/m), w0 from :func:`spring_rate`. The splitting
scheme then has W_x right to 3e-4 (linear springs, no gap). For e != 1 the velocity kick of one step
is at most 0.3 W_v in the centre, as :func:`centre_width` estimates it, and the error of W_v at most
1 %.

**Relaxation time.** It is that of a rod on a linear spring, whose stiffness is estimated for
quadratic springs, and in a box at most that of a gas without springs. The step resolves the
lightest rod; the relaxation waits for the heaviest.
"""

import math

import numpy as np

from crazybilliards.model import WALLS_AND_MASSES, Array, Chain
from crazybilliards.model.checks import check_chain

# Parameters beside ``KNOWN`` with which these scales are right. A run refuses others.
knows: frozenset[str] = WALLS_AND_MASSES

_RESOLUTION, _KICK = 0.05, 0.3
_SLOWEST_MODE = 1.241  # rate of a strongly damped rod on a quadratic spring, in k s/gamma


def spring_rate(chain: Chain) -> float:
    """w0 = sqrt(F'(d)/m) [1/t_0]; a quadratic spring's is taken at U(d) = 10 T, the temperature."""
    lightest = chain.rod_masses[:2].min()
    if chain.spring == "linear":
        return math.sqrt(chain.stiffness / lightest)
    if chain.stiffness == 0 or chain.temperature == 0:
        return 0.0
    if math.isinf(chain.temperature):
        raise ValueError(
            "time_step: a quadratic spring without damping has no typical displacement to choose "
            "a step from; give time_step"
        )
    return math.sqrt(2 * chain.stiffness * chain.reach(10 * chain.temperature) / lightest)


def centre_width(chain: Chain) -> float:
    """Estimate the ratio of W_v in the centre of the chain to W, within a fifth for e < 1.

    Heating by the noise balances damping and collisions, whose cooling grows as the chain cools
    and contracts: 1/w^2 = 1 + q with q = c (1 - e^2) n sqrt(k m)/gamma, n the number of rods that
    lie within a few thermal lengths. c = 0.1 + 0.14 e^4 fits simulations from L = 10 to 1000.

    In a box the collisions of uncorrelated rods in a free length l are at least as frequent as
    these: w^2 - 1 + (1 - e^2) w^3 W m L/(sqrt(pi) gamma l) = 0.
    """
    e, width = chain.restitution, 1.0
    if e >= 1 or chain.damping == 0:
        return width
    if chain.box:
        free_path = 2 * chain.walls[1] / chain.size * chain.damping / math.sqrt(chain.mean_mass)
        loss = (1 - e**2) * math.sqrt(chain.temperature / math.pi) / free_path
        roots = np.roots([loss, 1.0, 0.0, -1.0])
        width = float(roots.real[np.isreal(roots) & (roots.real > 0)][0])
    if chain.stiffness > 0:
        length = max(2.5 * chain.thermal_length, 1e-60)
        neighbours = chain.size / (1 + chain.gap * chain.size / length)
        rate = spring_rate(chain) * chain.mass / chain.damping
        cooling = (0.1 + 0.14 * e**4) * (1 - e**2) * neighbours * rate
        width = min(1 / math.sqrt(1 + cooling), width)
    return width


def default_time_step(chain: Chain) -> float:
    """Return a step that resolves spring, damping and, for e != 1, the noise; see the module."""
    lightest = chain.rod_masses[:2].min()
    fastest = max(spring_rate(chain), chain.damping / lightest)
    if fastest == 0:
        raise ValueError(
            "time_step: a chain without damping and without a working spring has no time scale "
            "to choose a step from; give time_step"
        )
    step = _RESOLUTION / fastest
    elastic = chain.restitution == chain.wall_restitution == 1
    if elastic or chain.amplitude == 0 or chain.damping == 0:
        return step
    # A sqrt(dt)/m = 0.3 W_v, W = A/sqrt(2 m gamma)
    return min(step, (_KICK * centre_width(chain)) ** 2 * lightest / (2 * chain.damping))


def relaxation_time(chain: Chain) -> float:
    """Time in which a chain forgets its start [t_0], but for a factor e.

    It is the time constant of the chain's slowest mode, infinite without damping, and if neither
    springs nor walls hold the rods. With linear springs this mode is the motion of the centre of
    mass, on which collisions do not act: exactly 2m/gamma for weak damping, and about gamma/k for
    strong damping, at every restitution. No other mode is slower, at e < 1 in simulations. For
    quadratic springs the time is an estimate, which is right to a third for 1 to 300 rods with gaps
    from 0.03 s to s at restitution 1. A gas without springs forgets its density last, in a box of
    free length l by diffusion in gamma l^2/(pi^2 T), or in sqrt(2) l/(pi W) if damping is weak. For
    e > 1 the time is a lower bound: near the critical size the energy takes longer.

    Take a warm-up of at least five times it (the default is 12), and durations of hundreds.

    Examples
    --------
    >>> from crazybilliards.model import Chain
    >>> round(relaxation_time(Chain()), 2)
    8.38
    """
    check_chain(chain)
    chain.require_known("relaxation_time", knows)
    return math.inf if chain.stiffness == chain.box == 0 else settling_time(chain)


def settling_time(chain: Chain) -> float:
    """Return the relaxation time or, where nothing ties the rods, that of velocities [t_0]."""
    if chain.damping == 0:
        return math.inf
    time = max(_settling_time(chain, float(mass)) for mass in chain.rod_masses[:2])
    if chain.box and chain.temperature > 0:
        in_box = max(2 * chain.rod_masses[:2].max() / chain.damping, _crossing_time(chain))
        return float(in_box if chain.stiffness == 0 else min(time, in_box))
    return time


def _crossing_time(chain: Chain) -> float:
    """Time constant of the slowest wave of density in a box, diffusive or free [t_0]."""
    wave_number = math.pi / (2 * chain.walls[1])
    slowest = math.sqrt(chain.temperature / chain.rod_masses[:2].max())
    diffusion = chain.damping / (wave_number**2 * chain.temperature)
    return max(diffusion, math.sqrt(2) / (wave_number * slowest))


def _settling_time(chain: Chain, mass: float) -> float:
    half_damping = chain.damping / (2 * mass)
    rate = math.sqrt(_relaxing_stiffness(chain) / mass)
    if rate == 0:
        return 1 / (2 * half_damping)
    if rate >= half_damping:
        return 1 / half_damping
    # 1/(b - sqrt(b^2 - w^2)), written without cancellation.
    return (half_damping + math.sqrt(half_damping**2 - rate**2)) / rate**2


def correlation_time(chain: Chain) -> float:
    """Longest integral of an autocorrelation function from 0 on [t_0]; 0 if nothing relaxes.

    It is m/gamma for energies under weak damping, and gamma/k' for displacements under strong one.
    """
    if chain.damping == 0:
        return 0.0
    stiffness = _relaxing_stiffness(chain)
    swings = chain.damping / stiffness if stiffness > 0 else 0.0
    if chain.box and chain.temperature > 0:
        swings = min(swings or math.inf, _crossing_time(chain))
    return max(float(chain.rod_masses[:2].max()) / chain.damping, swings)


def _relaxing_stiffness(chain: Chain) -> float:
    """Stiffness k' of the linear spring that relaxes as slowly as the chain's own [M/t_0^2].

    A rod on a quadratic spring diffuses in k |d|^3/3 if the damping is strong. Its slowest mode
    decays at the rate 1.241 k s/gamma: 1.241 is the smallest eigenvalue above 0 of the
    Fokker-Planck operator -d^2/dz^2 + z|z| d/dz, z = d/s. In a chain, rods that collide move
    together, and k' is the mean of 2k|d| over them, at most that of a single rod:

        k' = 1.241 k s min[1, sqrt(z^2 + 1/(1 + g L/2s)^2)],      z = (0.54 g/s)^(2/5).

    The first part is that of fluctuations: neighbours a gap g apart are coupled by T/g^2, as points
    of a gas, so <d^2> = (g/2) sqrt(T/k') = 0.78 s^2 z^2. The second is that of the pressure, which
    pushes the rods within some s of the ends of a lattice of length gL, on average by about
    s/(1 + g L/2s).
    """
    if chain.spring == "linear":
        return chain.stiffness
    if chain.stiffness == 0 or chain.temperature == 0:
        return 0.0
    s, gap = chain.thermal_length, chain.lattice_gap
    fluctuation = (0.54 * gap / s) ** 0.4
    pushed = 1 / (1 + gap * chain.size / (2 * s))
    return _SLOWEST_MODE * chain.stiffness * s * min(1.0, math.hypot(fluctuation, pushed))


def first_decay(chain: Chain) -> float:
    """Estimate the time in which a rod's velocity decays first [t_0]: to 0.1 at e = 1, 0.5 below.

    It is the shortest of m/gamma, 1/w0, and the distance to the next rod over the velocity width,
    in the middle of a cloud as wide as that of a free rod, or on the lattice; inf without damping.
    """
    if chain.damping == 0:
        return math.inf
    width = centre_width(chain)
    rates = [chain.damping / chain.rod_masses[:2].min(), spring_rate(chain)]
    if chain.size > 1 and chain.temperature > 0:
        room = 2.5 * width * chain.thermal_length / chain.size + chain.gap
        room = min(room, 2 * chain.walls[1] / chain.size)
        rates.append(width * chain.free_velocity_width / room)
    return 1 / max(rates)


def typical_speed(chain: Chain, duration: float, y: Array, v: Array) -> float:
    """Upper estimate of the speed that noise and the start's own energy give a rod [R/t_0]."""
    lightest = chain.rod_masses[:2].min()
    heating = min(duration, lightest / (2 * chain.damping) if chain.damping else np.inf)
    noise = chain.amplitude / lightest * np.sqrt(heating)
    spring = np.sqrt(2 * chain.potential(y - chain.reduced_anchors).max() / lightest)
    return float(noise + spring + np.abs(v).max())


def start_swing(chain: Chain, duration: float, y: Array, v: Array) -> float:
    """Largest displacement of a free rod with the start's energy, in this time if unbound [R]."""
    if chain.box:
        return chain.box
    displacement = y - chain.reduced_anchors
    if chain.stiffness == 0:
        flight = min(duration, chain.mass / chain.damping) if chain.damping else duration
        return float(np.abs(displacement).max() + np.abs(v).max() * flight)
    energy = chain.potential(displacement) + chain.rod_masses / 2 * v**2
    return chain.reach(float(energy.max()))
