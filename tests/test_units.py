"""The units of length, mass and time do not matter, to any solver, theory or simulation.

A chain written in other units, by powers of two (of four for times, of which amplitudes contain
square roots), must give the same bits after rescaling. All solvers work in the chain's own scales,
so this holds for iterations and adaptive steps as well.
"""

import numpy as np
import pytest

from crazybilliards.kinetic import (
    breathing_cloud,
    compressed,
    correlated_phase_space,
    critical_damping,
    critical_restitution,
    critical_size,
    displaced,
    equilibrium,
    equilibrium_states,
    force_balance,
    hydrodynamics,
    phase_space,
    relax_phase_space,
    two_clumps,
)
from crazybilliards.kinetic.kinetic_equation import criticality
from crazybilliards.model import Chain
from crazybilliards.particles import simulate


class Units:
    """Other units: a length R, mass M or time T in them is that many times the former number."""

    def __init__(self, length, mass, time):
        self.length, self.mass, self.time = length, mass, time

    def of(self, unit):
        """Return the factor of a unit as results carry it, "M R^2/T^2" say."""
        factors = {"1": 1.0, "R": self.length, "M": self.mass, "T": self.time}
        above, _, below = unit.partition("/")
        product = 1.0
        for part, sign in ((above, 1), (below, -1)):
            for each in part.split():
                name, _, power = each.partition("^")
                product *= factors[name] ** (sign * int(power or 1))
        return product

    def chain(self, chain):
        return chain.replace(
            radius=self.length * chain.radius,
            gap=self.length * chain.gap,
            mass=self.mass * chain.mass,
            damping=self.of("M/T") * chain.damping,
            stiffness=self.of("M/T^2" if chain.spring == "linear" else "M/R T^2") * chain.stiffness,
            amplitude=self.of("M R/T") / np.sqrt(self.time) * chain.amplitude,
        )


LINEAR = Chain(size=5, gap=0.25, amplitude=1.3, radius=0.8)
QUADRATIC = LINEAR.replace(spring="quadratic")
DISSIPATIVE = LINEAR.replace(restitution=0.9)
GAPLESS = LINEAR.replace(gap=0.0)
DRIVEN = Chain(size=5, restitution=1.1)
QUIET = {"progress": False}


def flow(start, **settings):
    def solve(chain, units):
        begin = start(chain, units)
        return hydrodynamics(chain, begin, 2 * units.time, every=units.time, **settings, **QUIET)

    return solve


def moved(chain, units):
    return displaced(chain, units.length)


def wide(chain, units):
    return compressed(chain, 1.5)


def clumps(chain, units):
    return two_clumps(chain, units.length, units.of("R/T"))


def variance(units):
    return lambda x: units.of("R^2/T^2") * (0.1 + 0.05 * np.exp(-((x / units.length) ** 2)))


def soft(units):
    return lambda x: 0.3 * np.asarray(x)


def particles(**settings):
    def solve(chain, units):
        return simulate(
            chain,
            duration=200 * units.time,
            warmup=5 * units.time,
            observe=("widths", "density", "energy", "velocities"),
            **settings,
            **QUIET,
        )

    return solve


# name: (chain, solver of a chain in some units)
SOLVERS = {
    "equilibrium": (LINEAR, lambda chain, _: equilibrium(chain)),
    "equilibrium, quadratic": (QUADRATIC, lambda chain, _: equilibrium(chain)),
    "equilibrium_states": (LINEAR, lambda chain, _: equilibrium_states(chain, 3)),
    "displaced": (LINEAR, moved),
    "compressed": (QUADRATIC, wide),
    "two_clumps": (LINEAR, clumps),
    "force_balance": (LINEAR, lambda chain, _: force_balance(chain)),
    "force_balance, quadratic": (QUADRATIC, lambda chain, _: force_balance(chain)),
    "force_balance, variance": (
        LINEAR,
        lambda chain, units: force_balance(chain, velocity_variance=variance(units)),
    ),
    "force_balance, displacement": (
        LINEAR,
        lambda chain, units: force_balance(chain, soft(units)),
    ),
    "force_balance, both": (
        LINEAR,
        lambda chain, units: force_balance(chain, soft(units), variance(units)),
    ),
    "label": (LINEAR, flow(moved)),
    "label, evolving": (QUADRATIC, flow(wide, velocity_variance="evolving")),
    "eulerian": (LINEAR, flow(moved, frame="eulerian")),
    "eulerian, evolving": (QUADRATIC, flow(wide, frame="eulerian", velocity_variance="evolving")),
    "breathing_cloud": (
        GAPLESS,
        lambda chain, units: breathing_cloud(chain, 2 * units.time, stretch=0.5),
    ),
    "phase_space": (DISSIPATIVE, lambda chain, _: phase_space(chain, cells=8)),
    "correlated_phase_space": (
        GAPLESS.replace(size=10, restitution=0.9),
        lambda chain, _: correlated_phase_space(chain, cells=8),
    ),
    "relax_phase_space": (
        DISSIPATIVE,
        lambda chain, units: relax_phase_space(
            chain, moved(chain.replace(restitution=1), units), units.time, cells=8, **QUIET
        ),
    ),
    "simulate": (LINEAR, particles()),
    "simulate, quadratic": (QUADRATIC, particles()),
    "simulate, dissipative": (DISSIPATIVE, particles()),
    "simulate, contact dynamics": (DISSIPATIVE, particles(method="contact-dynamics")),
    "simulate, euler": (LINEAR, particles(stepper="euler", time_step=None)),
}
OTHER = {
    "long": Units(2.0**40, 2.0**-20, 4.0**15),
    "short": Units(2.0**-30, 2.0**10, 4.0**-20),
}


@pytest.fixture(scope="module")
def reference():
    known = {}

    def solved(name):
        if name not in known:
            chain, solve = SOLVERS[name]
            known[name] = solve(chain, Units(1.0, 1.0, 1.0))
        return known[name]

    return solved


@pytest.mark.compiled
@pytest.mark.parametrize("scale", OTHER)
@pytest.mark.parametrize("name", SOLVERS)
def test_units_do_not_matter(name, scale, reference):
    units, (chain, solve) = OTHER[scale], SOLVERS[name]
    one, other = reference(name), solve(units.chain(chain), units)
    assert set(one.variables) == set(other.variables)
    for variable, expected in one.variables.items():
        found = other[variable].values / units.of(expected.attrs.get("units", "1"))
        np.testing.assert_array_equal(found, expected.values, variable)


@pytest.mark.parametrize("scale", OTHER)
def test_units_do_not_matter_to_critical_chains(scale, monkeypatch):
    monkeypatch.setattr(criticality, "_critical_drag", lambda damping: (damping, 0.0))
    units = OTHER[scale]
    for solve, unit in (
        (critical_size, "1"),
        (critical_restitution, "1"),
        (critical_damping, "M/T"),
    ):
        assert solve(units.chain(DRIVEN)).value / units.of(unit) == solve(DRIVEN).value
