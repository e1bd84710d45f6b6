"""Cases of a sweep: equal ones have one key, wrong ones are refused before any work."""

import json

import numpy as np
import pytest

from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.comparison.sweeps import Case
from crazybilliards.comparison.sweeps.case import compute
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.model import Chain
from crazybilliards.model.fingerprint import room_fingerprint


def test_equal_cases_have_equal_keys_however_their_numbers_are_written():
    chain = Chain(size=3, damping=2)
    one = Case("simulate", chain, {"duration": 100, "observe": ("widths",), "seed": np.int64(1)})
    other = Case(
        "simulate",
        Chain(size=np.int64(3), damping=np.float64(2.0)),
        {"seed": 1, "observe": ["widths"], "duration": 100.0, "replicas": 1},
    )
    assert one == other
    assert one.key == other.key
    assert len({one, other}) == 1
    assert one.key != Case("simulate", chain, {"duration": 100, "seed": 2}).key
    assert one.key != Case("simulate", chain.replace(gap=0.1), dict(one.settings)).key


def test_the_canonical_text_holds_every_parameter():
    stored = json.loads(Case("simulate", Chain(), {"duration": 100}).canonical)
    assert set(Chain().parameters()) < set(stored)
    assert {"duration", "warmup", "time_step", "method", "seed", "job"} < set(stored)
    assert not {"threads", "checkpoint", "progress", "start"} & set(stored)


def test_key_and_seed_follow_from_what_is_not_the_default():
    """A parameter that the package gets later, at its default, changes neither."""
    case = Case("simulate", Chain(size=3, gap=0), {"duration": 5000, "seed": 1})
    assert case.changed == {"size": 3, "seed": 1}
    assert case.key == "1ea596a9dd6911f2ba11"
    assert case.own_seed == 703106191185711103
    others = [
        Case("simulate", Chain(size=3), {}),
        Case("simulate", Chain(size=3, gap=1), {"seed": 1}),
        Case("equilibrium", Chain(size=3), {}),
        Case("phase_space", Chain(size=3), {}),
    ]
    assert len({each.key for each in [case, *others]}) == 5
    assert len({each.own_seed for each in [case, *others]}) == 5


def test_every_theory_is_a_job():
    assert set(JOBS) == {"simulate", "simulate_limit", *THEORIES}
    for name, theory in THEORIES.items():
        assert Case(name, Chain(size=10), {}).key
        assert JOBS[name].function is theory.solve
        assert JOBS[name].source == room_fingerprint("model", "kinetic")
    assert JOBS["simulate"].source == room_fingerprint("model", "particles")


def test_a_worker_with_other_source_code_refuses():
    case = Case("simulate", Chain(size=2), {"duration": 100})
    with pytest.raises(ValueError, match="other source code"):
        compute(case, "0123456789abcdef0123")
