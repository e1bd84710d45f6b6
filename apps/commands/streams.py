"""What commands write to a terminal or a pipe: what goes wrong there costs no work."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
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
        try:
            return self.stream.write(text)
        except OSError as error:
            self._give_up(error)
            return len(text)

    def flush(self) -> None:
        try:
            self.stream.flush()
        except OSError as error:
            self._give_up(error)
            self.stream.flush()

    def _give_up(self, error: OSError) -> None:
        # What the stream still holds is written when Python ends, and must not fail then either.
        self.failed = error
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, self.stream.fileno())
        os.close(nowhere)


@contextmanager
def plain_streams() -> Iterator[_Stream]:
    """Let commands go on where nobody reads them, and show warnings in one line; give stdout."""
    _open_closed()
    before = sys.stdout, sys.stderr
    output, errors = map(_Stream, before)
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        sys.stdout, sys.stderr = output, errors
        try:
            yield output
            output.flush()
        finally:
            sys.stdout, sys.stderr = before


def _open_closed() -> None:
    """Open a standard stream that was closed, by ``>&-`` in a shell say, to nowhere.

    Otherwise the next file that is opened would get its number, and what a library writes to
    standard output would go into that file.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode))  # noqa: SIM115


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"crazybilliards: warning: {' '.join(str(message).split())}", file=sys.stderr)
