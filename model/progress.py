"""What is shown while something is computed: bars on a terminal and in a notebook, or nothing.

Where nobody looks, because standard error is a file or closed, nothing is written. The variable
``TQDM_DISABLE=1`` of the environment hides all bars.
"""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from threading import Event, Thread
from typing import Any

from tqdm import tqdm

_PATIENCE = 2.0  # s without a bar: what is quicker shows none
_LOOK = 0.2  # s between two changes of a bar that shows the time
_waiting: ContextVar[bool] = ContextVar("waiting", default=False)


def watched() -> bool:
    """Return whether somebody sees standard error: on a terminal or in a notebook."""
    return _in_notebook() or (sys.stderr is not None and sys.stderr.isatty())


def progress_bar(
    progress: bool | str, items: Iterable[Any] | None = None, **look: Any
) -> tqdm[Any]:
    """Return tqdm's bar: a widget in a notebook that has ipywidgets, otherwise text.

    It is hidden unless ``progress`` asks for it and somebody is watching. In a notebook it appears
    after two seconds, because what it shows there stays.
    """
    kind: type[tqdm[Any]] = tqdm
    if not (progress and watched()):
        look["disable"] = True
    elif _in_notebook():
        from tqdm import notebook

        if getattr(notebook, "IProgress", None) is not None:
            kind = notebook.tqdm_notebook
        look.setdefault("delay", _PATIENCE)
        if "bar_format" in look:  # widgets have no width in letters
            look["bar_format"] = re.sub(r"{bar:\d+}", "{bar}", look["bar_format"])
    return kind(items, **look)


@contextmanager
def waiting_for(
    what: str, progress: bool = True, *, seconds: float | None = None
) -> Iterator[None]:
    """Show ``what`` and the time until it is done, if that is more than two seconds.

    ``seconds``: about how long it takes. Within another such block nothing is shown.
    """
    if not progress or _waiting.get() or not watched():
        yield
        return
    done = Event()
    showing = Thread(target=_show_time, args=(what, seconds, done), daemon=True)
    showing.start()
    try:
        with silent():
            yield
    finally:
        done.set()
        showing.join()


@contextmanager
def silent() -> Iterator[None]:
    """Let :func:`waiting_for` show nothing in this block."""
    before = _waiting.set(True)
    try:
        yield
    finally:
        _waiting.reset(before)


def _show_time(what: str, seconds: float | None, done: Event) -> None:
    """Show how long something has taken, and the share of the time that it may take."""
    begun = time.monotonic()
    if done.wait(_PATIENCE):
        return
    how = "{desc}: {elapsed}"
    if seconds is not None:
        how = f"{{desc}}: {{bar}}| {{elapsed}} of about {tqdm.format_interval(max(seconds, 1))}"
    with progress_bar(True, total=seconds, desc=what, bar_format=how, leave=False, delay=0) as bar:
        bar.start_t -= time.monotonic() - begun
        while not done.wait(_LOOK):
            passed = time.monotonic() - begun
            bar.n = passed if seconds is None else min(passed, seconds)
            bar.refresh()


def _in_notebook() -> bool:
    """Return whether this is a notebook's kernel, whose outputs can show widgets."""
    shell = sys.modules.get("IPython")
    return shell is not None and type(shell.get_ipython()).__name__ == "ZMQInteractiveShell"
