"""Every stationary theory says how wrong it is itself, from the tables of the documentation."""

import re
from pathlib import Path

import numpy as np
import pytest

from crazybilliards.kinetic import equilibrium, force_balance, phase_space
from crazybilliards.kinetic.kinetic_equation.accuracy import expected_accuracy
from crazybilliards.model import Chain

PAGE = Path(__file__).parents[2] / "docs" / "kinetic_equation.md"
ROW = re.compile(
    r"^\| ([\d.]+)(, gamma = 4)? \| (\d+) \| \S+ \| (\S+) \| (\S+) \| \S+ \|$", re.MULTILINE
)


def test_the_errors_are_those_of_the_page():
    rows = ROW.findall(PAGE.read_text(encoding="utf-8"))
    assert len(rows) == 31
    for e, driven, size, border, largest in rows:
        chain = Chain(size=int(size), restitution=float(e), damping=4.0 if driven else 1.0)
        # Exact at e = 1, where the table has the errors of the simulation.
        expected = (0, 0) if float(e) == 1 else (float(largest) / 100, abs(float(border)) / 100)
        assert expected_accuracy(chain) == pytest.approx(expected)


def test_between_the_measured_chains_the_larger_error_counts():
    """L = 200, e = 0.8: of 100 and 300 rods at 0.75 and 0.9."""
    assert expected_accuracy(Chain(size=200, restitution=0.8)) == pytest.approx((0.184, 0.05))


@pytest.mark.parametrize(
    "chain",
    [
        Chain(size=20, restitution=0.9),
        Chain(size=2000, restitution=0.9),
        Chain(restitution=0.9, gap=0.1),
        Chain(restitution=0.9, spring="quadratic"),
        Chain(restitution=0.9, damping=10),
        Chain(restitution=1.05, damping=1, size=30),
        Chain(restitution=1.06, damping=4, size=30),
    ],
)
def test_what_was_not_measured_is_unknown(chain):
    assert np.isnan(expected_accuracy(chain)).all()


def test_every_theory_has_it():
    assert phase_space(Chain(size=30, restitution=0.9), cells=8).attrs["model_error"] == 0.019
    assert equilibrium(Chain(size=5)).attrs["model_error"] == 0
    errors = [
        force_balance(Chain(amplitude=amplitude)).attrs["model_error"]
        for amplitude in (0.5, 1, 2, 3, 10, 30, 100)
    ]
    assert errors[1:] == [0.138, 0.138, 0.099, 0.027, 0.007, 0.007]
    assert np.isnan(errors[0])
    assert np.isnan(force_balance(Chain(gap=0.5)).attrs["model_error"])
    assert np.isnan(force_balance(Chain(), velocity_variance=2.0).attrs["model_error"])
