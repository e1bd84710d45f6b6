"""Cost of a step of the elastic chain against the cost of drawing its noise alone.

Every group is one chain: the multiple in parentheses is the ratio to the noise. Divide a time by
the particle steps in the group's name for the cost per particle and step.
"""

import numpy as np
import pytest
from numba import njit

from crazybilliards.model import Chain
from crazybilliards.particles import stepping
from crazybilliards.particles.drift import make_law, make_scratch
from crazybilliards.particles.schedule import default_time_step, relaxation_time

PARTICLE_STEPS = 2_000_000

CASES = [
    pytest.param(size, time_step, id=f"L={size}, dt={time_step or 'default'}")
    for size in (100, 1000)
    for time_step in (None, 0.01, 0.001)
]


@njit(cache=True, nogil=True)
def draw_noise(generator, number):
    total = 0.0
    for _ in range(number):
        total += generator.standard_normal()
    return total


@pytest.mark.parametrize(("size", "time_step"), CASES)
@pytest.mark.parametrize("work", ["noise alone", "whole step"])
def test_step(benchmark, work, size, time_step, request):
    chain = Chain(size=size)
    time_step = time_step or default_time_step(chain)
    case = request.node.callspec.id.split("-")[-1]
    benchmark.group = f"{case}: {PARTICLE_STEPS} particle steps"
    generator = np.random.Generator(np.random.PCG64(0))
    if work == "noise alone":
        benchmark(draw_noise, generator, PARTICLE_STEPS)
        return
    y, v, anchors = np.zeros((3, size))
    step = stepping.make_step(chain, time_step, "splitting")
    settle = int(5 * relaxation_time(chain) / time_step)
    law = make_law(chain, time_step, "event-driven", 0.03, 1.0)
    kernel = (y, v, anchors, generator, step, law, make_scratch(size), np.zeros(0, dtype=np.int64))
    stepping.advance(*kernel, settle)
    benchmark(stepping.advance, *kernel, PARTICLE_STEPS // size)
