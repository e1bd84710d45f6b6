"""The velocity width in the centre against the number of rods."""

from __future__ import annotations

import xarray as xr
from bokeh.models import ColumnDataSource, LegendItem, Range1d

from crazybilliards.comparison.claims.repetition import central_width
from crazybilliards.comparison.explore.plots import BLACK, GREY, add_legend, make_plot
from crazybilliards.comparison.explore.session import Session
from crazybilliards.model import Chain

# W_v of the middle tenth [R/T] by L, the limit dt -> 0 of docs/central_width.md.
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


class Sizes:
    """Chains that were measured one after the other, which differ in their number of rods only.

    Widths are divided by that of a free rod, so that those of e = 0 do not depend on the amplitude.
    """

    def __init__(self) -> None:
        plot = make_plot(
            _HEIGHT,
            x_axis_type="log",
            y_axis_type="log",
            x_range=Range1d(1.6, 16_000),
            y_range=Range1d(0.02, 5),
            x_axis_label="number of rods L (log)",
            y_axis_label="width in the centre / W (log)",
        )
        self._chain: Chain | None = None
        self._found: dict[int, float] = {}
        columns: dict[str, list[float]] = {"size": [], "width": []}
        self.measured = ColumnDataSource(dict(columns), name="central widths")
        self.limit = ColumnDataSource(dict(columns), name="limit of central widths")
        self.paper = ColumnDataSource(dict(columns))
        names = {"x": "size", "y": "width"}
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
        """Show the point of the session's chain."""
        chain = session.chain
        self._found[chain.size] = central_width(measured) / chain.free_velocity_width
        self._show_points()

    def _show_points(self) -> None:
        sizes = sorted(self._found)
        self.measured.data = {"size": sizes, "width": [self._found[size] for size in sizes]}
