"""Pictures of velocity widths, velocity distributions and avalanche sizes."""

from __future__ import annotations

import numpy as np
import xarray as xr
from bokeh.models import ColumnDataSource, DataRange1d, LegendItem, Range1d

from crazybilliards.apps.explore.plots import (
    BLACK,
    GREY,
    LABELS,
    THEORIES,
    Array,
    Symbols,
    add_legend,
    make_plot,
)
from crazybilliards.apps.explore.session import Session
from crazybilliards.model import Chain
from crazybilliards.reproduction.distributions import gaussian

_HEIGHT = 350
_BORDER = "#0072B2"
_PAPERS_EXPONENT = -2.2  # of avalanche sizes at e = 0


class Widths:
    """Measured velocity widths, the free rod's width, and those of the kinetic equation."""

    def __init__(self) -> None:
        plot = make_plot(
            "velocity width of each rod, simulation and theories",
            _HEIGHT,
            x_range=DataRange1d(range_padding=0.02),
            y_range=DataRange1d(start=0, only_visible=True),
            x_axis_label="rod i",
            y_axis_label="velocity width Wᵥ [R/T]",
        )
        columns: dict[str, list[float]] = {"particle": [], "width": []}
        self.measured = ColumnDataSource(dict(columns), name="measured widths")
        self.free = ColumnDataSource(dict(columns), name="free width")
        self.kinetic = ColumnDataSource(dict(columns), name="kinetic widths")
        columns_of = {"x": "particle", "y": "width"}
        circles = plot.scatter(
            **columns_of, source=self.measured, size=5, color=BLACK, fill_alpha=0
        )
        free = plot.line(**columns_of, source=self.free, **THEORIES["exact"])
        kinetic = plot.line(**columns_of, source=self.kinetic, **THEORIES["kinetic"])
        self._item = LegendItem(label=LABELS["kinetic"], renderers=[kinetic], visible=False)
        self._reference = LegendItem(renderers=[free])
        self._symbols = Symbols(circles)
        add_legend(plot, self._symbols.item, self._reference, self._item)
        self.plot = plot

    def begin(self, chain: Chain) -> None:
        """Show only the width of a free rod."""
        self.measured.data = {"particle": [], "width": []}
        self.kinetic.data = {"particle": [], "width": []}
        self._item.visible = False
        self._reference.label = {"value": "exact" if chain.restitution == 1 else "free rod"}
        self.free.data = {"particle": [1, chain.size], "width": [chain.free_velocity_width] * 2}

    def show(self, session: Session, measured: xr.Dataset) -> None:
        """Show what was measured so far."""
        self._symbols.show(session.settled)
        self.measured.data = self._columns(measured)

    def show_theory(self, theory: xr.Dataset) -> None:
        """Show the widths of the kinetic equation."""
        self.kinetic.data = self._columns(theory)
        self._item.visible = True

    @staticmethod
    def _columns(result: xr.Dataset) -> dict[str, Array]:
        return {"particle": result.particle.values, "width": result.velocity_width.values}


class Velocities:
    """Velocity distributions at the border and in the middle, beside that of a free rod."""

    def __init__(self) -> None:
        plot = make_plot(
            "velocity distributions of middle and outermost rods",
            _HEIGHT,
            y_axis_type="log",
            y_range=Range1d(1e-4, 3),
            x_axis_label="velocity v/W, at the border outward positive",
            y_axis_label="probability density W p(v)",
        )
        self._chain: Chain | None = None
        self.measured = ColumnDataSource(
            {"v": [], "border": [], "middle": []}, name="velocity distribution"
        )
        self.free = ColumnDataSource({"v": [], "p": []})
        circles = plot.scatter(
            "v", "middle", source=self.measured, size=6, color=BLACK, fill_alpha=0
        )
        squares = plot.scatter(
            "v",
            "border",
            source=self.measured,
            size=6,
            marker="square",
            color=_BORDER,
            fill_alpha=0,
        )
        line = plot.line("v", "p", source=self.free, **THEORIES["exact"])
        self._symbols = Symbols(circles, "middle rods"), Symbols(squares, "outermost rods")
        add_legend(
            plot,
            *(each.item for each in self._symbols),
            LegendItem(label="free rod: a Gaussian", renderers=[line]),
        )
        self.plot = plot

    def begin(self, chain: Chain) -> None:
        """Show only the Gaussian of a free rod."""
        self._chain = chain
        self.measured.data = {"v": [], "border": [], "middle": []}
        v = np.linspace(-4.2, 4.2, 101)
        self.free.data = {"v": v, "p": gaussian(v, 1.0)}

    def show(self, session: Session, measured: xr.Dataset) -> None:
        """Show what was measured so far, in units of the free rod's width W."""
        width = session.chain.free_velocity_width
        for symbols in self._symbols:
            symbols.show(session.settled)
        found = session.sums.distributions()
        seen = (found.border > 0) | (found.middle > 0)
        # A logarithm has no place for zero.
        border, middle = (
            np.where(p > 0, p * width, np.nan)[seen] for p in (found.border, found.middle)
        )
        self.measured.data = {"v": found.v[seen] / width, "border": border, "middle": middle}


class Avalanches:
    """Sizes of avalanches: how many collisions a hit triggers, in the paper's count."""

    def __init__(self) -> None:
        plot = make_plot(
            "avalanche sizes",
            _HEIGHT,
            x_axis_type="log",
            y_axis_type="log",
            x_range=Range1d(0.8, 1000),
            y_range=Range1d(1e-6, 2),
            x_axis_label="collisions triggered N (log)",
            y_axis_label="probability p(N)",
        )
        self.measured = ColumnDataSource({"size": [], "p": []}, name="avalanche sizes")
        self.paper = ColumnDataSource({"size": [], "p": []}, name="paper's avalanches")
        circles = plot.scatter("size", "p", source=self.measured, size=6, color=BLACK, fill_alpha=0)
        line = plot.line("size", "p", source=self.paper, color=GREY, line_dash="dashed")
        self._item = LegendItem(label="the paper's power law, exponent -2.2", renderers=[line])
        add_legend(plot, LegendItem(label="simulation", renderers=[circles]), self._item)
        self.plot = plot

    def begin(self, chain: Chain) -> None:
        """Show only the paper's power law, which it states for e = 0."""
        self.measured.data = {"size": [], "p": []}
        stated = chain.restitution == 0
        size = np.array([1.0, 1000.0] if stated else [])
        self.paper.data = {"size": size, "p": 0.6 * size**_PAPERS_EXPONENT}
        self._item.visible = stated

    def show(self, session: Session, measured: xr.Dataset) -> None:
        """Show how many hits triggered how many collisions so far."""
        counts = session.avalanche_sizes()[1:]
        sizes = np.flatnonzero(counts) + 1
        if sizes.size:
            self.measured.data = {"size": sizes, "p": counts[sizes - 1] / counts.sum()}
