"""Scripts in studies/: their tables have the heads of the documentation's, and right numbers."""

import csv
import hashlib
import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from PIL import Image

from crazybilliards.kinetic.kinetic_equation import criticality
from crazybilliards.kinetic.kinetic_equation.weak_damping import weak_damping_drag
from crazybilliards.model import Chain
from studies import critical_size, neighbours, validity, validity_picture

TABLES = Path(__file__).parents[1] / "docs" / "tables"


def result(chain, status="completed", **variables):
    """Return a result of a chain with these variables, as far as a study looks at it."""
    provenance = json.dumps({"chain": chain.parameters()})
    return xr.Dataset(variables, attrs={"status": status, "provenance": provenance})


def result_of_widths(chain, widths, **attributes):
    """Return a result with these velocity widths, known to a thousandth."""
    error = ("particle", 1e-3 * widths)
    variables = {"velocity_width": ("particle", widths), "velocity_width_error": error}
    return result(chain, **variables, **attributes)


def test_tables_have_the_columns_of_those_in_the_documentation(monkeypatch):
    """Without results they are heads only."""
    monkeypatch.setattr(validity, "checked", list)
    studies = (critical_size, neighbours, validity)
    written = {name: table[0] for study in studies for name, table in study.tables({}).items()}
    assert len(written) == 8
    for name, heads in written.items():
        stored, *_ = csv.reader((TABLES / f"{name}.csv").read_text("utf-8").splitlines())
        assert stored == heads


def test_the_picture_of_the_errors_has_every_chain_that_was_held_out():
    figure = validity_picture.draw(TABLES)
    figure.canvas.draw()
    plt.close(figure)
    usual = [case for case in validity.held_out() if case.chain.damping == 1]
    for pairs in (False, True):
        assert validity_picture.errors(TABLES, pairs=pairs).held_out.sum() == len(usual)


@pytest.mark.parametrize(
    ("picture", "tables"),
    [("validity", validity_picture.TABLES), ("correlated_displacements", ["displacement_widths"])],
)
def test_pictures_of_tables_are_drawn_from_those_that_are_shown(picture, tables):
    drawn = Image.open(TABLES.parent / "figures" / f"{picture}.png").text["Source"]
    contents = "".join((TABLES / f"{name}.csv").read_text(encoding="utf-8") for name in tables)
    assert drawn == hashlib.sha256(contents.encode()).hexdigest()


def driven(chain, critical, **attributes):
    """Return a run whose energy diverges like 1/(L_c - L)."""
    width = chain.free_velocity_width * np.full(chain.size, (1 - chain.size / critical) ** -0.5)
    return result_of_widths(chain, width, **attributes)


def test_the_simulated_critical_size_is_where_the_energy_is_infinite(monkeypatch):
    """The theory's number of rods, times a factor, is found again."""
    monkeypatch.setattr(
        criticality, "_critical_drag", lambda damping: (weak_damping_drag(damping), 0.005)
    )
    results, factors = {}, {1.0: 1.0, 2.0: 1.05, 4.0: 0.95}
    for name, case in critical_size.cases().items():
        theory = criticality.critical_size(case.chain.replace(size=100)).value
        results[name] = driven(case.chain, theory * factors[case.chain.damping])
    _, *rows = critical_size.tables(results)["critical_size"]
    theory, simulated = (np.array([float(row[k].split()[0]) for row in rows]) for k in (2, 4))
    np.testing.assert_allclose(simulated / theory, [1, 1.05, 0.95, 0.95], rtol=2e-3)


def test_chains_that_diverge_leave_the_critical_size_open():
    results = {
        name: driven(case.chain, 31.0, status="diverged" if case.chain.size > 26 else "completed")
        for name, case in critical_size.cases().items()
        if (case.chain.restitution, case.chain.damping) == (1.05, 1.0)
    }
    [_, row] = critical_size.tables(results)["critical_size"]
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


def test_errors_of_the_theories_are_those_of_their_widths(monkeypatch):
    """Theories whose widths are off by a tenth, and by 4 %, in every chain held out."""
    held_out = list(validity.held_out())
    monkeypatch.setattr(validity, "checked", lambda: held_out)
    results = {}
    for case in held_out:
        scatter = {name: 1 + 1e-3 * float(name[-1]) for name in case.runs.cases("full")}
        mean = np.sqrt(np.mean(np.square(list(scatter.values()))))
        factors = {name: factor / mean for name, factor in scatter.items()}
        factors |= dict(zip(case.theories, (0.9, 1.04), strict=True))
        for seed, (name, factor) in enumerate(factors.items()):
            of_one = result_of_widths(case.chain, factor * np.ones(case.chain.size))
            about = json.loads(of_one.attrs["provenance"]) | {"seed": seed, "snapshots": 1}
            results[name] = of_one.assign_attrs(source="simulation", provenance=json.dumps(about))
    heads, *rows = validity.tables(results)["correlations_held_out"]
    assert len(rows) == 16
    for row in rows:
        cells = dict(zip(heads, row, strict=True))
        for place in ("centre", "border"):
            assert cells[f"W_v {place} without, %"] == "-10.0"
            assert cells[f"W_v {place}, %"] == "+4.0"
        assert cells["W_v largest, %"] == "4.0"
