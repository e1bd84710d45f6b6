"""Whatever the arguments, a function of the package returns a sound result or says what is wrong.

Hypothesis draws chains and arguments from a list of nasty values (zero, negative, NaN, infinite,
1e300, 1e-300, strings, None, truth values, numpy scalars, lists, huge whole numbers) and from
ordinary ones. Every call must end in one of three ways:

* a result: finite, ordered where rods are ordered, with the right number of rods;
* one ValueError or TypeError of one line;
* for a run that would take long: the return after a Ctrl-C, which is sent after two seconds.

Any other exception, any warning, a NaN, a call that outlives Ctrl-C by ten minutes, or one
that asks for more address space than the limit set here fails the test.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr
from exploration import (  # noqa: F401 (two are fixtures of every test)
    ANY,
    ELASTIC,
    NEAR_ONE,
    ORDINARY,
    SIZES,
    arguments,
    chains,
    compiled,
    explored,
    limits,
    outcome,
    require_sound,
)
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.kinetic import (
    breathing_cloud,
    compressed,
    critical_size,
    displaced,
    equilibrium,
    equilibrium_states,
    force_balance,
    hydrodynamics,
    phase_space,
    relax_phase_space,
)
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import OBSERVERS
from crazybilliards.particles.start import given_start


@explored(1000)
@given(arguments(**dict.fromkeys(Chain().parameters(), ORDINARY)))
def test_a_chain_is_sound_or_refused(parameters):
    chain = outcome(Chain, **parameters)
    if chain is None:
        return
    assert Chain(**chain.parameters()) == chain
    assert not math.isnan(chain.temperature + chain.thermal_length + chain.free_velocity_width)


@pytest.mark.filterwarnings("ignore:amplitude=0 and a start at rest")
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
    st.sampled_from(["displaced", "compressed", "given_start"]),
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
    else:
        start = outcome({"displaced": displaced, "compressed": compressed}[kind], chain, first)
    require_sound(start)


@explored(30)
@given(chains(st.floats(1, 1.1)))
def test_a_critical_size_is_sound_or_refused(parameters):
    chain = outcome(Chain, **parameters)
    estimate = None if chain is None else outcome(critical_size, chain)
    if estimate is not None:
        assert 0 < estimate.value < math.inf
        assert 0 <= estimate.error < math.inf
