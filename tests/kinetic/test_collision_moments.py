"""What a collision does to moments: each number against the integral that it stands for."""

import numpy as np
import pytest
from scipy.integrate import dblquad

from crazybilliards.kinetic.gas.collision_moments import decay_of_two_masses, moments_of_collisions


def average(function):
    """Return <|v - u| function(v, u)> over two Gaussians, by quadrature."""

    def weighted(v, u):
        return abs(v - u) * function(v, u) * np.exp(-(v**2 + u**2) / 2) / (2 * np.pi)

    below = dblquad(weighted, -9, 9, -9, lambda v: v, epsabs=1e-9)[0]
    return below + dblquad(weighted, -9, 9, lambda v: v, 9, epsabs=1e-9)[0]


def third(v):
    return v**3 - 3 * v


@pytest.mark.parametrize("restitution", [0.5, 1.2])
def test_collision_moments_are_the_integrals(restitution):
    """The energy is what both lose; the others are covariances that a collision makes."""
    found, share = moments_of_collisions(restitution), (1 - restitution) / 2

    def after(v, u):
        return v - share * (v - u), u + share * (v - u)

    def lost(v, u):
        return (v**2 + u**2 - sum(each**2 for each in after(v, u))) / 2

    def decayed(v, u):
        return -(third(after(v, u)[0]) - third(v)) * (third(v) + third(u)) / 6

    def made(psi, phi):
        def change(v, u):
            one, other = after(v, u)
            return psi(one) * phi(other) - psi(v) * phi(u)

        return change

    for name, function in (
        ("energy", lost),  # mutation: E(e) of e^2
        ("temperature", made(lambda v: v**2 - 1, lambda v: v**2 - 1)),
        ("velocity_heat", made(lambda v: v, third)),
        ("heat", made(third, third)),
        ("decay", decayed),
    ):
        assert getattr(found, name) == pytest.approx(average(function), abs=1e-7), name
    assert found.energy == pytest.approx(average(made(lambda v: v, lambda v: v)), abs=1e-7)
    assert set(moments_of_collisions(1.0)) == {0.0}


def test_collisions_of_two_masses_damp_the_heat_flux_and_those_of_one_do_not():
    """Against velocities drawn at random, with the momenta and energies before and after."""
    assert decay_of_two_masses(1.0) == pytest.approx(0, abs=1e-12)
    assert decay_of_two_masses(3.0) == pytest.approx(decay_of_two_masses(1 / 3), rel=1e-12)
    scales = np.sqrt([[0.5], [1.5]])
    before = np.random.default_rng(1).normal(size=(2, 250_000)) / scales
    after = (scales**2 * before).sum(axis=0) - before
    old, new = (third(scales * each).sum(axis=0) for each in (before, after))
    drawn = -np.abs(before[0] - before[1]) * (new - old) * old / 12
    error = drawn.std() / 500
    assert decay_of_two_masses(3.0) == pytest.approx(drawn.mean(), abs=5 * error)
    assert error < 0.06
