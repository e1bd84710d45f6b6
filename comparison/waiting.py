"""Show on a terminal what a command is doing if it has no progress bar."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def waiting_for(what: str, progress: bool = True) -> Iterator[None]:
    """Show ``what`` until it is done; nothing where standard error is no terminal."""
    if not progress:
        yield
        return
    from rich.console import Console
    from rich.markup import escape

    with Console(stderr=True).status(escape(what)):
        yield
