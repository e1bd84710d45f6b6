"""The kinetic equation with pair correlations: exact at e = 1, its balances, simulations."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic import correlated_phase_space, equilibrium, phase_space
from crazybilliards.kinetic.kinetic_equation.continuation import (
    elastic_state,
    free_units,
    solved,
)
from crazybilliards.kinetic.kinetic_equation.velocity_space import Box, VelocitySpace
from crazybilliards.kinetic.kinetic_equation.weak_form import (
    Equation,
    coefficients,
    stationary_state,
)
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

CHAIN = Chain(size=30, restitution=0.9)
LABELS = np.linspace(-0.45, 0.45, 19)


@pytest.fixture(scope="module")
def theory():
    """Return the theory of a chain of 30 rods, solved once for each restitution."""
    known = {}

    def find(restitution):
        if restitution not in known:
            known[restitution] = correlated_phase_space(CHAIN.replace(restitution=restitution))
        return known[restitution]

    return find


def test_elastic_chain_is_exact(theory):
    chain = CHAIN.replace(restitution=1)
    found, exact = theory(1), equilibrium(chain)
    np.testing.assert_allclose(found.velocity_width, chain.free_velocity_width, rtol=2e-4)
    for name in ("mean_displacement", "displacement_width"):
        np.testing.assert_allclose(found[name], exact[name], atol=5e-3 * chain.thermal_length)
    np.testing.assert_array_equal(found.neighbour_covariance, 0)
    np.testing.assert_array_equal(found.contact_loss, 0)
    free = chain.free_velocity_width**2
    np.testing.assert_allclose(found.relative_temperature, free, rtol=1e-3)
    np.testing.assert_allclose(found.mode_velocity_variance, free, rtol=1e-3)


@pytest.mark.compiled
@pytest.mark.parametrize("restitution", [0.9, 0.75])
def test_energy_and_momentum_balance(restitution, theory):
    """Noise heats, damping and collisions cool; the centre of mass is as warm as if alone."""
    chain, found = CHAIN.replace(restitution=restitution), theory(restitution)
    free = chain.free_velocity_width**2
    rate = chain.damping / chain.mass
    lost = 2 * found.contact_loss.sum() / chain.mass + 2 * rate * (found.velocity_width**2).sum()
    assert float(lost / (2 * rate * free * chain.size)) == pytest.approx(1, abs=4e-3)
    assert float(found.mode_velocity_variance[0] / free) == pytest.approx(1, abs=8e-3)
    assert (found.mode_velocity_variance > 0).all()


@pytest.mark.compiled
def test_the_force_balances_the_springs(theory):
    """Between two rods there is what pulls all rods beyond them."""
    chain, found = CHAIN, theory(0.9)
    pull = chain.stiffness * found.mean_displacement.values[::-1].cumsum()[::-1][1:]
    np.testing.assert_allclose(found.contact_force, pull, rtol=0.02)


@pytest.mark.compiled
@pytest.mark.parametrize("restitution", [0.9, 0.75])
def test_simulation(restitution, theory):
    """Velocity widths within the error that the theory states; correlations in the centre."""
    chain, found = CHAIN.replace(restitution=restitution), theory(restitution)
    run = simulate(
        chain,
        duration=8_000,
        every=0.5,
        seed=3,
        observe=("widths", "snapshots"),
        threads=1,
        progress=False,
    )
    ratio = (found.velocity_width / run.velocity_width).values[2:-2] - 1
    error = (run.velocity_width_error / run.velocity_width).values[2:-2].max()
    assert np.abs(ratio).max() < found.attrs["model_error"] + 5 * error
    v = run.velocity.values[0][:, 10:20]
    blocks = v[: len(v) // 16 * 16].reshape(16, -1, v.shape[1])
    measured = (blocks[:, :, 1:] * blocks[:, :, :-1]).mean(axis=(1, 2)) / (blocks**2).mean((1, 2))
    shared, relative = found.neighbour_covariance.values, found.relative_temperature.values
    expected = (shared / (shared + relative))[10:19].mean()
    standard_error = measured.std(ddof=1) / 4
    assert abs(measured.mean() - expected) < 5 * standard_error
    assert expected > 10 * standard_error, "the simulation is long enough to see the correlation"
    wide = (found.displacement_width / run.displacement_width).values - 1
    assert np.abs(wide).max() < 0.07


@pytest.mark.compiled
def test_correlations_warm_a_long_chain():
    """What the theory is for: strangers make 100 rods at e = 0.75 nine per cent too cold."""
    chain = Chain(size=100, restitution=0.75)
    middle = slice(45, 55)
    strangers = phase_space(chain, cells=22).velocity_width[middle].mean()
    found = correlated_phase_space(chain, cells=22).velocity_width[middle].mean()
    assert float(found / strangers) == pytest.approx(1.09, abs=0.02)


def test_a_constant_factor_is_that_of_the_collisions():
    state = elastic_state(CHAIN, 2, 10)
    numbers = coefficients(CHAIN, free_units(CHAIN), 2)
    factor = PchipInterpolator(LABELS, 0 * LABELS + 0.7)
    with_factor = stationary_state(state.space, numbers, state.f, factor=factor).f
    weaker = numbers._replace(drag=0.7 * numbers.drag, diffusion=0.7 * numbers.diffusion)
    expected = stationary_state(state.space, weaker, state.f).f
    np.testing.assert_allclose(with_factor, expected, atol=1e-8 * expected.max())


@pytest.mark.parametrize("symmetric", [True, False])
def test_the_variation_knows_the_factor(symmetric):
    """Newton's method needs how the factor moves with the label: a difference quotient."""
    space = VelocitySpace(Box(4.0, 4.0, 1.0, 1.0), 6, symmetric)
    y, v = space.axes
    f = space.nodal(np.exp(-(y[:, None] ** 2 + v**2) / 2))
    f = f / (space.whole_mass @ f)
    change = space.nodal(np.exp(-((y[:, None] - 0.5) ** 2 + v**2) / 1.5)) * 0.01
    factor = PchipInterpolator(LABELS, 1 + 0.5 * np.cos(3 * LABELS))
    equation = Equation(space, coefficients(CHAIN, free_units(CHAIN), 2), factor)
    frozen = equation.matrix(equation.mean(f))
    step = 1e-5
    shifted = [equation.matrix(equation.mean(f + sign * step * change)) for sign in (1, -1)]
    expected = (shifted[0] @ f - shifted[1] @ f) / (2 * step)
    found = equation.variation(f)(change)
    np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(frozen @ f).max())


def test_a_factor_of_one_changes_nothing():
    chain = Chain(size=30, restitution=0.95)
    state = solved(elastic_state(chain, 2, 8))
    with_one = solved(
        type(state)(
            state.chain,
            state.order,
            state.space,
            state.f,
            state.residual,
            PchipInterpolator(LABELS, 1 + 0 * LABELS),
        )
    )
    np.testing.assert_allclose(with_one.f, state.f, atol=1e-9 * state.f.max())


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"restitution": 1.05}, "restitution from 0.5 to 1 only, got 1.05; phase_space"),
        ({"restitution": 0.4}, "restitution from 0.5 to 1 only, got 0.4"),
        ({"size": 9}, "size from 10 to 1000 only, got 9"),
        ({"size": 1001}, "size from 10 to 1000 only"),
        ({"damping": 0.4}, r"damping/sqrt\(k m\) from 0.24 to 1.5 only"),
        ({"damping": 4}, r"damping/sqrt\(k m\) from 0.24 to 1.5 only"),
        ({"gap": 0.1}, "without gap only"),
        ({"spring": "quadratic"}, "linear springs only"),
        ({"amplitude": 0}, "no steady state"),
    ],
)
def test_what_is_not_derived_is_refused(changes, reason):
    with pytest.raises(ValueError, match=reason):
        correlated_phase_space(CHAIN.replace(**changes))


@pytest.mark.parametrize(
    ("settings", "reason"),
    [({"tolerance": 0}, "tolerance"), ({"cells": 3}, "cells"), ({"cells": 151}, "cells")],
)
def test_wrong_settings_are_named(settings, reason):
    with pytest.raises(ValueError, match=reason):
        correlated_phase_space(CHAIN, **settings)


def test_no_agreement_is_an_error_with_a_reason(monkeypatch):
    from crazybilliards.kinetic.correlations import stationary

    monkeypatch.setattr(stationary, "_MOST_ITERATIONS", 2)
    with pytest.raises(ValueError, match=r"do not agree after 2 iterations.*phase_space and sim"):
        correlated_phase_space(CHAIN)
