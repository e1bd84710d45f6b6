"""Cases of a sweep: equal ones have one key, wrong ones are refused before any work."""

import json

import numpy as np
import pytest

from crazybilliards.comparison.sweeps import Case
from crazybilliards.comparison.sweeps.case import compute
from crazybilliards.model import Chain


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


def test_the_canonical_text_holds_every_parameter_and_the_version():
    stored = json.loads(Case("simulate", Chain(), {"duration": 100}).canonical)
    assert set(Chain().parameters()) < set(stored)
    assert {"duration", "warmup", "time_step", "method", "seed", "version", "job"} < set(stored)
    assert not {"threads", "checkpoint", "progress", "start"} & set(stored)


@pytest.mark.parametrize(
    ("job", "settings", "message"),
    [
        ("simulation", {}, "job must be one of"),
        ("simulate", {"length": 3}, "simulate takes any of"),
        ("simulate", {"threads": 3}, "simulate takes any of"),
        ("simulate", {"duration": -1}, "duration must be"),
        ("simulate", {"duration": {"a": 1}}, "plain value"),
        ("simulate", {"observe": ["heat"]}, "observe takes any of"),
        ("phase_space", {"duration": 1}, "phase_space takes any of"),
    ],
)
def test_a_wrong_case_is_refused_before_any_work(job, settings, message):
    with pytest.raises(ValueError, match=message):
        Case(job, Chain(size=3), settings)


def test_settings_of_a_theory_are_checked_before_any_work():
    for settings in ({"cells": "x"}, {"cells": 10**6}, {"tolerance": -1}, {"order": 3}):
        with pytest.raises(ValueError, match=next(iter(settings))):
            Case("phase_space", Chain(size=3), settings)
    for job in ("equilibrium", "force_balance"):
        with pytest.raises(ValueError, match=f"{job} takes restitution=1"):
            Case(job, Chain(restitution=0.5), {})


def test_a_worker_with_another_version_refuses():
    case = Case("simulate", Chain(size=2), {"duration": 100})
    with pytest.raises(ValueError, match="another version"):
        compute(case, case.canonical.replace('"version": "', '"version": "9'))
