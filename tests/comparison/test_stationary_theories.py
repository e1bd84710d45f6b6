"""The table of theories says what the theories themselves check and state, and picks the best."""

import re
import warnings

import numpy as np
import pytest

from crazybilliards.comparison import best_theory, theories
from crazybilliards.comparison.stationary_theories import THEORIES, choose_theory
from crazybilliards.kinetic import (
    UnmeasuredWarning,
    correlated_phase_space,
    equilibrium,
    force_balance,
    phase_space,
)
from crazybilliards.kinetic.accuracy import Accuracy
from crazybilliards.model import Chain

CHAINS = {
    "elastic": (Chain(size=30), "equilibrium"),
    "elastic, gap": (Chain(size=30, gap=0.5), "equilibrium"),
    "quadratic": (Chain(size=30, spring="quadratic"), "equilibrium"),
    "near 1": (Chain(size=100, restitution=0.95), "phase_space"),
    "0.5": (Chain(size=100, restitution=0.5), "correlated_phase_space"),
    "0.5, gap": (Chain(size=100, restitution=0.5, gap=0.1), "phase_space"),
    "0.9, quadratic": (Chain(size=30, restitution=0.9, spring="quadratic"), "phase_space"),
    "driven": (Chain(size=30, restitution=1.05, damping=4.0), "phase_space"),
}

ERRORS = [f"{quantity}_model_error" for quantity in Accuracy._fields]  # columns and attributes


@pytest.mark.parametrize("name", CHAINS)
def test_the_best_theory_of_a_chain(name):
    chain, best = CHAINS[name]
    table = theories(chain)
    assert table.attrs["best"] == best == choose_theory(chain).theory.name
    assert table.takes.sel(theory=best)
    assert (table.expected_seconds.values[table.takes.values] > 0).all()


@pytest.mark.parametrize("name", CHAINS)
def test_a_reason_is_the_error_that_the_theory_raises(name):
    chain, _ = CHAINS[name]
    table = theories(chain)
    for theory in THEORIES.values():
        row = table.sel(theory=theory.name)
        assert bool(row.takes) == (row.reason == "")
        if not row.takes:
            with pytest.raises(ValueError, match=f"^{re.escape(str(row.reason.values))}$"):
                theory.solve(chain)
            assert np.isnan([row[name] for name in ERRORS]).all()


@pytest.mark.parametrize(
    "chain", [Chain(size=12, restitution=0.9), Chain(size=12), Chain(size=12, gap=0.3)]
)
def test_expected_errors_are_those_that_results_state(chain):
    table = theories(chain)
    for name in table.theory.values[table.takes.values]:
        settings = {"cells": 6} if name.endswith("phase_space") else {}
        stated = THEORIES[name].solve(chain, **settings).attrs
        row = table.sel(theory=name)
        for column in ERRORS:
            assert row[column] == pytest.approx(stated[column], nan_ok=True), column
        if not name.endswith("phase_space"):
            assert row.velocity_width_model_error == 0


def test_the_best_theory_depends_on_the_quantity_and_says_why():
    chain, best = Chain(size=100, restitution=0.95), {}
    for quantity in ("velocity_width", "displacement_width", "mean_displacement", "density"):
        theory, why = choose_theory(chain, quantity)
        best[quantity] = theory.name
        assert theory.name == theories(chain)[f"{quantity}_model_error"].idxmin("theory")
        assert why.startswith(f"{theory.name} has the smallest stated error of ")
    assert best["velocity_width"] == "phase_space"
    assert best["displacement_width"] == "correlated_phase_space"


@pytest.mark.parametrize(
    ("chain", "quantity", "theory"),
    [
        (Chain(size=20, gap=0.5), "velocity_width", equilibrium),
        (Chain(size=12, restitution=0.9), "displacement_width", correlated_phase_space),
    ],
)
def test_the_best_theory_is_the_solved_one(chain, quantity, theory):
    settings = {} if theory is equilibrium else {"cells": 6}
    found = best_theory(chain, quantity, **settings)
    expected = theory(chain, **settings).drop_attrs(deep=False)
    assert found.drop_attrs(deep=False).identical(expected)
    assert (found.best_theory, found.chosen) == (
        theory.__name__,
        choose_theory(chain, quantity, settings).why,
    )


def test_without_a_known_error_the_first_theory_is_taken_and_that_is_said():
    theory, why = choose_theory(Chain(size=30, restitution=0.9, spring="quadratic"))
    assert theory.name == "phase_space"
    assert why == "phase_space comes first, no error of velocity width is known here"


def test_a_chain_that_no_theory_takes_has_none():
    chain = Chain(size=5, damping=0.0)
    assert theories(chain).attrs["best"] == ""
    with pytest.raises(ValueError, match=r"^this chain has no steady state: damping=0"):
        best_theory(chain)
    with pytest.raises(ValueError, match="no theory takes this chain: equilibrium: .*; phase_space: ") as caught:
        best_theory(Chain(size=200_000, restitution=0.9))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("gap", "e"), [(0.0, 0.9), (0.1, 0.9), (0.1, 1.0)])
def test_the_best_theory_gives_the_quantity_or_there_is_none(gap, e):
    chain = Chain(size=12, restitution=e, gap=gap)
    found = {
        name: theory.solve(chain, **({"cells": 6} if name.endswith("phase_space") else {}))
        for name, theory in THEORIES.items()
        if not theory.refusal(chain)
    }
    for quantity in Accuracy._fields:
        variable = "velocity_width" if quantity == "border" else quantity
        have = [name for name, result in found.items() if variable in result]
        assert have == [name for name in found if not THEORIES[name].lacks(chain, quantity)]
        if have:
            assert choose_theory(chain, quantity).theory.name in have
        else:
            assert (quantity, gap, e) == ("displacement_width", 0.1, 0.9)
            with pytest.raises(ValueError, match="phase_space: it gives no displacement_width of"):
                best_theory(chain, quantity)


def test_an_unknown_error_is_said_where_the_theory_is_called():
    chain = Chain(size=5, restitution=0.9)
    with pytest.warns(UnmeasuredWarning, match="kinetic equation was not measured") as caught:
        phase_space(chain, cells=8)
    with pytest.warns(UnmeasuredWarning, match="force balance was not measured"):
        force_balance(Chain(size=20, spring="quadratic"))
    assert caught[0].filename == __file__


def test_a_known_error_needs_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        phase_space(Chain(size=30, restitution=0.9), cells=8)
        force_balance(Chain(size=20, gap=0.3))


def test_a_reason_is_true_where_several_theories_state_the_same_error():
    why = choose_theory(Chain(size=30), "velocity_width").why
    first = "equilibrium comes first of those with the smallest stated error of velocity width: "
    assert why.startswith(first + "equilibrium 0 %, force_balance 0 %, ")
