"""Scripts in studies/: their tables have the heads of the documentation's, and right numbers."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from crazybilliards.kinetic.gas.descriptions import VARIANCES
from crazybilliards.model import Chain
from studies import critical_size, elastic_lattice, neighbours

TABLES = Path(__file__).parents[2] / "docs" / "tables"


def test_tables_have_the_columns_of_those_in_the_documentation():
    """Without results they are heads only."""
    studies = (critical_size, neighbours)
    written = {name: table[0] for study in studies for name, table in study.tables({}).items()}
    assert len(written) == 4
    for name, heads in written.items():
        stored, *_ = csv.reader((TABLES / f"{name}.csv").read_text("utf-8").splitlines())
        assert stored == heads


@pytest.mark.parametrize("length", [3.0, 10.0, 30.0])
def test_the_correlation_length_is_that_of_the_spectrum(length):
    chain = Chain(size=1000, restitution=0.5)
    mode = np.arange(chain.size)
    share = 1 / (1 + (np.pi * mode / chain.size * length) ** 2)
    spectrum = chain.free_velocity_width**2 * (0.1 + 0.9 * share)
    provenance = json.dumps({"chain": chain.parameters()})
    smooth = xr.Dataset(
        {"mode_velocity_variance": ("mode", spectrum)}, {"mode": mode}, {"provenance": provenance}
    )
    value, error = neighbours.correlation_length(smooth)
    assert value == pytest.approx(length, rel=0.02)
    assert error == 0
    noisy = smooth.assign(mode_velocity_variance_error=0.01 * smooth.mode_velocity_variance)
    assert 0.001 * length < neighbours.correlation_length(noisy).error < 0.05 * length


def test_the_table_of_a_gap_is_that_of_the_elastic_lattice():
    assert elastic_lattice.variance(2.0) == pytest.approx(VARIANCES[2.0], abs=1e-4)
