"""The steady state of the gas: exact at e = 1, its balances, simulations of chains of all kinds."""

import math

import numpy as np
import pytest

from crazybilliards.comparison import deviation, smooth
from crazybilliards.kinetic import equilibrium, steady_state
from crazybilliards.kinetic.gas import agreement, fluctuations, mean_state
from crazybilliards.kinetic.gas.cells import make_cells
from crazybilliards.kinetic.gas.mean_state import Medium, mean_slope
from crazybilliards.kinetic.gas.stationary import rods_of
from crazybilliards.model import Chain
from crazybilliards.particles import simulate


def gas(size, restitution, damping, walls=1.0):
    """Return a gas in a box without springs, with this Gamma in the room of a rod."""
    chain = Chain(size=size, stiffness=0, box=3.0 * size)
    W = chain.damping / (chain.mass * damping)
    amplitude = W * math.sqrt(2 * chain.mass * chain.damping)
    return chain.replace(restitution=restitution, amplitude=amplitude, wall_restitution=walls)


KINDS = {
    "linear": Chain(size=16, restitution=0.5),
    "gap": Chain(size=20, restitution=0.5, gap=0.5),
    "quadratic": Chain(size=16, restitution=0.5, spring="quadratic"),
    "box": Chain(size=10, restitution=0.8, box=21),
    "quadratic box": Chain(size=8, restitution=0.8, box=17, spring="quadratic"),
    "gas": gas(9, 0.5, 0.1),
    "inelastic walls": gas(10, 0.85, 0.1, 0.5),
}


@pytest.fixture(scope="module")
def theory():
    """Return ``steady_state`` of a kind of chain, solved once."""
    known = {}

    def find(kind):
        if kind not in known:
            known[kind] = steady_state(KINDS[kind])
        return known[kind]

    return find


ELASTIC = [
    *(Chain(size=size) for size in (1, 2, 4)),
    Chain(size=20, spring="quadratic"),
    Chain(size=20, box=42),
    Chain(size=20, box=60, stiffness=0),
    *(Chain(size=20, gap=gap) for gap in (0.3, 2.0)),  # mutation: phi = 1 with a gap
    Chain(size=20, gap=0.3, box=80),
]


@pytest.mark.parametrize("chain", ELASTIC, ids=repr)
def test_elastic_chains_are_exact(chain):
    found, exact = steady_state(chain), equilibrium(chain)
    np.testing.assert_allclose(found.velocity_width, chain.free_velocity_width, rtol=1e-9)
    assert deviation(smooth(found), smooth(exact)).maximum < 1e-3
    atol = 2e-3 * (chain.thermal_length if chain.stiffness else 1.0)
    np.testing.assert_allclose(found.mean_displacement, exact.mean_displacement, atol=atol)
    np.testing.assert_allclose(found.displacement_width, exact.displacement_width, rtol=2e-3)
    if chain.box and not chain.gap:
        np.testing.assert_allclose(found.wall_force, exact.wall_force, rtol=1e-3)
    if chain.size > 3:
        for name in ("neighbour_covariance", "contact_loss"):
            np.testing.assert_array_equal(found[name], 0)
        for name in ("relative_temperature", "mode_velocity_variance"):
            np.testing.assert_allclose(found[name], chain.free_velocity_width**2, rtol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_noise_gives_what_damping_and_collisions_take(kind, theory):
    """Points and rods disagree a little on it. An inelastic wall takes its share as well.

    Mutations: a without 1 - 1/L, the loss at a wall.
    """
    chain, found = KINDS[kind], theory(kind)
    given = chain.damping * chain.free_velocity_width**2 * chain.size
    taken = float(chain.damping * (found.velocity_width**2).sum() + found.contact_loss.sum())
    e_w = chain.wall_restitution
    if e_w < 1:
        slowed = (1 - e_w) * math.sqrt(2 / (math.pi * e_w)) * found.velocity_width.values[0]
        taken += float(found.wall_force.sum()) * slowed
    both = chain.exchangeable and not chain.box
    assert taken == pytest.approx(given, rel=6e-3 if both else 1e-6)


@pytest.mark.parametrize("kind", ["linear", "gap"])
def test_the_centre_of_mass_is_as_warm_as_if_alone(kind, theory):
    """Collisions do not act on it."""
    free = KINDS[kind].free_velocity_width ** 2
    modes = theory(kind).mode_velocity_variance
    assert float(modes[0]) == pytest.approx(free, rel=6e-3)
    assert (modes > 0).all()
    assert float(modes[1]) < 0.95 * free


@pytest.mark.parametrize("kind", ["linear", "gap", "box"])
def test_the_force_balances_the_springs(kind, theory):
    """Between two rods there is what pulls all rods beyond them, and what the wall pushes."""
    chain, found = KINDS[kind], theory(kind)
    pull = chain.stiffness * found.mean_displacement.values[::-1].cumsum()[::-1][1:]
    wall = float(found.wall_force[1]) if chain.box else 0.0
    np.testing.assert_allclose(found.contact_force, pull + wall, rtol=1e-3)


@pytest.mark.parametrize("kind", ["gas", "inelastic walls"])
def test_the_pressure_of_a_gas_is_that_of_its_energy(kind, theory):
    """P (X - 2RL) = sum m <v^2>, whatever rods and walls lose."""
    chain, found = KINDS[kind], theory(kind)
    energy = chain.mass * float((found.velocity_width**2).sum())
    np.testing.assert_allclose(found.wall_force * 2 * chain.walls[1], energy, rtol=1e-4)


@pytest.mark.parametrize("kind", ["quadratic", "box"])
def test_the_unit_of_length_does_not_matter(kind, theory, monkeypatch):
    """It changes every stiffness, h_uu and place. Mutation: h without k_i."""
    own = mean_state.unit_length
    monkeypatch.setattr(mean_state, "unit_length", lambda chain: 0.4 * own(chain))
    found = steady_state(KINDS[kind])
    np.testing.assert_allclose(found.velocity_width, theory(kind).velocity_width, rtol=1e-4)
    np.testing.assert_allclose(found.displacement_width, theory(kind).displacement_width, rtol=1e-4)


# Largest relative difference of W_v but for statistics: of the rods 3 to L - 2, and of the first.
# Mutations: a conductivity without the 3, Lambda at an elastic wall ("gas").
AWAY = {
    "linear": (0.02, 0.03),
    "gap": (0.015, 0.03),
    "quadratic": (0.025, 0.035),
    "box": (0.02, 0.02),
    "quadratic box": (0.02, 0.02),
    "gas": (0.01, 0.01),
    "inelastic walls": (0.02, 0.09),
}


@pytest.mark.compiled
@pytest.mark.parametrize("kind", KINDS)
def test_simulation(kind, theory):
    chain, found = KINDS[kind], theory(kind)
    run = simulate(chain, duration=40_000, seed=3, observe="widths", threads=1, progress=False)
    off = np.abs(found.velocity_width / run.velocity_width - 1).values
    beyond = off - 5 * (run.velocity_width_error / run.velocity_width).values
    inner, first = AWAY[kind]
    assert beyond[2:-2].max() < inner
    assert beyond[[0, -1]].max() < first
    assert float(run.velocity_width_error.max() / run.velocity_width.min()) < 0.01


def test_heat_flows_from_the_border_to_where_collisions_take_it(theory):
    """What the last 5 rods have beyond their damping and losses flows inwards."""
    chain, found = KINDS["gap"], theory("gap")
    for name in ("velocity_width", "displacement_width", "contact_force", "velocity_variance"):
        np.testing.assert_allclose(found[name], found[name][::-1], rtol=1e-6)
    cooled = chain.damping * (found.velocity_width.values[-5:] ** 2).sum()
    lost = found.contact_loss.values[-4:].sum() + found.contact_loss.values[-5] / 2
    surplus = 5 * chain.damping * chain.free_velocity_width**2 - cooled - lost
    inwards = -float(np.interp(15, found.label, found.heat_flux))
    assert inwards == pytest.approx(surplus, rel=0.02)
    right = (found.x > 0) & (found.label < chain.size)
    assert float(found.heat_flux.where(right).max()) <= 0


@pytest.mark.parametrize("changes", [{}, {"spring": "quadratic"}, {"stiffness": 0, "box": 90}])
def test_mean_gaps_are_the_distances_of_mean_places(changes):
    """By order statistics of contacts, and of rods. Mutation: g without L/(L + 1)."""
    chain = Chain(size=20, **changes)
    mean = agreement.in_agreement(chain, make_cells(20, walled=chain.box > 0)).mean
    gaps = mean.gap[1:-1] if chain.box else mean.gap
    np.testing.assert_allclose(gaps, np.diff(mean.place), rtol=2e-3)


def test_the_slope_of_quadratic_springs_is_the_mean_over_their_fluctuations():
    """2 K <|x + u|>, by sampling u with the variance that the slope implies. Mutation: 1.5 K."""
    x, T, gap, spread = np.array([0.0, 1.5]), np.array([0.4, 0.4]), np.array([0.3, 0.3]), 0.05
    medium = Medium.of(Chain())._replace(stiffness=0.8, exponent=3)
    k = mean_slope(medium, x, T, gap, np.full(2, spread))
    local = T / np.sqrt(k**2 + 4 * k * T / gap**2)
    u = np.random.default_rng(1).normal(size=(400_000, 2)) * np.sqrt(local + spread)
    sampled = 2 * 0.8 * np.abs(x + u)
    assert (np.abs(sampled.mean(0) - k) < 5 * sampled.std(0) / np.sqrt(len(u))).all()


def test_correlations_cool_a_gas(theory):
    """What they are for: independent rods of this gas are 9 % too fast."""
    field = steady_state(KINDS["gas"], correlations=False).velocity_width
    assert float((field / theory("gas").velocity_width).mean()) > 1.05


@pytest.mark.parametrize("changes", [{"gap": 0.3}, {"box": 54}])
def test_cells_of_several_rods_change_little(changes):
    chain = Chain(size=24, restitution=0.75, **changes)
    fine, coarse = (
        rods_of(chain, agreement.in_agreement(chain, make_cells(24, most, walled=chain.box > 0)))
        for most in (24, 15)
    )
    width = np.sqrt(fine.velocity_variance)
    np.testing.assert_allclose(np.sqrt(coarse.velocity_variance), width, rtol=0.01)
    np.testing.assert_allclose(coarse.width, fine.width, rtol=0.01)


@pytest.mark.parametrize(
    ("place", "name", "value", "reason"),
    [
        (agreement, "_MOST_ITERATIONS", 2, "after 2 iterations"),
        (fluctuations.LinearResponse, "largest_growth", lambda _: 0.5, "grow at the rate 0.5"),
    ],
)
def test_a_state_that_is_not_found_is_an_error_with_a_reason(
    place, name, value, reason, monkeypatch
):
    monkeypatch.setattr(place, name, value)
    with pytest.raises(ValueError, match=f"no steady state that could be.*{reason}"):
        steady_state(Chain(size=8, restitution=0.75))


def test_the_way_to_small_restitutions_does_not_matter(monkeypatch):
    """Straight there, or by way of larger ones: the fixed point is the same."""
    chain = Chain(size=8, restitution=0)
    by_way = steady_state(chain)
    monkeypatch.setattr(agreement, "_WAY", ())
    direct = steady_state(chain)
    assert by_way.attrs["iterations"] > direct.attrs["iterations"]
    np.testing.assert_allclose(by_way.velocity_width, direct.velocity_width, rtol=2e-3)
