"""The relaxation time: against the slowest mode of one rod, and measured autocorrelations."""

import numpy as np
import pytest
from scipy.linalg import eigh_tridiagonal

from crazybilliards.kinetic import equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.scales import relaxation_time, settling_time


@pytest.mark.parametrize("damping", [0.1, 4.0, 50.0])
def test_on_linear_springs_it_is_that_of_the_slowest_mode(damping):
    chain = Chain(damping=damping)
    roots = np.roots([chain.mass, chain.damping, chain.stiffness])
    assert relaxation_time(chain) == pytest.approx(1 / np.abs(roots.real).min())


def test_strongly_damped_quadratic_springs_relax_by_diffusion():
    """With the slowest mode of z' = -z|z| + sqrt(2) xi, by finite differences."""
    edges = np.linspace(-4.5, 4.5, 2001)
    z, h = (edges[1:] + edges[:-1]) / 2, edges[1] - edges[0]
    weight, between = np.exp(-(np.abs(z) ** 3) / 3), np.exp(-(np.abs(edges[1:-1]) ** 3) / 3)
    diagonal = (np.append(between, 0) + np.append(0, between)) / weight / h**2
    beside = -between / np.sqrt(weight[1:] * weight[:-1]) / h**2
    [rate], _ = eigh_tridiagonal(diagonal, beside, select="i", select_range=(1, 1))
    chain = Chain(size=1, spring="quadratic", damping=1e4, amplitude=200.0, stiffness=2.0)
    expected = chain.damping / (chain.stiffness * chain.thermal_length * rate)
    assert relaxation_time(chain) == pytest.approx(expected, rel=1e-3)


def test_without_a_scale_of_the_spring_the_velocity_relaxes():
    chain = Chain(spring="quadratic", amplitude=0.0)
    assert relaxation_time(chain) == pytest.approx(chain.mass / chain.damping)
    assert relaxation_time(chain.replace(damping=0.0)) == np.inf


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
def test_without_a_spring_nothing_is_forgotten(spring):
    chain = Chain(spring=spring, stiffness=0.0)
    assert relaxation_time(chain) == np.inf
    assert settling_time(chain) == pytest.approx(chain.mass / chain.damping)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("size", "gap", "damping", "replicas", "low", "high"),
    [
        # At weak damping the energy relaxes 2.4 times faster than the upper estimate.
        (1, 0.0, 0.05, 100, 0.33, 0.57),
        (1, 0.0, 8.0, 160, 0.85, 1.15),
        (10, 0.3, 8.0, 20, 0.5, 1.2),
    ],
)
def test_quadratic_springs_relax_in_that_time(size, gap, damping, replicas, low, high):
    """Mean displacements forget, or energies where they swing, in the exact steady state.

    With s = W = 1. Low and high are five standard errors off what eight seeds found. The estimate
    for chains with a gap is good to a third.
    """
    how = {"spring": "quadratic", "mass": 1.0, "amplitude": np.sqrt(2 * damping)}
    chain = Chain(size=size, damping=damping, gap=gap, **how)
    step, start = relaxation_time(chain) / 8, equilibrium_states(chain, replicas, seed=1)
    times = {"duration": 480 * step, "every": step, "observe": "snapshots", "progress": False}
    run = simulate(chain, start=start, replicas=replicas, **times)
    displacement = run.position.values - chain.anchors
    measured = displacement.mean(axis=2)
    if damping < 1:
        measured = chain.potential(displacement)[..., 0] + run.velocity.values[..., 0] ** 2 / 2
    measured = measured - measured.mean()
    lags = np.arange(1, 40)
    correlation = np.array([(measured[:, n:] * measured[:, :-n]).mean() for n in lags])
    seen = slice(np.argmax(correlation < 0.15 * (measured**2).mean()))
    rate, _ = -np.polyfit(lags[seen] / 8, np.log(correlation[seen]), 1)
    assert low < 1 / rate < high
