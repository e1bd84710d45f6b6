"""Cost of a step under each collision operator, against drawing its noise alone.

Every group is one chain length: the multiple in parentheses is the ratio to the noise. Divide a
time by the particle steps in the group's name for the cost per particle and step. Chains are
settled first; the time step is 1e-3 and the default one for elastic chains.
"""

import numpy as np
import pytest
from numba import njit

from crazybilliards.model import Chain
from crazybilliards.particles import stepping
from crazybilliards.particles.avalanche import make_tally
from crazybilliards.particles.drift import make_law, make_scratch
from crazybilliards.particles.schedule import default_time_step

PARTICLE_STEPS = 1_000_000
SIZES = (10, 100, 1000, 10_000)
WORK = {
    "sort": (1.0, "event-driven", 1e-3),
    "sort, default step": (1.0, "event-driven", None),
    "isotonic": (0.0, "event-driven", 1e-3),
    "heap, e=0.95": (0.95, "event-driven", 1e-3),
    "contact dynamics, e=0": (0.0, "contact-dynamics", 1e-3),
}


@njit(cache=True, nogil=True)
def draw_noise(generator, number):
    total = 0.0
    for _ in range(number):
        total += generator.standard_normal()
    return total


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("work", ["noise alone", *WORK])
def test_step(benchmark, work, size):
    benchmark.group = f"L={size:6d}, {PARTICLE_STEPS} particle steps"
    generator = np.random.Generator(np.random.PCG64(0))
    if work == "noise alone":
        benchmark(draw_noise, generator, PARTICLE_STEPS)
        return
    restitution, method, time_step = WORK[work]
    chain = Chain(size=size, restitution=restitution)
    time_step = time_step or default_time_step(chain)
    y, v, anchors = np.zeros((3, size))
    law = make_law(chain, time_step, method, 0.03, speed=1.0)
    step = stepping.make_step(chain, time_step, "splitting")
    kernel = (
        y,
        v,
        anchors,
        generator,
        step,
        law,
        make_scratch(size),
        make_tally(size, contacts=False, waves=False),
    )
    stepping.advance(*kernel, max(20_000_000 // size, 1000))
    benchmark(stepping.advance, *kernel, PARTICLE_STEPS // size)
