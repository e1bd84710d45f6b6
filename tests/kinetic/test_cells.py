"""Cells of rods: they hold all rods, and covariances are continued to short distances."""

import numpy as np
import pytest

from crazybilliards.kinetic.gas.cells import MOST, at_distance, cells_of_points, make_cells


@pytest.mark.parametrize("size", [1, 10, MOST, MOST + 1, 1000, 100_000])
@pytest.mark.parametrize("kind", ["rods", "points"])
def test_cells_hold_all_rods(size, kind):
    make = cells_of_points if kind == "points" else make_cells
    cells, walled = make(size), make(size, walled=True)
    assert cells.rods.sum() == pytest.approx(size)
    assert (cells.rods > {"rods": 1 - 1e-9, "points": 0}[kind]).all()
    np.testing.assert_allclose(cells.rods, cells.rods[::-1], atol=2e-15 * size, rtol=0)
    np.testing.assert_allclose(cells.centres + cells.centres[::-1], size)
    np.testing.assert_allclose(np.diff(cells.centres), cells.distances)
    np.testing.assert_allclose(cells.contacts, cells.rods.cumsum()[:-1])
    beyond = 0.0 if kind == "points" else 0.5  # of a rod: a wall is where its neighbour would be
    np.testing.assert_allclose(walled.all_distances[[0, -1]], cells.centres[0] + beyond)
    np.testing.assert_array_equal(walled.all_labels[walled.inner], cells.all_labels)
    if kind != "points" and size <= MOST:
        np.testing.assert_allclose(cells.rods, 1)


@pytest.mark.parametrize("size", [20, 400])
def test_covariances_are_continued_linearly_to_a_short_distance(size):
    cells = make_cells(size, most=100)
    apart = np.abs(cells.centres[:, None] - cells.centres)
    middle = (cells.centres[:, None] + cells.centres) / 2
    covariance = 3 - 0.01 * apart + 0.002 * middle + 7 * np.eye(cells.rods.size)
    found = at_distance(covariance, cells.centres, cells.contacts, 1.0)
    np.testing.assert_allclose(found, 3 - 0.01 + 0.002 * cells.contacts, rtol=2e-3)
    # What neighbours have beyond that, from their own last collision, is left out as well.
    contact = np.full(cells.contacts.size, 5.0)
    spiked = covariance + np.diag(contact, 1) + np.diag(contact, -1)
    found = at_distance(spiked, cells.centres, cells.contacts, 1.0, nearest=2)
    np.testing.assert_allclose(found, 3 - 0.01 + 0.002 * cells.contacts, rtol=2e-3)
