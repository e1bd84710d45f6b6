"""What commands write to a terminal or a pipe: what goes wrong there costs no work."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from typing import Any, TextIO

READER_GONE = 141  # as if the signal SIGPIPE had ended it, like other programs


class _Stream:
    """A stream that goes to nowhere once it fails: its reader has gone, or a disk is full."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream
        self.failed: OSError | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)

    def write(self, text: str) -> int:
        self._try(self.stream.write, text)
        return len(text)

    def flush(self) -> None:
        self._try(self.stream.flush)

    def _try(self, send: Callable[..., object], *text: str) -> None:
        try:
            send(*text)
        except OSError as error:
            # What the stream still holds is written when Python ends, and must not fail then.
            self.failed = error
            with open(os.devnull, "w") as nowhere:
                os.dup2(nowhere.fileno(), self.stream.fileno())


@contextmanager
def plain_streams() -> Iterator[_Stream]:
    """Let commands go on where nobody reads them, and show warnings in one line; give stdout."""
    # A stream that was closed, by >&- in a shell say, goes to nowhere. Otherwise the next file that
    # is opened would get its number, and what a library writes to standard output.
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode))  # noqa: SIM115
    output, errors = _Stream(sys.stdout), _Stream(sys.stderr)
    with warnings.catch_warnings(), redirect_stdout(output), redirect_stderr(errors):
        warnings.showwarning = _show_warning
        yield output
        output.flush()


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"crazybilliards: warning: {' '.join(str(message).split())}", file=sys.stderr)
