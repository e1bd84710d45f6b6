"""The errors that the theory with pair correlations states are the largest ones of its tables."""

import csv
from pathlib import Path

import pytest

from crazybilliards.kinetic.accuracy import expected_correlated_phase_space
from crazybilliards.model import Chain

TABLES = Path(__file__).parents[2] / "docs" / "tables"
ROUNDED = 5e-4


def rows():
    """Return size, restitution, and errors of inner particles and border of all chains."""
    found = []
    for which in ("derived_with", "held_out"):
        with open(TABLES / f"correlations_{which}.csv", encoding="utf-8", newline="") as file:
            found += csv.DictReader(file)
    return [
        (
            int(row["L"]),
            float(row["e"]),
            float(row["W_v largest, %"]) / 100,
            abs(float(row["W_v border, %"])) / 100,
        )
        for row in found
    ]


def accuracy(e, size):
    return expected_correlated_phase_space(Chain(size=size, restitution=e))


def test_every_chain_of_the_tables_is_within_the_errors():
    assert len(rows()) == 43
    for size, e, inner, border in rows():
        expected = accuracy(e, size)
        assert inner <= expected.inner + ROUNDED, (size, e)
        assert border <= expected.border + ROUNDED, (size, e)


@pytest.mark.parametrize("long", [False, True])
def test_no_error_is_larger_than_that_of_some_chain(long):
    of_size = [row for row in rows() if (row[0] > 300) == long]
    for e in {row[1] for row in of_size}:
        stated = accuracy(e, of_size[0][0])
        assert stated.inner <= max(row[2] for row in of_size if row[1] == e) + ROUNDED
        assert stated.border <= max(row[3] for row in of_size if row[1] == e) + ROUNDED


def test_between_measured_restitutions_the_larger_error_counts():
    assert accuracy(0.6, 100) == accuracy(0.5, 100)
    assert accuracy(0.96, 600) == (0.019, 0.011)
    assert accuracy(0.1, 1000).inner == 0.226
