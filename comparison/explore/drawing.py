"""The pictures of the page, in Bokeh: rods, density, velocity widths, energy and collisions.

Colours are those of :mod:`crazybilliards.comparison.drawing`: the simulation black, each theory
its own colour and dash.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from bokeh.models import (
    ColorBar,
    ColumnDataSource,
    DataRange1d,
    Legend,
    LegendItem,
    LinearColorMapper,
    Range1d,
)
from bokeh.plotting import figure
from numpy.typing import NDArray

from crazybilliards.comparison.explore.session import Session
from crazybilliards.model import Chain
from crazybilliards.particles.scales import centre_width

Array = NDArray[np.float64]

_BLACK, _GREY = "#000000", "#777777"
_STYLES: Mapping[str, Mapping[str, Any]] = {
    "exact": {"color": "#E69F00", "line_width": 3},
    "balance": {"color": "#0072B2", "line_width": 2, "line_dash": "dashed"},
    "kinetic": {"color": "#D55E00", "line_width": 2.5, "line_dash": "dotdash"},
}
_LABELS = {
    "exact": "exact equilibrium",
    "balance": "force balance",
    "kinetic": "kinetic equation",
}
_BLUE, _PALE, _ORANGE = (0, 114, 178), (240, 240, 240), (213, 94, 0)  # Okabe and Ito's
_MOST_POINTS = 250
_MOST_TIMES = 400
_TOOLS = "pan,box_zoom,wheel_zoom,reset,save"


def _palette() -> list[str]:
    """Blue for rods moving left, nearly white at rest, orange for rods moving right."""
    anchors = np.array([_BLUE, _PALE, _ORANGE], dtype=float)
    shades = np.linspace(-1, 1, 63)
    rgb = [np.interp(shades, (-1, 0, 1), anchors[:, channel]) for channel in range(3)]
    return ["#{:02x}{:02x}{:02x}".format(*map(round, colour)) for colour in zip(*rgb, strict=True)]


def _plot(height: int, **settings: Any) -> Any:
    plot = figure(
        tools=_TOOLS,
        toolbar_location="right",
        height=height,
        sizing_mode="stretch_width",
        min_border_right=12,
        **settings,
    )
    plot.toolbar.autohide = True
    plot.toolbar.logo = None
    return plot


def _legend(plot: Any, *items: LegendItem) -> None:
    legend = Legend(
        items=list(items),
        orientation="horizontal",
        padding=0,
        margin=0,
        spacing=14,
        label_standoff=5,
        border_line_alpha=0,
        label_text_font_size="12px",
    )
    plot.add_layout(legend, "above")


class Rods:
    """The rods where they are, coloured by velocity, their anchors as ticks underneath."""

    def __init__(self) -> None:
        self.range = Range1d(-1, 1)
        self.source = ColumnDataSource({"x": [], "v": []}, name="rods")
        self._anchors = ColumnDataSource({"x": []})
        self._colours = LinearColorMapper(palette=_palette(), low=-1, high=1)
        plot = _plot(170, x_range=self.range, y_range=Range1d(-1.2, 0.8))
        plot.rect(
            "x",
            0,
            2,
            1.1,
            source=self.source,
            fill_color={"field": "v", "transform": self._colours},
            line_color="#404040",
            line_width=0.5,
        )
        plot.segment("x", -1.15, "x", -0.8, source=self._anchors, color=_GREY)
        plot.yaxis.visible = False
        plot.ygrid.visible = False
        plot.xaxis.axis_label = "position x [R]; ticks below the rods: anchors"
        plot.add_layout(ColorBar(color_mapper=self._colours, title="v [R/T]", width=12), "right")
        self.plot = plot

    def begin(self, chain: Chain) -> None:
        """Fit axes and colours to a chain."""
        half = float(chain.anchors[-1]) + 5 * chain.radius + 4 * chain.thermal_length
        self.range.update(start=-half, end=half)
        fast = 2.5 * chain.free_velocity_width * centre_width(chain)
        self._colours.update(low=-fast, high=fast)
        self._anchors.data = {"x": chain.anchors}

    def show(self, session: Session) -> None:
        """Move the rods; make room where they need more than there is."""
        x = session.positions
        self.source.data = {"x": x, "v": session.v.copy()}
        reach = float(np.abs(x[[0, -1]]).max()) + session.chain.radius
        if reach > self.range.end:
            self.range.update(start=-1.3 * reach, end=1.3 * reach)


class Density:
    """The density building up over the theories, all smoothed as in the paper."""

    def __init__(self, rods: Rods) -> None:
        self._range = rods.range
        plot = _plot(
            420,
            x_range=rods.range,
            y_range=DataRange1d(start=0, only_visible=True),
            x_axis_label="position x [R]",
            y_axis_label="density [1/R]",
        )
        self.measured = ColumnDataSource({"x": [], "density": []}, name="measured density")
        circles = plot.scatter(
            "x", "density", source=self.measured, size=4, color=_BLACK, fill_alpha=0
        )
        items = [LegendItem(label="simulation", renderers=[circles])]
        self.theories: dict[str, ColumnDataSource] = {}
        self._items: dict[str, LegendItem] = {}
        for name, style in _STYLES.items():
            source = ColumnDataSource({"x": [], "density": []}, name=f"{name} density")
            line = plot.line("x", "density", source=source, **style)
            item = LegendItem(label=_LABELS[name], renderers=[line], visible=False)
            self.theories[name], self._items[name] = source, item
        _legend(plot, *items, *self._items.values())
        self.plot = plot

    def clear(self) -> None:
        """Show nothing: the chain is another one."""
        self.measured.data = {"x": [], "density": []}
        for name, source in self.theories.items():
            source.data = {"x": [], "density": []}
            self._items[name].visible = False

    def show(self, smoothed: xr.Dataset) -> None:
        """Show what was measured so far."""
        self.measured.data = self._seen(smoothed, _MOST_POINTS)

    def show_theory(self, name: str, smoothed: xr.Dataset) -> None:
        """Show the density of a theory."""
        self.theories[name].data = self._seen(smoothed, 8 * _MOST_POINTS)
        self._items[name].visible = True

    def _seen(self, smoothed: xr.Dataset, most: int) -> dict[str, Array]:
        """Return the part of a density within the picture, thinned out to ``most`` points."""
        x, density = smoothed.x.values, smoothed.density.values
        inside = np.flatnonzero((x >= self._range.start) & (x <= self._range.end))
        inside = inside[:: -(-inside.size // most)]
        return {"x": x[inside], "density": density[inside]}


class Widths:
    """The velocity widths building up, the free rod's width, and those of the kinetic equation."""

    def __init__(self) -> None:
        plot = _plot(
            420,
            x_range=DataRange1d(range_padding=0.02),
            y_range=DataRange1d(start=0, only_visible=True),
            x_axis_label="particle i",
            y_axis_label="velocity width W_v [R/T]",
        )
        columns: dict[str, list[float]] = {"particle": [], "width": []}
        self.measured = ColumnDataSource(dict(columns), name="measured widths")
        self.free = ColumnDataSource(dict(columns), name="free width")
        self.kinetic = ColumnDataSource(dict(columns), name="kinetic widths")
        columns_of = {"x": "particle", "y": "width"}
        circles = plot.scatter(
            **columns_of, source=self.measured, size=5, color=_BLACK, fill_alpha=0
        )
        free = plot.line(**columns_of, source=self.free, **_STYLES["exact"])
        kinetic = plot.line(**columns_of, source=self.kinetic, **_STYLES["kinetic"])
        self._item = LegendItem(label=_LABELS["kinetic"], renderers=[kinetic], visible=False)
        self._reference = LegendItem(renderers=[free])
        simulation = LegendItem(label="simulation", renderers=[circles])
        _legend(plot, simulation, self._reference, self._item)
        self.plot = plot

    def begin(self, chain: Chain) -> None:
        """Show only the width of a free rod."""
        self.measured.data = {"particle": [], "width": []}
        self.kinetic.data = {"particle": [], "width": []}
        self._item.visible = False
        self._reference.label = {"value": "exact" if chain.restitution == 1 else "free rod"}
        self.free.data = {"particle": [1, chain.size], "width": [chain.free_velocity_width] * 2}

    def show(self, measured: xr.Dataset) -> None:
        """Show what was measured so far."""
        self.measured.data = self._columns(measured)

    def show_theory(self, theory: xr.Dataset) -> None:
        """Show the widths of the kinetic equation."""
        self.kinetic.data = self._columns(theory)
        self._item.visible = True

    @staticmethod
    def _columns(result: xr.Dataset) -> dict[str, Array]:
        return {"particle": result.particle.values, "width": result.velocity_width.values}


class Times:
    """Kinetic energy and collisions per contact and time, as they go."""

    def __init__(self) -> None:
        self.source = ColumnDataSource(name="times")
        self._free = 0.0
        self.clear()
        self.energy = self._plot("kinetic energy [M R²/T²]", y_range=DataRange1d(start=0))
        simulation = self.energy.line("time", "energy", source=self.source, color=_BLACK)
        free = self.energy.line("time", "free", source=self.source, **_STYLES["exact"])
        _legend(
            self.energy,
            LegendItem(label="simulation", renderers=[simulation]),
            LegendItem(label="free rods, on average", renderers=[free]),
        )
        # Dissipative rods that start in contact collide fifty times as often at first.
        self.rate = self._plot("collisions per contact [1/T]", y_axis_type="log")
        self.rate.line("time", "rate", source=self.source, color=_BLACK)
        self.rate.x_range = self.energy.x_range

    @staticmethod
    def _plot(label: str, **settings: Any) -> Any:
        return _plot(290, x_axis_label="time t [T]", y_axis_label=label, **settings)

    def begin(self, chain: Chain) -> None:
        """Know the mean energy of free rods, L T/2."""
        self._free = chain.size * chain.temperature / 2

    def clear(self) -> None:
        """Forget the past: the clock was set back."""
        self.source.data = {"time": [], "energy": [], "free": [], "rate": []}

    def show(self, rows: Sequence[tuple[float, float, float]]) -> None:
        """Go on by some times, each with its energy and rate of collisions."""
        time, energy, rate = map(list, zip(*rows, strict=True))
        free = [self._free] * len(rows)
        self.source.stream(
            {"time": time, "energy": energy, "free": free, "rate": rate}, rollover=_MOST_TIMES
        )
