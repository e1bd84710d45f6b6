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

from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.kinetic.kinetic_equation import criticality
from crazybilliards.kinetic.kinetic_equation.weak_damping import weak_damping_drag
from crazybilliards.model import Chain
from studies import (
    critical_size,
    elastic_gaps,
    neighbours,
    validity,
    validity_picture,
    width_in_the_limit,
)
from studies.common import options

TABLES = Path(__file__).parents[1] / "docs" / "tables"
STUDIES = (critical_size, neighbours, validity, width_in_the_limit)


def described(chain, status="completed", **variables):
    """Return a result of a chain with these variables, as far as a study looks at it."""
    provenance = json.dumps({"chain": chain.parameters()})
    return xr.Dataset(variables, attrs={"status": status, "provenance": provenance})


def test_a_folder_is_made_before_any_work_or_refused(tmp_path, monkeypatch, capsys):
    (tmp_path / "file").touch()
    monkeypatch.setattr("sys.argv", ["study", str(tmp_path / "new" / "folder")])
    assert options("", folder=Path).folder.is_dir()
    monkeypatch.setattr("sys.argv", ["study", str(tmp_path / "file")])
    with pytest.raises(SystemExit):
        options("", folder=Path)
    assert "no folder can be made there" in capsys.readouterr().err


def test_tables_have_the_columns_of_those_in_the_documentation(monkeypatch):
    """Without results they are heads only."""
    monkeypatch.setattr(validity, "checked", list)
    written = {name: table[0] for study in STUDIES for name, table in study.tables({}).items()}
    compared = 0
    for name, own in written.items():
        stored = TABLES / f"{name}.csv"
        if stored.exists():
            heads, *_ = csv.reader(stored.read_text(encoding="utf-8").splitlines())
            assert [head for head in heads if head != "s"] == own  # seconds: of then
            compared += 1
    assert compared == 9


def test_the_picture_of_the_errors_has_every_chain_that_was_held_out():
    figure = validity_picture.draw(TABLES)
    figure.canvas.draw()
    plt.close(figure)
    for pairs in (False, True):
        found = validity_picture.errors(TABLES, pairs=pairs)
        usual = [each for each in validity.held_out() if each.chain.damping == 1]
        assert found.held_out.sum() == len(usual)


@pytest.mark.parametrize(
    ("picture", "tables"),
    [("validity", validity_picture.TABLES), ("correlated_displacements", ["displacement_widths"])],
)
def test_pictures_of_tables_are_drawn_from_those_that_are_shown(picture, tables):
    drawn = Image.open(TABLES.parent / "figures" / f"{picture}.png").text["Source"]
    contents = "".join((TABLES / f"{name}.csv").read_text(encoding="utf-8") for name in tables)
    assert drawn == hashlib.sha256(contents.encode()).hexdigest()


# -- the critical size --------------------------------------------------------------------------


def driven(chain, critical, **how):
    """Return a run whose energy diverges like 1/(L_c - L)."""
    width = chain.free_velocity_width * np.full(chain.size, (1 - chain.size / critical) ** -0.5)
    error = ("particle", 1e-3 * width)
    return described(chain, velocity_width=("particle", width), velocity_width_error=error, **how)


def test_the_simulated_critical_size_is_where_the_energy_is_infinite(monkeypatch):
    """The theory's number of rods, times a factor, is found again."""
    monkeypatch.setattr(
        criticality, "_critical_drag", lambda each: (weak_damping_drag(each), 0.005)
    )
    results, factors = {}, {1.0: 1.0, 2.0: 1.05, 4.0: 0.95}
    for name, case in critical_size.cases().items():
        theory = criticality.critical_size(case.chain.replace(size=100)).value
        results[name] = driven(case.chain, theory * factors[case.chain.damping])
    _, *rows = critical_size.tables(results)["critical_size"]
    assert rows[0] == ["1.05", "1", "30.7 ± 0.2", "30.7", "30.7 ± 0.5"]
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


# -- neighbours ---------------------------------------------------------------------------------


@pytest.mark.parametrize("length", [3.0, 10.0, 30.0])
def test_the_correlation_length_is_that_of_the_spectrum(length):
    chain = Chain(size=1000, restitution=0.5)
    mode = np.arange(chain.size)
    share = 1 / (1 + (np.pi * mode / chain.size * length) ** 2)
    spectrum = chain.free_velocity_width**2 * (0.1 + 0.9 * share)
    result = described(chain, mode_velocity_variance=("mode", spectrum)).assign_coords(mode=mode)
    value, error = neighbours.correlation_length(result)
    assert value == pytest.approx(length, rel=0.02)
    assert error == 0
    noisy = result.assign(mode_velocity_variance_error=0.01 * result.mode_velocity_variance)
    assert 0.001 * length < neighbours.correlation_length(noisy).error < 0.05 * length


# -- the kinetic equation -----------------------------------------------------------------------


def rods(chain, factor):
    """Return velocity widths of rods that are all the same."""
    widths = factor * np.ones(chain.size)
    errors = ("particle", 0.01 * widths)
    return described(chain, velocity_width=("particle", widths), velocity_width_error=errors)


def test_errors_of_the_theories_are_those_of_their_widths(monkeypatch):
    """Theories whose widths are off by a tenth, and by 4 %, in every chain held out."""
    held_out = list(validity.held_out())
    monkeypatch.setattr(validity, "checked", lambda: held_out)
    results = {}
    for each in held_out:
        scatter = {name: 1 + 1e-3 * float(name[-1]) for name in each.runs.cases("full")}
        mean = np.sqrt(np.mean(np.square(list(scatter.values()))))
        results |= {name: rods(each.chain, factor / mean) for name, factor in scatter.items()}
        results |= zip(each.theories, (rods(each.chain, 0.9), rods(each.chain, 1.04)), strict=True)
    heads, *rows = validity.tables(results)["correlations_held_out"]
    assert len(rows) == 16
    for row in rows:
        found = dict(zip(heads, row, strict=True))
        for place in ("centre", "border"):
            assert found[f"W_v {place} without, %"] == "-10.0"
            assert found[f"W_v {place}, %"] == "+4.0"
        assert found["W_v largest, %"] == "4.0"


# -- elastic chains with gaps -------------------------------------------------------------------


@pytest.mark.compiled
@pytest.mark.validate
def test_rods_with_gaps_are_where_the_exact_solution_has_them():
    """Within 5 errors, and below 2 % of s; if the rods were those of another gap, far off."""
    results = {
        name: JOBS[case.job].function(case.chain, **case.settings)
        for name, case in elastic_gaps.cases().items()
    }
    _, *rows = elastic_gaps.tables(results)["elastic_gaps"]
    assert all(float(row[2]) < 0.02 and float(row[3]) < 5 for row in rows)
    plt.close(elastic_gaps.draw(results))
    results["rods 0.0"], results["rods 2.0"] = results["rods 2.0"], results["rods 0.0"]
    _, *rows = elastic_gaps.tables(results)["elastic_gaps"]
    assert [float(row[3]) > 5 for row in rows] == [True, True, False, False, True, True]
