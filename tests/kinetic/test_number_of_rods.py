"""Theories hold all rods at wide gaps, and the gap of a single rod does not matter.

Over the whole parameter space the same is checked in ``tests/torture/test_number_of_rods.py``.
"""

import numpy as np
import pytest
from all_rods import require_all_rods

from crazybilliards.kinetic import (
    compressed,
    displaced,
    equilibrium,
    force_balance,
    hydrodynamics,
    phase_space,
    relax_phase_space,
    two_clumps,
)
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result


def softly(x):
    return 0.3 * np.asarray(x)


def hot(x):
    return 2.0 + 0 * np.asarray(x)


THEORIES = {
    "equilibrium": equilibrium,
    "force_balance": force_balance,
    "number": lambda chain: force_balance(chain, velocity_variance=2.0),
    "variance": lambda chain: force_balance(chain, velocity_variance=hot),
    "displacement": lambda chain: force_balance(chain, softly),
    "both": lambda chain: force_balance(chain, softly, hot),
    "compressed": lambda chain: compressed(chain, 3.0),
    "two_clumps": lambda chain: two_clumps(chain, 1.0, 1.0),
    "hydrodynamics": lambda chain: hydrodynamics(
        chain, compressed(chain, 1.5), 0.5, every=0.5, progress=False
    ),
}


@pytest.mark.parametrize(("size", "gap"), [(2, 100.0), (100, 20.0), (1, 100.0)])
@pytest.mark.parametrize("theory", THEORIES)
def test_all_rods_are_held_at_wide_gaps(theory, size, gap):
    require_all_rods(THEORIES[theory](Chain(size=size, gap=gap)), size)


def test_the_gap_of_a_single_rod_is_none():
    """It has no neighbour to be apart from."""
    for spring in ("linear", "quadratic"):
        chain = Chain(size=1, spring=spring)
        apart = chain.replace(gap=20.0)
        for solve in (force_balance, lambda each: phase_space(each, cells=8)):
            np.testing.assert_array_equal(solve(apart).density, solve(chain).density)
    start = displaced(Chain(size=1), 1.0).drop_attrs()
    options = {"duration": 1.0, "every": 1.0, "progress": False}
    for solve in (hydrodynamics, relax_phase_space):
        one, other = (solve(Chain(size=1, gap=gap), start, **options) for gap in (0.0, 20.0))
        np.testing.assert_array_equal(one.mean_displacement, other.mean_displacement)
        np.testing.assert_array_equal(one.density, other.density)


def test_a_result_without_all_rods_is_refused():
    chain, x = Chain(size=10), np.array([-1.0, 1.0])
    density = ("x", np.array([0.0, 0.0]))
    for most in (9.9999, 10.0001, np.nan):
        with pytest.raises(ValueError, match="of the chain's 10 rods"):
            result(
                chain,
                {"density": density, "label": ("x", np.array([0.0, most]))},
                coordinates={"x": x},
                source="theory",
                method={},
            )
