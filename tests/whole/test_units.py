"""The units of length, mass and time do not matter, to any solver, theory or simulation.

A chain written in other units, by powers of two (of four for times, of which amplitudes contain
square roots), must give the same bits after rescaling. All solvers work in the chain's own scales,
so this holds for iterations and adaptive steps as well.
"""

import numpy as np
import pytest
from every_solver import SOLVERS, Given

from crazybilliards.kinetic import compressed, displaced
from crazybilliards.model import Chain


class Units:
    """Other units: a length R, mass M or time t_0 in them is that many times the former number."""

    def __init__(self, length, mass, time):
        self.length, self.mass, self.time = length, mass, time

    def of(self, unit):
        """Return the factor of a unit as results carry it, "M R^2/t_0^2" say."""
        factors = {"1": 1.0, "R": self.length, "M": self.mass, "t": self.time}
        above, _, below = unit.partition("/")
        product = 1.0
        for part, sign in ((above, 1), (below, -1)):
            for each in part.split():
                name, _, power = each.replace("_0", "").partition("^")
                product *= factors[name] ** (sign * int(power or 1))
        return product

    def chain(self, chain):
        return chain.replace(
            radius=self.length * chain.radius,
            gap=self.length * chain.gap,
            mass=self.mass * chain.mass,
            damping=self.of("M/t_0") * chain.damping,
            stiffness=self.of("M/t_0^2" if chain.spring == "linear" else "M/R t_0^2")
            * chain.stiffness,
            box=self.length * chain.box,
            amplitude=self.of("M R/t_0") / np.sqrt(self.time) * chain.amplitude,
        )

    def given(self, chain):
        """Return what the solvers are given, in these units; ``chain`` is written in them."""
        start = None  # of a box nobody makes one
        if not chain.box:
            elastic, moved = chain.replace(restitution=1.0), chain.spring == "linear"
            start = displaced(elastic, self.length) if moved else compressed(elastic, 1.5)
        return Given(
            start=start,
            variance=self.variance,
            number=0.1 * self.of("R^2/t_0^2"),
            length=self.length,
            times={"duration": 2 * self.time, "every": self.time},
            run={"duration": 200 * self.time},
            warmup=5 * self.time,
        )

    def variance(self, x):
        return self.of("R^2/t_0^2") * (0.1 + 0.05 * np.exp(-((x / self.length) ** 2)))


LINEAR = Chain(size=5, gap=0.25, amplitude=1.3, radius=0.8)
CHAINS = (LINEAR, LINEAR.replace(spring="quadratic"), LINEAR.replace(restitution=0.9))
WALLED = LINEAR.replace(box=9.5, mass_ratio=3.0)
# Each solver with each kind of chain that it takes.
CASES = {
    f"{name}, {chain.spring}, e = {chain.restitution:g}": (name, chain)
    for name, solver in SOLVERS.items()
    for chain in (each.replace(**solver.needs) for each in CHAINS)
}
CASES |= {
    f"{name}, in a box, k = {k}": (name, WALLED.replace(stiffness=k, wall_restitution=0.8))
    for name in SOLVERS
    for k in (0, 1)
    if name.startswith("simulate")
}
LONG, SHORT = Units(2.0**40, 2.0**-20, 4.0**15), Units(2.0**-30, 2.0**10, 4.0**-20)


@pytest.mark.compiled
@pytest.mark.parametrize("case", CASES)
def test_units_do_not_matter(case):
    (name, chain), scales = CASES[case], (LONG, SHORT)
    one, other = (SOLVERS[name].solve(c, u.given(c)) for u in scales for c in [u.chain(chain)])
    if name == "critical_size":
        assert one == other
        return
    assert set(one.variables) == set(other.variables)
    for variable, values in one.variables.items():
        unit = values.attrs.get("units", "1")
        found = (
            each[variable].values / u.of(unit) for each, u in zip((one, other), scales, strict=True)
        )
        np.testing.assert_array_equal(*found, variable)
