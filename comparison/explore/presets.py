"""Settings that show what the figures of arXiv:1404.7460 show.

Chains of the paper that are longer than the page takes are shown at its largest size.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from crazybilliards.comparison.paper.reproducible import find_studies
from crazybilliards.model import Chain


@dataclass(frozen=True)
class Preset:
    """A figure of the paper by its name, what to add to its title, and the chain."""

    figure: str
    remark: str
    chain: Chain

    @property
    def label(self) -> str:
        """What a user chooses: number and title of the figure, and the remark."""
        [figure] = find_studies(self.figure)
        return f"{figure.heading} ({self.remark})"


def _preset(figure: str, remark: str, **parameters: Any) -> Preset:
    return Preset(figure, remark, Chain(**parameters))


PRESETS = (
    _preset("widths-inelastic", "L = 300", size=300, restitution=0.0),
    _preset("central-width", "L = 30", size=30, restitution=0.0),
    _preset("widths-restitution", "e = 0.95, L = 300", size=300, restitution=0.95),
    _preset("velocities-elastic", "L = 100", size=100),
    _preset("velocities-flippers", "L = 100", size=100, restitution=1.05, damping=4.0),
    _preset("velocities-flippers-damped", "L = 100", size=100, restitution=1.05, damping=10.0),
    _preset("widths-size", "L = 25", size=25, restitution=1.05, damping=4.0),
    _preset("energy", "linear springs", size=100, restitution=1.01, damping=0.4),
    _preset("energy", "quadratic", size=100, restitution=1.01, damping=0.4, spring="quadratic"),
    _preset("density", "A = 10", size=100, amplitude=10.0),
    _preset("amplitude", "e = 0.95, A = 3, L = 300", size=300, restitution=0.95, amplitude=3.0),
    _preset("gap", "e = 0.95, g = 0.2, L = 300", size=300, restitution=0.95, gap=0.2),
)
