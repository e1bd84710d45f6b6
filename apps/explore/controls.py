"""What a user can press, choose and read on the page."""

from __future__ import annotations

from html import escape
from typing import Any

import panel as pn
from panel.links import Callback

from crazybilliards.apps.explore.challenges import CHALLENGES, SENTENCE, Verdict
from crazybilliards.apps.explore.presets import PRESETS, Preset
from crazybilliards.apps.explore.session import Session
from crazybilliards.apps.explore.setting import Setting

SPEEDS = (0.02, 0.1, 0.5, 3, 30, 300)  # T per second
SLOW = 3  # up to here single collisions can be followed
NO_PRESET = "(choose)"
SOLVE = "Solve the kinetic equation"
MORE = "More: figures, noise, gap, spring, theory"
QUANTITIES = {
    "velocity width of each rod": "widths",
    "velocity distribution": "velocities",
    "avalanche sizes": "avalanches",
    "central width against L": "sizes",
}
HISTORIES = {"kinetic energy": "energy", "collisions per contact": "rate"}
_BY_LABEL = {preset.label: preset for preset in PRESETS}
_ALWAYS_SHOWN = 3  # of the sliders, on a narrow screen: the challenges need these


class Controls:
    """The widgets of one page, and what it says in words."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.setting_widgets = setting.widgets()
        self.play = pn.widgets.Toggle(name="Pause", value=True, button_type="primary")
        self.step, self.reset, self.push = (
            pn.widgets.Button(name=name, description=description)
            for name, description in (
                ("Step", "Move on to the next collision"),
                ("Reset", "All rods at rest at their anchors"),
                ("Push the left end", "Kick the leftmost rod to the right"),
            )
        )
        self.speed = pn.widgets.RadioButtonGroup(
            name="speed", options={f"{speed:g}": speed for speed in SPEEDS}, value=SLOW
        )
        self.challenges = [
            pn.widgets.Button(name=f"{number} {challenge.title}")
            for number, challenge in enumerate(CHALLENGES, 1)
        ]
        self.preset = pn.widgets.Select(
            name="what the paper's figures show", options=[NO_PRESET, *_BY_LABEL]
        )
        self.solve = pn.widgets.Button(name=SOLVE)
        self.quantity = pn.widgets.Select(name="measured", options=QUANTITIES)
        self.history = pn.widgets.Select(name="in time", options=HISTORIES)
        self.status = pn.pane.HTML(css_classes=["status"])
        self.progress = pn.pane.HTML(css_classes=["progress"])
        self.look = pn.pane.HTML(css_classes=["look"], sizing_mode="stretch_width", visible=False)
        self.accuracy = pn.pane.HTML(css_classes=["status"])
        self.more = pn.widgets.Toggle(name=MORE, css_classes=["more"])
        self.rest = pn.Column(
            self.preset,
            *self.setting_widgets[_ALWAYS_SHOWN:],
            self.solve,
            self.accuracy,
            margin=0,
            css_classes=["folded"],
        )
        self.message = pn.pane.Alert(alert_type="warning", visible=False)
        self.play.param.watch(self._name_toggle, "value")
        self.more.param.watch(self._fold, "value")

    @property
    def slow(self) -> bool:
        """Whether the chain is so slow that single collisions can be followed."""
        return bool(self.speed.value <= SLOW)

    def say(self, message: str) -> None:
        """Show a message at the top of the page; an empty text hides it."""
        # A message may quote the address, which anybody can write.
        self.message.object = f"<div role='alert'>{escape(message)}</div>"
        self.message.visible = bool(message)

    @property
    def chosen(self) -> Preset | None:
        """The preset chosen."""
        return _BY_LABEL.get(self.preset.value)

    def show_look(self) -> None:
        """Say what to look for in the preset chosen."""
        preset = self.chosen
        self._tell(f"<b>{preset.label}.</b> {preset.look}" if preset is not None else "")

    def show_challenge(self, number: int, verdict: Verdict) -> None:
        """Say what the challenge of this number asks for, and what was found so far."""
        challenge, button = CHALLENGES[number], self.challenges[number]
        self._tell(f"<b>{challenge.title}.</b> {challenge.ask}<br>{verdict.said}")
        if verdict.done and not button.name.endswith("✓"):
            button.name += " ✓"
            self.say(f"Challenge done: {challenge.title}.")

    def mark_challenge(self, number: int | None) -> None:
        """Mark the button of the challenge chosen, if any."""
        for place, button in enumerate(self.challenges):
            button.button_type = "primary" if place == number else "default"

    def _tell(self, words: str) -> None:
        self.look.object, self.look.visible = words, bool(words)

    def show_accuracy(self, notes: dict[str, str]) -> None:
        """Show the error of each theory."""
        self.accuracy.object = "<br>".join(f"{name}: {note}" for name, note in notes.items())

    def show_progress(self, session: Session) -> None:
        """Show how long the chain has been measured, or when the measurement begins."""
        waiting = session.measured_from - session.time
        if session.diverged:
            words = "the chain has run away: there is no steady state to measure"
        elif session.holds:
            words = "you hold a rod: nothing is measured"
        elif waiting <= 0:
            words = f"measured for {session.measured_duration:.3g} T"
        else:
            seconds = f"{waiting / self.speed.value:.0f} s"
            words = f"settling, shown in grey; measured in {seconds} at this speed"
        self.progress.object = words

    def show_solving(self, seconds: float | None) -> None:
        """Show how long the solver has run; None if it is not running."""
        solving = seconds is not None
        self.solve.name = f"Solving, {seconds:.0f} s: cancel" if solving else SOLVE
        self.solve.button_type = "warning" if solving else "default"

    def close(self) -> None:
        """Let go of the widgets of a closed page.

        Panel's table of callbacks has an entry for each number field beside a slider. The entry
        refers back to its field, so Panel would keep the widgets of every page for ever.
        """
        for widget in self.setting_widgets:
            for part in widget.select():
                Callback.registry.pop(part, None)

    def forget_preset(self) -> None:
        """Deselect the preset if the parameters no longer match it."""
        if self.chosen is not None and self.chosen.chain != self.setting.chain():
            self.preset.value = NO_PRESET

    def head(self) -> list[Any]:
        """Return what stands above everything else, from top to bottom."""
        return [
            pn.pane.HTML(f"<h1>Crazy billiards</h1><p>{SENTENCE}</p>", sizing_mode="stretch_width"),
            _row(*self.challenges),
            self.look,
        ]

    def panel(self) -> list[Any]:
        """Return what stands beside the pictures, from top to bottom."""
        return [
            self.message,
            _row(self.play, self.step, self.reset, self.push),
            pn.pane.HTML("speed [T per second]", css_classes=["status"]),
            self.speed,
            *self.setting_widgets[:_ALWAYS_SHOWN],
            self.status,
            self.more,
            self.rest,
        ]

    def _fold(self, event: Any) -> None:
        self.rest.css_classes = [] if event.new else ["folded"]

    def _name_toggle(self, event: Any) -> None:
        self.play.name = "Pause" if event.new else "Play"


def _row(*buttons: Any) -> pn.FlexBox:
    """Return buttons close to one another, in as few rows as the screen allows."""
    for button in buttons:
        button.margin = (3, 4)
    return pn.FlexBox(*buttons, margin=(0, 6))
