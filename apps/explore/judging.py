"""The challenge that one page shows, and what its chain has done for it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from crazybilliards.apps.explore.challenges import CHALLENGES
from crazybilliards.apps.explore.controls import NO_PRESET, Controls
from crazybilliards.apps.explore.session import Session


class Judging:
    """Sets the chain of a challenge, and lets a judge of its own look at it.

    Parameters
    ----------
    controls
        The buttons of the challenges, and the place where they are told.
    start_anew
        Called when a challenge begins with a chain that has run away before.
    """

    def __init__(self, controls: Controls, start_anew: Callable[[], None]) -> None:
        self._controls, self._start_anew = controls, start_anew
        self._judges = [challenge.new_judge() for challenge in CHALLENGES]
        self._chosen: int | None = None
        for number, button in enumerate(controls.challenges):
            button.on_click(partial(self._choose, number))
        controls.preset.param.watch(self._leave, "value")
        if controls.setting.chain() == CHALLENGES[0].chain:
            self._mark(0)

    def pushed(self, session: Session) -> None:
        """Note that the leftmost rod has just been pushed."""
        if self._chosen is not None:
            self._judges[self._chosen].pushed(session)

    def follow(self, session: Session) -> None:
        """Look at the chain, in every frame."""
        if self._chosen is not None:
            self._judges[self._chosen].follow(session)

    def show(self, session: Session) -> None:
        """Say what was found so far."""
        if self._chosen is not None:
            verdict = self._judges[self._chosen].verdict(session)
            self._controls.show_challenge(self._chosen, verdict)

    def _choose(self, number: int, event: Any) -> None:
        controls, challenge = self._controls, CHALLENGES[number]
        controls.preset.value = NO_PRESET
        self._mark(number)
        controls.setting.take(challenge.chain)
        controls.speed.value = challenge.speed
        controls.quantity.value = "widths"
        controls.play.value = True
        self._start_anew()

    def _leave(self, event: Any) -> None:
        """Let a preset take the place of the challenge."""
        if event.new != NO_PRESET:
            self._mark(None)

    def _mark(self, number: int | None) -> None:
        self._chosen = number
        self._controls.mark_challenge(number)
