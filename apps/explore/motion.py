"""The present rods, and a strip with their past positions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import Pan, PanEnd, PanStart
from bokeh.models import ColumnDataSource, LinearColorMapper, Range1d, Span
from numpy.typing import NDArray

from crazybilliards.apps.explore.plots import BLACK, GREY, PALE_GREY, make_plot
from crazybilliards.apps.explore.session import Session
from crazybilliards.model import Chain
from crazybilliards.particles.scales import centre_width

# Moving left, at rest, moving right: as on the page without installation, docs/chain.
COLOURS = (0, 114, 178), (225, 225, 225), (230, 120, 0)
_SHADES = 254
_EMPTY, _MET = 0, 255  # of the strip's 256 colours: between rods, and where two of them met
_COLUMNS, ROWS = 720, 150
_MARK = 2  # columns to either side of a collision


def _palette() -> list[str]:
    """Blue for rods moving left, grey at rest, orange for rods moving right."""
    anchors = np.array(COLOURS, dtype=float)
    shades = np.linspace(-1, 1, _SHADES)
    rgb = [np.interp(shades, (-1, 0, 1), anchors[:, channel]) for channel in range(3)]
    return ["#{:02x}{:02x}{:02x}".format(*map(round, colour)) for colour in zip(*rgb, strict=True)]


class Rods:
    """The rods coloured by velocity, with ticks at their anchors.

    Parameters
    ----------
    dragged
        Called with x [R] where the mouse takes hold and where it moves to, and with None when it
        lets go.
    """

    def __init__(self, dragged: Callable[[float | None], None]) -> None:
        self.range = Range1d(-1, 1)
        self.half = 1.0  # of the range when it is not zoomed [R]
        self.source = ColumnDataSource({"x": [], "v": []}, name="rods")
        self._anchors = ColumnDataSource({"x": []})
        self._colours = LinearColorMapper(palette=_palette(), low=-1, high=1)
        plot = make_plot(
            "rods where they are, coloured by velocity",
            150,
            low=84,
            tools="",
            x_range=self.range,
            y_range=Range1d(-1.2, 0.8),
        )
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
        plot.segment("x", -1.15, "x", -0.8, source=self._anchors, color=GREY, line_width=1.5)
        # Bokeh draws the outline together with what it drew last: the last anchor of a former axis,
        # if nothing comes after the anchors.
        plot.add_layout(Span(location=-1.2, dimension="width", line_color=PALE_GREY))
        plot.yaxis.visible = False
        plot.grid.visible = False
        plot.xaxis.visible = False
        for event in (PanStart, Pan):
            plot.on_event(event, lambda event: dragged(event.x))
        plot.on_event(PanEnd, lambda event: dragged(None))
        self.plot = plot
        self.key = pn.pane.HTML(sizing_mode="stretch_width", margin=(5, 16, 0, 84))

    @property
    def fastest(self) -> float:
        """Velocity of the last of the colours [R/T]."""
        return float(self._colours.high)

    def begin(self, chain: Chain) -> None:
        """Set axes and colours for a chain."""
        self.half = float(chain.anchors[-1]) + 5 * chain.radius + 4 * chain.thermal_length
        self.range.update(start=-self.half, end=self.half)
        fast = 2.5 * chain.free_velocity_width * centre_width(chain)
        self._colours.update(low=-fast, high=fast)
        self.key.object = (
            f"<div class='key'><span>−{fast:.2g} R/T</span><span>velocity v</span>"
            f"<span>{fast:.2g} R/T</span></div>"
        )
        self._anchors.data = {"x": chain.anchors}

    def show(self, session: Session) -> None:
        """Move the rods; widen the axis first if they would leave it."""
        x = session.positions
        reach = float(np.abs(x[[0, -1]]).max()) + session.chain.radius
        if reach > self.range.end and self.range.start == -self.range.end:
            self.half = 1.3 * reach
            self.range.update(start=-self.half, end=self.half)
        self.source.data = {"x": x, "v": session.v.copy()}

    def drawn(self, session: Session) -> list[tuple[float, float, str]]:
        """Return place, anchor and colour of each rod, for a drawing without Bokeh."""
        palette = self._colours.palette
        shades = np.clip(0.5 + 0.5 * session.v / self.fastest, 0, 1) * (len(palette) - 1)
        colours = [palette[round(shade)] for shade in shades]
        places = session.positions.tolist(), session.chain.anchors.tolist()
        return list(zip(*places, colours, strict=True))


class Strip:
    """Space and time: one row per moment, newest on top. A bar marks a collision."""

    def __init__(self, rods: Rods) -> None:
        self._rods = rods
        self._half, self._row_time = 1.0, 1.0
        self._image = np.zeros((ROWS, _COLUMNS), dtype=np.uint8)
        self._met_before: set[int] = set()
        self.source = ColumnDataSource(name="strip")
        self._ages = Range1d(1, 0)
        plot = make_plot(
            "space and time: where the rods were, and where they met",
            260,
            low=132,
            tools="save",
            x_range=rods.range,
            y_range=self._ages,
        )
        palette = ["#ffffff", *_palette(), BLACK]
        plot.image(
            "image",
            "x",
            "y",
            "width",
            "height",
            source=self.source,
            color_mapper=LinearColorMapper(palette=palette, low=-0.5, high=255.5),
        )
        plot.yaxis.axis_label = "ago [T]"
        plot.xaxis.visible = False
        plot.grid.visible = False
        self.plot: Any = plot
        self.clear(1.0)

    def clear(self, row_time: float) -> None:
        """Clear the strip and set the time between rows [T]."""
        self._row_time = row_time
        self._half = self._rods.half
        self._image[:] = _EMPTY
        self._met_before = set()
        self._ages.update(start=ROWS * row_time, end=0)
        self.show()

    def add(self, session: Session, met: list[int]) -> None:
        """Add a row on top: the rods where they are, and the contacts where they met."""
        if self._rods.half > 1.01 * self._half:
            self.clear(self._row_time)
        self._image[1:] = self._image[:-1]
        self._image[0] = self._row(session, set(met))

    def show(self) -> None:
        """Draw what was added."""
        self.source.data = {
            "image": [self._image.copy()],
            "x": [-self._half],
            "y": [0.0],
            "width": [2 * self._half],
            "height": [ROWS * self._row_time],
        }

    def _row(self, session: Session, met: set[int]) -> NDArray[np.uint8]:
        x = session.positions
        radius = session.chain.radius
        width = 2 * self._half / _COLUMNS
        centres = -self._half + width * (np.arange(_COLUMNS) + 0.5)
        nearest = np.searchsorted(x[:-1] + np.diff(x) / 2, centres)
        shades = np.clip(0.5 + 0.5 * session.v / self._rods.fastest, 0, 1) * (_SHADES - 1) + 1
        row = shades.astype(np.uint8)[nearest]
        row[np.abs(centres - x[nearest]) > radius] = _EMPTY
        # Rods that stay in contact meet in every row: only the first one is marked.
        for contact in met - self._met_before:
            middle = int(((x[contact] + x[contact + 1]) / 2 + self._half) / width)
            row[max(middle - _MARK, 0) : max(middle + _MARK, 0)] = _MET
        self._met_before = met
        return row
