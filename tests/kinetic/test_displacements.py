"""The covariance that displacement widths are made of: the centre of mass, and waves in time."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import curve_fit

from crazybilliards.kinetic.gas.agreement import in_agreement, relaxing_pairs
from crazybilliards.kinetic.gas.cells import make_cells
from crazybilliards.kinetic.gas.stationary import rods_of
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

STEP = 0.2  # T, between two values of a correlation function
NUMBER = 40


@pytest.mark.parametrize(
    ("size", "restitution"), [(30, 0.9), pytest.param(80, 0.4, marks=pytest.mark.validate)]
)
def test_the_centre_of_mass_is_displaced_as_if_alone(size, restitution):
    """The variance of independent points, and what neighbourhoods have in common: W^2/L."""
    chain = Chain(size=size, restitution=restitution)
    found = in_agreement(chain, make_cells(size))
    labels, displaced = found.labels, found.fluctuations.displaced
    own = labels.fine.rods @ labels.place**2 / size
    rods = displaced.cells.rods
    shared = rods @ displaced.displacement @ rods / size
    assert own + shared == pytest.approx(1, abs=0.015)


def waves_of(values):
    """Return the waves 1 and 2 of values of rods, which are along the last axis."""
    size = values.shape[-1]
    q = np.array([[1], [2]])
    return values @ (np.sqrt(2 / size) * np.cos(np.pi * q * (np.arange(size) + 0.5) / size)).T


def damping(correlation):
    """Return the rate at which a correlation function decays, in units of the springs' rate."""

    def oscillation(t, rate, frequency, sine):
        return np.exp(-rate * t) * (np.cos(frequency * t) + sine * np.sin(frequency * t))

    times = STEP * np.arange(NUMBER) * np.sqrt(Chain().stiffness / Chain().mass)
    return curve_fit(oscillation, times, correlation / correlation[0], p0=(0.3, 1, 0.3))[0][0]


@pytest.mark.compiled
@pytest.mark.validate
def test_long_waves_are_damped_as_in_a_simulation():
    """Without the relaxing stress the damping is too small by a quarter."""
    size = 60
    chain = Chain(size=size, restitution=0.4)
    run = simulate(
        chain, duration=24_000, every=STEP, seed=3, observe="snapshots", threads=1, progress=False
    )
    moved = waves_of(run.position.values[0] - run.position.values[0].mean(axis=0))
    lagged = [(moved[: len(moved) - lag] * moved[lag:]).mean(axis=0) for lag in range(NUMBER)]
    simulated = [damping(each) for each in np.transpose(lagged)]
    # The linear equation with the stress.
    found = in_agreement(chain, make_cells(size))
    response, _ = relaxing_pairs(found.fluctuations.background)
    h = response.stationary()
    # Of independent points in their order, as evenly distributed ones have it.
    i = np.arange(1, size + 1)
    bridge = np.minimum.outer(i, i) * (size + 1 - np.maximum.outer(i, i))
    own = rods_of(chain, found).width ** 2 - np.diag(found.fluctuations.displaced.displacement)
    local = np.sqrt(own / np.diag(bridge))
    h[:size, :size] += bridge * np.outer(local, local)
    step = expm(response.generator * STEP * np.sqrt(chain.stiffness / chain.mass))
    states = [waves_of(h[:, :size])]
    for _ in range(NUMBER - 1):
        states.append(step @ states[-1])
    predicted = [
        damping(np.array([waves_of(each[:size].T)[q, q] for each in states])) for q in (0, 1)
    ]
    np.testing.assert_allclose(predicted, simulated, rtol=0.15)
