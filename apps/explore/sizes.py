"""The velocity width in the centre against the number of rods."""

from __future__ import annotations

import xarray as xr
from bokeh.models import ColumnDataSource, LegendItem, Range1d

from crazybilliards.apps.explore.plots import BLACK, GREY, add_legend, make_plot
from crazybilliards.apps.explore.session import Session
from crazybilliards.comparison.widths import central_width
from crazybilliards.model import Chain
from crazybilliards.particles.scales import relaxation_time

# W_v of the middle tenth [R/T] by L, the limit dt -> 0 of docs/tables/central_width.csv.
_LIMIT = {
    10: 0.17565,
    30: 0.11920,
    100: 0.07483,
    300: 0.04862,
    1000: 0.03001,
    3000: 0.019036,
    10_000: 0.01115,
}
_LIMIT_OF = Chain(size=2, restitution=0.0)
_PAPERS_EXPONENT = -0.38
_HEIGHT = 350
# A chain gets its point after so many relaxation times of measurement. Its width is then known to
# 6 to 8 % (one standard deviation of 20 runs each, of 2 to 30 rods at e = 0 and e = 1), which is
# less than the size of a symbol. At 30 T per second this takes three seconds for damping 1: longer
# than a slider stays at a value that it only passes.
_ENOUGH = 10
# The range of widths follows the points, but shows these at least. Noise of chains that are all as
# fast as a free rod would fill the picture otherwise, and Bokeh labels an axis of less than two
# decades at its upper end only.
_SHOWN_AT_LEAST = [0.02, 2.0]


class Sizes:
    """Chains that differ in their number of rods only, measured while this picture was shown.

    A chain gets a point when it has been measured for ten relaxation times. Of several
    measurements of a chain the longest is kept. A chain that runs away loses its point.

    The table of long runs and the paper's power law are shown for e = 0, damping 1, linear springs
    and no gap. Widths are divided by that of a free rod, so that those of e = 0 do not depend on
    the amplitude.
    """

    def __init__(self) -> None:
        plot = make_plot(
            "velocity width in the centre against the number of rods",
            _HEIGHT,
            x_axis_type="log",
            y_axis_type="log",
            x_range=Range1d(1.6, 16_000),
            x_axis_label="number of rods L (log)",
            y_axis_label="width in the centre / W (log)",
        )
        self._chain: Chain | None = None
        self._found: dict[int, tuple[float, float]] = {}  # duration of measurement, width
        columns: dict[str, list[float]] = {"size": [], "width": []}
        self.measured = ColumnDataSource(dict(columns), name="central widths")
        self.limit = ColumnDataSource(dict(columns), name="limit of central widths")
        self.paper = ColumnDataSource(dict(columns))
        names = {"x": "size", "y": "width"}
        plot.line([2, 2], _SHOWN_AT_LEAST, line_alpha=0)
        line = plot.line(**names, source=self.paper, color=GREY, line_dash="dashed")
        squares = plot.scatter(
            **names, source=self.limit, size=8, marker="square", color=GREY, fill_alpha=0
        )
        circles = plot.scatter(**names, source=self.measured, size=8, color=BLACK)
        self._items = [
            LegendItem(label="long runs", renderers=[squares]),
            LegendItem(label="paper: L^−0.38", renderers=[line]),
        ]
        add_legend(plot, LegendItem(label="measured here", renderers=[circles]), *self._items)
        self.plot = plot

    def begin(self, chain: Chain) -> None:
        """Keep the points of chains that differ from this one in the number of rods only."""
        kind = chain.replace(size=2)
        if kind != self._chain:
            self._chain = kind
            self._found.clear()
        self._show_points()
        known = kind.replace(amplitude=1.0) == _LIMIT_OF
        free = _LIMIT_OF.free_velocity_width
        sizes = list(_LIMIT) if known else []
        widths = [_LIMIT[size] / free for size in sizes]
        self.limit.data = {"size": sizes, "width": widths}
        law = [widths[0] * (size / sizes[0]) ** _PAPERS_EXPONENT for size in sizes]
        self.paper.data = {"size": sizes, "width": law}
        for item in self._items:
            item.visible = known

    def show(self, session: Session, measured: xr.Dataset) -> None:
        """Show the point of the session's chain, if it was measured for long enough."""
        chain, duration = session.chain, session.measured_duration
        if session.diverged or duration < _ENOUGH * relaxation_time(chain):
            return
        width = central_width(measured) / chain.free_velocity_width
        before = self._found.get(chain.size, (0.0, width))
        self._found[chain.size] = max(before, (duration, width))
        self._show_points()

    def forget(self, chain: Chain) -> None:
        """Remove the point of a chain that turned out to have no steady state."""
        self._found.pop(chain.size, None)
        self._show_points()

    def _show_points(self) -> None:
        sizes = sorted(self._found)
        widths = [self._found[size][1] for size in sizes]
        self.measured.data = {"size": sizes, "width": widths}
