"""What a user sets on the page: the parameters of a chain with the range of each."""

from __future__ import annotations

import param
from panel.widgets import EditableFloatSlider, EditableIntSlider, Select, Widget

from crazybilliards.model import Chain


class Setting(param.Parameterized):
    """The parameters of the chain, named as those of :class:`crazybilliards.model.Chain`."""

    size = param.Integer(100, bounds=(2, 300))
    restitution = param.Number(1.0, bounds=(0.0, 1.1))
    amplitude = param.Number(1.0, bounds=(0.1, 30.0))
    damping = param.Number(1.0, bounds=(0.1, 20.0))
    gap = param.Number(0.0, bounds=(0.0, 5.0))
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

    def ranges(self) -> str:
        """Return in words what each parameter takes."""
        numbers = [
            f"{name} {low:g} to {high:g}"
            for name in self.parameters()
            if name != "spring"
            for low, high in [self.param[name].bounds]
        ]
        return ", ".join([*numbers, "spring linear or quadratic"])

    def widgets(self) -> list[Widget]:
        """Return a widget for each parameter."""
        sliders = [
            EditableFloatSlider.from_param(self.param[name], name=label, step=step)
            for name, label, step in (
                ("restitution", "restitution e", 0.01),
                ("amplitude", "noise amplitude A [M R/T^(3/2)]", 0.1),
                ("damping", "damping gamma [M/T]", 0.1),
                ("gap", "gap g at the anchors [R]", 0.05),
            )
        ]
        return [
            EditableIntSlider.from_param(self.param.size, name="number of rods L"),
            *sliders,
            Select.from_param(self.param.spring, name="spring"),
        ]
