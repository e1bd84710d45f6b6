"""What is measured, against what is known exactly at e = 1."""

import numpy as np
import pytest
from scipy.stats import norm

from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import Plan
from crazybilliards.particles.observers.energy import Energy
from crazybilliards.particles.schedule import Schedule


@pytest.mark.compiled
def test_kinetic_energy_is_half_a_temperature_a_rod():
    chain = Chain(size=10)
    run = simulate(chain, duration=20_000, replicas=4, observe="energy", progress=False)
    assert run.kinetic_energy.sizes["time"] <= 1000
    energy, error = run.kinetic_energy, run.kinetic_energy_error
    expected = chain.size * chain.temperature / 2
    spread = error.mean().item() / np.sqrt(run.sizes["time"])
    assert abs(energy.mean().item() - expected) < 5 * spread
    assert (np.diff(run.time) > 0).all()
    assert run.time[-1] <= run.attrs["end_time"] + 1e-9


def test_energy_starts_at_the_start():
    run = simulate(Chain(size=50), duration=100, warmup=0, observe="energy", progress=False)
    assert run.time[0] == pytest.approx(1.02, abs=0.05)
    # From rest the noise gives A^2 t/(2 m) a rod at first.
    assert run.kinetic_energy[0].item() == pytest.approx(50 * 1.02 / (2 * 4.19), rel=0.5)
    assert "kinetic_energy_error" not in run


@pytest.mark.compiled
def test_elastic_collisions_are_the_zero_crossings_of_gaussian_processes():
    """Rice: each of the L(L-1)/2 pairs of relabelled points meets w0/pi times a time unit."""
    chain = Chain(size=20)
    run = simulate(chain, duration=5000, replicas=2, observe="collisions", progress=False)
    expected = 190 * np.sqrt(chain.stiffness / chain.mass) / np.pi
    total = run.collision_rate.sum().item()
    spread = np.sqrt((run.collision_rate_error**2).sum().item()) * 3  # contacts are correlated
    assert total == pytest.approx(expected, rel=0.02)
    assert abs(total - expected) < 5 * spread
    assert run.collision_rate[-1] == 0
    np.testing.assert_allclose(
        run.collision_rate[:-1], run.collision_rate[-2::-1], atol=8 * spread / 20
    )


@pytest.mark.compiled
def test_velocities_are_gaussian_at_restitution_one():
    chain = Chain(size=5)
    run = simulate(chain, duration=50_000, replicas=2, observe="velocities", progress=False)
    density, v = run.velocity_density, run.velocity.values
    assert run.velocity_outside == 0
    width = np.gradient(v)
    np.testing.assert_allclose((density * width).sum("velocity"), 1, rtol=0.01)
    W = chain.free_velocity_width
    middle = np.abs(v) < 2 * W
    coarse = density.values.mean(axis=0)[middle]
    expected = norm.pdf(v[middle], scale=W)
    assert np.abs(coarse / expected - 1).mean() < 0.03


def test_the_autocorrelation_time_is_that_of_a_free_rod():
    """gamma/k for the displacement of one rod on a linear spring; 64 blocks tell it to 18 %."""
    chain = Chain(size=1, damping=2)
    run = simulate(chain, duration=30_000, observe="widths", progress=False)
    assert run.autocorrelation_time.item() == pytest.approx(2, rel=0.6)


def test_collisions_are_only_seen_one_at_a_time():
    with pytest.raises(ValueError, match="'collisions' are only seen"):
        simulate(Chain(), method="contact-dynamics", observe="collisions", progress=False)
    with pytest.raises(ValueError, match="'velocities' needs"):
        simulate(Chain(damping=0), observe="velocities", progress=False)
    with pytest.raises(ValueError, match="would take"):
        simulate(Chain(size=10**7), observe="velocities", progress=False)


def test_observe_and_particles_take_lists():
    for wrong in (5, None, True, [["widths"]], [3]):
        with pytest.raises(ValueError, match="observe takes"):
            simulate(Chain(), observe=wrong, progress=False)
    for wrong in (5, "12", True):
        with pytest.raises(ValueError, match="particles must be a list"):
            simulate(Chain(), particles=wrong, progress=False)


def test_the_energy_of_a_run_of_a_billion_snapshots_takes_no_memory_for_their_times():
    schedule = Schedule(0.1, warmup_steps=0, stride=10, blocks=64, snapshots_per_block=10**8)
    energy = Energy(Plan(Chain(), schedule, np.arange(100), swing=0.0, copies=1))
    energy.counts[:] = energy.together
    assert energy.coordinates()["time"][[0, -1]] == pytest.approx([3.2e6, 6.4e9 - 3.2e6], rel=1e-6)
