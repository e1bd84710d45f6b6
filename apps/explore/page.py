"""The page runs a clock and reacts to the user.

In every frame the session advances by the elapsed time times the chosen speed, within a limit on
computing time, so that the page stays responsive. The measurements are redrawn every few frames.
A frame begins with what the user did and what other threads found since the last one.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from functools import partial
from queue import SimpleQueue
from threading import Lock
from time import perf_counter
from typing import Any

import numpy as np
import panel as pn

from crazybilliards.apps.explore.address import Address
from crazybilliards.apps.explore.challenges import KICK
from crazybilliards.apps.explore.controls import SLOW, Controls
from crazybilliards.apps.explore.judging import Judging
from crazybilliards.apps.explore.layout import arrange, draw_first
from crazybilliards.apps.explore.pictures import Pictures
from crazybilliards.apps.explore.session import Session
from crazybilliards.apps.explore.setting import Setting
from crazybilliards.apps.explore.solving import Solving
from crazybilliards.comparison.coverage import smooth

_PERIOD = 33  # ms from frame to frame
_BUDGET = 0.012  # s of computing in a frame
_STEP_BUDGET = 0.3  # s of computing until the next collision
_LONGEST = 0.1  # s; a frame advances by no more than this, even after a longer pause
_FRAMES_PER_DRAWING = 8
_STEPS_PER_ROW = 3
_STEPPING_SPEED = 0.1  # at which Step goes on, if the speed is no slow one


class Page:
    """One page in one browser, with its own chain, setting and clock.

    See :class:`~crazybilliards.apps.explore.solving.Solving` for ``threads`` and ``turn``.
    """

    def __init__(self, threads: Executor, turn: Lock) -> None:
        self._document = pn.state.curdoc
        self.setting = Setting()
        self.controls = Controls(self.setting)
        self._address = Address(self.setting, self.controls.say)
        self.session = Session(self.setting.chain())
        self.pictures = Pictures(self._drag)
        self._rows: list[tuple[float, float, float]] = []
        self._frames, self._owed_rows = 0, 0.0
        self._last, self._drawn = perf_counter(), (perf_counter(), 0.0)
        self._due: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._reacting = False
        self._solving = Solving(
            self.controls, self.pictures, self.session, threads, turn, self._due.put
        )
        self._listen()
        self._judging = Judging(self.controls, self._in_a_frame(self._start_anew))
        self._set_pace()
        self._begin()
        self._judging.show(self.session)
        self._address.write()
        self.controls.say(self._address.refusal)
        pn.state.add_periodic_callback(self._frame, period=_PERIOD)
        pn.state.on_session_destroyed(self._close)

    def view(self) -> pn.viewable.Viewable:
        """Return the layout."""
        draw_first(self.session, self.pictures.rods)
        return arrange(self.controls, self.pictures)

    def react(self) -> None:
        """Do what was asked for since the last frame, by the user and by other threads."""
        self._reacting = True
        try:
            while not self._due.empty():
                self._due.get()()
        finally:
            self._reacting = False

    def _in_a_frame(self, do: Callable[..., None]) -> Callable[..., None]:
        """Return what does this in the next frame, or at once if a frame asks for it.

        Pictures can only be changed with the lock of Bokeh's document. A frame has it. Panel calls
        without it if a user does two things at nearly the same time.
        """

        def asked(*events: Any) -> None:
            if self._reacting:
                do(*events)
            else:
                self._due.put(partial(do, *events))

        return asked

    def _listen(self) -> None:
        controls, locked = self.controls, self._in_a_frame
        self.setting.param.watch(locked(self._changed), self.setting.parameters())
        controls.preset.param.watch(locked(self._take_preset), "value")
        for widget in (controls.speed, controls.quantity, controls.history):
            widget.param.watch(locked(self._set_pace), "value")
        controls.step.on_click(locked(self._step))
        controls.reset.on_click(locked(self._restart))
        controls.push.on_click(locked(self._push))
        controls.solve.on_click(locked(self._solving.ask))

    def _close(self, context: Any) -> None:
        self._solving.cancel()
        self.controls.close()

    # -- the clock --------------------------------------------------------------------------

    def _frame(self) -> None:
        if self._document.session_context.session.connection_count == 0:
            self._solving.cancel()
            return  # the browser has closed the page
        self.react()
        now = perf_counter()
        elapsed, self._last = min(now - self._last, _LONGEST), now
        self._frames += 1
        session = self.session
        if self.controls.play.value and not session.diverged:
            time, collisions = session.time, session.collisions
            self._advance(elapsed)
            if session.time > time:
                self._keep(time, collisions)
            self.pictures.rods.show(session)
            self._judging.follow(session)
            if session.diverged:
                self._explain_divergence()
        if self._frames % _FRAMES_PER_DRAWING == 0:
            self._draw()
            self._solving.poll()

    def _advance(self, elapsed: float) -> None:
        """Advance the chain; in slow motion, one row of the strip at a time."""
        if not self.controls.slow:
            self.session.advance(self.controls.speed.value * elapsed, _BUDGET)
            return
        rows, self._owed_rows = divmod(elapsed * 1000 / _PERIOD + self._owed_rows, 1)
        for _ in range(int(rows)):
            self.session.advance(self._row_time, _BUDGET)
            self.pictures.strip.add(self.session, self.session.contacts_met())
        self.pictures.strip.show()

    @property
    def _row_time(self) -> float:
        return float(self.controls.speed.value * _PERIOD / 1000)

    def _keep(self, time: float, collisions: int) -> None:
        """Record the energy and the collision rate of a frame."""
        session = self.session
        contacts = (session.chain.size - 1) * (session.time - time)
        rate = (session.collisions - collisions) / contacts
        self._rows.append((session.time, session.kinetic_energy, rate))

    def _explain_divergence(self) -> None:
        self._draw()
        self.controls.say(self.pictures.show_divergence(self.session))

    def _draw(self) -> None:
        """Show what was measured."""
        session, (then, before) = self.session, self._drawn
        now = perf_counter()
        self._drawn = now, session.time
        speed = max(session.time - before, 0.0) / (now - then)
        self.pictures.density.follow_zoom()
        if self._rows:
            self.pictures.times.show(self._rows)
            self._rows.clear()
            observed = session.observed()
            if observed is not None:
                self.pictures.density.show(smooth(observed), session.settled)
                self.pictures.panels[self.controls.quantity.value].show(session, observed)
        self._judging.show(session)
        self.controls.show_progress(session)
        self.controls.status.object = (
            f"t = {session.time:.4g} T, {speed:.2g} T per second<br>"
            f"free rod's velocity width W = {session.chain.free_velocity_width:.3g} R/T"
        )

    # -- what a user does -------------------------------------------------------------------

    def _changed(self, *events: Any) -> None:
        self.session.change(self.setting.chain())
        self._begin()
        self._address.write()

    def _restart(self, event: Any) -> None:
        self.session.restart()
        self._begin()

    def _start_anew(self) -> None:
        if self.session.diverged:
            self._restart(None)

    def _begin(self) -> None:
        """Show the session's chain without any measurements."""
        chain = self.session.chain
        self._solving.begin()
        self.controls.say("")
        self.controls.forget_preset()
        self._rows.clear()
        self.pictures.begin(self.session)
        self.pictures.arrange(self.controls.quantity.value, self.controls.history.value, chain)
        self.pictures.strip.clear(self._row_time)

    def _set_pace(self, *events: Any) -> None:
        """Set the time step for the chosen speed and pictures."""
        controls, slow = self.controls, self.controls.slow
        self.session.pace(
            self._row_time / _STEPS_PER_ROW if slow else np.inf,
            resolved=slow,
            avalanches=controls.quantity.value == "avalanches",
        )
        self.pictures.arrange(
            controls.quantity.value, controls.history.value, self.session.chain, strip=slow
        )
        self.pictures.strip.clear(self._row_time)

    def _take_preset(self, event: Any) -> None:
        preset = self.controls.chosen
        self.controls.show_look()
        if preset is None:
            return
        self.setting.take(preset.chain)
        self.controls.quantity.value = preset.quantity
        self.controls.speed.value = 30
        if not preset.steady:
            self.controls.history.value = "energy"
            self._restart(event)
        if preset.solved and not self._solving.busy:
            self._solving.ask(event)

    def _step(self, event: Any) -> None:
        """Move on to the next collision; say which rods met, or why the chain diverged."""
        if self.session.diverged:
            return
        self.controls.play.value = False
        if not self.controls.slow:
            self.controls.speed.value = _STEPPING_SPEED
        session, strip = self.session, self.pictures.strip
        deadline = perf_counter() + _STEP_BUDGET
        met: list[int] = []
        while not met and perf_counter() < deadline and not session.diverged:
            met = session.advance_to_collision(self._row_time)
            strip.add(session, met)
        # Panel sends words at once and Bokeh pictures later: the words would come before the rods
        # of which they tell.
        with pn.io.unlocked():
            strip.show()
            self.pictures.rods.show(session)
        if session.diverged:
            self._explain_divergence()
            return
        pairs = ", ".join(f"{contact + 1} and {contact + 2}" for contact in met)
        found = f"rods {pairs} met" if met else "no two rods have met yet"
        self.controls.say(f"t = {session.time:.5g} T: {found}.")

    def _push(self, event: Any) -> None:
        if not self.controls.slow:
            self.controls.speed.value = SLOW
        self.session.push(0, KICK * self.session.chain.free_velocity_width)
        self._judging.pushed(self.session)
        self.pictures.rods.show(self.session)

    def _drag(self, x: float | None) -> None:
        """Let the rod that the mouse took hold of follow it, or let go of it."""
        if x is None:
            self.session.release()
        else:
            self.session.hold(x)
            self.pictures.rods.show(self.session)


def make_page(threads: Executor, turn: Lock) -> pn.viewable.Viewable:
    """Return a new page, for one browser."""
    return Page(threads, turn).view()
