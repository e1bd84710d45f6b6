"""The accelerated fixed-point iteration: it converges, or gives up."""

import numpy as np
import pytest

from crazybilliards.kinetic.gas.agreement import find_fixed_point
from crazybilliards.kinetic.gas.mean_state import NoSteadyStateError


def test_the_fixed_point_is_found_with_its_state_or_refused():
    """Mutation: an image that is not the last one's state."""
    matrix = np.array([[0.5, -0.9], [0.8, -1.4]])  # a plain iteration would grow
    found = find_fixed_point(lambda x: (matrix @ x + 1, x.copy()), np.zeros(2), 1e-10)
    np.testing.assert_allclose(found.x, np.linalg.solve(np.eye(2) - matrix, [1, 1]), rtol=1e-8)
    np.testing.assert_array_equal(found.state, found.x)
    assert found.residual < 1e-10
    assert 3 < found.evaluations < 20
    with pytest.raises(NoSteadyStateError, match=r"no agreement after 60 iterations: .* by [1-3]"):
        find_fixed_point(lambda x: (x + 2 + np.cos(x), None), np.array([0.3]), 1e-3)


def test_a_step_to_where_there_is_nothing_ends_it_with_what_was_found_before():
    def image(x):
        if x > 0.55:
            raise ValueError("nothing here")
        return x + 2, None

    with pytest.raises(NoSteadyStateError, match=r"no agreement after 1 iterations: .* by 2"):
        find_fixed_point(image, np.zeros(1), 1e-8)
    with pytest.raises(ValueError, match="nothing here"):
        find_fixed_point(image, np.ones(1), 1e-8)
