"""The chain parameters that the user can set, with their ranges."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from urllib.parse import parse_qsl

import param
from panel.widgets import EditableFloatSlider, EditableIntSlider, Select, Widget

from crazybilliards.model import Chain

_LONGEST = 20  # letters of a wrong value that are shown


class Setting(param.Parameterized):
    """The parameters of the chain, named as those of :class:`crazybilliards.model.Chain`."""

    # The defaults are the chain of the first challenge, whose collisions are visible.
    size = param.Integer(20, bounds=(2, 1000))
    restitution = param.Number(1.0, bounds=(0.0, 1.1))
    amplitude = param.Number(1.0, bounds=(0.1, 30.0))
    damping = param.Number(0.3, bounds=(0.1, 20.0))
    gap = param.Number(0.5, bounds=(0.0, 5.0))
    spring = param.Selector(default="linear", objects=["linear", "quadratic"])

    @classmethod
    def parameters(cls) -> list[str]:
        """Return the names of the parameters."""
        return [name for name in cls.param if name != "name"]

    def chain(self) -> Chain:
        """Return the chain."""
        return Chain(**{name: getattr(self, name) for name in self.parameters()})

    def take(self, chain: Chain) -> None:
        """Take over the parameters of a chain, all at once."""
        self.param.update(**{name: getattr(chain, name) for name in self.parameters()})

    def query(self) -> dict[str, str]:
        """Return the parameters as an address holds them."""
        values = {name: getattr(self, name) for name in self.parameters()}
        return {
            name: value if isinstance(value, str) else f"{value:.12g}"
            for name, value in values.items()
        }

    def take_query(self, query: str) -> None:
        """Set the parameters from a query, ``?size=30&amplitude=2``.

        If one value is wrong, none is set. Unknown names are ignored.

        Raises
        ------
        ValueError
            If a parameter is not a number, or not in its range; the setting is then unchanged.
        """
        asked = {
            name: text
            for name, text in parse_qsl(query.removeprefix("?"), keep_blank_values=True)
            if name in self.parameters()
        }
        wrong: dict[str, str] = {}
        values: dict[str, Any] = {}
        for name, text in asked.items():
            try:
                values[name] = self._read(name, text)
            except ValueError:
                wrong[name] = text
        if wrong:
            said = ", ".join(f"{name}={_shortened(text)}" for name, text in wrong.items())
            raise ValueError(
                f"The address asks for {said}, which this page does not take. Nothing of the "
                f"address was used. It takes {self._ranges(wrong)}."
            )
        self.param.update(**values)

    def _read(self, name: str, text: str) -> Any:
        """Return the value of a parameter; raise a ValueError unless the page takes it."""
        of = self.param[name]
        if isinstance(of, param.Selector):
            if text not in of.objects:
                raise ValueError(name)
            return text
        value = int(text) if isinstance(of, param.Integer) else float(text)
        low, high = of.bounds
        if not low <= value <= high:
            raise ValueError(name)
        return value

    def _ranges(self, names: Mapping[str, str]) -> str:
        """Return in words what these parameters take."""
        return ", ".join(
            f"{name} {' or '.join(of.objects)}"
            if isinstance(of, param.Selector)
            else f"{name} {of.bounds[0]:g} to {of.bounds[1]:g}"
            for name in names
            for of in [self.param[name]]
        )

    def widgets(self) -> list[Widget]:
        """Return a widget for each parameter, those that matter most first."""
        return [
            EditableFloatSlider.from_param(self.param.restitution, name="restitution e", step=0.01),
            EditableIntSlider.from_param(self.param.size, name="number of rods L"),
            *(
                EditableFloatSlider.from_param(self.param[name], name=label, step=step)
                for name, label, step in (
                    ("damping", "damping γ [M/T]", 0.1),
                    ("amplitude", "noise amplitude A [M R/√T³]", 0.1),
                    ("gap", "gap g at the anchors [R]", 0.05),
                )
            ),
            Select.from_param(self.param.spring, name="spring"),
        ]


def _shortened(text: str) -> str:
    """Return the beginning of a text on one line."""
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST else line[:_LONGEST] + "..."
