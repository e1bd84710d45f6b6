"""The errors of a limit of the time step: how many groups, how long, and what they cost."""

import json

import numpy as np
import pytest

from crazybilliards.model import Chain
from crazybilliards.particles import simulate, simulate_limit
from crazybilliards.particles.vanishing_step import limit as limit_module


def levels(limit):
    return json.loads(limit.attrs["provenance"])["levels"]


@pytest.mark.compiled
def test_the_error_holds_both_parts():
    limit = simulate_limit(Chain(size=50, restitution=0), accuracy=0.01, seed=4, progress=False)
    parts = levels(limit)
    bias = limit.attrs["time_step_error"] * limit.central_velocity_width
    whole = np.sqrt(sum(each["error"] ** 2 for each in parts) + bias**2)
    assert float(limit.central_velocity_width_error) == pytest.approx(float(whole))
    assert float(bias) == pytest.approx(abs(parts[-1]["value"]) / (9**1.5 - 1))
    total = sum(each["value"] for each in parts)
    assert float(limit.central_velocity_width) == pytest.approx(total)
    assert sum(each["share_of_variance"] for each in parts) == pytest.approx(1)


@pytest.mark.compiled
@pytest.mark.parametrize("replicas", [31, 32, 64])
def test_any_number_of_replicas_gives_a_limit(replicas):
    """From 32 on a replica has one group, and only all of them together have an error bar."""
    limit = simulate_limit(
        Chain(size=2, restitution=0), accuracy=0.1, replicas=replicas, progress=False
    )
    assert limit.attrs["status"] == "completed"
    assert 0 < limit.central_velocity_width_error < 0.1 * limit.central_velocity_width


@pytest.mark.compiled
def test_a_density_that_hardly_any_rod_measured_has_no_error_bar():
    """A node without a visit had the error 0, also where the density is not small."""
    chain = Chain(size=5, restitution=0, damping=10.0, gap=0.3)
    limits = [simulate_limit(chain, accuracy=0.1, seed=seed, progress=False) for seed in range(10)]
    density, error = (
        np.array([limit[name].values for limit in limits]) for name in ("density", "density_error")
    )
    assert np.isnan(error[density == 0]).all()
    known = np.isfinite(error)
    assert (error[known] > 0).all()
    typical = density.mean(axis=0)
    assert known[:, typical > 0.5 * typical.max()].all()
    assert (np.abs(density - typical) < 7 * error)[known].all()


@pytest.mark.compiled
def test_the_work_is_planned_with_the_collisions_that_were_met(monkeypatch):
    """At e = 0.5 a collision costs as much as eight steps of a rod."""
    chain = Chain(size=30, restitution=0.5)
    found = []
    monkeypatch.setattr(limit_module, "_collect", lambda levels, *_: found.append(levels))
    simulate_limit(chain, accuracy=0.02, seed=1, observe="widths", progress=False)
    [planned] = found
    base = planned.used[0]
    run = simulate(
        chain,
        time_step=planned.steps.time_steps[base],
        duration=2000,
        observe="collisions",
        progress=False,
    )
    collisions = float(run.collision_rate.sum()) / chain.size * planned.steps.interval
    steps = planned.steps.stride * planned.steps.per_step(base) + 1
    expected = steps * (20 / chain.size + 6) + 50 * collisions
    assert planned._cost(base, coupled=False) == pytest.approx(expected, rel=0.02)
    assert 50 * collisions > 0.1 * expected
