"""Seeds in the forms that numpy's users know: one number behind all of them."""

import json
from functools import partial

import numpy as np
import pytest

from crazybilliards.comparison import compare, compare_relaxation
from crazybilliards.kinetic import equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.model.randomness import seed_of
from crazybilliards.particles import simulate

CHAIN = Chain(size=3)
SHORT = {"duration": 100, "progress": False}


@pytest.mark.compiled
def test_a_sequence_means_its_number():
    for function in (
        partial(simulate, CHAIN, **SHORT),
        partial(equilibrium_states, CHAIN, 2),
        partial(compare, CHAIN, {"amplitude": [2.0]}, **SHORT),
        partial(compare_relaxation, CHAIN, duration=1.0, every=1.0, replicas=2, progress=False),
    ):
        five, six = (function(seed=np.random.SeedSequence(number)) for number in (5, 6))
        assert five.identical(function(seed=5))
        assert not five.equals(six)


def test_a_generator_gives_a_seed_that_the_provenance_tells():
    generator = np.random.default_rng(1)
    first, second = (simulate(CHAIN, seed=generator, **SHORT) for _ in range(2))
    assert not first.equals(second)
    seeds = [json.loads(run.attrs["provenance"])["seed"] for run in (first, second)]
    again = np.random.default_rng(1)
    assert seeds == [int(again.integers(2**63)) for _ in range(2)]
    assert simulate(CHAIN, seed=seeds[0], **SHORT).identical(first)


def test_streams_of_one_sequence_differ():
    """A number that is too long for the provenance is mixed to a shorter one."""
    assert seed_of(np.random.SeedSequence(2**4096)) < 2**128
    assert seed_of(np.random.SeedSequence(2**4095)) == 2**4095
    sequence = np.random.SeedSequence(5)
    assert seed_of(sequence) == 5
    assert seed_of(np.int64(5)) == 5
    children = [seed_of(child) for child in sequence.spawn(3)]
    assert len({5, *children}) == 4
    again = np.random.SeedSequence(5).spawn(1)[0]
    assert seed_of(again) == children[0] < 2**128
    assert seed_of(np.random.SeedSequence([1, 2])) != seed_of(np.random.SeedSequence([2, 1]))
