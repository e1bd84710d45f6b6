"""The limit of a vanishing time step: right, with the errors it states, and nothing lost."""

import json

import numpy as np
import pytest
import xarray as xr

from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain
from crazybilliards.particles import scales, simulate, simulate_limit
from crazybilliards.particles.limit import LimitRun
from crazybilliards.particles.running.replica import Replica
from crazybilliards.particles.scales import default_time_step, time_step_error

WIDTHS = ("velocity_width", "displacement_width", "mean_displacement")


def off(one, other, name):
    """Return the largest deviation in standard errors."""
    error = np.hypot(one[f"{name}_error"], other[f"{name}_error"])
    return float(np.abs((one[name] - other[name]) / error.where(error > 0)).max())


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize("restitution", [0.0, 0.2])
def test_it_agrees_with_runs_at_a_far_shorter_step(restitution):
    chain = Chain(size=10, restitution=restitution)
    accuracy = 0.003 if restitution == 0 else 0.004
    limit = simulate_limit(chain, accuracy=accuracy, seed=3, observe="widths", progress=False)
    step = default_time_step(chain) / 16
    run = simulate(
        chain, time_step=step, duration=30_000, replicas=2, seed=3, observe="widths", progress=False
    )
    for name in WIDTHS:
        assert off(limit, run, name) < 5, name


@pytest.mark.compiled
def test_it_is_one_run_at_one_step_and_has_the_wanted_accuracy():
    chain, how = Chain(size=12, restitution=0), {"seed": 4, "progress": False}
    limit = simulate_limit(chain, accuracy=0.01, **how)
    width, error = limit.central_velocity_width, limit.central_velocity_width_error
    assert 0.85 < error / width / 0.01 <= 1
    provenance = json.loads(limit.attrs["provenance"])
    schedule, step = provenance["schedule"], provenance["schedule"]["time_step"]
    every, duration = schedule["stride"] * step, provenance["duration"]
    run = simulate(chain, time_step=step, every=every, duration=duration, **how)
    assert provenance["snapshots"] == json.loads(run.attrs["provenance"])["snapshots"]
    bias = time_step_error(chain, step, float(width))
    assert limit.attrs["time_step_error"] == bias
    assert 0.001 < bias < 0.005
    of_springs = chain.stiffness / chain.mass * step**2 / 8
    for name, share in zip(WIDTHS, (bias, bias + of_springs, bias + of_springs), strict=True):
        np.testing.assert_array_equal(limit[name], run[name])
        expected = np.hypot(run[f"{name}_error"], share * abs(run[name]))
        np.testing.assert_allclose(limit[f"{name}_error"], expected)
    middle = (run.velocity_width[5:7] ** 2).mean() ** 0.5
    assert float(width) == pytest.approx(float(middle), rel=1e-12)


@pytest.mark.compiled
def test_a_free_rod_has_its_exact_widths():
    """Two at e = 0 that never meet: steps that could be shorter, and a limit that is known."""
    chain = Chain(size=2, restitution=0, gap=100)
    limit = simulate_limit(chain, accuracy=0.003, seed=1, progress=False)
    W, s = chain.free_velocity_width, chain.thermal_length
    exact = {
        "velocity_width": W,
        "displacement_width": s,
        "mean_displacement": 0,
        "central_velocity_width": W,
    }
    for name, value in exact.items():
        assert abs((limit[name] - value) / limit[f"{name}_error"]).max() < 5, name
        assert (limit[f"{name}_error"] < 0.03 * max(W, s)).all()
    gauss = np.exp(-(((abs(limit.x) - chain.anchors[1]) / s) ** 2) / 2) / (np.sqrt(2 * np.pi) * s)
    deviation = ((limit.density - gauss) / limit.density_error).where(gauss > 0.2 * gauss.max())
    assert float(abs(deviation).max()) < 5


@pytest.mark.compiled
@pytest.mark.parametrize("spring", ["linear", "quadratic"])
def test_an_elastic_chain_resolves_the_springs_alone(spring):
    chain = Chain(size=10, spring=spring)
    limit = simulate_limit(chain, accuracy=0.005, seed=1, progress=False)
    exact = equilibrium(chain)
    step = json.loads(limit.attrs["provenance"])["schedule"]["time_step"]
    if spring == "linear":
        assert (limit.attrs["time_step_error"], limit.attrs["flight"]) == (0, "exact")
        assert "double_step_change" not in limit.attrs  # nothing to check
    else:
        assert 1 < step / default_time_step(chain) < 3
    for name in WIDTHS:
        error = limit[f"{name}_error"]
        assert float(np.abs((limit[name] - exact[name]) / error).max()) < 5, name


@pytest.mark.compiled
def test_a_change_at_twice_the_step_that_nobody_expected_is_stated(monkeypatch):
    chain, how = Chain(size=50, restitution=0), {"accuracy": 0.02, "observe": "widths"}
    right = simulate_limit(chain, **how, progress=False)
    change, error = (right.attrs[f"double_step_change{end}"] for end in ("", "_error"))
    assert abs(change) < 5 * error < 0.3
    monkeypatch.setattr(scales, "_CORRECTED", 1e-4)  # the measured one is 0.1
    with pytest.warns(UserWarning, match="changed by .* at twice the time step, where"):
        wrong = simulate_limit(chain, **how, progress=False)
    bias = wrong.attrs["time_step_error"]
    assert bias == abs(wrong.attrs["double_step_change"]) > 0.05
    off_by = abs(wrong.central_velocity_width - right.central_velocity_width)
    assert 5 * right.central_velocity_width_error < off_by < 3 * wrong.central_velocity_width_error


OPTIONS = {"accuracy": 0.01, "seed": 5, "progress": False, "warmup": 30.0}


@pytest.mark.compiled
def test_the_same_seed_gives_the_same_bits_whatever_the_threads():
    chain = Chain(size=50, restitution=0)
    one, two = (simulate_limit(chain, replicas=2, threads=n, **OPTIONS) for n in (1, 2))
    xr.testing.assert_identical(one, two)
    other = simulate_limit(chain, replicas=2, **{**OPTIONS, "seed": 6})
    assert (other.velocity_width != one.velocity_width).all()


@pytest.mark.compiled
def test_ctrl_c_gives_the_limit_with_the_errors_so_far(ctrl_c, tmp_path):
    chain, counts = Chain(size=12, restitution=0), {}
    whole = simulate_limit(chain, replicas=2, **OPTIONS)
    options = {**OPTIONS, "replicas": 2, "checkpoint": tmp_path / "state"}

    def in_a_later_round(callers):
        for copy in callers[len(counts) :]:
            counts[len(counts)] = copy.snapshots
        return len(callers) > 40

    ctrl_c(Replica, "_block", in_a_later_round)
    cut = simulate_limit(chain, **options)
    assert cut.attrs["status"] == "interrupted"
    assert cut.central_velocity_width_error > whole.central_velocity_width_error
    deviation = abs(cut.central_velocity_width - whole.central_velocity_width)
    assert deviation < 5 * cut.central_velocity_width_error
    for _ in range(2):  # the second time there is nothing left to do
        xr.testing.assert_identical(simulate_limit(chain, **options), whole)


@pytest.mark.compiled
def test_ctrl_c_between_two_looks_gives_the_limit_with_the_errors_so_far(ctrl_c):
    ctrl_c(LimitRun, "accurate", lambda callers: len(callers) > 2)
    limit = simulate_limit(Chain(size=12, restitution=0), **OPTIONS)
    assert limit.attrs["status"] == "interrupted"
    assert limit.central_velocity_width_error < 0.1 * limit.central_velocity_width


@pytest.mark.compiled
def test_the_checkpoint_of_another_run_is_refused(ctrl_c, tmp_path):
    ctrl_c(Replica, "_advance", bool)
    chain = Chain(size=50, restitution=0)
    path = tmp_path / "state"
    with pytest.raises(KeyboardInterrupt, match="nothing was measured"):
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


@pytest.mark.compiled
@pytest.mark.parametrize("replicas", [31, 64])
def test_any_number_of_replicas_gives_a_limit(replicas):
    """From 64 on a replica has one block, and only all of them together have an error bar."""
    limit = simulate_limit(
        Chain(size=2, restitution=0), accuracy=0.1, replicas=replicas, progress=False
    )
    assert limit.attrs["status"] == "completed"
    assert 0 < limit.central_velocity_width_error < 0.1 * limit.central_velocity_width
