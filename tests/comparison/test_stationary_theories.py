"""Which theory a chain has, and that unknown errors are said where a theory is called."""

import re
import warnings

import pytest

from crazybilliards.comparison.stationary_theories import THEORIES, theory_of
from crazybilliards.kinetic import UnmeasuredWarning, force_balance
from crazybilliards.model import Chain

CHAIN, BOX = Chain(size=30), Chain(size=30, box=90)


@pytest.mark.parametrize(
    ("chain", "name"),
    [
        *((each, "equilibrium") for each in (CHAIN, CHAIN.replace(gap=0.5), BOX)),
        (CHAIN.replace(spring="quadratic"), "equilibrium"),
        *((each.replace(restitution=0.9), "steady_state") for each in (CHAIN, BOX)),
        (CHAIN.replace(restitution=1.05), "steady_state"),
        (BOX.replace(wall_restitution=0.9), "steady_state"),
    ],
)
def test_what_keeps_its_energy_in_collisions_has_an_exact_equilibrium(chain, name):
    assert theory_of(chain).name == name
    theory_of(chain).check(chain)


@pytest.mark.parametrize("name", THEORIES)
@pytest.mark.parametrize("changed", [{"damping": 0.0}, {"restitution": 0.9, "mass_ratio": 2.0}])
def test_a_theory_is_checked_by_the_error_that_it_raises(name, changed):
    chain, theory = CHAIN.replace(**changed), THEORIES[name]
    with pytest.raises(ValueError, match=r"\w") as caught:
        theory.check(chain)
    with pytest.raises(ValueError, match=f"^{re.escape(str(caught.value))}$"):
        theory.solve(chain)


def test_an_unknown_error_is_said_where_the_theory_is_called():
    with pytest.warns(UnmeasuredWarning, match="force balance was not measured") as caught:
        force_balance(CHAIN.replace(spring="quadratic"))
    assert caught[0].filename == __file__


def test_a_known_error_needs_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        force_balance(CHAIN.replace(gap=0.3))
