"""Cost of a step under each collision operator, against drawing its noise alone.

Every group is one chain length. Divide a time by ``particle_steps`` of the measurement for the
cost per particle and step, as ``report.py`` does, which also gives the ratio to the noise. The time
step is 1e-3, for elastic chains the default one. The exact flight costs as much at any step. The
collisions of a second are those of the elastic chain whose collisions are recorded, at the default
step: there they are most of the work.

How many contacts are closed in a chain at e = 0 changes slowly, and its cost with it: the rounds of
a measurement go on for seconds, over many such changes. A call ends with half a kick more, noise
included, and therefore takes many steps, however long the chain.
"""

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from crazybilliards.model import Array, Chain
from crazybilliards.model.kernels import kernel
from crazybilliards.model.parameters import Spring
from crazybilliards.particles import stepping
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import Method, make_scratch
from crazybilliards.particles.noise import Noise, fill, make_noise
from crazybilliards.particles.scales import centre_width, default_time_step

PARTICLE_STEPS = 1_000_000
LEAST_STEPS = 20  # of one call
SIZES = (10, 100, 1000, 10_000, 100_000, 1_000_000)
WORK: dict[str, tuple[float, Method, float | None, Spring]] = {
    "exact, e = 1, any step": (1.0, "event-driven", 1.0, "linear"),
    "sort, e = 1, quadratic springs, default step": (1.0, "event-driven", None, "quadratic"),
    "isotonic, e = 0, dt = 1e-3": (0.0, "event-driven", 1e-3, "linear"),
    "events, e = 0.95, dt = 1e-3": (0.95, "event-driven", 1e-3, "linear"),
    "events, e = 1, default step": (1.0, "event-driven", None, "linear"),
    "Contact Dynamics, e = 0, dt = 1e-3": (0.0, "contact-dynamics", 1e-3, "linear"),
}
NOISE = "noise alone"


@kernel
def draw_noise(noise: Noise, kicks: Array, size: int, steps: int) -> None:
    """Draw the noise of some steps, of as many at a time as have room in ``kicks``."""
    rows = kicks.size // size
    for taken in range(0, steps, rows):
        fill(noise, kicks[: min(rows, steps - taken) * size])


@pytest.mark.benchmark(max_time=3.0)
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("work", [NOISE, *WORK])
def test_step(benchmark: BenchmarkFixture, work: str, size: int) -> None:
    benchmark.group = f"L={size:7d}"
    steps = max(PARTICLE_STEPS // size, LEAST_STEPS)
    benchmark.extra_info.update(work=work, size=size, particle_steps=steps * size)
    noise, scratch = make_noise(np.random.SeedSequence(0)), make_scratch(size)
    if work == NOISE:
        benchmark(draw_noise, noise, scratch.kicks, size, steps)
        return
    if work.startswith("events, e = 1") and size > 1000:
        pytest.skip("hundreds of collisions a rod and step: that is what sorting is for")
    if work.startswith("events, e = 0.95") and size > 10_000:
        pytest.skip("takes too long to come near its steady state")
    restitution, method, time_step, spring = WORK[work]
    chain = Chain(size=size, restitution=restitution, spring=spring)
    time_step = time_step or default_time_step(chain)
    # Near the steady state, which long chains take too long to find from rest.
    generator = np.random.default_rng(0)
    y = np.sort(generator.normal(scale=chain.thermal_length, size=size))
    v = generator.normal(scale=centre_width(chain) * chain.free_velocity_width, size=size)
    dynamics = make_dynamics(
        chain, time_step, speed=1.0, method=method, counted=work.startswith("events, e = 1")
    )
    unseen = make_tally(size, contacts=False)
    state = (y, v, noise, dynamics, scratch, unseen)
    stepping.advance(*state, max(20_000_000 // size, 50))
    collisions = benchmark(stepping.advance, *state, steps)
    benchmark.extra_info["collisions"] = collisions
