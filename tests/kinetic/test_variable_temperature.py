"""The force balance with a profile of the temperature: finite elements against everything else."""

import numpy as np
import pytest
from all_rods import require_all_rods

from crazybilliards.comparison import smooth
from crazybilliards.kinetic import force_balance
from crazybilliards.model import Chain
from crazybilliards.particles import simulate


def close_packing(chain, one, other):
    difference = np.interp(other.x, one.x, one.density, left=0, right=0) - other.density
    return float(np.abs(difference).max()) / chain.close_packed_density


@pytest.mark.parametrize(
    ("size", "gap", "amplitude"),
    [(2, 0.2, 0.1), (10, 0.0, 100), (1000, 1.0, 100), (1000, 1.0, 0.1), (100_000, 0.0, 0.1)],
)
def test_a_constant_profile_gives_the_label_closure(size, gap, amplitude):
    """Newton's method in x against a quadrature over u: nothing in common but the equation."""
    chain = Chain(size=size, gap=gap, amplitude=amplitude)
    free = chain.free_velocity_width**2
    elements = force_balance(chain, velocity_variance=lambda x: free)
    theory = force_balance(chain)
    assert close_packing(chain, elements, theory) < 1e-5
    assert elements.attrs["residual"] < 1e-11
    np.testing.assert_allclose(
        elements.mean_displacement, theory.mean_displacement, atol=2e-3 * chain.thermal_length
    )


PROFILES = {
    "cold centre": lambda z: 1 - 0.8 * np.exp(-4 * z**2),
    "hot border": lambda z: 1 + 3 * z**2,
    "step": lambda z: 0.55 + 0.45 * np.tanh((np.abs(z) - 0.7) / 0.02),
    "jump": lambda z: np.where(np.abs(z) < 0.7, 0.2, 1.0),
    "lopsided": lambda z: np.exp(z),
}


@pytest.mark.parametrize(("size", "gap"), [(10, 0.5), (1000, 0.0)])
@pytest.mark.parametrize("name", PROFILES)
def test_steep_profiles_satisfy_the_integrated_balance(name, size, gap):
    """Check rho W^2/(1 - 2 R rho) = int_x^inf rho F(<dx>)/m, whatever W^2 does."""
    chain = Chain(size=size, gap=gap, amplitude=5)
    extent = chain.anchors[-1] + 3 * chain.thermal_length
    free = chain.free_velocity_width**2

    def variance(x):
        return free * PROFILES[name](np.clip(np.asarray(x) / extent, -1, 1))

    theory = force_balance(chain, velocity_variance=variance)
    x, rho = theory.x.values, theory.density.values
    pressure = rho * variance(x) / (1 - 2 * chain.radius * rho)
    force = rho * theory.displacement.values * chain.stiffness / chain.mass
    cells = (force[1:] + force[:-1]) / 2 * np.diff(x)
    beyond = np.append(np.cumsum(cells[::-1])[::-1], 0)
    assert np.abs(pressure - beyond).max() < 0.01 * pressure.max()
    assert theory.attrs["residual"] < 1e-11


@pytest.mark.compiled
@pytest.mark.parametrize(("e", "off"), [(0.5, 0.042), (0.95, 0.018)])
def test_the_measured_widths_give_nearly_the_measured_density(e, off):
    """The general force balance fed with W_v(x) of a dissipative chain.

    Not exact: W_v belongs to a rod wherever it is, the equation wants the variance at a place. At
    A = 30 the density is off by ``off`` of close packing at most, in the wings; with the free W_v
    it would be by 0.3 to 0.4.
    """
    chain = Chain(size=100, restitution=e, amplitude=30)
    run = simulate(chain, duration=1000, replicas=2, progress=False)
    theory = force_balance(chain, velocity_variance=run)
    free = force_balance(chain.replace(restitution=1))
    assert close_packing(chain, smooth(theory), smooth(run)) == pytest.approx(off, abs=0.015)
    assert close_packing(chain, smooth(free), smooth(run)) > 0.25


def test_the_mesh_reaches_as_far_as_hot_rods():
    """The variance grows beyond the anchors; where it grows like x^2, nothing holds them."""
    chain = Chain(size=10)
    free, end = chain.free_velocity_width**2, chain.anchors[-1]

    def grown(factor, power):
        return lambda x: free * (1 + factor * np.maximum(np.abs(x) / end - 1, 0) ** power)

    require_all_rods(force_balance(chain, velocity_variance=grown(20, 1)), chain.size)
    with pytest.raises(ValueError, match="rods are found beyond x = "):
        force_balance(chain, velocity_variance=grown(300, 2))
