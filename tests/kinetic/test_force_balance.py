"""The force balance against closed forms, its own differential equation, and bad input."""

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.special import wrightomega
from scipy.stats import gennorm

from crazybilliards.kinetic import equilibrium, force_balance
from crazybilliards.model import Chain


def closed_form(chain, quantiles):
    """x, rho and <dx> without gap: rho_y is L times the density of a free rod."""
    n = chain.potential_exponent
    free = gennorm(n, scale=n ** (1 / n) * chain.thermal_length)
    y = free.ppf(quantiles)
    x = y + 2 * chain.radius * chain.size * (quantiles - 0.5)
    reduced = chain.size * free.pdf(y)
    return x, reduced / (1 + 2 * chain.radius * reduced), y


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize(("size", "amplitude"), [(2, 100.0), (100, 1.0), (100_000, 0.1)])
def test_without_gap_it_is_the_closed_form(size, amplitude, spring):
    chain = Chain(size=size, amplitude=amplitude, spring=spring)
    theory = force_balance(chain)
    inside = np.abs(theory.label / size - 0.5).values < 0.5 - 1e-9
    # Solve x(quantile) = grid on a table fine enough for relative errors of 1e-7.
    quantiles = np.geomspace(1e-12, 0.5, 20_001)
    x, density, displacement = closed_form(chain, quantiles)
    left = inside & (theory.x.values <= 0) & (theory.x.values >= x[0])
    expected = CubicSpline(x, density)(theory.x.values[left])
    np.testing.assert_allclose(theory.density.values[left], expected, rtol=1e-6)
    expected = CubicSpline(x, displacement)(theory.x.values[left])
    np.testing.assert_allclose(
        theory.displacement.values[left], expected, atol=1e-6 * chain.thermal_length
    )


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("gap", [0.2, 1.0])
def test_it_satisfies_the_papers_equation(gap, spring):
    """Rho' = -F(<dx>)/(m W^2) rho (1 - 2 R rho)^2 and <dx> = x - (2R + g)(N - L/2), N' = rho."""
    chain = Chain(size=50, amplitude=30, gap=gap, spring=spring, radius=1.3)
    theory = force_balance(chain)
    x, rho = theory.x.values, theory.density.values
    spline = CubicSpline(x, rho)
    pull = chain.force(theory.displacement) / (chain.mass * chain.free_velocity_width**2)
    right = -pull * rho * (1 - 2 * chain.radius * rho) ** 2
    np.testing.assert_allclose(spline(x, 1), right, atol=2e-5 * np.abs(right).max())
    np.testing.assert_allclose(CubicSpline(x, theory.label)(x, 1), rho, atol=1e-6 * rho.max())
    seen = rho > 1e-12
    by_labels = x - (2 * chain.radius + gap) * (theory.label.values - chain.size / 2)
    np.testing.assert_allclose(theory.displacement.values[seen], by_labels[seen], atol=1e-7)


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("amplitude", [0.1, 100.0])
@pytest.mark.parametrize(("size", "gap"), [(2, 0.2), (101, 1e-6), (101, 3.0), (100_000, 0.2)])
def test_it_just_works(size, gap, amplitude, spring):
    chain = Chain(size=size, gap=gap, amplitude=amplitude, spring=spring)
    theory = force_balance(chain)
    assert theory.attrs["residual"] < 1e-6
    for name in theory.data_vars:
        assert np.isfinite(theory[name]).all(), name
    assert ((theory.density >= 0) & (theory.density < chain.close_packed_density)).all()
    assert theory.label[0] == pytest.approx(0, abs=1e-9)
    assert theory.label[-1] == pytest.approx(size, rel=1e-12)
    assert (np.diff(theory.label) >= -1e-9).all()
    # Averaged over labels <dx> vanishes: springs and pressure are inner forces.
    assert abs(theory.mean_displacement.mean().item()) < 1e-9 * size


def test_a_lattice_that_ends_where_the_mesh_changes_is_solved():
    """Ten thermal lengths: the plateau begins where the fine part of the mesh ends, to rounding."""
    for amplitude in (1.0, 3.0, 10.0, 30.0):
        chain = Chain(size=100, amplitude=amplitude)
        assert force_balance(chain.replace(gap=0.1 * chain.thermal_length)).residual < 1e-6


def test_a_wide_gap_has_a_plateau_of_one_rod_per_lattice_cell():
    chain = Chain(size=1000, gap=1.0, amplitude=0.3)
    theory = force_balance(chain)
    middle = np.abs(theory.x.values) < 1000
    np.testing.assert_allclose(theory.density.values[middle], 1 / 3, rtol=1e-9)
    np.testing.assert_allclose(theory.displacement.values[middle], 0, atol=1e-9)


def test_prescribing_the_closed_form_displacement_gives_the_closed_form_density():
    chain = Chain(amplitude=10)
    quantiles = np.concatenate([np.geomspace(1e-18, 0.5, 20_000)])
    x, density, displacement = closed_form(chain, quantiles)
    x = np.concatenate([x, -x[-2::-1]])
    table = CubicSpline(x, np.concatenate([displacement, -displacement[-2::-1]]))
    theory = force_balance(chain, displacement=table)
    density = CubicSpline(x, np.concatenate([density, density[-2::-1]]))
    seen = np.abs(theory.x.values) < 130
    np.testing.assert_allclose(
        theory.density.values[seen], density(theory.x.values[seen]), rtol=2e-6
    )
    assert theory.attrs["residual"] < 1e-7


@pytest.mark.parametrize("amplitude", [1.0, 100.0])
def test_the_arctanh_closure_is_a_wright_omega_function(amplitude):
    """Ln rho_y + 2R rho_y + Psi/s^2 is constant, Psi the integral of B arctanh(C x)."""
    chain = Chain(amplitude=amplitude)
    s = chain.thermal_length
    scale, steepness = 1.3 * s, 1 / (100 + 3 * s)

    def displacement(x):
        return scale * np.arctanh(steepness * np.asarray(x))

    displacement.support = (-1 / steepness, 1 / steepness)
    theory = force_balance(chain, displacement=displacement)
    inside = np.abs(theory.x.values) < 0.999 / steepness
    x, rho = theory.x.values[inside], theory.density.values[inside]
    psi = scale * (
        x * np.arctanh(steepness * x) + np.log1p(-((steepness * x) ** 2)) / (2 * steepness)
    )
    reduced = rho.max() / (1 - 2 * rho.max())
    constant = np.log(reduced) + 2 * reduced
    omega = wrightomega(constant - psi / s**2 + math.log(2)).real / 2
    # Near close packing rho does not determine the constant well: compare what it does.
    np.testing.assert_allclose(rho, omega / (1 + 2 * omega), atol=2e-6)
    assert theory.label[-1] == pytest.approx(100, rel=1e-6)
    assert (theory.density.values[~inside] <= rho.min() + 1e-3).all()


def test_a_result_or_a_table_can_be_prescribed():
    chain = Chain(amplitude=30)
    exact = equilibrium(chain)
    from_result = force_balance(chain, displacement=exact)
    table = (exact.mean_position.values, exact.mean_displacement.values)
    from_table = force_balance(chain, displacement=table)
    np.testing.assert_array_equal(from_result.density, from_table.density)
    # As good as the closure by labels, here.
    assert np.abs(from_result.density - exact.density).max() < 0.02 * chain.close_packed_density


def test_a_velocity_variance_replaces_the_temperature():
    chain = Chain(size=30, restitution=0.9, gap=0.1)
    hot = Chain(size=30, gap=0.1, amplitude=2)
    theory = force_balance(chain, velocity_variance=hot.free_velocity_width**2)
    np.testing.assert_allclose(theory.density, force_balance(hot).density, rtol=1e-12)
