"""How far a computation is: tqdm's bar, as text or as a widget of a notebook, or lines in a log."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterable
from contextlib import suppress
from threading import Event, Thread
from typing import Any

from tqdm import std
from tqdm.auto import tqdm

_PAUSE = 30.0  # s between two lines


def progress_bar(
    progress: bool | str, items: Iterable[Any] | None = None, **look: Any
) -> std.tqdm[Any]:
    """Return tqdm's bar if ``progress``; where standard error is no terminal it writes lines."""
    # A program in the background may have closed standard error, where tqdm cannot write.
    if not progress or sys.stderr is None:
        return tqdm(items, disable=True, **look)
    return (tqdm if getattr(sys.stderr, "isatty", bool)() else _Lines)(items, **look)


class _Lines(std.tqdm):
    """Writes a line every half minute, also while nothing advances: a case can take long."""

    def __init__(self, items: Iterable[Any] | None, **look: Any) -> None:
        self._closed = Event()
        super().__init__(items, file=io.StringIO(), **look)
        if not self.disable:
            Thread(target=self._tell, args=[sys.stderr], daemon=True).start()

    def _tell(self, stream: Any) -> None:
        with suppress(OSError, ValueError):  # nobody reads it any more
            while not self._closed.wait(_PAUSE):
                print(f"crazybilliards: {self}", file=stream, flush=True)

    def display(self, *_: Any, **__: Any) -> None:
        pass  # at other times

    def close(self) -> None:
        self._closed.set()
        super().close()
