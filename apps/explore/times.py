"""Kinetic energy and collision rate in time, and an explanation of divergence."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, DataRange1d, LegendItem

from crazybilliards.apps.explore.plots import BLACK, GREY, THEORIES, Array, add_legend, make_plot
from crazybilliards.comparison.fits import fit_growth
from crazybilliards.kinetic.kinetic_equation.weak_damping import (
    weak_damping_critical_size,
    weak_damping_growth_holds,
    weak_damping_growth_rate,
)
from crazybilliards.model import Chain

_HEIGHT = 350
_MOST_TIMES = 400
_GROWN = 10.0  # times the energy of free rods: beyond, noise hardly counts


class Times:
    """Kinetic energy, and collisions per contact and time.

    The energy's axis is logarithmic for e > 1, where it may grow without end.
    """

    def __init__(self) -> None:
        self.source = ColumnDataSource(name="times")
        self.fitted = ColumnDataSource({"time": [], "energy": []}, name="growth")
        self._chain = Chain()
        self.energy = self._energy_plot("kinetic energy in time", y_range=DataRange1d(start=0))
        self.log_energy = self._energy_plot(
            "kinetic energy in time, logarithmic", y_axis_type="log"
        )
        # Dissipative rods that start in contact collide fifty times as often at first.
        self.rate = self._plot(
            "collisions per contact in time", "collisions per contact [1/T]", y_axis_type="log"
        )
        self.rate.line("time", "rate", source=self.source, color=BLACK)
        self.rate.x_range = self.log_energy.x_range = self.energy.x_range
        self.clear()

    def _energy_plot(self, description: str, **settings: Any) -> Any:
        plot = self._plot(description, "kinetic energy [M R²/T²]", **settings)
        simulation = plot.line("time", "energy", source=self.source, color=BLACK)
        free = plot.line("time", "free", source=self.source, **THEORIES["exact"])
        growth = plot.line(
            "time", "energy", source=self.fitted, color=GREY, line_width=3, line_dash="dashed"
        )
        add_legend(
            plot,
            LegendItem(label="simulation", renderers=[simulation]),
            LegendItem(label="free rods, on average", renderers=[free]),
            LegendItem(label="exponential growth", renderers=[growth]),
        )
        plot.legend.items[-1].visible = False
        return plot

    @staticmethod
    def _plot(description: str, label: str, **settings: Any) -> Any:
        return make_plot(
            description, _HEIGHT, x_axis_label="time t [T]", y_axis_label=label, **settings
        )

    def begin(self, chain: Chain) -> None:
        """Set the chain and remove the fitted growth."""
        self._chain = chain
        self._show_growth({"time": [], "energy": []})

    def clear(self) -> None:
        """Clear the curves after the clock was reset."""
        self.source.data = {"time": [], "energy": [], "free": [], "rate": []}
        self._show_growth({"time": [], "energy": []})

    def show(self, rows: Sequence[tuple[float, float, float]]) -> None:
        """Append rows of time, energy and collision rate."""
        time, energy, rate = map(list, zip(*rows, strict=True))
        free = [self._chain.size * self._chain.temperature / 2] * len(rows)
        self.source.stream(
            {"time": time, "energy": energy, "free": free, "rate": rate}, rollover=_MOST_TIMES
        )

    def explain_divergence(self, energies: Iterable[tuple[float, float]]) -> str:
        """Draw how the energy of a diverged chain grew, and return the reason in words."""
        chain = self._chain
        if chain.restitution <= 1:
            return "A rod was moved so far that the time step cannot follow it. Press Reset."
        words = (
            f"The chain runs away. Each collision at e = {chain.restitution:g} adds energy, and "
            f"the damping γ = {chain.damping:g} takes out less than that. "
        )
        found = self._growth(np.array(list(energies)).reshape(-1, 2))
        if chain.spring == "quadratic":
            words += (
                "Rods that swing further on quadratic springs swing faster and collide more often: "
                "the energy becomes infinite after a finite time. "
            )
        elif found is not None:
            words += f"The energy grew like exp({found:.2g} t). "
            words += _theory_of_growth(chain)
        return words + "Lower e or L, raise γ, or press Reset to see it again."

    def _growth(self, kept: Array) -> float | None:
        """Fit and draw exponential growth; None if there was too little of it."""
        free = self._chain.size * self._chain.temperature / 2
        late = kept[kept[:, 1] > _GROWN * free]
        if len(late) < 5:
            return None
        fit = fit_growth(late[:, 0], late[:, 1])
        ends = late[[0, -1], 0]
        self._show_growth({"time": list(ends), "energy": list(fit(ends))})
        return fit.rate

    def _show_growth(self, data: dict[str, list[float]]) -> None:
        self.fitted.data = data
        for plot in (self.energy, self.log_energy):
            plot.legend.items[-1].visible = bool(data["time"])


def _theory_of_growth(chain: Chain) -> str:
    """Return the rate of growth that theory gives, or for which chains there is one."""
    if not weak_damping_growth_holds(chain):
        return (
            "The theory of this growth is not meant for this chain: it needs weak damping, linear "
            "springs, no gap, at least 30 rods, and e close to 1. "
        )
    return (
        "Theory, for weak damping and rods much faster than noise makes them: "
        f"exp({weak_damping_growth_rate(chain):.2g} t), which is right to 5 %. "
        "To first order in e - 1 the critical size is "
        f"{weak_damping_critical_size(chain):.3g} rods. "
    )
