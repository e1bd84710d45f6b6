"""Studies beyond the paper: right numbers give right verdicts, and wrong ones can fail."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.kinetic.kinetic_equation.criticality import critical_size
from crazybilliards.model import Chain
from crazybilliards.reproduction.beyond import STUDIES
from crazybilliards.reproduction.checked_chains import Group, checked
from crazybilliards.reproduction.claims.report import all_cases
from crazybilliards.reproduction.claims.tables import as_csv, percent
from crazybilliards.reproduction.correlated_rods import correlation_length, neighbours
from crazybilliards.reproduction.reproducible import find_studies

TABLES = Path(__file__).parents[2] / "docs" / "tables"


def described(chain, status="completed", **variables):
    """Return a result of a chain with these variables, as far as a study looks at it."""
    provenance = json.dumps({"chain": chain.parameters()})
    return xr.Dataset(variables, attrs={"status": status, "provenance": provenance})


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_every_case_can_be_carried_out_and_shared_ones_count_once(quality):
    cases = all_cases(STUDIES, quality)
    assert len(cases) == len({case.key for case in cases})
    assert len(cases) < sum(len(study.cases(quality)) for study in STUDIES)


def test_limits_of_short_chains_and_runs_of_long_ones_are_those_of_figures():
    [width] = find_studies("width-in-the-limit")
    [figure] = find_studies("central-width")
    shared = set(width.cases("full").values()) & set(figure.cases("full").values())
    assert sorted(case.chain.size for case in shared) == [10, 30, 100, 300, 1000]
    [validity], [widths] = find_studies("validity"), find_studies("widths-restitution")
    runs = set(validity.cases("full").values()) & set(widths.cases("full").values())
    assert {case.chain.restitution for case in runs if case.job == "simulate"} == {
        *(0, 0.5, 0.75, 0.85, 0.92, 0.95)
    }


def test_the_chains_that_were_held_out_are_sixteen_and_in_no_other_group():
    groups = {group: set() for group in Group}
    for each in checked("full"):
        groups[each.group].add(each.chain)
    held_out = groups.pop(Group.HELD_OUT)
    assert len(held_out) == 16
    assert not held_out & set.union(*groups.values())


def test_tables_are_comma_separated_values():
    assert as_csv([["a", "b, %"], ["1", percent(-0.145, 0.02)]]) == b'a,"b, %"\n1,"-14.5, +2.0"\n'


def test_tables_have_the_columns_of_those_in_the_documentation():
    """Without results they are heads only. The page of the chains derived with has others."""
    written = {name: table[0] for study in STUDIES for name, table in study.tables({}).items()}
    compared = 0
    for name in written.keys() - {"correlations_derived_with"}:
        stored = TABLES / f"{name}.csv"
        if stored.exists():
            heads, *_ = csv.reader(stored.read_text(encoding="utf-8").splitlines())
            assert [head for head in heads if head != "s"] == written[name]  # seconds: of then
            compared += 1
    assert compared == 8


# -- the critical size --------------------------------------------------------------------------


def driven(chain, critical, **how):
    """Return a run whose energy diverges like 1/(L_c - L)."""
    width = chain.free_velocity_width * np.full(chain.size, (1 - chain.size / critical) ** -0.5)
    error = ("particle", 1e-3 * width)
    return described(chain, velocity_width=("particle", width), velocity_width_error=error, **how)


def critical_results(critical):
    """Return runs of the study, of a chain whose critical size is the theory's times a factor."""
    [study] = find_studies("critical-size")
    results = {}
    for name, case in study.cases("full").items():
        theory = critical_size(case.chain.replace(size=100)).value
        results[name] = driven(case.chain, theory * critical(case.chain.damping))
    return study, results


def test_the_simulated_critical_size_is_where_the_energy_is_infinite():
    study, results = critical_results(lambda damping: {2.0: 1.05, 4.0: 0.95}.get(damping, 1.0))
    verdicts = {claim.statement: claim.verdict for claim in study.claims(results)}
    assert len(verdicts) == 4 + 3
    assert set(verdicts.values()) == {"confirmed"}
    _, row, *_ = study.tables(results)["critical_size"]
    assert row == ["1.05", "1", "30.7 ± 0.2", "30.7", "30.7 ± 0.5"]


def test_the_claims_of_the_critical_size_can_fail():
    study, results = critical_results(lambda damping: {2.0: 0.95, 4.0: 1.05}.get(damping, 1.0))
    verdicts = [claim.verdict for claim in study.claims(results) if "diverge" in claim.statement]
    assert verdicts == ["refuted"] * 3


def test_chains_that_diverge_leave_the_critical_size_open():
    [study] = find_studies("critical-size")
    results = {
        name: driven(case.chain, 31.0, status="diverged" if case.chain.size > 26 else "completed")
        for name, case in study.cases("quick").items()
    }
    [_, row] = study.tables(results)["critical_size"]
    assert row[-1] == "nan ± nan"


# -- neighbours ---------------------------------------------------------------------------------


@pytest.mark.parametrize("length", [3.0, 10.0, 30.0])
def test_the_correlation_length_is_that_of_the_spectrum(length):
    chain = Chain(size=1000, restitution=0.5)
    mode = np.arange(chain.size)
    share = 1 / (1 + (np.pi * mode / chain.size * length) ** 2)
    spectrum = chain.free_velocity_width**2 * (0.1 + 0.9 * share)
    result = described(chain, mode_velocity_variance=("mode", spectrum)).assign_coords(mode=mode)
    value, error = correlation_length(result)
    assert value == pytest.approx(length, rel=0.02)
    assert error == 0
    noisy = result.assign(mode_velocity_variance_error=0.01 * result.mode_velocity_variance)
    assert 0.001 * length < correlation_length(noisy).error < 0.05 * length


@pytest.mark.compiled
def test_claims_about_neighbours_can_fail():
    [study] = find_studies("neighbours")
    results = {
        name: JOBS[case.job].function(case.chain, **case.settings)
        for name, case in neighbours(30, 0.0, "quick").items()
    }
    assert {claim.verdict for claim in study.claims(results)} <= {"confirmed", "undecided"}
    theory = results["theory L=30 e=0"]
    theory["neighbour_covariance"] = 0.5 * theory.neighbour_covariance
    _, covariance = study.claims(results)
    assert covariance.verdict == "refuted"


# -- the kinetic equation -----------------------------------------------------------------------


def rods(chain, factor):
    """Return widths of rods that are all the same."""
    widths = factor * np.ones(chain.size)
    variables = {
        f"{kind}_width{end}": ("particle", share * widths)
        for kind in ("velocity", "displacement")
        for end, share in (("", 1.0), ("_error", 0.01))
    }
    return described(chain, **variables)


def verdicts_of_validity(factor):
    """Return the verdicts on chains held out, if widths of the theory of pairs are off by that."""
    [study] = find_studies("validity")
    results = {}
    for each in checked("quick"):
        if each.group == Group.HELD_OUT:
            runs = {name for name in each.cases("quick") if name.startswith(each.runs.name)}
            results |= {name: rods(each.chain, 1 + 1e-3 * float(name[-1])) for name in runs}
            results[each.independent] = rods(each.chain, 0.9)
            results[each.with_pairs] = rods(each.chain, factor)
    return [claim.verdict for claim in study.claims(results)]


def test_what_is_claimed_of_the_kinetic_equation_can_fail():
    assert verdicts_of_validity(1.0) == ["confirmed"] * 3
    assert verdicts_of_validity(1.04) == ["confirmed", "refuted", "confirmed"]
    assert verdicts_of_validity(1.1) == ["confirmed", "refuted", "refuted"]
