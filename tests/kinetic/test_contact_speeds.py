"""How fast neighbours are when they meet: the package's table against the solver it comes from."""

import numpy as np
import pytest

from crazybilliards.kinetic.gas.closure import SQUARES, contact_speed
from studies.contact_speeds import contact_square, make_mesh, solve

COARSE = (48, 75), (64, 100)
FINER = (75, 120), (100, 160)


@pytest.mark.parametrize("restitution", [0.3, 0.75])
def test_the_table_is_what_the_solver_finds(restitution):
    """On these meshes 0.0075 above the converged value, whatever the restitution."""
    assert contact_speed(1.0) == SQUARES[1.0] == 1
    found = contact_square(restitution, COARSE)
    assert found == pytest.approx(SQUARES[restitution] + 0.0075, abs=2e-3)


@pytest.mark.parametrize("restitution", [0.0, 1.0])
def test_balances_of_the_solver(restitution):
    """Collisions give the momentum that the force takes, and with damping the energy of the noise.

    On meshes of one proportion the error falls like the size of the cells.
    """
    a, off = 0.8, []
    for cells in FINER:
        found = solve(make_mesh(*cells), restitution, a)
        momentum = (1 + restitution) * found.impulse
        energy = a * found.square + (1 - restitution**2) / 2 * found.energy
        off.append([momentum - 1, energy - 1])
    coarse, fine = np.array(off)
    np.testing.assert_allclose(fine + (fine - coarse) / (4 / 3 - 1), 0, atol=6e-3)
