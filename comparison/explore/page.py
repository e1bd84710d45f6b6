"""The page: the widgets, the pictures, and the clock that moves the chain.

Every frame advances the session by the time that passed, at the speed chosen, within a budget of
computing so that the page stays responsive; every few frames what was measured is drawn anew.
"""

from __future__ import annotations

from concurrent.futures import Executor
from time import perf_counter
from typing import Any

import panel as pn

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.explore.drawing import Density, Rods, Times, Widths
from crazybilliards.comparison.explore.presets import PRESETS
from crazybilliards.comparison.explore.session import Session
from crazybilliards.comparison.explore.setting import Setting
from crazybilliards.comparison.explore.theories import (
    Background,
    Densities,
    elastic_densities,
    kinetic_density,
)
from crazybilliards.model import Chain

_PERIOD = 33  # ms from frame to frame
_BUDGET = 0.012  # s of computing in a frame
_LONGEST = 0.1  # s that a frame makes up for; a page that slept does not catch up
_FRAMES_PER_DRAWING = 8
_NO_PRESET = "(choose)"
_CHAINS = {preset.label: preset.chain for preset in PRESETS}
_SPEEDS = (3, 10, 30, 100, 300)  # T per second


class Page:
    """One page in one browser: its own chain, setting and clock.

    ``threads`` compute what takes a moment, ``processes`` what takes seconds: a thread that
    computes for long would slow the chain down.
    """

    def __init__(self, threads: Executor, processes: Executor) -> None:
        self.setting = Setting()
        self.session = Session(self.setting.chain())
        self.rods = Rods()
        self.density, self.widths, self.times = Density(self.rods), Widths(), Times()
        self._rows: list[tuple[float, float, float]] = []
        self._frames, self._last, self._drawn = 0, perf_counter(), (perf_counter(), 0.0)
        self._make_widgets()
        post = pn.state.curdoc.add_next_tick_callback
        self._elastic = Background(threads, elastic_densities, self._show_theories, post)
        self._kinetic = Background(processes, kinetic_density, self._show_theories, post)
        self.setting.param.watch(self._changed, self.setting.parameters())
        self._begin()
        if pn.state.location is not None:
            names = self.setting.parameters()
            pn.state.location.sync(self.setting, names, on_error=self._refuse_address)
        pn.state.add_periodic_callback(self._frame, period=_PERIOD)

    def _make_widgets(self) -> None:
        self.preset = pn.widgets.Select(
            name="figure of the paper",
            options=[_NO_PRESET, *_CHAINS],
        )
        self.preset.param.watch(self._take_preset, "value")
        self.play = pn.widgets.Toggle(name="Pause", value=True, button_type="primary")
        self.play.param.watch(self._name_toggle, "value")
        self.reset = pn.widgets.Button(name="Reset")
        self.reset.on_click(self._restart)
        self.speed = pn.widgets.RadioButtonGroup(
            name="speed", options={str(speed): speed for speed in _SPEEDS}, value=30
        )
        self.solve = pn.widgets.Button(name="Solve the kinetic equation")
        self.solve.on_click(self._ask_kinetic)
        self.status = pn.pane.HTML(styles={"font-size": "12px"})
        self.message = pn.pane.Alert(alert_type="warning", visible=False, margin=(4, 10))

    def view(self) -> pn.viewable.Viewable:
        """Return the layout."""
        controls = pn.Column(
            pn.pane.HTML("<h2 style='margin:0'>Crazy billiards</h2>"),
            pn.Row(self.play, self.reset),
            pn.pane.HTML("speed [T per second]", margin=(5, 10, 0, 10)),
            self.speed,
            self.preset,
            *self.setting.widgets(),
            self.solve,
            self.status,
            self.message,
            pn.pane.HTML(
                "The address of this page holds the setting: who opens it sees the same chain.",
                styles={"font-size": "12px", "color": "#555555"},
            ),
            width=330,
        )
        pictures = pn.Column(
            self.rods.plot,
            pn.Row(self.density.plot, self.widths.plot, sizing_mode="stretch_width"),
            pn.Row(self.times.energy, self.times.rate, sizing_mode="stretch_width"),
            sizing_mode="stretch_width",
        )
        return pn.Row(controls, pictures, sizing_mode="stretch_width")

    # -- the clock --------------------------------------------------------------------------

    def _frame(self) -> None:
        now = perf_counter()
        elapsed, self._last = min(now - self._last, _LONGEST), now
        self._frames += 1
        session = self.session
        if self.play.value and not session.diverged:
            time, collisions = session.time, session.collisions
            session.advance(self.speed.value * elapsed, _BUDGET)
            if session.time > time:
                self._keep(time, collisions)
            if session.diverged:
                self._say(
                    f"The chain diverged at t = {session.time:.4g} T: collisions with e > 1 put in "
                    "more energy than the damping takes out. Change a parameter, or reset."
                )
            self.rods.show(session)
        if self._frames % _FRAMES_PER_DRAWING == 0:
            self._draw()

    def _keep(self, time: float, collisions: int) -> None:
        """Take down energy and collisions of a frame."""
        session = self.session
        contacts = (session.chain.size - 1) * (session.time - time)
        rate = (session.collisions - collisions) / contacts
        self._rows.append((session.time, session.kinetic_energy, rate))

    def _draw(self) -> None:
        """Show what was measured."""
        session, (then, before) = self.session, self._drawn
        now = perf_counter()
        self._drawn = now, session.time
        speed = max(session.time - before, 0.0) / (now - then)
        if self._rows:
            self.times.show(self._rows)
            self._rows.clear()
            measured = session.measured()
            if measured is not None:
                self.density.show(smooth(measured))
                self.widths.show(measured)
        waiting = session.measured_from - session.time
        measuring = (
            f"measured for {session.measured_duration:.0f} T"
            if waiting <= 0
            else f"measuring begins in {waiting:.0f} T"
        )
        self.status.object = (
            f"t = {session.time:.1f} T, {speed:.1f} T per second<br>{measuring}<br>"
            f"free width W = {session.chain.free_velocity_width:.3g} R/T"
        )

    # -- what a user does -------------------------------------------------------------------

    def _changed(self, *events: Any) -> None:
        self.session.change(self.setting.chain())
        self._begin()

    def _restart(self, event: Any) -> None:
        self.session.restart()
        self._begin()

    def _begin(self) -> None:
        """Show the session's chain as it is now, of which nothing was measured yet."""
        chain = self.session.chain
        self._say("")
        if self.session.time == 0:
            self.times.clear()
            self._rows.clear()
        self.rods.begin(chain)
        self.rods.show(self.session)
        self.density.clear()
        self.widths.begin(chain)
        self.times.begin(chain)
        if _CHAINS.get(self.preset.value) != chain:
            self.preset.value = _NO_PRESET
        if chain.restitution == 1:
            self._elastic.ask(chain)

    def _take_preset(self, event: Any) -> None:
        if event.new in _CHAINS:
            self.setting.take(_CHAINS[event.new])

    def _name_toggle(self, event: Any) -> None:
        self.play.name = "Pause" if event.new else "Play"

    def _ask_kinetic(self, event: Any) -> None:
        self.solve.name = "Solving ..."
        self.solve.disabled = True
        self._kinetic.ask(self.session.chain)

    def _show_theories(self, chain: Chain, outcome: Densities | BaseException) -> None:
        """Show what was computed, if it is still of this chain."""
        if not self._kinetic.busy:
            self.solve.name = "Solve the kinetic equation"
            self.solve.disabled = False
        if chain != self.session.chain:
            return
        if isinstance(outcome, BaseException):
            self._say(f"No theory for this chain: {outcome}")
            return
        for name, theory in outcome.items():
            self.density.show_theory(name, theory)
            if "velocity_width" in theory:
                self.widths.show_theory(theory)

    def _refuse_address(self, refused: dict[str, Any]) -> None:
        asked = ", ".join(f"{name}={value}" for name, value in refused.items())
        self._say(f"The address asks for {asked}; the page takes {self.setting.ranges()}.")

    def _say(self, message: str) -> None:
        self.message.object = message
        self.message.visible = bool(message)


def make_page(threads: Executor, processes: Executor) -> pn.viewable.Viewable:
    """Return a new page, for one browser."""
    return Page(threads, processes).view()
