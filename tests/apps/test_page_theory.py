"""Which theory the page's server solves, and that a class understands why it has none."""

import re
from dataclasses import replace
from urllib.parse import urlencode

import pytest

from crazybilliards.apps.explore import theory
from crazybilliards.comparison.stationary_theories import THEORIES

GROWS = "by the theory its energy grows without bound"
UNSOLVED = "its equations could not be solved for this chain; fewer rods"
ADVICE = r"--|_|\bcells\b|Python|simulate|iteration"


def require_words(answer, said):
    assert answer["refused"].startswith(said)
    assert not re.search(ADVICE, answer["refused"])


@pytest.mark.parametrize(
    ("chain", "said"),
    [
        ({"size": 40, "restitution": 1.05}, GROWS),
        ({"size": 40, "restitution": 1.05, "amplitude": 0}, "without noise there is no steady"),
        ({"size": 20, "restitution": 1.02}, None),
        ({"size": 30, "restitution": 0, "damping": 0.3, "gap": 0.5}, None),
        ({"size": 1, "restitution": 0.9, "spring": "quadratic"}, None),
    ],
)
def test_energy_grows_only_if_the_solver_has_found_so(chain, said):
    answer = theory.answer(urlencode(chain))
    assert list(answer) == (["refused"] if said else ["best"])
    if said:
        require_words(answer, said)


def test_what_could_not_be_solved_is_not_said_to_run_away(monkeypatch):
    def fail(chain):
        raise ValueError("no agreement after 60 iterations")

    failing = replace(THEORIES["steady_state"], solve=fail)
    monkeypatch.setitem(THEORIES, "steady_state", failing)
    require_words(theory.answer("restitution=1.05&gap=0.5"), UNSOLVED)
