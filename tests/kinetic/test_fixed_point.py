"""The accelerated fixed-point iteration: it converges, goes back, or gives up."""

import numpy as np
import pytest

from crazybilliards.kinetic.gas.fixed_point import NoFixedPointError, find_fixed_point


def test_the_fixed_point_is_found_or_refused():
    matrix = np.array([[0.5, -0.9], [0.8, -1.4]])  # a plain iteration would grow
    found = find_fixed_point(lambda x: matrix @ x + 1, np.zeros(2), 1e-10, 40)
    np.testing.assert_allclose(found.x, np.linalg.solve(np.eye(2) - matrix, [1, 1]), rtol=1e-8)
    assert found.residual < 1e-10
    with pytest.raises(NoFixedPointError, match="no agreement after 5 iterations"):
        find_fixed_point(lambda x: x + 1, np.zeros(2), 1e-3, 5)


def test_the_fixed_point_goes_back_from_where_there_is_nothing():
    def image(x):
        if x > 0.55:
            raise ValueError("nothing here")
        return 2 * x**2 + 0.1

    found = find_fixed_point(image, np.zeros(1), 1e-8, 40)
    np.testing.assert_allclose(found.x, (1 - np.sqrt(0.2)) / 4, atol=1e-7)
    with pytest.raises(ValueError, match="nothing here"):
        find_fixed_point(image, np.ones(1), 1e-8, 40)
