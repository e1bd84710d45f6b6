"""How neighbours move together and what they exchange, against exact cases and raw snapshots."""

import numpy as np
import pytest

from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.impacts import make_impacts
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.observers import Covariances
from crazybilliards.particles.stepping import record

ALL = ["widths", Covariances(separations=9), "modes", "impacts"]


def agree(measured, expected, factor=5):
    """Within ``factor`` standard errors, where something was measured."""
    values, errors = measured
    known = np.isfinite(values.values)
    assert known.any()
    assert (abs(values.values - expected) <= factor * errors.values)[known].all()


def with_error(run, name):
    """Return a variable and its standard error."""
    return run[name], run[f"{name}_error"]


@pytest.mark.compiled
def test_two_elastic_rods_are_two_points_that_pass():
    """Half normal gaps, and relative velocities that do not depend on them."""
    chain = Chain(size=2)
    options = {"duration": 40_000, "time_step": 0.1, "progress": False}
    run = simulate(chain, observe=ALL, **options)
    width, length = chain.free_velocity_width, chain.thermal_length
    agree(with_error(run, "neighbour_covariance"), 0)
    agree(with_error(run, "mode_velocity_variance"), width**2)
    agree(with_error(run, "mean_gap"), 2 * length / np.sqrt(np.pi))
    variance = length**2 * (2 - 4 / np.pi)
    agree([each[:, 0] for each in with_error(run, "gap_covariance")], variance)
    agree(with_error(run, "contact_force"), chain.stiffness * length / np.sqrt(np.pi))
    for name in ("relative_temperature", "contact_temperature", "rebound_temperature"):
        agree(with_error(run, name), width**2)
        assert (run[f"{name}_error"] / run[name]).item() < 0.03
    assert (run.contact_loss == 0).all()


@pytest.mark.compiled
@pytest.mark.parametrize("e", [1.0, 0.75])
def test_collisions_keep_up_the_springs_and_take_what_noise_gives(e):
    chain = Chain(size=2, restitution=e)
    options = {"duration": 20_000, "time_step": 0.02, "every": 0.2, "progress": False}
    run = simulate(chain, observe=ALL, seed=2, **options)
    springs = chain.stiffness * run.mean_displacement[1].item()
    spread = chain.stiffness * run.mean_displacement_error[1].item()
    assert abs(run.contact_force.item() - springs) < 5 * spread
    noise = chain.size * chain.amplitude**2 / (2 * chain.mass)
    squares = run.velocity_width**2
    taken = noise - chain.damping * float(squares.sum())
    spread = 4 * chain.damping * float((run.velocity_width * run.velocity_width_error).sum())
    assert abs(run.contact_loss.item() - taken) < 5 * spread / np.sqrt(2)
    root = np.sqrt(run.contact_temperature)
    expected = 2 / np.sqrt(np.pi) * (1 - e) * run.contact_force * root
    np.testing.assert_allclose(run.contact_loss, expected, rtol=1e-3, atol=1e-15)
    np.testing.assert_allclose(run.rebound_temperature, e**2 * run.contact_temperature, rtol=1e-3)


@pytest.mark.compiled
@pytest.mark.parametrize("average", ["time", "ensemble"])
def test_they_are_the_averages_of_the_snapshots(average):
    chain = Chain(size=6, restitution=0.5)
    options = {"duration": 60, "every": 0.5, "replicas": 40, "average": average}
    observe = [Covariances(separations=3), "snapshots"]
    run = simulate(chain, observe=observe, progress=False, **options)
    over = ("replica",) if average == "ensemble" else ("replica", "time")
    v, gaps = run.velocity, run.position.diff("particle").drop_vars("particle") - 2
    for r in range(4):
        own, other = (v.isel(particle=part).values for part in (slice(6 - r), slice(r, 6)))
        expected = v.isel(particle=slice(6 - r)).copy(data=own * other).mean(over)
        found = run.velocity_covariance.isel(separation=r)
        np.testing.assert_allclose(found.isel(particle=slice(6 - r)), expected)
        assert found.isel(particle=slice(6 - r, 6)).isnull().all()
        left, right = (gaps.isel(particle=part) for part in (slice(5 - r), slice(r, 5)))
        found = run.gap_covariance.isel(separation=r)
        both = (left * right).mean(over) - left.mean(over) * right.mean(over)
        np.testing.assert_allclose(found.isel(contact=slice(5 - r)), both, rtol=1e-6, atol=1e-12)
        assert found.isel(contact=slice(5 - r, 5)).isnull().all()
    neighbours = run.velocity_covariance.isel(separation=1, particle=slice(5))
    np.testing.assert_array_equal(run.neighbour_covariance, neighbours)


def test_steps_that_diverge_do_not_count():
    def recorded(most, fastest):
        dynamics = make_dynamics(Chain(size=5, restitution=0.5), 0.1, speed=1.0, counted=True)
        tally = make_tally(5, contacts=True)._replace(impacts=make_impacts(5))
        buffers, noise = np.zeros((2, most, 5)), make_noise(np.random.SeedSequence(3))
        state = np.zeros(5), np.zeros(5), noise, dynamics._replace(fastest=fastest)
        valid, _ = record(*state, make_scratch(5), tally, 7, *buffers)
        return valid, buffers[1], tally.impacts

    _, speeds, _ = recorded(9, np.inf)
    number, _, kept = recorded(99, np.abs(speeds).max())
    assert 9 <= number < 99
    _, _, expected = recorded(number, np.inf)
    np.testing.assert_array_equal(kept, expected)
    assert (expected > 0).all()
