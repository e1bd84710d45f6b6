"""Whatever the arguments, a function of the package returns a sound result or says what is wrong.

Hypothesis draws chains and arguments from a list of nasty values (zero, negative, NaN, infinite,
1e300, 1e-300, strings, None, truth values, numpy scalars, lists, huge whole numbers) and from
ordinary ones. Every call must end in one of three ways:

* a result: finite, ordered where rods are ordered, with the right number of rods;
* one ValueError or TypeError of one line;
* for a run that would take long: the return after a Ctrl-C, which is sent after two seconds.

Any other exception, any warning, a NaN, a call that outlives Ctrl-C by a minute, or one that asks
for more address space than the limit set here fails the test.
"""

from __future__ import annotations

import faulthandler
import math
import resource
import signal
from contextlib import contextmanager

import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from crazybilliards.kinetic import (
    breathing_cloud,
    compressed,
    critical_damping,
    critical_restitution,
    critical_size,
    displaced,
    equilibrium,
    equilibrium_states,
    force_balance,
    hydrodynamics,
    phase_space,
    relax_phase_space,
    two_clumps,
)
from crazybilliards.model import Chain, chain_of
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import OBSERVERS
from crazybilliards.particles.start import given_start

EXAMPLES = 300
PATIENCE = 2.0  # seconds until Ctrl-C
HANG = 90.0  # seconds after Ctrl-C until the process is given up, with its traceback
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
    for method, e in (("event-driven", 1.0), ("event-driven", 0.5), ("contact-dynamics", 0.5)):
        simulate(Chain(size=2, restitution=e), method=method, duration=200.0, progress=False)
    chain = Chain(size=2)
    for frame in ("label", "eulerian"):
        for variance in (None, "evolving"):
            options = {"frame": frame, "velocity_variance": variance, "progress": False}
            hydrodynamics(chain, displaced(chain, 1.0), 0.1, **options)


@contextmanager
def interrupted_when_long():
    """Send Ctrl-C after a while, and give up on what does not heed it."""

    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, PATIENCE)
    faulthandler.dump_traceback_later(PATIENCE + HANG, exit=True)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        faulthandler.cancel_dump_traceback_later()
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
    """Check a result: finite, the widths not negative, rods in order."""
    if not isinstance(result, xr.Dataset) or result.attrs.get("status") == "interrupted":
        return
    for name, values in result.variables.items():
        if str(name).endswith("_error"):  # infinite where nothing is known
            assert not np.isnan(values).any(), name
        else:
            assert np.isfinite(values).all(), name
        if str(name).endswith(("width", "density", "rods", "energy", "_error")):
            # A density of finite elements may ripple around zero.
            ripple = 0.1 if name == "phase_space_density" else 1e-9
            assert float(values.min()) >= -ripple * float(abs(values).max()), name
    chain = chain_of(result)
    assert isinstance(chain, Chain)
    if "mean_position" in result.coords:
        room = result.mean_position.diff("particle") - 2 * chain.radius
        assert (room > -1e-6 * abs(result.mean_position).max()).all()


def explored(examples=EXAMPLES):
    return settings(
        max_examples=examples,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )


@explored(1000)
@given(arguments(**dict.fromkeys(Chain().parameters(), ORDINARY)))
def test_a_chain_is_sound_or_refused(parameters):
    chain = outcome(Chain, **parameters)
    if chain is None:
        return
    assert Chain(**chain.parameters()) == chain
    assert not math.isnan(chain.temperature + chain.thermal_length + chain.free_velocity_width)


@explored()
@given(
    chains(ANY),
    arguments(
        duration=st.floats(50, 300),
        warmup=st.floats(0, 30),
        time_step=st.floats(0.001, 1),
        method=st.sampled_from(["event-driven", "contact-dynamics"]),
        stepper=st.sampled_from(["splitting", "euler"]),
        merging=st.floats(0, 1),
        seed=st.integers(0, 10),
        observe=st.sets(st.sampled_from(sorted(OBSERVERS)), min_size=1, max_size=2).map(list),
        particles=st.lists(SIZES, min_size=1, max_size=3, unique=True).map(sorted),
        replicas=st.integers(1, 3),
        average=st.sampled_from(["time", "ensemble"]),
        every=st.floats(0.01, 10),
        threads=st.integers(1, 2),
        checkpoint_interval=st.floats(0, 10),
    ),
)
def test_a_simulation_is_sound_or_refused(parameters, options):
    chain = outcome(Chain, **parameters)
    if chain is None:
        return
    run = outcome(simulate, chain, **{"duration": 200.0, "progress": False, **options})
    require_sound(run)


@explored()
@given(chains(ELASTIC), arguments(replicas=st.integers(1, 5), seed=st.integers(0, 9)))
def test_an_equilibrium_is_sound_or_refused(parameters, options):
    chain = outcome(Chain, **parameters)
    if chain is not None:
        require_sound(outcome(equilibrium, chain))
        require_sound(outcome(equilibrium_states, chain, **{"replicas": 2, **options}))


TABLE = st.sampled_from(
    [
        ([-9.0, 0.0, 9.0], [1.0, 2.0, 1.0]),
        ([-9.0, 0.0, 9.0], [-1.0, 0.0, 1.0]),
        ([-9.0, 0.0, 9.0], [1e200, -1e200, 1.0]),
        ([-9.0, 0.0, 9.0], [0.0, 0.0, 0.0]),
        ([0.0, 0.0], [1.0, 2.0]),
        ([-1.0, math.nan], [1.0, 2.0]),
        ([-1.0, 1.0], ["a", "b"]),
        ([1.0], [2.0]),
        np.tanh,
        np.arctan,
        lambda x: None,
        lambda x: np.full_like(x, np.nan),
        lambda x: 1.0,
    ]
)


@explored()
@given(chains(ELASTIC), arguments(displacement=TABLE, velocity_variance=ORDINARY | TABLE))
def test_a_force_balance_is_sound_or_refused(parameters, options):
    chain = outcome(Chain, **parameters)
    if chain is not None:
        require_sound(outcome(force_balance, chain, **options))


@explored()
@given(
    chains(ELASTIC),
    arguments(
        duration=ORDINARY,
        every=ORDINARY,
        stretch=ORDINARY,
        shift=ORDINARY,
        start_velocity_variance=ORDINARY,
        evolving=st.booleans(),
    ),
)
def test_a_breathing_cloud_is_sound_or_refused(parameters, options):
    chain = outcome(Chain, **{**parameters, "gap": 0.0, "spring": "linear"})
    if chain is not None:
        require_sound(outcome(breathing_cloud, chain, **{"duration": 1.0, **options}))


def starts(chain):
    """Return the usual starts of a chain and some that are not sound."""
    good = outcome(displaced, chain, chain.thermal_length)
    if good is None:
        return []
    few = good.isel(x=slice(None, None, 2))
    return [
        good,
        *(good * factor for factor in (0, -1, math.nan, 10)),
        *(few, good.rename(x="z"), good.drop_vars("x"), good.isel(x=0), good.isel(x=[0])),
        *(good.isel(x=[]), good.isel(x=slice(None, None, -1)), good.drop_vars("label")),
        good.assign(label=good.label * math.nan).assign_attrs(good.attrs),
        good.assign(velocity_variance=good.velocity_variance * 0),
        good.assign(flow_velocity=good.flow_velocity + math.inf),
        good.assign(flow_velocity=good.flow_velocity + 1e100),
        good.assign_attrs(provenance="{"),
        good.astype(str),
        good.assign_coords(x=good.x * math.nan),
        *(xr.Dataset(), None, "start", 3, {}),
    ]


@explored(150)
@given(
    chains(ELASTIC),
    arguments(
        duration=st.floats(0.1, 5),
        frame=st.sampled_from(["label", "eulerian"]),
        displacement=st.none() | TABLE,
        velocity_variance=st.sampled_from([None, "evolving"]) | ORDINARY | TABLE,
        every=st.floats(0.1, 2),
        cells=st.integers(8, 200),
    ),
    st.integers(0, 60),
)
def test_a_flow_is_sound_or_refused(parameters, options, number):
    chain = outcome(Chain, **parameters)
    some = starts(chain) if chain is not None else []
    if some:
        start = some[number] if number < len(some) else some[0]
        options = {"duration": 1.0, "progress": False, **options}
        require_sound(outcome(hydrodynamics, chain, start, **options))


@explored(100)
@given(
    chains(NEAR_ONE),
    arguments(
        duration=st.floats(0.1, 3),
        every=st.floats(0.1, 2),
        time_step=st.floats(0.01, 1),
        cells=st.integers(4, 12),
    ),
    st.integers(0, 60),
)
def test_a_phase_space_in_time_is_sound_or_refused(parameters, options, number):
    chain = outcome(Chain, **parameters)
    some = starts(chain) if chain is not None else []
    if some:
        start = some[number] if number < len(some) else some[0]
        options = {"duration": 0.5, "cells": 6, "progress": False, **options}
        require_sound(outcome(relax_phase_space, chain, start, **options))


@explored(100)
@given(
    chains(NEAR_ONE),
    arguments(order=st.sampled_from([1, 2]), tolerance=st.floats(0.002, 0.1), cells=SIZES),
)
def test_a_phase_space_is_sound_or_refused(parameters, options):
    chain = outcome(Chain, **parameters)
    if chain is not None:
        require_sound(outcome(phase_space, chain, **{"cells": 6, **options}))


@explored()
@given(
    chains(ELASTIC),
    st.sampled_from(["displaced", "compressed", "two_clumps", "given_start"]),
    arguments(first=ORDINARY, second=ORDINARY, replicas=st.integers(1, 3)),
)
def test_a_start_is_sound_or_refused(parameters, kind, options):
    chain = outcome(Chain, **parameters)
    if chain is None:
        return
    first, second = options.get("first", 1.0), options.get("second", 1.0)
    if kind == "given_start":
        replicas = options.get("replicas", 1)
        start = outcome(given_start, chain, first, second, replicas=replicas)
    elif kind == "two_clumps":
        start = outcome(two_clumps, chain, first, second)
    else:
        start = outcome({"displaced": displaced, "compressed": compressed}[kind], chain, first)
    require_sound(start)


@explored(30)
@given(
    chains(st.floats(1, 1.1)),
    st.sampled_from([critical_size, critical_restitution, critical_damping]),
)
def test_a_critical_value_is_sound_or_refused(parameters, function):
    chain = outcome(Chain, **parameters)
    estimate = None if chain is None else outcome(function, chain)
    if estimate is not None:
        assert 0 < estimate.value < math.inf
        assert 0 <= estimate.error < math.inf
