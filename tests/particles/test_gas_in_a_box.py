"""Gases between walls against exact laws: positions, velocities, pressure, and motion in time."""

import math
from contextlib import nullcontext

import numpy as np
import pytest
from drifts import moved

from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain
from crazybilliards.particles import given_start, relaxation_time, simulate
from crazybilliards.particles.scales import centre_width

ROOM = 20.0


def gas(size, room=ROOM, **parameters):
    """Return rods without springs in a box, with the temperature 1 and the mass 1."""
    damping = parameters.setdefault("damping", 1.0)
    parameters = {"stiffness": 0, "mass": 1, "amplitude": math.sqrt(2 * damping)} | parameters
    return Chain(size=size, box=room + 2 * size, **parameters)


def pulls(run, exact, *names):
    """Return the deviations of variables in standard errors."""
    off = [((run[name] - exact[name]) / run[f"{name}_error"]).values for name in names]
    return np.concatenate(off)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("size", "time_step", "duration"), [(1, 1.0, 1.5e5), (5, 0.1, 2.5e4), (50, 30.0, 1.5e6)]
)
def test_without_springs_the_steady_state_is_exact_at_any_step(size, time_step, duration):
    chain = gas(size, damping=0.5)
    how = {"duration": duration, "time_step": time_step, "every": max(time_step, 1.0)}
    run, walls = (simulate(chain, observe=observe, **how) for observe in ("widths", "walls"))
    names = ("mean_displacement", "displacement_width", "velocity_width")
    assert np.abs(pulls(run, equilibrium(chain), *names)).max() < 5
    assert (run.attrs["flight"], run.attrs["time_step_error"]) == ("exact", 0.0)
    rate = size / ROOM / math.sqrt(2 * math.pi)
    assert (np.abs(walls.wall_force - size / ROOM) < 5 * walls.wall_force_error).all()
    assert (np.abs(walls.wall_collision_rate - rate) < 5 * walls.wall_collision_rate_error).all()
    assert (walls.wall_force_error < 0.05 * size / ROOM).all()


LONG = {"duration": 2.5e5, "time_step": 0.8, "every": 0.8}


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("parameters", "how"),
    [
        ({"amplitude": 3, "damping": 0.5}, LONG),  # exact at any step
        ({"mass_ratio": 3.0}, {}),
        ({"gap": 0.5}, {}),
        ({"spring": "quadratic", "mass_ratio": 0.2}, {}),
        ({"stiffness": 0, "mass_ratio": 0.3, "gap": 1.0}, {}),
    ],
)
def test_on_springs_or_with_two_masses_the_pressure_is_exact_too(parameters, how):
    chain = gas(6, room=3.0, **{"stiffness": 1, "amplitude": 2, **parameters})
    run = simulate(chain, **{"duration": 1.5e4, "observe": ["widths", "walls"]} | how)
    names = ("mean_displacement", "displacement_width", "velocity_width", "wall_force")
    assert np.abs(pulls(run, equilibrium(chain), *names)).max() < 5
    assert run.attrs["time_step_error"] < 1e-3
    assert (run.wall_force_error < 0.05 * run.wall_force).all()


@pytest.mark.compiled
@pytest.mark.filterwarnings("ignore:wall_collision_rate is infinite")
@pytest.mark.parametrize(("wall", "width", "error"), [(0.0, 0.6178, 0.0), (0.1, 0.6200, 0.04)])
def test_elastic_rods_meet_a_wall_that_absorbs_as_single_rods_do(wall, width, error):
    """The force is that of each rod alone in the box; widths are from a 32nd of the step."""
    chain = Chain(size=10, amplitude=3, stiffness=0, box=22, wall_restitution=wall)
    one, how = chain.replace(size=1, box=4), {"observe": ["walls", "widths"], "duration": 5000}
    many, alone = (simulate(each, replicas=100 // each.size, **how) for each in (chain, one))
    off = many.wall_force / 10 - alone.wall_force
    scatter = np.hypot(many.wall_force_error / 10, alone.wall_force_error)
    assert (np.abs(off) < 5 * scatter).all()
    assert error <= alone.attrs["time_step_error"] < error + 0.02
    assert alone.velocity_width.item() == pytest.approx(width, rel=error + 5 * 1.1e-3)


@pytest.mark.compiled
@pytest.mark.parametrize(("size", "ratio"), [(2, 1), (22, 1), (6, 3)])
def test_without_noise_the_error_of_the_force_is_that_of_its_ends(size, ratio):
    """Blocks of the mean would say ten times as much, or too little near a period."""
    chain = gas(size, damping=0, mass_ratio=ratio)
    rng = np.random.default_rng(size)
    pulls, how = [], {"duration": 100, "every": 1, "observe": "walls"}
    for _ in range(40):
        velocity = rng.normal(size=size) / np.sqrt(chain.rod_masses)
        law = (chain.rod_masses * velocity**2).sum() / ROOM
        position = chain.physical(np.sort(rng.uniform(*chain.walls, size)))
        start = given_start(chain, position, velocity, replicas=1)
        run = simulate(chain, start=start, **how)
        pulls.append((run.wall_force - law) / run.wall_force_error)
    assert 0.8 < np.sqrt(np.square(pulls).mean()) < 1.25


@pytest.mark.parametrize("time_step", [1.0, 0.25, 0.01])
@pytest.mark.parametrize("e", [1.0, 0.9, 0.5])
def test_two_rods_that_fly_to_a_wall_that_absorbs_both_stop_there(e, time_step):
    chain = gas(2, room=10, damping=0, restitution=e, wall_restitution=0)
    y, v = moved(chain, ([-4.89, -4.69], [-1.0, -1.0]), time_step, round(2 / time_step))
    np.testing.assert_allclose([*y, *v], [-5, -5, 0, 0], atol=1e-8)


@pytest.mark.parametrize(
    ("wall", "told"), [(0.1, "infinite"), (0.2, "small, by about 6.%"), (0.5, "")]
)
def test_a_rate_that_is_infinite_or_not_resolved_says_so(wall, told):
    """True rates: .545 at e = .2 and .115 at .5, from steps of a hundredth and the known decay."""
    chain = Chain(size=1, amplitude=3, stiffness=0, box=6, wall_restitution=wall)
    with pytest.warns(RuntimeWarning, match=told) if told else nullcontext():
        run = simulate(chain, observe="walls", duration=2000, time_step=0.02)
    rate = run.wall_collision_rate.values.mean()
    assert rate == np.inf if wall == 0.1 else 0.08 < rate < 0.25


@pytest.mark.compiled
@pytest.mark.parametrize(("damping", "time_step"), [(0.0, 5.0), (0.05, 0.7)])
def test_a_gas_released_from_one_half_fills_the_box_as_its_points_do(damping, time_step):
    """The share beyond the middle, 1/2 - sum over odd q of (2/(pi q))^2 exp(-k_q^2 M(t)/2)."""
    room, size, replicas = 100.0, 50, 200
    chain = gas(size, room, damping=damping)
    generator = np.random.default_rng(1)
    y = np.sort(generator.uniform(-room / 2, 0, (replicas, size)), axis=1)
    v = generator.normal(size=y.shape)
    start = given_start(chain, chain.physical(y), v, replicas=replicas)
    how = {"average": "ensemble", "every": 25.0, "replicas": replicas}
    run = simulate(
        chain, duration=100.0, time_step=time_step, start=start, observe="snapshots", **how
    )
    beyond = (run.position > 2 * chain.radius * chain.rank).transpose("time", ...).values
    share = beyond.mean(axis=2)
    t = run.time.values
    spread = t**2 if damping == 0 else 2 / damping**2 * (damping * t - 1 + np.exp(-damping * t))
    k = np.pi * np.arange(1, 400, 2) / room
    exact = 0.5 - ((2 / (k * room)) ** 2 * np.exp(-np.outer(spread, k**2) / 2)).sum(axis=1)
    error = share.std(axis=1) / math.sqrt(replicas)
    assert (np.abs(share.mean(axis=1) - exact)[1:] < 5 * error[1:]).all()


@pytest.mark.compiled
@pytest.mark.parametrize(("e", "found"), [(0.9, 0.7416), (0.5, 0.5568)])
def test_a_granular_gas_is_as_cold_as_the_balance_of_energy_says(e, found):
    """50 rods with Gamma l/(L W) = 0.1; ``found`` in other simulations, whose error is 1e-3."""
    chain = gas(50, room=5.0, restitution=e)
    run = simulate(chain, duration=8000)  # it scatters by 2.5e-3
    middle = np.sqrt((run.velocity_width[12:38] ** 2).mean().item())
    assert middle == pytest.approx(found, rel=0.01)
    assert centre_width(chain) == pytest.approx(found, rel=0.02)


def test_a_gas_forgets_its_start_by_diffusion_or_by_free_flight():
    """The slowest wave of density decays as exp(-k^2 M(t)/2), k = pi/room."""
    for damping, room in ((0.01, 5.0), (5.0, 30.0)):
        chain = gas(20, room, damping=damping)
        t = 5 * relaxation_time(chain)
        spread = 2 / damping**2 * (damping * t - 1 + math.exp(-damping * t))
        assert math.exp(-((math.pi / room) ** 2) * spread / 2) < 0.01
