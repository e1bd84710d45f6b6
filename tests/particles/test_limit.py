"""The limit of a vanishing time step: right, with the errors it states, and nothing lost."""

import json

import numpy as np
import pytest
import xarray as xr

from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain
from crazybilliards.particles import simulate, simulate_limit
from crazybilliards.particles.scales import default_time_step, time_step_error
from crazybilliards.particles.vanishing_step import limit as limit_module
from crazybilliards.particles.vanishing_step.level_steps import plan_steps
from crazybilliards.particles.vanishing_step.multilevel import Levels
from crazybilliards.particles.vanishing_step.sampler import Sampler

WIDTHS = ("velocity_width", "displacement_width", "mean_displacement")


def levels(limit):
    return json.loads(limit.attrs["provenance"])["levels"]


def off(one, other, name):
    """Return the largest deviation in standard errors."""
    error = np.hypot(one[f"{name}_error"], other[f"{name}_error"])
    return float(np.abs((one[name] - other[name]) / error.where(error > 0)).max())


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize("restitution", [0.0, 0.2])
def test_it_agrees_with_runs_at_a_far_shorter_step(restitution):
    chain = Chain(size=10, restitution=restitution)
    limit = simulate_limit(
        chain,
        accuracy=0.003 if restitution == 0 else 0.004,
        seed=3,
        observe="widths",
        progress=False,
    )
    step = default_time_step(chain) / 16
    run = simulate(
        chain, time_step=step, duration=30_000, replicas=2, seed=3, observe="widths", progress=False
    )
    _, *differences = levels(limit)
    assert differences
    assert limit.attrs["coupling"] == "strong"
    for name in WIDTHS:
        assert off(limit, run, name) < 5, name
    if restitution == 0:  # the base alone would not do: its step is too long by far
        correction = abs(sum(each["value"] for each in differences))
        assert correction > 4 * limit.central_velocity_width_error
    error = limit.central_velocity_width_error / limit.central_velocity_width
    assert 0.002 < error < 0.005


@pytest.mark.compiled
def test_a_free_rod_has_its_exact_widths_and_distribution():
    """Two at e = 0 that never meet: several levels, and a limit that is known."""
    chain = Chain(size=2, restitution=0, gap=100)
    observe = ("widths", "velocities", "energy", "density")
    limit = simulate_limit(chain, accuracy=0.003, seed=1, observe=observe, progress=False)
    W, s = chain.free_velocity_width, chain.thermal_length
    exact = {
        "velocity_width": W,
        "displacement_width": s,
        "mean_displacement": 0,
        "kinetic_energy": chain.temperature,
        "central_velocity_width": W,
    }
    for name, value in exact.items():
        assert abs((limit[name] - value) / limit[f"{name}_error"]).max() < 5, name
        assert (limit[f"{name}_error"] < 0.03 * max(W, s)).all()
    for name, width in (("velocity_density", W), ("density", s)):
        values, errors = limit[name], limit[f"{name}_error"]
        if name == "velocity_density":
            values, errors = values[0], errors[0]
            away = values.velocity_bin
        else:
            away = abs(values.x) - chain.anchors[1]
        gauss = np.exp(-((away / width) ** 2) / 2) / (np.sqrt(2 * np.pi) * width)
        inside = gauss > 0.2 * gauss.max()
        deviation = ((values - gauss) / errors).where(inside)
        # Bins as wide as 5 % of v have other means than their centres by less than 1e-3.
        assert float(abs(deviation).max()) < 5, name
    assert limit.kinetic_energy.dims == ()


@pytest.mark.compiled
@pytest.mark.parametrize("spring", ["linear", "quadratic"])
def test_an_elastic_chain_takes_one_step(spring):
    """There is nothing to resolve but the springs, whose error is known, or none."""
    chain = Chain(size=10, spring=spring)
    limit = simulate_limit(chain, accuracy=0.005, seed=1, progress=False)
    exact = equilibrium(chain)
    [level] = levels(limit)
    assert limit.attrs["coupling"] == "one step"
    if spring == "linear":
        assert (limit.attrs["time_step_error"], limit.attrs["flight"]) == (0, "exact")
    else:
        assert 1 < level["time_step"] / default_time_step(chain) < 3
    for name in WIDTHS:
        error = limit[f"{name}_error"]
        assert float(np.abs((limit[name] - exact[name]) / error).max()) < 5, name


@pytest.mark.compiled
def test_where_coupling_is_weak_it_says_so_and_runs_plainly(capsys):
    chain = Chain(size=10, restitution=0.9)
    limit = simulate_limit(chain, accuracy=0.005, seed=1, observe="widths", threads=1)
    assert limit.attrs["coupling"] == "weak"
    assert limit.attrs["correlation"] < 0.6
    [level] = levels(limit)
    assert level["subtracted_time_step"] is None
    step, width = level["time_step"], float(limit.central_velocity_width)
    expected = time_step_error(chain, step, width)  # springs make no error of velocities
    assert limit.attrs["time_step_error"] == pytest.approx(expected)
    assert "only: plain runs at" in capsys.readouterr().err


def test_successive_steps_have_odd_ratios_and_common_snapshots():
    for restitution in (0.0, 0.5, 0.95, 1.0, 1.05):
        chain = Chain(size=30, restitution=restitution)
        for accuracy in (1e-3, 0.03):
            steps = plan_steps(chain, accuracy, None)
            assert len(steps.time_steps) == len(steps.ratios)
            for level, step in enumerate(steps.time_steps):
                assert step * steps.per_step(level) == pytest.approx(steps.time_steps[0])
            assert all(ratio % 2 == 1 for ratio in steps.ratios)
            shorter = plan_steps(chain, accuracy / 4, None)
            if restitution == 1:  # exact, whatever the step
                assert shorter == steps
            else:
                assert shorter.time_steps[-1] < steps.time_steps[-1]


OPTIONS = {"accuracy": 0.01, "seed": 5, "progress": False, "warmup": 30.0}


@pytest.mark.compiled
def test_the_same_seed_gives_the_same_bits_whatever_the_threads():
    chain = Chain(size=50, restitution=0)
    one, two = (simulate_limit(chain, replicas=2, threads=n, **OPTIONS) for n in (1, 2))
    xr.testing.assert_identical(one, two)
    other = simulate_limit(chain, replicas=2, **{**OPTIONS, "seed": 6})
    assert (other.velocity_width != one.velocity_width).all()
    assert len(levels(one)) > 1


@pytest.mark.compiled
def test_ctrl_c_gives_the_limit_with_the_errors_so_far(ctrl_c, tmp_path):
    chain = Chain(size=12, restitution=0)
    whole = simulate_limit(chain, **OPTIONS)
    options = {**OPTIONS, "checkpoint": tmp_path / "state"}
    pilot = {}

    def enough(callers):
        """Every level has had its pilot round, and some go on."""
        for sampler in callers:
            pilot[id(sampler)] = sampler.before
        return any(pilot.values()) and len(callers) % 3 == 0

    ctrl_c(Sampler, "_block", enough)
    cut = simulate_limit(chain, **options)
    assert cut.attrs["status"] == "interrupted"
    assert cut.central_velocity_width_error > whole.central_velocity_width_error
    deviation = abs(cut.central_velocity_width - whole.central_velocity_width)
    assert deviation < 5 * cut.central_velocity_width_error
    resumed = simulate_limit(chain, **options)
    xr.testing.assert_identical(resumed, whole)


@pytest.mark.compiled
def test_ctrl_c_between_two_rounds_gives_the_limit_with_the_errors_so_far(ctrl_c):
    """Even where the next round would measure a further level for the first time."""
    ctrl_c(Levels, "_extend", lambda callers: len(callers) > 2)
    limit = simulate_limit(Chain(size=12, restitution=0), **OPTIONS)
    assert limit.attrs["status"] == "interrupted"
    assert limit.central_velocity_width_error < 0.1 * limit.central_velocity_width


@pytest.mark.compiled
def test_the_checkpoint_of_another_run_is_refused(ctrl_c, tmp_path):
    ctrl_c(Sampler, "_advance", bool)
    chain = Chain(size=50, restitution=0)
    path = tmp_path / "state"
    with pytest.raises(KeyboardInterrupt, match="not every level"):
        simulate_limit(chain, warmup=1e6, checkpoint=path, progress=False)
    for change, reason in (
        ({"accuracy": 0.02}, "another run: accuracy is 0.01 there and 0.02 here; remove"),
        ({"replicas": 2}, "replicas is 1 there and 2 here"),
        ({"seed": 1}, "seed is 0 there and 1 here"),
    ):
        with pytest.raises(ValueError, match=reason):
            simulate_limit(chain, warmup=1e6, checkpoint=path, progress=False, **change)
    with pytest.raises(ValueError, match="a checkpoint of another run"):
        simulate(chain, checkpoint=path, progress=False)


@pytest.mark.compiled
def test_a_chain_without_a_steady_state_is_marked_diverged():
    chain = Chain(size=150, restitution=1.05, damping=4)
    limit = simulate_limit(chain, accuracy=0.1, warmup=200.0, observe="widths", progress=False)
    assert limit.attrs["status"] == "diverged"
    assert limit.attrs["end_time"] < 200
    assert "velocity_width" not in limit


# -- errors ------------------------------------------------------------------------------------


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
