"""Which theories the page's server solves, and that a class understands why it has none."""

import re
from urllib.parse import urlencode

import pytest

from crazybilliards.apps.explore import theory

GROWS = "by the kinetic equation its energy grows without bound"
UNSOLVED = "its equations could not be solved for this chain; fewer rods"
ADVICE = r"--|_|\bcells\b|tolerance|Python|simulate|GMRES|Newton"


@pytest.mark.validate
@pytest.mark.compiled
@pytest.mark.parametrize(
    ("chain", "said"),
    [
        ({"size": 40, "restitution": 1.05}, GROWS),
        ({"size": 200, "restitution": 1.1, "damping": 10, "gap": 5}, UNSOLVED),
        ({"size": 30, "restitution": 0, "amplitude": 0.1, "gap": 5}, UNSOLVED),
        ({"size": 40, "restitution": 1.05, "amplitude": 0}, "without noise there is no steady"),
        ({"size": 20, "restitution": 1.02}, None),
        ({"size": 90, "restitution": 0, "damping": 0.3, "gap": 0.5}, None),
    ],
)
def test_energy_grows_only_if_the_solver_has_found_so(chain, said):
    """Chains above e = 1 that could not be solved, or have a solution, are not said to run away.

    The last chain has a solution to the page's tolerance, and none to the usual one.
    """
    answer = theory.answer(urlencode(chain))
    assert ("best" in answer) == (said is None)
    if said:
        assert answer["refused"].startswith(said)
        assert not re.search(ADVICE, answer["refused"])
