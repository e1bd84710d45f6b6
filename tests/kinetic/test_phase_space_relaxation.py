"""The kinetic equation in time: exact at e = 1, relaxing to the steady state otherwise."""

import re

import numpy as np
import pytest

from crazybilliards.comparison import smooth
from crazybilliards.kinetic import (
    compressed,
    displaced,
    force_balance,
    hydrodynamics,
    phase_space,
    relax_phase_space,
    rod_by_rod,
)
from crazybilliards.kinetic.exact.breathing import breathing_cloud
from crazybilliards.kinetic.kinetic_equation import relaxation as phase_space_relaxation
from crazybilliards.kinetic.kinetic_equation.continuation import continued, elastic_state
from crazybilliards.kinetic.rods import places
from crazybilliards.model import Chain

CHAIN = Chain(size=30)


@pytest.mark.parametrize(("stretch", "shift"), [(1.0, 1.0), (0.4, 0.0), (1.5, 0.0)])
def test_elastic_cloud_moves_as_the_exact_one(stretch, shift):
    start = displaced(CHAIN, shift) if shift else compressed(CHAIN, stretch)
    flow = relax_phase_space(CHAIN, start, 6.0, every=0.5, progress=False)
    exact = breathing_cloud(CHAIN, 6.0, every=0.5, stretch=stretch, shift=shift)
    s = CHAIN.thermal_length
    assert float(np.abs(flow.centre - exact.centre).max()) < 1e-3 * s
    assert float(np.abs(flow.cloud_width - exact.cloud_width).max()) < 1e-3 * s
    drift = flow.mean_velocity.mean("particle")
    energy = CHAIN.size * CHAIN.mass / 2 * (exact.velocity_variance + drift**2)
    if shift:
        np.testing.assert_allclose(flow.kinetic_energy, energy, rtol=2e-3)
    assert float(np.abs(flow.rods - CHAIN.size).max()) < 1e-10 * CHAIN.size
    assert float(flow.phase_space_density.min()) > -1e-3 * float(flow.phase_space_density.max())


@pytest.mark.parametrize("gap", [0.0, 0.2])
def test_the_density_is_that_of_the_fluid(gap):
    """At restitution 1 the fluid with a temperature moves as the kinetic equation does."""
    chain = CHAIN.replace(gap=gap)
    start = displaced(chain, 1.0)
    flow = relax_phase_space(chain, start, 4.0, every=2.0, cells=16, progress=False)
    fluid = rod_by_rod(
        hydrodynamics(chain, start, 4.0, every=2.0, velocity_variance="evolving", progress=False)
    )
    # Twice and three times what the mesh leaves, which falls with the cells squared.
    for name, most in (("density", 2e-2), ("label", 2e-3)):
        difference = flow[name].interp(x=fluid.x, kwargs={"fill_value": 0.0}) - fluid[name]
        inside = np.abs(fluid.x) < float(flow.x[-1])
        assert float(np.abs(difference.where(inside)).max()) < most, name
    np.testing.assert_allclose(flow.density.integrate("x"), chain.size, rtol=1e-4)
    # The tails of the rods are continued beyond the mesh.
    np.testing.assert_allclose(flow.label[:, -1], chain.size, rtol=1e-9)
    smoothed = smooth(flow).density.interp(x=fluid.x, kwargs={"fill_value": 0.0})
    assert float(np.abs(smoothed - smooth(fluid).density).max()) < 1e-3


def test_error_is_of_second_order_in_the_time_step():
    start = displaced(CHAIN, 1.0)

    def centre(step):
        return relax_phase_space(
            CHAIN, start, 6.0, every=6.0, time_step=step, cells=12, progress=False
        ).centre.values[-1]

    exact = breathing_cloud(CHAIN, 6.0, every=6.0, shift=1.0).centre.values[-1]
    coarse, fine = (abs(centre(step) - exact) for step in (0.5, 0.25))
    assert coarse / fine == pytest.approx(4, rel=0.1)


def test_a_step_longer_than_the_outputs_are_apart_ends_at_every_output():
    start = displaced(CHAIN, 1.0)
    asked = {"duration": 1.0, "every": 0.5, "cells": 8, "progress": False}
    one, longer = (relax_phase_space(CHAIN, start, time_step=t, **asked) for t in (0.5, 1e60))
    assert one.centre.equals(longer.centre)


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize(("restitution", "damping"), [(0.9, 1.0), (1.05, 6.0)])
def test_it_relaxes_to_the_steady_state(restitution, damping):
    chain = Chain(size=40, restitution=restitution, damping=damping)
    order = 2 if restitution < 1 else 1
    steady = continued(chain, elastic_state(chain, order, 20)).energy()
    start = phase_space(chain.replace(amplitude=1.5), cells=20)
    how = {"every": 25.0, "time_step": 0.5, "cells": 14, "progress": False}
    flow = relax_phase_space(chain, start, 25.0, **how)
    energy = flow.kinetic_energy / (chain.size * chain.temperature / 2)
    assert float(energy[0]) == pytest.approx(1.5**2 * steady, rel=5e-3)
    assert float(energy[-1]) == pytest.approx(steady, rel=5e-3)
    assert float(np.abs(flow.rods - chain.size).max()) < 1e-10 * chain.size


def test_with_a_gap_a_steady_state_stays():
    chain = CHAIN.replace(gap=0.2)
    flow = relax_phase_space(
        chain, force_balance(chain), 3.0, time_step=0.2, cells=14, progress=False
    )
    s = chain.thermal_length
    assert float(np.abs(flow.cloud_width / flow.cloud_width[0] - 1).max()) < 5e-3
    assert float(np.abs(flow.mean_velocity).max()) < 0.02 * chain.free_velocity_width
    assert float(np.abs(flow.centre).max()) < 1e-6 * s


def test_divergence_is_a_result():
    chain = Chain(size=160, restitution=1.05, damping=4.0)
    flow = relax_phase_space(
        chain, displaced(chain, 0.1), 20.0, every=0.2, time_step=0.1, cells=12, progress=False
    )
    assert flow.attrs["status"] == "diverged"
    assert flow.attrs["end_time"] < 20
    assert np.isfinite(flow.kinetic_energy).all()
    assert float(flow.kinetic_energy[-1]) > float(flow.kinetic_energy[0])


def test_a_cloud_that_contracts_below_the_mesh_has_not_diverged():
    """Its energy falls: the error names the mesh and the time that can be solved for."""
    chain = Chain(size=100, restitution=0.8)
    start = force_balance(chain.replace(restitution=1))
    arguments = {"every": 0.5, "time_step": 0.2, "cells": 8, "progress": False}
    with pytest.raises(ValueError, match=r"beyond .*: on cells=8 the distribution") as caught:
        relax_phase_space(chain, start, 8.0, **arguments)
    solved_for = float(re.search(r"beyond ([\d.]+):", str(caught.value))[1])
    flow = relax_phase_space(chain, start, solved_for, **arguments)
    assert flow.attrs["status"] == "completed"
    assert float(flow.kinetic_energy[-1]) < float(flow.kinetic_energy[0])


def test_interrupt_keeps_what_there_is(monkeypatch):
    seen = []
    original = phase_space_relaxation.snapshot

    def interrupt(*arguments):
        seen.append(1)
        if len(seen) > 3:
            raise KeyboardInterrupt
        return original(*arguments)

    monkeypatch.setattr(phase_space_relaxation, "snapshot", interrupt)
    flow = relax_phase_space(CHAIN, displaced(CHAIN, 1.0), 5.0, cells=8, progress=False)
    assert flow.attrs["status"] == "interrupted"
    assert flow.time.size == 3


@pytest.mark.parametrize("size", [1, 4])
def test_a_symmetric_state_stays_symmetric_and_on_the_grid(size):
    """Also on a mesh so coarse that f has ripples in the vacuum."""
    chain = Chain(size=size, radius=0.3, damping=0.5, amplitude=1.0)
    flow = relax_phase_space(chain, compressed(chain, 1.15), 1.0, cells=12, progress=False)
    highest = float(flow.density.max())
    np.testing.assert_allclose(flow.density, flow.density[:, ::-1], atol=1e-9 * highest)
    np.testing.assert_allclose(flow.label + flow.label[:, ::-1].values, size, rtol=1e-9)
    assert float(flow.density[:, [0, -1]].max()) < 1e-9 * highest


def test_more_rods_than_are_told_apart_have_the_density_of_a_fluid(monkeypatch):
    chain = Chain(size=60, damping=0.5, amplitude=10.0)
    start = compressed(chain, 0.9)
    rods = relax_phase_space(chain, start, 1.0, every=0.5, cells=12, progress=False)
    monkeypatch.setattr(places, "MOST_RODS", 50)
    fluid = relax_phase_space(chain, start, 1.0, every=0.5, cells=12, progress=False)
    assert (rods.attrs["density_of"], fluid.attrs["density_of"]) == ("rods", "fluid")
    np.testing.assert_allclose(fluid.density.integrate("x"), 60, rtol=1e-3)
    off = rods.label.interp(x=fluid.x) - fluid.label
    assert 0.01 < float(np.abs(off).max()) < 0.5  # of a rod, which is a spread around its place
