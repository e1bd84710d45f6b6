"""The theories that one page shows beside its chain: when they are asked for, and what is said."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from threading import Lock
from typing import Any

from crazybilliards.apps.explore.controls import Controls
from crazybilliards.apps.explore.pictures import Pictures
from crazybilliards.apps.explore.session import Session
from crazybilliards.apps.explore.theories import (
    Background,
    Densities,
    Solver,
    balance_density,
    exact_density,
    kinetic_density,
)
from crazybilliards.model import Chain


class Solving:
    """Theories of the session's chain.

    At e = 1 the densities appear by themselves, computed by ``threads``. The kinetic equation is
    solved in a separate process, one at a time for all pages that share ``turn``. What the threads
    have found is shown by calls that they hand to ``arrived``.
    """

    def __init__(
        self,
        controls: Controls,
        pictures: Pictures,
        session: Session,
        threads: Executor,
        turn: Lock,
        arrived: Callable[[Callable[[], None]], None],
    ) -> None:
        self._controls, self._pictures, self._session = controls, pictures, session
        self._notes: dict[str, str] = {}
        self._elastic = [
            Background(threads, job, self.show, arrived)
            for job in (balance_density, exact_density)  # the faster one first
        ]
        self._kinetic = Solver(kinetic_density, turn)

    @property
    def busy(self) -> bool:
        """Whether the kinetic equation is being solved, or waits for its turn."""
        return self._kinetic.chain is not None

    def begin(self) -> None:
        """Begin for the session's chain: forget what is known of another one."""
        chain = self._session.chain
        if chain.restitution == 1:
            for theory in self._elastic:  # at once, because the user waits for the answer
                theory.ask(chain)
        self._notes.clear()
        self._controls.show_accuracy(self._notes)
        if self._kinetic.chain != chain:
            self._kinetic.cancel()
        self._controls.show_solving(self._kinetic.seconds if self.busy else None)

    def cancel(self) -> None:
        """Stop solving the kinetic equation."""
        self._kinetic.cancel()

    def ask(self, event: Any) -> None:
        """Solve the kinetic equation, or stop if it is being solved."""
        if self.busy:
            self._kinetic.cancel()
            self._controls.show_solving(None)
        else:
            self._kinetic.ask(self._session.chain)
            self._controls.show_solving(0.0)

    def poll(self) -> None:
        """Show the solution of the kinetic equation once it is there."""
        chain = self._kinetic.chain
        if chain is None:
            return
        outcome = self._kinetic.poll()
        self._controls.show_solving(self._kinetic.seconds if outcome is None else None)
        if outcome is not None:
            self.show(chain, outcome)

    def show(self, chain: Chain, outcome: Densities | BaseException) -> None:
        """Show what was computed, if it is still of the session's chain."""
        if chain != self._session.chain:
            return
        if not isinstance(outcome, BaseException):
            self._notes |= self._pictures.show_theories(outcome)
            self._controls.show_accuracy(self._notes)
        elif not self._session.diverged:  # which the page has explained already
            self._controls.say(f"No theory for this chain: {outcome}")
