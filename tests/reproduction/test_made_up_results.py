"""Claims and errors of figures from made-up results, so that what has to come out is known."""

import itertools
import json
from functools import cache
from types import MappingProxyType

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.widths import central_width
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.vocabulary import result
from crazybilliards.reproduction.figures import FIGURES
from crazybilliards.reproduction.vanishing_step import central_limit, limit_estimate, limits

AVALANCHES, DISPLACEMENTS, ENERGY, GAPS = (FIGURES[number - 1] for number in (6, 9, 15, 19))

# -- limits dt -> 0: W_v(i) is a sum of two power laws ----------------------------------------

NOISE, BIAS = 1e-3, 1e-3
CHAIN = Chain(size=100, restitution=0.0)


def made_up(chain, job, *, seed=0, steeper=0.0):
    """Return a result: W_v(centre) = L^-0.38, nu by the paper's law of e, noise on every rod."""
    i = np.arange(1.0, chain.size + 1)
    nu = steeper - (0.46 + 0.2457 * np.exp(-8.65 * (1 - chain.restitution)))
    profile = i**nu + i[::-1] ** nu
    profile *= chain.size**-0.38 / profile.min()
    name = f"{chain.size} {chain.restitution} {job}".encode()
    normal = np.random.default_rng([seed, *name]).normal(size=2)
    tilt = NOISE * normal[0] * np.log(profile / profile.min())  # of each run, so that nu scatters
    width = profile * (1 + NOISE * normal[1] + tilt)
    variables = {"velocity_width": ("particle", width)}
    variables["velocity_width_error"] = ("particle", NOISE * width)
    if job == "simulate_limit":
        variables["central_velocity_width"] = ((), width.min())
        variables["central_velocity_width_error"] = ((), np.hypot(NOISE, BIAS) * width.min())
    source = "theory" if job.endswith("phase_space") else "simulation"
    run = result(chain, variables, source=source, method={"schedule": {"time_step": 5e-4}})
    return run.assign_attrs(time_step_error=BIAS) if job == "simulate_limit" else run


def test_the_time_step_that_is_left_does_not_average_out():
    """Five limits: a fifth of the variance, all of the bias."""
    runs = [made_up(CHAIN, "simulate_limit", seed=seed) for seed in range(5)]
    five = {f"{limits(100).name}/{seed}": run for seed, run in enumerate(runs)}
    value, error = central_limit(five, 100)
    assert value == pytest.approx(100**-0.38, rel=5 * NOISE)
    assert error / value == pytest.approx((NOISE**2 / 5 + BIAS**2) ** 0.5, rel=1e-2)
    one = {f"{limits(100).name}/0": runs[0]}
    alone = float(runs[0].central_velocity_width_error)
    assert central_limit(one, 100).error == pytest.approx(alone, rel=1e-2)


def test_an_exponent_is_uncertain_by_scatter_and_by_the_step_that_is_left():
    """Equal limits do not scatter: what is left is the step, whose share b makes nu flatter.

    A centre wider by b, less outside, lowers ln(W_v(border)/W_v(centre)) = 1.4 by some of b, and
    nu by about as large a share.
    """

    def exponent(run):
        return fit_border_power_law(run).exponent

    first = made_up(CHAIN, "simulate_limit")
    results = {f"{limits(100).name}/{k}": first for k in range(4)}
    found = limit_estimate(results, 100, exponent)
    assert found.value == exponent(first)
    assert 0.5 * BIAS < found.error / abs(found.value) / 0.7 < 2 * BIAS
    width = limit_estimate(results, 100, central_width)
    assert width.error / width.value == pytest.approx(BIAS, rel=1e-2)
    # And the scatter between limits counts, as it does between runs.
    results[f"{limits(100).name}/1"] = made_up(CHAIN, "simulate_limit", steeper=0.04)
    assert limit_estimate(results, 100, exponent).error > 0.01


@pytest.mark.validate
@pytest.mark.parametrize(("number", "theories"), [(3, 1), (4, 0), (7, 2)])
def test_limits_are_drawn_and_theories_beside_the_runs(number, theories):
    figure = FIGURES[number - 1]
    results = {
        name: made_up(case.chain, case.job, seed=case.settings.get("seed", 0))
        for name, case in figure.cases("quick").items()
    }
    drawn = figure.draw(results)
    drawn.canvas.draw()
    shown = [line.get_ydata() for line in drawn.axes[0].lines]
    plt.close(drawn)
    found = [each for name, each in results.items() if name.startswith("theory")]
    assert len(found) == theories
    for theory in found:
        widths = theory.velocity_width / chain_of(theory).free_velocity_width
        assert any(np.array_equal(each, widths) for each in shown)


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
    return run.assign_attrs(provenance=json.dumps({"duration": 100.0}))


@cache
def claims_of_waves():
    generator = np.random.default_rng(1)
    results = {name: waves(case, generator) for name, case in AVALANCHES.cases("quick").items()}
    return AVALANCHES.claims(results)


def test_a_time_step_that_decides_about_an_exponent_is_named():
    """No step gives it: not reproduced. One does: it cannot be decided, and that one is named."""
    triggered, pushes = claims_of_waves()[:2]
    assert triggered.verdict == "not reproduced"
    assert not any(each.lies(triggered.within) for each in triggered.elsewhere.values())
    assert pushes.verdict == "cannot be decided"
    assert pushes.found.value == pytest.approx(-PUSHES[0.01], abs=5 * pushes.found.error)
    for step in (0.1, 0.023, 0.001):
        for sizes in ("20 to 150", "10 to 100"):
            there = pushes.elsewhere[f"dt = {step:g}, N_c = {sizes}"]
            assert there.lies(pushes.within) is (step == 0.023)
    assert len(triggered.elsewhere) == len(pushes.elsewhere) == 2 * len(PUSHES) - 1


def test_a_step_decides_whether_avalanches_have_a_mean():
    """Exponents above -2 have none; the paper's own, -2.2, has one, and no variance."""
    mean, variance = claims_of_waves()[-2:]
    for claim, least in ((mean, 2), (variance, 3)):
        assert claim.verdict == "cannot be decided"
        for step, exponent in PUSHES.items():
            if step != 0.01:
                there = claim.elsewhere[f"pushes, dt = {step:g}, N_c = 20 to 150"]
                assert there.lies(claim.within) is (exponent < least)


# -- figure 15: where a fit begins ------------------------------------------------------------


def claims_of_energy(late_rate, singular, rates=MappingProxyType({"100": 0.4, "250": 0.4})):
    """Return the claims, for a growth rate beyond t = 150 and an energy by the time left.

    ``rates`` are those of collisions by when their count begins.
    """

    def energies(time, energy, status):
        return xr.Dataset({"kinetic_energy": ("time", energy)}, {"time": time}, {"status": status})

    def collisions(rate):
        return xr.Dataset({"collision_rate": ("particle", [rate, rate, np.nan])})

    linear, quadratic = np.linspace(1, 300, 600), np.linspace(0.05, 40, 4000)
    log_energy = 0.06 * np.minimum(linear, 150) + late_rate * np.maximum(linear - 150, 0)
    results = {}
    for k in range(4):
        growing = 1e3 * np.exp((1 + 1e-4 * k) * log_energy)
        ending = np.exp(1e-3 * k) * singular(40.05 - quadratic)
        for step, begin in itertools.product(("", " dt=0.005"), ("100", "250")):
            results[f"collisions from {begin}{step}/{k}"] = collisions(rates[begin])
            results[f"linear{step}/{k}"] = energies(linear, growing, "completed")
        for step in ("", " dt=0.0005"):
            results[f"quadratic{step}/{k}"] = energies(quadratic, ending, "diverged")
    return ENERGY.claims(results)


def test_the_growth_rate_is_given_early_and_late():
    _, growth, power_law = claims_of_energy(0.0594, lambda left: 1e6 * left**-5.0)
    assert growth.verdict == "reproduced"
    assert "rate 0.060009" in growth.quantity
    assert "from E = 1e+03 to t = 150 T, and 0.0594089" in growth.quantity
    assert growth.found.value == pytest.approx(-0.01, rel=1e-6)
    assert power_law.found == pytest.approx((5.0, 0.0), abs=1e-4)
    assert "1e+05: 5.0" in power_law.quantity


@pytest.mark.parametrize(("late", "verdict"), [(0.41, "reproduced"), (0.5, "not reproduced")])
def test_a_collision_frequency_that_changes_is_not_constant(late, verdict):
    frequency, *_ = claims_of_energy(0.06, lambda left: 1e6 * left**-5.0, {"100": 0.4, "250": late})
    assert frequency.found.value == pytest.approx(late / 0.4 - 1)
    assert frequency.verdict == verdict


def test_an_exponent_has_the_spread_of_its_ranges_as_an_error():
    """From left**-4 to left**-6: the later the fit begins, the larger."""
    *_, power_law = claims_of_energy(0.06, lambda left: 1e6 * (left**-4.0 + left**-6.0))
    assert power_law.verdict == "reproduced"
    least, most = (
        float(power_law.quantity.split(f"1e+0{power}: ")[1].split()[0]) for power in (5, 8)
    )
    assert most > least + 0.1
    assert power_law.found.error == pytest.approx((most - least) / 2, rel=0.02)


# -- figures 9 and 19: displacements ----------------------------------------------------------


def claims_of_displacements(figure, shift, spread):
    """Return the claims of a figure, by what they state, for a <dx> and for W_x over W_v."""
    results = {}
    for name, case in figure.cases("quick").items():
        if case.job == "simulate":
            run = made_up(case.chain, case.job, seed=case.settings["seed"])
            moved = shift(run.particle.values - (case.chain.size + 1) / 2)
            values = {"mean_displacement": moved, "displacement_width": spread(run)}
            for quantity, value in values.items():
                run[quantity] = ("particle", value)
                run[f"{quantity}_error"] = ("particle", 0.1 * NOISE * np.abs(value))
            results[name] = run
    return {claim.statement: claim for claim in figure.claims(results)}


@pytest.mark.parametrize(
    ("law", "verdict"),
    [
        (lambda r: (500.5 - r) ** -1.2 - (500.5 + r) ** -1.2, "not reproduced"),
        (lambda r: np.arctanh(r / 501), "cannot be decided"),  # two small powers are nearly that
        (lambda r: np.sign(r) * (np.abs(r) > 300), "reproduced"),
    ],
)
def test_a_power_law_of_displacements_is_recognised(law, verdict):
    told = claims_of_displacements(DISPLACEMENTS, law, lambda run: run.velocity_width.values)
    assert told["<dx> does not follow a power law"].verdict == verdict


@pytest.mark.parametrize(("factor", "verdict"), [(1.0, "reproduced"), (0.8, "not reproduced")])
def test_rods_in_the_centre_move_like_free_ones_only_if_springs_alone_hold_them(factor, verdict):
    def spread(run):
        return factor * run.velocity_width.values * np.sqrt(chain_of(run).mass)

    told = claims_of_displacements(GAPS, lambda r: r, spread)
    for e in ("0", "0.75", "0.95"):
        assert told[f"rods in the centre move like free ones, e = {e}"].verdict == verdict
