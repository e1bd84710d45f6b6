"""How the page is laid out: controls beside the pictures, above one another on a narrow screen."""

from __future__ import annotations

from importlib.resources import files

import panel as pn

from crazybilliards.comparison.explore.controls import Controls
from crazybilliards.comparison.explore.pictures import Pictures

_HERE = files("crazybilliards.comparison.explore")
# The containers are grids. Their children lie in the container's own shadow tree.
_PAGE = """
:host { display: grid; grid-template-columns: 340px minmax(0, 1fr); gap: 0 16px; }
@media (max-width: 800px) { :host { grid-template-columns: minmax(0, 1fr); } }
"""
_PAIR = """
:host { display: grid; grid-template-columns: 1fr 1fr; gap: 0 16px; }
@media (max-width: 1100px) { :host { grid-template-columns: minmax(0, 1fr); } }
"""


def prepare() -> None:
    """Load Panel, and the style of all pages."""
    document, components = _read("page.css").split("/* in every component */")
    pn.extension(global_css=[document], raw_css=[components])


def arrange(controls: Controls, pictures: Pictures) -> pn.viewable.Viewable:
    """Return the page."""
    wide = {"sizing_mode": "stretch_width", "margin": 0}
    panes = pictures.in_space
    in_space = pn.Column(
        pictures.rods.key,
        panes["rods"],
        pictures.legend,
        panes["strip"],
        controls.progress,
        panes["density"],
        **wide,
    )
    measured = pn.Column(controls.quantity, *pictures.measured.values(), **wide)
    in_time = pn.Column(controls.history, *pictures.in_time.values(), **wide)
    help_text = pn.pane.HTML(_read("help.html"), css_classes=["help"], **wide)
    right = pn.Column(
        in_space, pn.Column(measured, in_time, stylesheets=[_PAIR], **wide), help_text, **wide
    )
    left = pn.Column(*controls.panel(), sizing_mode="stretch_width", css_classes=["controls"])
    page = pn.Column(left, right, stylesheets=[_PAGE], **wide)
    if pn.state.curdoc is not None:
        pn.state.curdoc.js_on_event("document_ready", _named())
    return page


def _named() -> object:
    from bokeh.models import CustomJS

    return CustomJS(code=_read("page.js"))


def _read(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")
