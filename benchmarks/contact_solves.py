"""One contact solve: the exact one in O(L) against Gauss-Seidel stopped at two tolerances.

A settled chain at e = 0, L = 1000, dt = 1e-3; Gauss-Seidel is warm-started from the last step's
impulses, as Contact Dynamics codes do.
"""

import numpy as np
import pytest
from gauss_seidel import solve
from pytest_benchmark.fixture import BenchmarkFixture

from crazybilliards.model import Array, Chain
from crazybilliards.particles import stepping
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import Law, Scratch, drift, make_scratch
from crazybilliards.particles.noise import fill, make_noise

SIZE, TIME_STEP = 1000, 1e-3
UNSEEN = make_tally(2, contacts=False)
Settled = tuple[Law, Scratch, list[tuple[Array, Array]]]


@pytest.fixture(scope="module")
def solver() -> Settled:
    """Return a settled chain's law and fifty successive states, the next kick already given."""
    chain = Chain(size=SIZE, restitution=0)
    dynamics = make_dynamics(chain, TIME_STEP, speed=1.0, method="contact-dynamics")
    noise = make_noise(np.random.SeedSequence(0))
    scratch = make_scratch(SIZE)
    y, v = np.zeros((2, SIZE))
    kernel = (y, v, noise, dynamics, scratch, UNSEEN)
    stepping.advance(*kernel, 30_000)
    states, kicks = [], np.zeros(SIZE)
    for _ in range(50):
        stepping.advance(*kernel, 1)
        fill(noise, kicks)
        states.append((y.copy(), v + dynamics.step.noise * kicks))
    return dynamics.law, scratch, states


@pytest.mark.benchmark(group=f"50 contact solves of {SIZE} rods")
def test_exact(benchmark: BenchmarkFixture, solver: Settled) -> None:
    law, scratch, states = solver

    def solve_all() -> None:
        for y, v in states:
            drift(y.copy(), v.copy(), np.zeros(SIZE), TIME_STEP, law, scratch, UNSEEN)

    benchmark(solve_all)


@pytest.mark.benchmark(group=f"50 contact solves of {SIZE} rods")
@pytest.mark.parametrize("tolerance", [1e-3, 1e-10])
def test_gauss_seidel(benchmark: BenchmarkFixture, solver: Settled, tolerance: float) -> None:
    _, _, states = solver

    def solve_all() -> None:
        impulses, bounds = np.zeros((2, SIZE - 1))
        for y, v in states:
            solve(y, v.copy(), np.zeros(SIZE), TIME_STEP, 0.0, tolerance, impulses, bounds)

    benchmark.pedantic(solve_all, rounds=3, warmup_rounds=1)
