"""The table of theories says what the theories themselves check and state, and picks the best."""

import re
import warnings

import numpy as np
import pytest

from crazybilliards.comparison import theories
from crazybilliards.comparison.stationary_theories import THEORIES, best_theory
from crazybilliards.kinetic import UnmeasuredWarning, force_balance, phase_space
from crazybilliards.kinetic.accuracy import Accuracy
from crazybilliards.model import Chain

CHAINS = {
    "elastic": (Chain(size=30), "equilibrium"),
    "elastic, gap": (Chain(size=30, gap=0.5), "equilibrium"),
    "quadratic": (Chain(size=30, spring="quadratic"), "equilibrium"),
    "near 1": (Chain(size=100, restitution=0.95), "phase_space"),
    "0.5": (Chain(size=100, restitution=0.5), "correlated_phase_space"),
    "0.5, gap": (Chain(size=100, restitution=0.5, gap=0.1), "phase_space"),
    "not measured": (Chain(size=30, restitution=0.9, spring="quadratic"), "phase_space"),
    "driven": (Chain(size=30, restitution=1.05, damping=4.0), "phase_space"),
}

ERRORS = [f"{quantity}_model_error" for quantity in Accuracy._fields]  # columns and attributes


@pytest.mark.parametrize("name", CHAINS)
def test_the_best_theory_of_a_chain(name):
    chain, best = CHAINS[name]
    table = theories(chain)
    assert table.attrs["best"] == best == best_theory(chain).name
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


def test_a_chain_that_no_theory_takes_has_none():
    chain = Chain(size=5, damping=0.0)
    assert theories(chain).attrs["best"] == ""
    with pytest.raises(ValueError, match=r"^this chain has no steady state: damping=0"):
        best_theory(chain)
    with pytest.raises(ValueError, match=r"^no theory takes this chain: equilibrium: ") as caught:
        best_theory(Chain(size=200_000, restitution=0.9))
    assert "\n" not in str(caught.value)


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
