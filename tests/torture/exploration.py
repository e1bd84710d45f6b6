"""How arguments are drawn, what a sound result is, and what becomes of a call that takes long."""

import math
import signal
from contextlib import contextmanager

import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, event, settings
from hypothesis import strategies as st

from crazybilliards.kinetic import displaced, hydrodynamics
from crazybilliards.model import Chain, chain_of
from crazybilliards.particles.stepping import compile_kernels

resource = pytest.importorskip("resource")  # not on Windows

PATIENCE = 2.0  # seconds until Ctrl-C
ROOM = 24 * 2**30  # bytes of address space; more is asked for by mistake only

STRANGE = st.sampled_from(
    [
        *(True, None, "", "1", "NaN", "x", b"1", (), [], [1.0], [None], [[1]], {}, 1j, 10**400),
        *(np.float64(2.0), np.float32(1e-3), np.int64(-4), np.bool_(True), np.array([1.0, 2.0])),
        *(np.zeros((3, 3)), np.array(3), range(3), "x" * 1000, [0] * 1000),
    ]
)
EXTREME = st.sampled_from(
    [
        *(0, -1, 1, 2, 0.0, -0.0, -1.5, math.nan, math.inf, -math.inf, 1e300, 1e-300, 5e-324),
        *(1e60, 1e-60, 1e30, 1e-30, 1e15, 1e-15, 1e9, 1e-9, 1e6, 1e-6, 1e3, 1e-3, 1e17),
        *(10**3, 10**5, 10**7, 10**9, 10**18, 10**30),
    ]
)
SIZES = st.integers(1, 12)
ORDINARY = st.floats(0.01, 10).map(lambda value: float(f"{value:.3g}"))


@st.composite
def arguments(draw, **each):
    """Draw some of the keyword arguments: up to two of them nasty, the others ordinary."""
    chosen = draw(st.fixed_dictionaries({}, optional=each))
    for _ in range(draw(st.sampled_from([0, 1, 1, 2]))):
        chosen[draw(st.sampled_from(sorted(each)))] = draw(EXTREME | EXTREME | STRANGE)
    return chosen


def chains(restitution):
    return arguments(
        size=SIZES,
        restitution=restitution,
        amplitude=ORDINARY,
        damping=ORDINARY,
        stiffness=ORDINARY,
        gap=st.just(0.0) | ORDINARY,
        radius=ORDINARY,
        mass=ORDINARY,
        spring=st.sampled_from(["linear", "quadratic"]),
    ).map(lambda parameters: {"size": 6, **parameters})


ELASTIC = st.just(1.0)
NEAR_ONE = st.just(1.0) | st.floats(0.9, 1.05).map(lambda e: round(e, 3))
ANY = st.just(1.0) | st.floats(0, 1.1).map(lambda e: round(e, 3))


@pytest.fixture(autouse=True)
def limits():
    """Bound the address space for the test."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (ROOM, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_AS, before)


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """Compile the kernels beforehand, so that a Ctrl-C meets a computation."""
    compile_kernels()
    for frame in ("label", "eulerian"):
        options = {"frame": frame, "velocity_variance": "evolving", "progress": False}
        hydrodynamics(Chain(size=2), displaced(Chain(size=2), 1.0), 0.1, **options)


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
    except (ValueError, TypeError) as error:
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
        assert 0 <= result.error < math.inf
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
