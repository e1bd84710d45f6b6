"""The errors that the theory with pair correlations states are the largest ones of its tables."""

import csv
from pathlib import Path

import numpy as np
import pytest

from crazybilliards.kinetic.accuracy import (
    expected_correlated_displacement,
    expected_correlated_phase_space,
)
from crazybilliards.model import Chain

TABLES = Path(__file__).parents[2] / "docs" / "tables"
ROUNDED = 5e-4


def rows():
    """Return size, restitution, and errors of inner particles, border and W_x of all chains."""
    found = []
    for which in ("derived_with", "held_out"):
        with open(TABLES / f"correlations_{which}.csv", encoding="utf-8", newline="") as file:
            found += csv.DictReader(file)
    names = "W_v largest, %", "W_v border, %", "W_x largest, %"
    return [
        (int(row["L"]), float(row["e"]), [abs(float(row[name])) / 100 for name in names])
        for row in found
    ]


def stated(e, size):
    chain = Chain(size=size, restitution=e)
    return [*expected_correlated_phase_space(chain), expected_correlated_displacement(chain)]


def test_every_chain_of_the_tables_is_within_the_errors():
    assert len(rows()) == 60
    for size, e, errors in rows():
        for error, expected in zip(errors, stated(e, size), strict=True):
            assert error <= expected + ROUNDED, (size, e)


@pytest.mark.parametrize("long", [False, True])
def test_no_error_is_larger_than_that_of_some_chain(long):
    """Of those with no smaller restitution: where few were simulated the others count."""
    of_size = [row for row in rows() if (row[0] > 300) == long]
    for e in {row[1] for row in of_size}:
        largest = np.max([errors for _, other, errors in of_size if other >= e], axis=0)
        assert (stated(e, of_size[0][0]) <= largest + ROUNDED).all(), e


def test_between_measured_restitutions_the_larger_error_counts():
    assert stated(0.52, 100) == stated(0.5, 100)
    assert stated(0.96, 600) == stated(0.95, 600)
    assert stated(0.05, 100) == stated(0.0, 100)
