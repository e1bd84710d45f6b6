"""All pictures of a page, and which of them are shown."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import panel as pn
import xarray as xr

from crazybilliards.apps.explore.density import Density
from crazybilliards.apps.explore.motion import Rods, Strip
from crazybilliards.apps.explore.panels import Avalanches, Velocities, Widths
from crazybilliards.apps.explore.plots import LABELS
from crazybilliards.apps.explore.session import Session
from crazybilliards.apps.explore.sizes import Sizes
from crazybilliards.apps.explore.theories import Densities
from crazybilliards.apps.explore.times import Times
from crazybilliards.model import Chain


class Pictures:
    """The pictures of one page, by what they show."""

    def __init__(self, dragged: Callable[[float | None], None]) -> None:
        self.rods = Rods(dragged)
        self.strip = Strip(self.rods)
        self.density = Density(self.rods)
        self.widths, self.sizes = Widths(), Sizes()
        self.panels: dict[str, Any] = {
            "widths": self.widths,
            "velocities": Velocities(),
            "avalanches": Avalanches(),
            "sizes": self.sizes,
        }
        self.times = Times()
        self.in_space = {
            name: pn.pane.Bokeh(picture.plot, sizing_mode="stretch_width")
            for name, picture in (
                ("rods", self.rods),
                ("strip", self.strip),
                ("density", self.density),
            )
        }
        self.legend = pn.pane.HTML(
            "Where the rods were, with the present at the top. A short bar marks a collision.",
            css_classes=["progress", "legend"],
        )
        self.measured = {
            name: pn.pane.Bokeh(panel.plot, sizing_mode="stretch_width")
            for name, panel in self.panels.items()
        }
        self.in_time = {
            name: pn.pane.Bokeh(plot, sizing_mode="stretch_width")
            for name, plot in (
                ("energy", self.times.energy),
                ("log energy", self.times.log_energy),
                ("rate", self.times.rate),
            )
        }
        self.chosen_measured, self.chosen_in_time = (
            pn.Column(sizing_mode="stretch_width", margin=0) for _ in range(2)
        )

    def begin(self, session: Session) -> None:
        """Reset all pictures for a chain without measurements."""
        chain = session.chain
        self.rods.begin(chain)
        self.rods.show(session)
        self.density.begin(chain)
        for panel in self.panels.values():
            panel.begin(chain)
        self.times.begin(chain)
        if session.time == 0:
            self.times.clear()

    def arrange(self, quantity: str, history: str, chain: Chain, strip: bool | None = None) -> None:
        """Show the chosen pictures. For e > 1 the energy axis is logarithmic."""
        if history == "energy" and chain.restitution > 1:
            history = "log energy"
        # The browser does not have the other pictures. Bokeh would lay out the whole page whenever
        # a hidden picture gets new data.
        for column, pane in (
            (self.chosen_measured, self.measured[quantity]),
            (self.chosen_in_time, self.in_time[history]),
        ):
            if column.objects != [pane]:
                column.objects = [pane]
        if strip is not None:
            self.in_space["strip"].visible = self.legend.visible = strip

    def show_divergence(self, session: Session) -> str:
        """Show how the energy of a diverged chain grew; return the reason in words."""
        self.sizes.forget(session.chain)
        return self.times.explain_divergence(session.energies)

    def show_theories(self, theories: Densities) -> dict[str, str]:
        """Show theories; return how far each can be trusted, by its name."""
        notes = {}
        for name, theory in theories.items():
            self.density.show_theory(name, theory)
            if "velocity_width" in theory:
                self.widths.show_theory(theory)
            if note := _trust(theory):
                notes[LABELS[name]] = note
        return notes


def _trust(theory: xr.Dataset) -> str:
    """Return the error of a theory's model in words."""
    error = float(theory.attrs.get("model_error", math.nan))
    if error == 0:
        return ""
    quantity = "velocity widths" if "velocity_width" in theory else "the density"
    if math.isnan(error):
        return f"the error of {quantity} was not measured for such chains"
    return f"expected error of {quantity}: {100 * error:.2g} %"
