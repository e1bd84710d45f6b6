"""Figures 6 and 15 say which choice or which range of a fit decides, from made-up results."""

import json
from functools import cache

import numpy as np
import pytest
import xarray as xr

from crazybilliards.reproduction.figures import FIGURES

AVALANCHES, ENERGY = FIGURES[5], FIGURES[14]

# -- figure 6: what the exponent depends on ---------------------------------------------------

PUSHES = {0.1: 1.6, 0.023: 2.2, 0.01: 2.5, 0.001: 3.3}  # exponents by time step
FACTOR = 0.5  # of each further collision in the paper's count, an exponential law


def waves(case, generator):
    """Return a run whose waves have these laws, the same from every rod."""
    sizes = np.arange(1.0, 401)
    laws = {
        ("avalanche_count", "avalanche_size"): sizes ** -PUSHES[case.settings["time_step"]],
        ("triggered_count", "triggered_collisions"): FACTOR**sizes,
    }
    run = xr.Dataset(coords={"particle": np.arange(1, 1001)})
    for (count, size), law in laws.items():
        number = generator.poisson(1e5 * law / law.sum(), size=(1000, sizes.size)).T
        run[count] = (size, "particle"), number
        run = run.assign_coords({size: sizes.astype(int)})
    run.attrs["provenance"] = json.dumps({"duration": 100.0})
    return run


@cache
def claims_of_waves():
    generator = np.random.default_rng(1)
    results = {name: waves(case, generator) for name, case in AVALANCHES.cases("quick").items()}
    return {claim.statement: claim for claim in AVALANCHES.claims(results)}


def exponents(count):
    """Return the claims of an exponent near -2.2, by time step."""
    return {
        step: claim
        for statement, claim in claims_of_waves().items()
        for step in PUSHES
        if f"({count}, dt = {step:g}," in statement
    }


def test_an_exponent_that_no_time_step_gives_is_not_reproduced():
    """The paper's count: once "cannot be decided" because the paper gives no time step."""
    claims = exponents("the paper's count")
    assert list(claims) == list(PUSHES)
    assert {claim.verdict for claim in claims.values()} == {"not reproduced"}
    for step, claim in claims.items():
        others = {f"dt = {other:g}" for other in PUSHES if other != step}
        assert claim.elsewhere.keys() == others | {"N_c = 2 to 10"}
        assert not any(each.lies(claim.within) for each in claim.elsewhere.values())


def test_an_exponent_that_one_time_step_gives_cannot_be_decided_and_the_step_is_named():
    claims = exponents("pushes")
    assert {claim.verdict for claim in claims.values()} == {"cannot be decided"}
    for step, claim in claims.items():
        lies = {choice: each.lies(claim.within) for choice, each in claim.elsewhere.items()}
        assert (step == 0.023) or lies["dt = 0.023"] is True
        assert (step == 0.1) or lies["dt = 0.1"] is False
        assert claim.found.value == pytest.approx(-PUSHES[step], abs=5 * claim.found.error)


# -- figure 15: where a fit begins ------------------------------------------------------------


def energies(time, energy, status):
    return xr.Dataset({"kinetic_energy": ("time", energy)}, {"time": time}, {"status": status})


def claims_of_energy(late_rate, singular):
    """Return the claims, for a growth rate beyond t = 150 and an energy by the time left."""
    linear, quadratic = np.linspace(1, 300, 600), np.linspace(0.05, 40, 4000)
    log_energy = 0.06 * np.minimum(linear, 150) + late_rate * np.maximum(linear - 150, 0)
    results = {}
    for k in range(4):
        factor = np.exp(1e-3 * k)
        growing = 1e3 * np.exp((1 + 1e-4 * k) * log_energy)
        results[f"linear/{k}"] = energies(linear, growing, "completed")
        left = 40.05 - quadratic
        results[f"quadratic/{k}"] = energies(quadratic, factor * singular(left), "diverged")
    return ENERGY.claims(results)


def test_the_growth_rate_is_given_early_and_late():
    growth, *_ = claims_of_energy(0.0594, lambda left: 1e6 * left**-5.0)
    assert growth.verdict == "reproduced"
    assert "rate 0.060009" in growth.quantity
    assert "from E = 1e+03 to t = 150 T, and 0.0594089" in growth.quantity
    assert growth.found.value == pytest.approx(-0.01, rel=1e-6)


def test_an_exponent_has_the_spread_of_its_ranges_as_an_error():
    *_, power_law = claims_of_energy(0.06, lambda left: 1e6 * left**-5.0)
    assert power_law.found == pytest.approx((5.0, 0.0), abs=1e-4)
    assert "1e+05: 5.0" in power_law.quantity
    # From left**-4 to left**-6: the later the fit begins, the larger.
    *_, power_law = claims_of_energy(0.06, lambda left: 1e6 * left**-4.0 + 1e6 * left**-6.0)
    assert power_law.verdict == "reproduced"
    least, most = (
        float(power_law.quantity.split(f"1e+0{power}: ")[1].split()[0]) for power in (5, 8)
    )
    assert most > least + 0.1
    assert power_law.found.error == pytest.approx((most - least) / 2, rel=0.02)
