"""Chains off restitution 1: the paper's widths, flippers, and what must not matter."""

import numpy as np
import pytest

from crazybilliards.kinetic import equilibrium_states
from crazybilliards.model import Chain, DivergedError, DivergedWarning
from crazybilliards.particles import simulate
from crazybilliards.particles.scales import centre_width, default_time_step


def centre_and_border(chain, share=0.1, **settings):
    """W_v of the chain's middle tenth, or share, and of its two outermost rods, with errors."""
    run = simulate(chain, replicas=2, observe="widths", progress=False, **settings)
    assert run.attrs["status"] == "completed"
    width, error = run.velocity_width.values, run.velocity_width_error.values
    half = max(int(share * width.size / 2), 1)
    middle = slice(width.size // 2 - half, width.size // 2 + half)
    return (
        np.sqrt(np.mean(width[middle] ** 2)),
        error[middle].mean() / np.sqrt(half),
        np.sqrt((width[0] ** 2 + width[-1] ** 2) / 2),
        error[[0, -1]].mean() / np.sqrt(2),
    )


@pytest.mark.compiled
@pytest.mark.parametrize(("size", "found", "duration"), [(30, 0.1181, 2500), (100, 0.0751, 1000)])
def test_the_centre_of_the_inelastic_chain_is_as_cold_as_it_was_found(size, found, duration):
    chain = Chain(size=size, restitution=0)
    centre, error, border, _ = centre_and_border(chain, duration=duration)
    assert error < 0.012 * centre
    assert centre == pytest.approx(found, rel=0.04)
    assert 0.2 < border < 0.25
    assert centre_width(chain) * chain.free_velocity_width == pytest.approx(centre, rel=0.2)


FLIPPERS = Chain(size=150, restitution=1.05, damping=4)
QUADRATIC = Chain(size=100, restitution=1.01, damping=0.4, spring="quadratic")
DIVERGING = {  # a chain, how it is simulated, and before when it diverges
    "supercritical": (FLIPPERS, {"duration": 30, "replicas": 2}, 30),
    "an ensemble": (FLIPPERS, {"duration": 50, "average": "ensemble", "replicas": 2}, 50),
    # No step is short enough for quadratic springs without damping when the swings are wide.
    "a long step": (QUADRATIC.replace(restitution=1, damping=0), {"time_step": 1.0}, 1e5),
    "quadratic": (QUADRATIC, {"duration": 500, "warmup": 0, "observe": "energy"}, 500),
}


@pytest.mark.filterwarnings("ignore:.*Without a steady state")
@pytest.mark.compiled
@pytest.mark.parametrize("name", DIVERGING)
def test_a_chain_that_diverges_keeps_what_was_measured(name):
    """Of an ensemble the times until the first replica blew up."""
    chain, how, before = DIVERGING[name]
    if "replicas" in how:
        elastic = chain.replace(restitution=1, amplitude=10 if "average" in how else 1)
        how = how | {"start": equilibrium_states(elastic, how["replicas"])}
    why = "a shorter one" if chain.restitution == 1 else "critical_size"
    with pytest.warns(DivergedWarning, match=rf"after t = [\d.e+]+: .*{why}"):
        run = simulate(chain, **{"observe": ("widths", "energy")} | how, progress=False)
    assert run.attrs["status"] == "diverged"
    assert 0 < run.time[-1] <= run.attrs["end_time"] < before
    assert "velocity_width" in run or "observe" in how
    assert run.kinetic_energy[-1] > 3 * run.kinetic_energy[0]
    for variable in run.data_vars:
        assert np.isfinite(run[variable]).all() or variable.endswith(
            ("_error", "autocorrelation_time")
        ), variable


@pytest.mark.compiled
def test_a_chain_that_explodes_at_once_has_a_status_and_no_averages():
    """150 flippers released in contact amplify their first kick without end."""
    told = r"before the first snapshot at t = .*warmup=0"
    with pytest.raises(DivergedError, match=told) as caught:
        simulate(FLIPPERS, duration=100, progress=False)
    run = caught.value.result
    assert run.attrs["status"] == "diverged"
    assert run.attrs["end_time"] < 1
    assert len(run.data_vars) == 0


MERGING = [{"duration": 2500, "merging": merging} for merging in (0.01, 0.1)]
CONTACTS = {"duration": 1500, "time_step": 0.003, "method": "contact-dynamics"}
ALIKE = {  # a restitution, and two ways to simulate it
    **{f"merging, e = {e}": (e, *MERGING) for e in (0.5, 0.95)},
    "contact dynamics": (0.0, CONTACTS | {"method": "event-driven"}, CONTACTS),
}


@pytest.mark.compiled
@pytest.mark.parametrize("name", ALIKE)
def test_neither_the_merging_threshold_nor_the_method_matters(name):
    e, *ways = ALIKE[name]
    (whole, error, border, border_error), (other, other_error, edge, edge_error) = (
        centre_and_border(Chain(size=20, restitution=e), share=1, seed=seed, **how)
        for seed, how in enumerate(ways)
    )
    assert abs(whole - other) < 5 * np.hypot(error, other_error)
    assert abs(border - edge) < 5 * np.hypot(border_error, edge_error)
    assert error < 0.005 * whole


def test_the_time_step_follows_what_has_to_be_resolved():
    assert default_time_step(Chain()) == pytest.approx(0.05 * np.sqrt(4 * np.pi / 3))
    steps = [default_time_step(Chain(size=size, restitution=0)) for size in (1, 10, 100, 1000)]
    assert steps == sorted(steps, reverse=True)
    # Rods too far apart to meet need no finer step than free ones.
    far = Chain(size=1000, restitution=0, gap=100)
    assert default_time_step(far) > 10 * steps[-1]
    lighter = Chain(size=6, mass=0.01 * far.mass, damping=0.5, gap=1)
    mixed = Chain(size=6, mass_ratio=0.01, damping=0.5, gap=1)
    assert default_time_step(mixed) == default_time_step(lighter)
