"""What a sound result is, what becomes of a call that takes long, and how many are tried."""

import math
import signal
from contextlib import contextmanager

import numpy as np
import xarray as xr
from hypothesis import HealthCheck, event, settings

from crazybilliards.model import Chain, chain_of
from crazybilliards.model.warn import DivergedError

PATIENCE = 2.0  # seconds until Ctrl-C


@contextmanager
def interrupted_when_long():
    """Send Ctrl-C after a while, and give up on what does not heed it."""

    def interrupt(*_):
        signal.raise_signal(signal.SIGINT)

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, PATIENCE)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def outcome(call, *positional, **named):
    """Return what a call returned; None where it refused in one line or was interrupted."""
    try:
        with interrupted_when_long():
            return call(*positional, **named)
    except (ValueError, TypeError, DivergedError) as error:
        event(str(error)[:40])
        message = str(error)
        assert message, "an error without a word"
        assert "\n" not in message, f"more than a line: {message!r}"
        assert len(message) < 500, f"a long line: {message!r}"
        # What numpy, scipy and Python say of their own arguments is no message to a user.
        for stranger in ("ufunc", "broadcast", "object", "ambiguous", "keyword", "convert"):
            assert stranger not in message, message
    except KeyboardInterrupt:
        event("interrupted")
    return None


def require_sound(result):
    """Check a result: finite where it is known, widths and the like not negative, rods in order."""
    if isinstance(result, tuple):
        assert 0 < result.value < math.inf
        # NaN: not measured, as a warning says.
        assert math.isnan(result.error) or 0 <= result.error < math.inf
    if not isinstance(result, xr.Dataset) or result.attrs.get("status") == "interrupted":
        return
    for name, values in result.variables.items():
        if "separation" in values.dims[1:]:
            # NaN where the second rod or contact is beyond the chain.
            first = result[values.dims[-2]]
            inside = first + result.separation <= first.size
            values = result[name].where(inside, 0.0).variable
        if "spectrum" in str(name) and np.isnan(values).all():  # of too short a run, with a warning
            continue
        # Infinite where nothing is known, as in a run of one block.
        if str(name).endswith("_error") or name == "autocorrelation_time":
            assert not np.isnan(values).any(), name
        else:
            assert np.isfinite(values).all(), name
        if str(name).endswith(("width", "density", "rods", "energy", "_error")):
            assert float(values.min()) >= -1e-9 * float(abs(values).max()), name
    chain = chain_of(result)
    assert isinstance(chain, Chain)
    if "mean_position" in result.coords:
        room = result.mean_position.diff("particle") - 2 * chain.radius
        assert (room > -1e-6 * abs(result.mean_position).max()).all()


def explored(examples):
    return settings(
        max_examples=examples,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
