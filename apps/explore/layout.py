"""How the page is laid out: controls beside the pictures, above one another on a narrow screen."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import panel as pn
from bokeh.models import CustomJS

from crazybilliards.apps.explore.controls import Controls
from crazybilliards.apps.explore.pictures import Pictures

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
_HERE = files("crazybilliards.apps.explore")
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
    measured = pn.Column(controls.quantity, pictures.chosen_measured, **wide)
    in_time = pn.Column(controls.history, pictures.chosen_in_time, **wide)
    help_text = pn.pane.HTML(
        _read("help.html").replace("NOTEBOOKS", _links()), css_classes=["help"], **wide
    )
    right = pn.Column(
        in_space, pn.Column(measured, in_time, stylesheets=[_PAIR], **wide), help_text, **wide
    )
    left = pn.Column(*controls.panel(), sizing_mode="stretch_width", css_classes=["controls"])
    page = pn.Column(left, right, stylesheets=[_PAGE], **wide)
    if pn.state.curdoc is not None:
        pn.state.curdoc.js_on_event("document_ready", _names(controls))
    return page


def _names(controls: Controls) -> CustomJS:
    """Name sliders, numbers and lists for screen readers, in page order."""
    lists = (controls.preset, controls.setting_widgets[-1], controls.quantity, controls.history)
    arguments = {
        "parameters": [widget.name for widget in controls.setting_widgets[:-1]],
        "lists": [each.name for each in lists],
    }
    return CustomJS(args=arguments, code=_read("page.js"))


def _links() -> str:
    """Return links to the notebooks, where they lie beside the package."""
    if not NOTEBOOKS.is_dir():
        return "<p>The notebooks of the repository, in its folder notebooks.</p>"
    items = (
        f"<li><a href='notebooks/{path.name}' download>{path.stem.replace('_', ' ')}</a></li>"
        for path in sorted(NOTEBOOKS.glob("*.ipynb"))
    )
    return f"<p>Notebooks, to open with JupyterLab:</p><ul>{''.join(items)}</ul>"


def _read(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")
