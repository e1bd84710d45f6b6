"""Steps of the eulerian frame: taken by py-pde against a bare loop around the same rates.

    python benchmarks/stepping.py

py-pde's time is that of its stepping alone, as it reports it; compilation is apart.
"""

import time

import numpy as np
from numba import njit
from pde import FieldCollection

from crazybilliards.kinetic import compressed
from crazybilliards.kinetic.fluids.eulerian_frame import Constants, make_constants
from crazybilliards.kinetic.fluids.finite_volumes import eulerian_rate, make_rate
from crazybilliards.kinetic.fluids.pde_solver import Flow, make_state
from crazybilliards.kinetic.fluids.position_cells import make_faces, starting_fields
from crazybilliards.kinetic.starts import read_start
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

STEPS = 5000


@njit
def bare_loop(fields: Array, dt: float, steps: int, constants: Constants) -> Array:
    for _ in range(steps):
        k1 = dt * eulerian_rate(fields, constants)
        k2 = dt * eulerian_rate(fields + 0.5 * k1, constants)
        k3 = dt * eulerian_rate(fields + 0.5 * k2, constants)
        k4 = dt * eulerian_rate(fields + k3, constants)
        fields = fields + (k1 + 2 * k2 + 2 * k3 + k4) / 6
    return fields


def main() -> None:
    print("| cells | bare loop, ns per cell and step | py-pde | ratio |\n|---|---|---|---|")
    chain = Chain(amplitude=10)
    start = read_start(chain, compressed(chain, 0.8))
    for cells in (200, 800, 3200):
        faces = make_faces(chain, start, STEPS, cells, 1.0)
        fields = starting_fields(chain, start, faces, thermal=False)
        constants = make_constants(chain, faces, None, None)
        dt = 0.02 * constants.spacing / chain.free_velocity_width
        values = np.array(list(fields.values()))
        bare_loop(values, dt, 1, constants)
        begin = time.perf_counter()
        expected = bare_loop(values, dt, STEPS, constants)
        bare = time.perf_counter() - begin
        state = make_state(fields, (faces[0], faces[-1]))
        flow = Flow(make_rate(constants))
        found = flow.solve(
            state, STEPS * dt, dt, tracker=None, solver="runge-kutta", backend="numba"
        )
        assert isinstance(found, FieldCollection)
        np.testing.assert_allclose(found.data, expected, atol=1e-12)
        stepping = flow.diagnostics["controller"]["profiler"]["solver"]
        scale = 1e9 / (STEPS * cells)
        print(f"| {cells} | {bare * scale:.0f} | {stepping * scale:.0f} | {stepping / bare:.2f} |")


if __name__ == "__main__":
    main()
