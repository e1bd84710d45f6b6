"""The bar that shows how far a computation is: tqdm's, as text or as a widget of a notebook."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import Any

from tqdm.auto import tqdm


def progress_bar(
    progress: bool | str, items: Iterable[Any] | None = None, **look: Any
) -> tqdm[Any]:
    """Return tqdm's bar if ``progress``, on a terminal or in a notebook; elsewhere it is silent."""
    # A program in the background may have closed standard error, and tqdm cannot write to None.
    hidden = not progress or sys.stderr is None
    return tqdm(items, disable=hidden or None, **look)
