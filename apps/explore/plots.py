"""Common fonts, colours, legends and thinning of the pictures.

Colours are those of :mod:`crazybilliards.comparison.drawing`: the simulation black, each theory
its own colour and dash.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from bokeh.models import Legend, LegendItem
from bokeh.plotting import figure
from numpy.typing import NDArray

Array = NDArray[np.float64]

BLACK, GREY, PALE_GREY = "#000000", "#767676", "#b0b0b0"
THEORIES: Mapping[str, Mapping[str, Any]] = {
    "exact": {"color": "#E69F00", "line_width": 3},
    "balance": {"color": "#0072B2", "line_width": 2, "line_dash": "dashed"},
    "kinetic": {"color": "#D55E00", "line_width": 2.5, "line_dash": "dotdash"},
}
LABELS = {"exact": "exact", "balance": "force balance", "kinetic": "kinetic equation"}
# Pictures that stand one above the other have frames of the same width.
_LEFT, _RIGHT = 84, 16
_TYPE = "14px"
_MARGIN = 8  # of the page, on each side: page.css
# On a narrow screen a legend that is wider than the frame gets a second line: it would be cut off.
_FRAME = f"calc(100vw - {_LEFT + _RIGHT + 2 * _MARGIN}px)"
_WRAPPED = f"""
@media (max-width: 800px) {{
  .bk-grid {{ display: flex; flex-wrap: wrap; max-width: {_FRAME}; }}
}}
"""
_LOW = """
@media (max-width: 800px) {{
  :host {{ height: {0}px !important; flex: 0 0 {0}px !important; }}
}}
"""
_TOOLS = "pan,box_zoom,wheel_zoom,reset,save"


def make_plot(
    description: str, height: int, *, low: int | None = None, tools: str = _TOOLS, **settings: Any
) -> Any:
    """Return an empty picture.

    Screen readers say its description. ``low`` is its height on a narrow screen, if it has another
    one there. ``settings`` are Bokeh's.
    """
    plot = figure(
        html_attributes={"role": "img", "aria-label": description},
        tools=tools,
        height=height,
        sizing_mode="stretch_width",
        min_border_left=_LEFT,
        min_border_right=_RIGHT,
        background_fill_color=None,
        border_fill_color=None,
        outline_line_color=PALE_GREY,
        active_scroll=None,
        **settings,
    )
    if low is not None:
        plot.stylesheets = [_LOW.format(low)]
    plot.toolbar.autohide = True
    plot.toolbar.logo = None
    plot.toolbar_inner = True
    plot.title.text_font_size = _TYPE
    plot.title.text_font_style = "normal"
    plot.axis.axis_label_text_font_size = _TYPE
    plot.axis.axis_label_text_font_style = "normal"
    plot.axis.major_label_text_font_size = _TYPE
    return plot


class Symbols:
    """Symbols of the simulation, grey as long as the chain settles, and their place in a legend."""

    def __init__(self, circles: Any, label: str = "simulation") -> None:
        self._circles, self._label = circles, label
        self._colour = circles.glyph.line_color
        circles.name = "simulation"
        self.item = LegendItem(label=label, renderers=[circles])

    def show(self, settled: bool) -> None:
        """Give the symbols their own colour, or grey."""
        self._circles.glyph.line_color = self._colour if settled else GREY
        self.item.label = {"value": self._label if settled else f"{self._label}, settling"}


def add_legend(plot: Any, *items: LegendItem) -> None:
    """Put a legend above the picture."""
    legend = Legend(
        items=list(items),
        orientation="horizontal",
        ncols="auto",
        padding=0,
        margin=0,
        spacing=10,
        label_standoff=5,
        border_line_alpha=0,
        background_fill_alpha=0,
        label_text_font_size=_TYPE,
        stylesheets=[_WRAPPED],
    )
    plot.add_layout(legend, "above")


def thinned(x: Array, values: Array, most: int) -> tuple[Array, Array]:
    """Return at most ``most`` points of a curve, with the extremes of each of its intervals.

    Every n-th point of an oscillating curve would show a false, longer wave.
    """
    if x.size <= most:
        return x, values
    length = -(-2 * x.size // most)
    # The last interval is filled up with its last value, which is then found at the end itself.
    filled = np.pad(values, (0, -x.size % length), mode="edge")
    x = np.pad(x, (0, -x.size % length), mode="edge")
    stretches = filled.reshape(-1, length)
    extremes = np.stack([stretches.argmin(axis=1), stretches.argmax(axis=1)], axis=1)
    extremes.sort(axis=1)
    kept = (extremes + length * np.arange(stretches.shape[0])[:, None]).ravel()
    return x[kept], filled[kept]
