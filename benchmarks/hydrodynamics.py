"""Hydrodynamics: relaxation in the label frame, and py-pde's stepping against a bare loop."""

import numpy as np
import pytest
from numba import njit

from crazybilliards.kinetic import compressed, hydrodynamics
from crazybilliards.kinetic.eulerian_frame import (
    _constants,
    _faces,
    _starting_fields,
    eulerian_rate,
)
from crazybilliards.kinetic.pde_solver import solve
from crazybilliards.kinetic.starts import read_start
from crazybilliards.model import Chain

STEPS = 2000


@pytest.mark.benchmark(group="relaxation to the steady state, label frame")
@pytest.mark.parametrize("temperature", ["isothermal", "evolving"])
@pytest.mark.parametrize("gap", [0.0, 0.2, 1.0])
@pytest.mark.parametrize("size", [10, 100, 1000])
@pytest.mark.parametrize("amplitude", [1, 10, 100])
def test_relaxation(benchmark, amplitude, size, gap, temperature):
    chain = Chain(size=size, amplitude=amplitude, gap=gap)
    start = compressed(chain, 0.5)
    arguments = {"every": 5, "temperature": temperature, "progress": False}
    hydrodynamics(chain, start, 10, **arguments)  # compiled
    benchmark.pedantic(hydrodynamics, (chain, start, 100), arguments, rounds=1)


@njit
def bare_loop(fields, dt, steps, constants):
    for _ in range(steps):
        k1 = dt * eulerian_rate(fields, *constants)
        k2 = dt * eulerian_rate(fields + 0.5 * k1, *constants)
        k3 = dt * eulerian_rate(fields + 0.5 * k2, *constants)
        k4 = dt * eulerian_rate(fields + k3, *constants)
        fields = fields + (k1 + 2 * k2 + 2 * k3 + k4) / 6
    return fields


@pytest.mark.parametrize("stepping", ["bare loop", "py-pde"])
@pytest.mark.parametrize("cells", [200, 800])
def test_stepping(benchmark, cells, stepping):
    """The same scheme for the same number of steps, eulerian frame."""
    benchmark.group = f"{STEPS} Runge-Kutta steps of {cells} cells"
    chain = Chain(amplitude=10)
    start = read_start(chain, compressed(chain, 0.8))
    faces = _faces(chain, start, cells, 1.0)
    fields = _starting_fields(chain, start, faces, thermal=False)
    constants = _constants(chain, faces, None, None)
    dt = 0.02 * constants.spacing
    if stepping == "bare loop":
        benchmark(bare_loop, np.array(list(fields.values())), dt, STEPS, tuple(constants))
        return

    def rate(values, time=0.0):
        return eulerian_rate(values, *constants)

    times = np.array([0.0, STEPS * dt])
    arguments = {"progress": False, "solver": "runge-kutta", "backend": "numpy", "dt": dt}
    benchmark(solve, rate, fields, times, **arguments)
