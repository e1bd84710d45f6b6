"""The measured density and the theories, all smoothed as in the paper."""

from __future__ import annotations

import numpy as np
import xarray as xr
from bokeh.models import ColumnDataSource, DataRange1d, LegendItem

from crazybilliards.apps.explore.motion import Rods
from crazybilliards.apps.explore.plots import (
    BLACK,
    LABELS,
    THEORIES,
    Array,
    Symbols,
    add_legend,
    make_plot,
    thinned,
)
from crazybilliards.model import Chain

_MOST_POINTS = 500
_MOST_OF_A_LINE = 2000


class Density:
    """The measured density and the theories."""

    def __init__(self, rods: Rods) -> None:
        self._range = rods.range
        plot = make_plot(
            "density against position, simulation and theories",
            330,
            x_range=rods.range,
            y_range=DataRange1d(start=0, only_visible=True),
            x_axis_label="position x [R]",
            y_axis_label="density ρ [1/R]",
        )
        self.measured = ColumnDataSource({"x": [], "density": []}, name="measured density")
        circles = plot.scatter(
            "x", "density", source=self.measured, size=4, color=BLACK, fill_alpha=0
        )
        self._symbols = Symbols(circles)
        # Of the rods at their anchors: it is not drawn, but gives axes to an empty picture.
        self._anchored = ColumnDataSource({"x": [], "density": []})
        plot.line("x", "density", source=self._anchored, line_alpha=0)
        self.theories: dict[str, ColumnDataSource] = {}
        self._known: dict[str, xr.Dataset] = {}
        self._drawn_range = (0.0, 0.0)
        self._items: dict[str, LegendItem] = {}
        for name, style in THEORIES.items():
            source = ColumnDataSource({"x": [], "density": []}, name=f"{name} density")
            line = plot.line("x", "density", source=source, **style)
            item = LegendItem(label=LABELS[name], renderers=[line], visible=False)
            self.theories[name], self._items[name] = source, item
        add_legend(plot, self._symbols.item, *self._items.values())
        self.plot = plot

    def begin(self, chain: Chain) -> None:
        """Remove all curves."""
        anchors = chain.anchors
        density = [1 / float(anchors[1] - anchors[0])] * 2
        self._anchored.data = {"x": [anchors[0], anchors[-1]], "density": density}
        self.measured.data = {"x": [], "density": []}
        for name, source in self.theories.items():
            source.data = {"x": [], "density": []}
            self._items[name].visible = False
        self._known.clear()

    def show(self, smoothed: xr.Dataset, settled: bool = True) -> None:
        """Show the measured density, in grey if the chain has not settled."""
        self._symbols.show(settled)
        self._anchored.data = {"x": [], "density": []}
        self.measured.data = self._seen(smoothed, _MOST_POINTS)

    def follow_zoom(self) -> None:
        """Show more of the theories' points where a user has zoomed in."""
        now = self._range.start, self._range.end
        if now != self._drawn_range:
            self._drawn_range = now
            for name, smoothed in self._known.items():
                self.theories[name].data = self._seen(smoothed, _MOST_OF_A_LINE)

    def show_theory(self, name: str, smoothed: xr.Dataset) -> None:
        """Show the density of a theory."""
        self._known[name] = smoothed
        self.theories[name].data = self._seen(smoothed, _MOST_OF_A_LINE)
        self._items[name].visible = True

    def _seen(self, smoothed: xr.Dataset, most: int) -> dict[str, Array]:
        """Return the part of a density within the picture, thinned out to ``most`` points."""
        x, density = smoothed.x.values, smoothed.density.values
        inside = np.flatnonzero((x >= self._range.start) & (x <= self._range.end))
        x, density = thinned(x[inside], density[inside], most)
        return {"x": x, "density": density}
