"""Theories hold all rods at wide gaps, and the gap of a single rod does not matter.

Over the whole parameter space the same is checked in ``tests/torture/test_any_number_of_rods.py``.
"""

import numpy as np
import pytest
from all_rods import require_all_rods
from every_solver import SOLVERS, Given

from crazybilliards.kinetic import compressed, displaced, force_balance, hydrodynamics, steady_state
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result

# With gaps as wide the others refuse the chain, or take long.
AT_WIDE_GAPS = [
    "equilibrium",
    "compressed",
    "steady_state",
    "hydrodynamics, label",
    *(name for name in SOLVERS if name.startswith("force_balance")),
]


@pytest.mark.parametrize(("size", "gap"), [(1, 100.0), (30, 20.0)])
@pytest.mark.parametrize("solver", AT_WIDE_GAPS)
def test_all_rods_are_held_at_wide_gaps(solver, size, gap):
    chain = Chain(size=size, gap=gap)
    numbers = {"number": 2.0, "stretch": 3.0, "times": {"duration": 0.5, "every": 0.5}}
    warm = {"variance": lambda x: 2.0 + 0 * np.asarray(x)}
    given = Given(start=compressed(chain, 1.5), **numbers, **warm)
    require_all_rods(SOLVERS[solver].solve(chain, given), size)


def test_one_rod_has_no_gap():
    """It has no neighbour to be apart from."""
    for spring in ("linear", "quadratic"):
        chain = Chain(size=1, spring=spring)
        apart = chain.replace(gap=20.0)
        for solve in (force_balance, steady_state):
            np.testing.assert_array_equal(solve(apart).density, solve(chain).density)
    start = displaced(Chain(size=1), 1.0).drop_attrs()
    options = {"duration": 1.0, "every": 1.0, "progress": False}
    one, other = (hydrodynamics(Chain(size=1, gap=gap), start, **options) for gap in (0.0, 20.0))
    np.testing.assert_array_equal(one.mean_displacement, other.mean_displacement)
    np.testing.assert_array_equal(one.density, other.density)


def test_a_result_without_all_rods_is_refused():
    chain, x = Chain(size=10), np.array([-1.0, 1.0])
    density = ("x", np.array([0.0, 0.0]))
    for most in (9.9999, 10.0001, np.nan):
        values = {"density": density, "label": ("x", np.array([0.0, most]))}
        with pytest.raises(ValueError, match="of the chain's 10 rods"):
            result(chain, values, coordinates={"x": x}, source="theory", method={})
