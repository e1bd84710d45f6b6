"""The exact law of equal rods in a box, and the starts of gases there."""

import numpy as np
import pytest

from crazybilliards.kinetic import force_balance, hydrodynamics
from crazybilliards.kinetic.exact.motion import gas_of_points, points_of
from crazybilliards.kinetic.starts import gathered, wave
from crazybilliards.model import Chain

ROOM = 40.0
GAS = Chain(size=20, box=80, stiffness=0, mass=1, damping=0.05, amplitude=0.1**0.5)


def decays(times, k):
    """Return exp(-k^2 M(t)/2) of a gas with W = 1, over (time, k)."""
    damping = GAS.damping
    spread = 2 / damping**2 * (damping * times - 1 + np.exp(-damping * times))
    return np.exp(-np.multiply.outer(spread, np.square(k)) / 2)


def test_a_wave_decays_as_one_cosine():
    found = gas_of_points(GAS, wave(GAS, 0.3), 60, 10)
    heights = 0.3 * decays(found.time.values, np.pi / ROOM)
    for label, height in zip(found.label, heights, strict=True):
        y, below = points_of(GAS, found.assign(label=label))
        place = (y + ROOM / 2) / ROOM
        law = GAS.size * (place + height * np.sin(np.pi * place) / np.pi)
        np.testing.assert_allclose(below, law, atol=1e-4)


@pytest.mark.parametrize("share", [0.5, 0.3])
def test_a_gas_released_from_one_side_fills_the_box(share):
    """The part beyond the middle is a sum of cosines of the box."""
    found = gas_of_points(GAS, gathered(GAS, share), 60, 5)
    k = np.pi * np.arange(1, 4001) / ROOM
    start = np.sin(k * share * ROOM) / (k * share * ROOM)
    law = 0.5 - 2 / ROOM * (start * np.sin(k * ROOM / 2) / k * decays(found.time.values, k)).sum(1)
    for label, expected in zip(found.label, law, strict=True):
        y, below = points_of(GAS, found.assign(label=label))
        assert 1 - np.interp(0, y, below) / GAS.size == pytest.approx(expected, abs=1e-3)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("frame", "kind", "damping", "tolerance"),
    [("eulerian", "evolving", 0.125, 0.01), ("label", None, 1.25, 0.003)],
)
@pytest.mark.filterwarnings("ignore:equal elastic rods")
def test_at_strong_damping_the_fluid_moves_as_its_points(frame, kind, damping, tolerance):
    """Of a gas released from one half: the shares beyond the middle."""
    chain = GAS.replace(damping=damping, amplitude=(2 * damping) ** 0.5)
    start = gathered(chain, 0.5)
    how = {"velocity_variance": kind, "frame": frame, "progress": False}
    flow = hydrodynamics(chain, start, 40, every=10, **how)
    np.testing.assert_allclose(flow.rods, chain.size, rtol=1e-12)
    exact = gas_of_points(chain, start, 40, 10)
    shares = [
        [1 - np.interp(0, *points_of(chain, each.isel(time=t))) / chain.size for t in range(1, 5)]
        for each in (flow, exact)
    ]
    np.testing.assert_allclose(*shares, atol=tolerance)


@pytest.mark.compiled
def test_a_start_of_two_masses_has_their_temperature():
    chain = GAS.replace(mass_ratio=3)
    for start in (force_balance(chain), wave(chain, 0.1)):
        how = {"every": 0.01, "velocity_variance": "evolving", "progress": False}
        flow = hydrodynamics(chain, start, 0.01, **how)
        inside = flow.density[0] > 0.1
        np.testing.assert_allclose(flow.velocity_variance[0][inside] * chain.mean_mass, 1)
