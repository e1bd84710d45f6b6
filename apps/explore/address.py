"""The address of the page stores the setting."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import panel as pn

from crazybilliards.apps.explore.setting import Setting


class Address:
    """Keep the page's address and a setting in agreement.

    Parameters
    ----------
    setting
        Takes over at once what the address asks for.
    say
        Called with why a later address is refused.

    Attributes
    ----------
    refusal
        Why the first address was refused, or an empty text.
    """

    def __init__(self, setting: Setting, say: Callable[[str], None]) -> None:
        self._setting, self._say = setting, say
        self.refusal = self._take()
        if pn.state.location is not None:
            pn.state.location.param.watch(self._follow, "search")

    def write(self) -> None:
        """Show the setting in the address."""
        if pn.state.location is not None:
            pn.state.location.update_query(**self._setting.query())

    def _take(self) -> str:
        if pn.state.location is None:
            return ""
        try:
            self._setting.take_query(pn.state.location.search)
        except ValueError as error:
            return str(error)
        return ""

    def _follow(self, event: Any) -> None:
        if refusal := self._take():
            self.write()
            self._say(refusal)
