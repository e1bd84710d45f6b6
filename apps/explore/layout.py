"""How the page is laid out: controls beside the pictures, above one another on a narrow screen."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import panel as pn
from bokeh.models import CustomJS

from crazybilliards.apps.explore.challenges import SENTENCE
from crazybilliards.apps.explore.controls import MORE, Controls
from crazybilliards.apps.explore.motion import Rods
from crazybilliards.apps.explore.pictures import Pictures
from crazybilliards.apps.explore.session import Session

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
_HERE = files("crazybilliards.apps.explore")
# The containers are grids. Their children lie in the container's own shadow tree.
_PAGE = """
:host {
  display: grid; grid-template-columns: 340px minmax(0, 1fr); grid-template-rows: auto auto 1fr;
  grid-template-areas: "head head" "controls stage" "controls pictures"; gap: 0 16px;
}
.head { grid-area: head; }
.stage { grid-area: stage; background: white; }
.controls { grid-area: controls; }
.pictures { grid-area: pictures; }
@media (max-width: 800px) {
  :host {
    grid-template-columns: minmax(0, 1fr); grid-template-rows: auto;
    grid-template-areas: "stage" "head" "controls" "pictures";
  }
  /* The rods stay in sight of whoever moves a slider further down. */
  .stage { position: sticky; top: 0; z-index: 2; border-bottom: 1px solid #b5b5b5; }
}
"""
_STAGE = "@media (max-width: 800px) { .legend { display: none; } }"
_CONTROLS = """
@media (min-width: 801px) { .more { display: none; } }
@media (max-width: 800px) { .folded { display: none; } }
"""
_PAIR = """
:host { display: grid; grid-template-columns: 1fr 1fr; gap: 0 16px; }
@media (max-width: 1100px) { :host { grid-template-columns: minmax(0, 1fr); } }
"""


def prepare() -> None:
    """Load Panel, and the style of all pages."""
    document, components = _read("page.css").split("/* in every component */")
    pn.extension(global_css=[document], raw_css=[components])


def draw_first(session: Session, rods: Rods) -> None:
    """Let the browser draw the rods and the first sentence while it loads the libraries."""
    if pn.state.curdoc is None:
        return
    pn.state.curdoc.template = _read("first.html")
    pn.state.curdoc.template_variables.update(
        sentence=SENTENCE, half=rods.half, rods=rods.drawn(session)
    )


def arrange(controls: Controls, pictures: Pictures) -> pn.viewable.Viewable:
    """Return the page."""
    wide = {"sizing_mode": "stretch_width", "margin": 0}
    panes = pictures.in_space
    head = pn.Column(*controls.head(), css_classes=["head"], **wide)
    stage = pn.Column(
        pictures.rods.key,
        panes["rods"],
        pictures.legend,
        panes["strip"],
        stylesheets=[_STAGE],
        css_classes=["stage"],
        **wide,
    )
    panel = pn.Column(
        *controls.panel(),
        stylesheets=[_CONTROLS],
        css_classes=["controls"],
        sizing_mode="stretch_width",
    )
    measured = pn.Column(controls.quantity, pictures.chosen_measured, **wide)
    in_time = pn.Column(controls.history, pictures.chosen_in_time, **wide)
    help_text = pn.pane.HTML(
        _read("help.html").replace("NOTEBOOKS", _links()), css_classes=["help"], **wide
    )
    below = pn.Column(
        controls.progress,
        panes["density"],
        pn.Column(measured, in_time, stylesheets=[_PAIR], **wide),
        help_text,
        css_classes=["pictures"],
        **wide,
    )
    page = pn.Column(head, stage, panel, below, stylesheets=[_PAGE], **wide)
    if pn.state.curdoc is not None:
        pn.state.curdoc.js_on_event("document_ready", _names(controls))
    return page


def _names(controls: Controls) -> CustomJS:
    """Name sliders, numbers and lists for screen readers, in page order."""
    lists = (controls.preset, controls.setting_widgets[-1], controls.quantity, controls.history)
    arguments = {
        "parameters": [widget.name for widget in controls.setting_widgets[:-1]],
        "lists": [each.name for each in lists],
        "more": MORE,
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
