"""The gas in time with heat flux and inelastic collisions: its equations and simulations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from crazybilliards.kinetic import (
    compressed,
    displaced,
    equilibrium_states,
    force_balance,
    hydrodynamics,
)
from crazybilliards.kinetic.fluids.label_rates import Constants, label_rate
from crazybilliards.kinetic.gas.collision_moments import moments_of_collisions
from crazybilliards.model import Chain, DivergedWarning
from crazybilliards.particles import simulate
from studies.relaxation_error import Place

EVOLVING = {"velocity_variance": "evolving", "progress": False}


def largest_difference(constants, cells):
    """Return by how much the rates differ from the equations, for smooth fields on these cells."""
    nu = (np.arange(cells) + 0.5) / cells - 0.5
    faces = np.arange(1, cells) / cells - 0.5

    def y(at):
        return at + 0.1 * np.sin(2 * at)

    def slope(at):
        return 1 + 0.2 * np.cos(2 * at)

    def flow(at):
        return 0.5 * at + 0.1 * at**2

    def heat(at):
        return 1 + 0.3 * np.sin(3 * at)

    def q(at):
        return 0.2 + 0.1 * np.cos(2 * at)

    d = np.diff(y(nu))
    kappa = np.full(cells - 1, 1 / cells)
    known = constants | {"kappa": kappa, "distance": d, "labels": nu}
    c = Constants(shares=np.full(cells, 1 / cells), walled=False, exponent=2, **known)
    rates = label_rate(np.array([y(nu), flow(nu), np.append(heat(faces) * d**2, 0.0), q(nu)]), c)

    def along(function, at, h=1e-5):
        return (function(at + h) - function(at - h)) / (2 * h)

    n = 1 / slope(nu)
    V_t = -along(lambda at: heat(at) / slope(at), nu) - c.stiffness * y(nu) - c.damping * flow(nu)
    decay = (
        3 * c.heating
        + c.mixing * n * np.sqrt(heat(nu))
        + n * abs(along(heat, nu)) / np.sqrt(heat(nu))
    )
    q_t = -3 * n * heat(nu) * along(heat, nu) - 3 * n * q(nu) * along(flow, nu) - decay * q(nu)
    n = 1 / slope(faces)
    loss = c.loss * n * heat(faces) ** 1.5
    T_t = -along(lambda at: q(at) / slope(at), faces) + 2 * c.heating * (1 - heat(faces)) - loss
    inner = slice(2, -2)
    return max(
        np.abs(found - exact)[inner].max()
        for found, exact in (
            (rates[1], V_t),
            (rates[2, :-1] / d**2, T_t),  # the work of compression leaves S alone
            (rates[3], q_t),
        )
    )


def test_the_rates_are_the_equations_to_second_order():
    """Flow that expands, so that there is no viscosity."""
    constants = {"lam": 0.0, "stiffness": 0.7, "damping": 0.4, "heating": 0.5}
    constants |= {"loss": 0.6, "mixing": 0.9}
    coarse, fine = (largest_difference(constants, cells) for cells in (50, 100))
    assert fine < 2e-3
    assert coarse / fine == pytest.approx(4, rel=0.2)


def test_a_jump_of_the_flow_meets_the_viscous_pressure():
    """It is n (2 dV^2 + sqrt(T) |dV|/2), where cells run into one another at T = 1."""
    even = {"labels": np.zeros(6), "shares": np.ones(6), "kappa": np.ones(5)}
    constants = {"lam": 0.0, "stiffness": 0.0, "damping": 0.0, "heating": 0.0}
    constants |= {"loss": 0.0, "mixing": 0.0, "walled": False, "exponent": 2}
    jump = np.array([0.3, 0.3, 0.3, -0.3, -0.3, -0.3])
    fields = np.array([np.arange(6.0), jump, np.ones(6), np.zeros(6)])
    rates = label_rate(fields, Constants(distance=np.ones(5), **even, **constants))
    viscous = 2 * 0.6**2 + 0.5 * 0.6
    np.testing.assert_allclose(rates[1, 1:5], [0, -viscous, viscous, 0], atol=1e-12)
    np.testing.assert_allclose(rates[2, :5], [0, 0, 2 * viscous * 0.6, 0, 0], atol=1e-12)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("chain", "replicas"), [(Place(5, 0.8, 0.5).chain(), 2000), (Place(20, 1.03, 1.0).chain(), 300)]
)
@pytest.mark.filterwarnings("ignore:the error of the kinetic energy")
def test_the_kinetic_energy_is_that_of_simulated_chains(chain, replicas):
    elastic, factor = chain.replace(restitution=1.0), 1.2
    states = equilibrium_states(elastic, replicas, seed=1)
    y = factor * elastic.reduced(states.position.values)
    times = {"duration": 8.0, "every": 1.0, "progress": False}
    start = states.assign(position=(states.position.dims, elastic.physical(y)))
    how = {"replicas": replicas, "average": "ensemble", "observe": "energy", "seed": 2}
    run = simulate(chain, start=start, **how, **times)
    flow = hydrodynamics(chain, compressed(chain, factor), velocity_variance="evolving", **times)
    off, energy = np.abs(flow.kinetic_energy - run.kinetic_energy), run.kinetic_energy
    assert (off < 5 * run.kinetic_energy_error + 0.005 * energy).all()  # the theory's own error
    assert flow.attrs["status"] == "completed"
    np.testing.assert_allclose(flow.rods, chain.size, rtol=1e-12)


@pytest.mark.compiled
def test_in_the_steady_state_heat_flows_to_where_collisions_take_it():
    """d(heat flux)/dN is what noise and damping give a rod, less what its collisions take."""
    chain = Chain(size=30, restitution=0.95, amplitude=10)
    start = force_balance(chain.replace(restitution=1))
    flow = hydrodynamics(chain, start, 60, every=60, **EVOLVING)
    end, W, m = flow.isel(time=-1), chain.free_velocity_width, chain.mass
    assert end.residual < 1e-3
    N, T, rho = end.label.values, end.velocity_variance.values, end.density.values
    n = rho / (1 - 2 * chain.radius * rho)
    given = chain.damping * (W**2 - T)
    taken = m / 2 * (1 - 1 / 30) * moments_of_collisions(0.95).energy * n * T**1.5
    inside = (N > 3) & (N < 27)
    slope = np.gradient(end.heat_flux.values[inside], N[inside])
    unit = chain.damping * W**2
    assert np.abs(slope - (given - taken)[inside]).max() < 0.01 * unit
    assert (given - taken)[inside].max() - (given - taken)[inside].min() > 0.1 * unit
    assert float(end.heat_flux[inside & (end.x.values > 0)].max()) < 0
    with pytest.warns(UserWarning, match="its heat_flux is not read"):
        hydrodynamics(chain, end, 0.1, every=0.1, **EVOLVING)


@pytest.mark.compiled
@pytest.mark.filterwarnings("ignore:the error of the kinetic energy")
def test_divergence_is_a_result():
    chain = Chain(size=160, restitution=1.05, damping=4.0)
    with pytest.warns(DivergedWarning, match="hydrodynamics: a chain diverged"):
        flow = hydrodynamics(chain, displaced(chain, 0.1), 20.0, every=0.5, cells=60, **EVOLVING)
    assert flow.attrs["status"] == "diverged"
    assert flow.attrs["end_time"] < 20
    assert np.isfinite(flow.kinetic_energy).all()
    assert float(flow.kinetic_energy[-1]) > float(flow.kinetic_energy[0])


@pytest.mark.compiled
@pytest.mark.parametrize("spring", ["linear", "quadratic"])
def test_springs_that_release_their_energy_are_no_divergence(spring):
    """Of a start far from rest it is thousands of times that of free rods."""
    chain = Chain(size=10, amplitude=0.3, spring=spring)
    start = displaced(chain, 60 * chain.thermal_length)
    flow = hydrodynamics(chain, start, 6.0, every=0.5, cells=40, velocity_variance=None)
    assert flow.attrs["status"] == "completed"
    assert float(flow.kinetic_energy.max()) > 1000 * float(flow.kinetic_energy[0])
    assert np.isfinite(flow.cloud_width).all()  # also where the centre is far away
    if spring == "linear":
        centre = solve_ivp(
            lambda t, y: (y[1], -(y[0] + chain.damping * y[1]) / chain.mass),
            (0, 6.0),
            (float(flow.centre[0]), 0.0),
            t_eval=flow.time.values,
            rtol=1e-9,
            atol=1e-9,
        )
        np.testing.assert_allclose(flow.centre, centre.y[0], atol=1e-4 * centre.y[0, 0])


@pytest.mark.compiled
@pytest.mark.parametrize("frame", ["label", "eulerian"])
def test_the_shortest_duration_is_not_taken_for_ctrl_c(frame):
    """py-pde drops outputs that are close together; a missing output is no sign of Ctrl-C."""
    chain, duration = Chain(size=5), 1e-50
    flow = hydrodynamics(chain, displaced(chain, 2.0), duration, frame=frame, progress=False)
    assert flow.attrs["status"] == "completed"
    assert flow.sizes["time"] == 101
    assert float(flow.time[-1]) == pytest.approx(duration)
    # A shifted state at rest begins to move with the acceleration -k/m times its shift.
    speed = -2.0 * chain.stiffness / chain.mass * duration
    np.testing.assert_allclose(flow.mean_velocity[-1].mean(), speed, rtol=0.02)
