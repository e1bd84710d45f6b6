"""Settings that show what the figures of arXiv:1404.7460 show.

Chains of 1000 rods are shown at a smaller size, because they settle sooner in the time of a user.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from crazybilliards.model import Chain
from crazybilliards.reproduction.reproducible import find_studies

Quantity = Literal["widths", "velocities", "avalanches", "sizes"]


@dataclass(frozen=True)
class Preset:
    """A figure of the paper, the chain, and how to look at it.

    Attributes
    ----------
    figure
        The figure's name.
    seen
        What is seen, in a few words.
    look
        What to look for.
    chain
        The chain. See ``solved`` for the kinetic equation.
    quantity
        What is drawn beside the density.
    steady
        Whether the chain has a steady state. One without is shown from its start, with its energy.
    """

    figure: str
    seen: str
    look: str
    chain: Chain
    quantity: Quantity
    steady: bool = True

    @property
    def label(self) -> str:
        """What a user chooses: what is seen, and the number of the figure."""
        [figure] = find_studies(self.figure)
        return f"{self.seen} (figure {figure.heading.partition('.')[0]})"

    @property
    def solved(self) -> bool:
        """Whether the page solves the kinetic equation: 0.9 <= e <= 1.05, e != 1, steady."""
        restitution = self.chain.restitution
        return self.steady and 0.9 <= restitution <= 1.05 and restitution != 1


def _preset(
    figure: str,
    seen: str,
    look: str,
    quantity: Quantity = "widths",
    steady: bool = True,
    **parameters: Any,
) -> Preset:
    return Preset(figure, seen, look, Chain(**parameters), quantity, steady)


PRESETS = (
    _preset(
        "velocities-inelastic",
        "The middle rods are slower",
        "The middle rods have a narrower distribution than the outermost ones, and both are "
        "narrower than a free rod's.",
        "velocities",
        size=100,
        restitution=0.0,
    ),
    _preset(
        "widths-inelastic",
        "Collisions cool the middle",
        "Collisions cool the chain: the velocity width is largest at the ends and falls off "
        "towards the middle.",
        size=300,
        restitution=0.0,
    ),
    _preset(
        "central-width",
        "Longer chains are colder",
        "Change L: the point of every chain that you measure stays. The longer the chain, the "
        "colder its middle. In long chains the width falls a little faster than the paper's power "
        "law.",
        "sizes",
        size=30,
        restitution=0.0,
    ),
    _preset(
        "avalanches-inelastic",
        "Avalanches at e = 0",
        "The paper sees a power law, a straight line here; the simulation falls off faster: it "
        "bends down from the line.",
        "avalanches",
        size=100,
        restitution=0.0,
    ),
    _preset(
        "widths-restitution",
        "A small loss cools a lot",
        "Lower e from 0.95 and the velocity widths in the middle fall: each collision then takes "
        "more energy.",
        size=100,
        restitution=0.95,
    ),
    _preset(
        "velocities-elastic",
        "A Gaussian at e = 1",
        "Elastic collisions leave no trace in the velocities: all symbols lie on the Gaussian of "
        "a free rod.",
        "velocities",
        size=100,
    ),
    _preset(
        "velocities-flippers",
        "The ends have heavy tails",
        "Every collision adds energy: all rods are faster than a free rod, and the tail of the "
        "outermost ones is a straight line, an exponential.",
        "velocities",
        size=100,
        restitution=1.05,
        damping=4.0,
    ),
    _preset(
        "velocities-flippers-damped",
        "The middle is faster",
        "With strong damping the large velocities are likelier in the middle, where more "
        "collisions feed the rods.",
        "velocities",
        size=100,
        restitution=1.05,
        damping=10.0,
    ),
    _preset(
        "avalanches-flippers",
        "Avalanches reach the far end",
        "Compare γ = 4 with γ = 10: the weaker the damping, the more hits trigger collisions "
        "through the whole chain.",
        "avalanches",
        size=100,
        restitution=1.05,
        damping=4.0,
    ),
    _preset(
        "widths-size",
        "A short chain: hot middle",
        "In this short chain the middle is fastest; raise L to 100 and the ends are.",
        size=25,
        restitution=1.05,
        damping=4.0,
    ),
    _preset(
        "energy",
        "Energy grows exponentially",
        "The energy grows exponentially, a straight line on its logarithmic axis, until the chain "
        "has run away.",
        steady=False,
        size=100,
        restitution=1.01,
        damping=0.4,
    ),
    _preset(
        "energy",
        "Energy becomes infinite",
        "The energy curves upwards on its logarithmic axis: it becomes infinite after a finite "
        "time.",
        steady=False,
        size=100,
        restitution=1.01,
        damping=0.4,
        spring="quadratic",
    ),
    _preset(
        "density",
        "Theory meets simulation",
        "The simulation lies on the exact density, and the force balance misses it at the edges "
        "only.",
        size=100,
        amplitude=10.0,
    ),
    _preset(
        "amplitude",
        "Noise only sets the scale",
        "Change A: velocities and displacements grow like A, and the velocity widths keep their "
        "shape.",
        size=100,
        restitution=0.95,
        amplitude=3.0,
    ),
    _preset(
        "gap",
        "A gap makes a plateau",
        "With a gap the velocity widths have a plateau in the middle; the wider the gap, the wider "
        "the plateau.",
        size=300,
        restitution=0.95,
        gap=0.2,
    ),
)
