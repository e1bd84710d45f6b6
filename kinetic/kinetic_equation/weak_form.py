r"""The kinetic equation of the chain for restitution near 1, in weak form.

If colliding points are relabelled, they pass through each other, and each of the two loses the
fraction lambda = (1 - e)/2 of their relative velocity. For small lambda, and if points that meet
are independent (molecular chaos), the density f(y, v, t) of L points obeys

    f_t + v f_y - (F/m) f_v = d/dv [ (gamma/m) v f + (A^2/2m^2) f_v ]            springs, noise
                            + lambda d/dv [ f int |v-u| (v-u) f(y,u) du ]          drag
                            + (lambda^2/2) d^2/dv^2 [ f int |v-u|^3 f(y,u) du ],   its diffusion

This is the Kramers-Moyal expansion of the collision operator to second order in lambda. The first
order is a drag towards the local flow for e < 1 and a drive for e > 1. For uniform granular media
such a drag is that of D. Benedetto, E. Caglioti and M. Pulvirenti (RAIRO Modél. Math. Anal. Numér.
31, 615, 1997). At e = 1 the equation is the Kramers equation. The second-order term is the shot
noise of random encounters. For e < 1 it is part of the equation, because collisions slow a point
down within a fraction of the cloud. For e > 1 it is left out, because fast points matter most. A
fast point crosses the whole cloud and so meets each of the L - 1 others exactly once.
F = F(y - g (N - L/2)) is the spring's force in mean field, where the anchor of a point is that of
its label N(y).

In units of a length l and a velocity c, and with f normalised to 1, the equation is:

    weak form, for all test functions p (no flux through the far border):

    int v f p_y - [ phi f + Gamma v f + D f_v + kappa f I1 + kappa_2 (f I3)_v ] p_v  = int f_t p,

    I1 = int |v-u| (v-u) f(y,u) du,      I3 = int |v-u|^3 f(y,u) du,
    phi = F l/m c^2,   Gamma = gamma l/m c,   D = A^2 l/2 m^2 c^3,
    kappa = lambda L,  kappa_2 = lambda^2 L/2.

Other theories may put factors before both collision terms and before the noise, which are functions
of the label. In these theories the colliding points are not independent, and a part of the motion,
with the noise that feeds it, is left out of f.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.sparse import csc_matrix
from skfem import BilinearForm
from skfem.helpers import grad

from crazybilliards.kinetic.kinetic_equation.velocity_space import VelocitySpace
from crazybilliards.model import Chain, spring
from crazybilliards.model.arrays import Array


class Units(NamedTuple):
    """Units of length [R] and velocity [R/t_0] of an equation."""

    length: float
    velocity: float


class Coefficients(NamedTuple):
    """The numbers of the equation in its units."""

    spring: float  # phi = spring * d |d|^(exponent - 2)
    exponent: int
    gap: float  # g L/l
    damping: float
    noise: float
    drag: float
    diffusion: float


def coefficients(chain: Chain, units: Units, order: int) -> Coefficients:
    """Return the equation's numbers for a chain; ``order`` 1 leaves out the shot noise."""
    length, velocity = units
    m, n = chain.mass, chain.potential_exponent
    share = (1 - chain.restitution) / 2
    return Coefficients(
        spring=chain.stiffness * length**n / (m * velocity**2),
        exponent=n,
        gap=chain.lattice_gap * chain.size / length,
        damping=chain.damping * length / (m * velocity),
        noise=chain.amplitude**2 * length / (2 * m**2 * velocity**3),
        drag=share * chain.size,
        diffusion=share**2 * chain.size / 2 if order == 2 else 0.0,
    )


@BilinearForm
def transport(f, p, w):  # type: ignore[no-untyped-def]
    """Evaluate the weak form: points move, and a flux -(drift f + spread f_v) changes their v.

    scikit-fem evaluates it for all pairs of the 9 functions of a cell, so sums are made before.
    """
    return w.x[1] * f * grad(p)[0] - (w.drift * f + w.spread * grad(f)[1]) * grad(p)[1]


class Mean(NamedTuple):
    """Fields that depend on f as a whole, tables over the quadrature points."""

    force: Array
    noise: Array
    I1: Array
    I3: Array
    I3v: Array


class Factors(NamedTuple):
    """Factors of the terms of the equation, functions of the label N/L - 1/2."""

    collisions: PchipInterpolator
    noise: PchipInterpolator


class Equation:
    """The weak form on one mesh with one set of coefficients."""

    def __init__(
        self, space: VelocitySpace, numbers: Coefficients, factors: Factors | None = None
    ) -> None:
        """Take factors other than 1 as functions of the label."""
        self.space, self.numbers, self._factors = space, numbers, factors

    def mean(self, f: Array) -> Mean:
        """Return force and collision integrals for a distribution."""
        table = self.space.table(self.space.interpolate(f)[0])
        label = self._label(table)
        force = self._force(self.space.y - self.numbers.gap * label)
        collisions, noise = self._along_label(label)
        noise = np.broadcast_to(self.numbers.noise * noise, table.shape)
        return Mean(force, noise, *self._integrals(table, collisions))

    def _integrals(self, table: Array, factor: Array) -> list[Array]:
        return [factor * (table @ kernel.T) for kernel in self.space.kernels]

    def _label(self, table: Array) -> Array:
        """Label N/L - 1/2 at each y: the share of the points between the centre and there."""
        label = self.space.cumulative(table @ self.space.v_weights)
        return label if self.space.symmetric else label - 0.5

    def _along_label(self, label: Array, derivative: int = 0) -> tuple[Array, Array]:
        """Return the factors of collisions and noise, or their derivatives, as columns."""
        if self._factors is None:
            constant = np.full((label.size, 1), 0.0 if derivative else 1.0)
            return constant, constant
        ends = self._factors.collisions.x[[0, -1]]
        within = np.clip(label, *ends)
        varies = np.where(within == label, 1.0, 0.0) if derivative else 1.0
        collisions, noise = ((varies * each(within, derivative))[:, None] for each in self._factors)
        return collisions, noise

    def _force(self, displacement: Array) -> Array:
        force = self.numbers.spring * spring.force(displacement, self.numbers.exponent)
        return np.broadcast_to(force[:, None], (force.size, self.space.v.size))

    def matrix(self, mean: Mean) -> csc_matrix:
        """Assemble the weak form with given force and integrals, on the unknowns."""
        numbers, v = self.numbers, self.space.v
        collisions = numbers.drag * mean.I1 + numbers.diffusion * mean.I3v
        drift = mean.force + numbers.damping * v + collisions
        spread = mean.noise + numbers.diffusion * mean.I3
        fields = {"drift": self.space.field(drift), "spread": self.space.field(spread)}
        whole = transport.assemble(self.space.basis, **fields)
        return (self.space.unknowns.T @ whole @ self.space.unknowns).tocsc()

    def variation(self, f: Array) -> Callable[[Array], Array]:
        """Return the function that maps a change of f to that of the weak form via the means."""
        space, numbers = self.space, self.numbers
        f_table, slope = (space.table(each) for each in space.interpolate(f))
        label = self._label(f_table)
        displacement = space.y - numbers.gap * label
        stiffness = numbers.spring * spring.stiffness(displacement, numbers.exponent)
        factor, _ = self._along_label(label)
        factor_slope, noise_slope = self._along_label(label, derivative=1)
        of_f = self._collisions(f_table, slope, self._integrals(f_table, factor_slope))
        of_f = of_f + numbers.noise * noise_slope * slope

        def change(df: Array) -> Array:
            table = space.table(space.interpolate(df)[0])
            flux = self._collisions(f_table, slope, self._integrals(table, factor))
            if numbers.gap > 0 or self._factors is not None:
                shift = space.cumulative(table @ space.v_weights)
                flux = flux - (stiffness * numbers.gap * shift)[:, None] * f_table
                flux = flux + shift[:, None] * of_f
            return -space.against_slopes(space.field(flux))

        return change

    def by_drag(self, f: Array, mean: Mean) -> Array:
        """Return the derivative of the weak form by the drag."""
        table = self.space.table(self.space.interpolate(f)[0])
        return -self.space.against_slopes(self.space.field(table * mean.I1))

    def _collisions(self, f: Array, slope: Array, integrals: list[Array]) -> Array:
        """Return the flux along v that collisions cause, drag and diffusion."""
        I1, I3, I3v = integrals
        return self.numbers.drag * f * I1 + self.numbers.diffusion * (slope * I3 + f * I3v)
