"""Scripts in studies/: their tables have the heads of the documentation's, and right numbers."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from crazybilliards.kinetic.gas.elastic_contacts import VARIANCES
from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.verdicts import Estimate
from studies import critical_size, elastic_lattice, neighbours

TABLES = Path(__file__).parents[1] / "docs" / "tables"


def result(chain, status="completed", **variables):
    """Return a result of a chain with these variables, as far as a study looks at it."""
    provenance = json.dumps({"chain": chain.parameters()})
    return xr.Dataset(variables, attrs={"status": status, "provenance": provenance})


def test_tables_have_the_columns_of_those_in_the_documentation():
    """Without results they are heads only."""
    studies = (critical_size, neighbours)
    written = {name: table[0] for study in studies for name, table in study.tables({}).items()}
    assert len(written) == 4
    for name, heads in written.items():
        stored, *_ = csv.reader((TABLES / f"{name}.csv").read_text("utf-8").splitlines())
        assert stored == heads


def driven(chain, critical, **attributes):
    """Return a run whose energy diverges like 1/(L_c - L); widths are known to a thousandth."""
    widths = chain.free_velocity_width * np.full(chain.size, (1 - chain.size / critical) ** -0.5)
    errors = ("particle", 1e-3 * widths)
    variables = {"velocity_width": ("particle", widths), "velocity_width_error": errors}
    return result(chain, **variables, **attributes)


def test_the_simulated_critical_size_is_where_the_energy_is_infinite(monkeypatch):
    """The number of rods in the limit of weak damping, times a factor, is found again.

    It stays open where two runs of three diverged.
    """

    def limit(chain):
        return Estimate(np.pi * chain.relative_damping / (chain.restitution - 1), 0.1)

    monkeypatch.setattr(critical_size, "critical_size", limit)
    results, factors = {}, {1.0: 1.0, 2.0: 1.05, 4.0: 0.95}
    for name, case in critical_size.cases().items():
        critical = limit(case.chain).value * factors[case.chain.damping]
        results[name] = driven(case.chain, critical)
    _, *rows = critical_size.tables(results)["critical_size"]
    theory, simulated = (np.array([float(row[k].split()[0]) for row in rows]) for k in (2, 3))
    np.testing.assert_allclose(simulated / theory, [1, 1.05, 0.95, 0.95], rtol=2e-3)
    diverged = {
        name: run.assign_attrs(status="diverged" if run.particle.size > 26 else "completed")
        for name, run in results.items()
        if name.startswith("e=1.05 gamma=1 ")
    }
    [_, row] = critical_size.tables(diverged)["critical_size"]
    assert row[-1] == "nan ± nan"


@pytest.mark.parametrize("length", [3.0, 10.0, 30.0])
def test_the_correlation_length_is_that_of_the_spectrum(length):
    chain = Chain(size=1000, restitution=0.5)
    mode = np.arange(chain.size)
    share = 1 / (1 + (np.pi * mode / chain.size * length) ** 2)
    spectrum = chain.free_velocity_width**2 * (0.1 + 0.9 * share)
    smooth = result(chain, mode_velocity_variance=("mode", spectrum)).assign_coords(mode=mode)
    value, error = neighbours.correlation_length(smooth)
    assert value == pytest.approx(length, rel=0.02)
    assert error == 0
    noisy = smooth.assign(mode_velocity_variance_error=0.01 * smooth.mode_velocity_variance)
    assert 0.001 * length < neighbours.correlation_length(noisy).error < 0.05 * length


def test_the_table_of_a_gap_is_that_of_the_elastic_lattice():
    assert elastic_lattice.variance(2.0) == pytest.approx(VARIANCES[2.0], abs=1e-4)
