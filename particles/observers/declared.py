"""What the class of an observer declares, checked once, when the class is defined."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from crazybilliards.model.checks import is_list, shown
from crazybilliards.model.vocabulary import VOCABULARY

_UNIT = re.compile(r"[RMT\d /^().*-]+")


def check_declarations(observer: Any) -> None:
    """Raise a ValueError unless name, gives, along and vocabulary of a class are complete."""
    owner = observer.__name__
    if not isinstance(name := getattr(observer, "name", None), str):
        raise ValueError(f"name of {owner} must be a text, got {shown(name)}")
    for what in ("gives", "along"):
        names = getattr(observer, what, None)
        if not is_list(names) or not all(isinstance(name, str) for name in names):
            raise ValueError(
                f"{what} of {owner} must be a tuple of names, such as ('my_variable',), got "
                f"{shown(names)}"
            )
    _check_vocabulary(owner, observer.vocabulary)
    for name in (*observer.along, *observer.gives):
        if name.removesuffix("_error") not in {**observer.vocabulary, **VOCABULARY}:
            raise ValueError(
                f"{owner} gives {name!r}, which has no meaning and unit: "
                f"vocabulary = {{{name!r}: (meaning, unit)}} in the class says them"
            )


def _check_vocabulary(owner: str, said: Any) -> None:
    """Raise unless the meanings and units can be written into a result."""
    entries = said.items() if isinstance(said, Mapping) else [(None, None)]
    for name, entry in entries:
        texts = [name, *entry] if isinstance(entry, tuple | list) else []
        right = len(texts) == 3 and all(isinstance(each, str) for each in texts)
        if not right or not _UNIT.fullmatch(texts[2]):
            raise ValueError(
                f"vocabulary of {owner} must be {{name: (meaning, unit)}}, all of them texts, and "
                f"units of R, M and T, such as R^2/T, or 1, got {shown(said)}"
            )
