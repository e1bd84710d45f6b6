"""Every figure is drawn and its claims are checked, from runs that are far too short.

Right numbers are the business of ``crazybilliards reproduce``; here nothing may break on the way.
Figures that need the kinetic equation of many rods take minutes and are left to it.
"""

from functools import cache
from typing import get_args

import matplotlib.pyplot as plt
import pytest

from crazybilliards.comparison.sweeps import Case
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.reproduction.claims.verdicts import Verdict
from crazybilliards.reproduction.figures import FIGURES

QUICK = [
    study
    for study in FIGURES
    if not any(
        case.job == "phase_space" and case.chain.size > 100
        for case in study.cases("quick").values()
    )
]


# Claims at e = 1, which hold at any step; and on the amplitude, which is a factor at any step.
STEP_LESS = ("velocities-elastic", "arctanh", "density", "amplitude")


@cache  # figures share cases, and shortened ones may be equal
def result(case):
    return JOBS[case.job].function(case.chain, **case.settings)


def short_run(case):
    if case.job == "correlated_phase_space":
        return result(Case(case.job, case.chain.replace(restitution=0.9), {"cells": 8}))
    if case.job == "phase_space":
        near_one = case.chain.replace(restitution=0.98, damping=1.0)
        return result(Case(case.job, near_one, {"cells": 8}))
    if case.job != "simulate":
        return result(case)
    settings, chain = dict(case.settings), case.chain
    # Flippers stay as they are: their energy grows in time, and short runs have no tails.
    if chain.restitution <= 1:
        settings |= {"duration": 70.0, "warmup": 20.0, "time_step": 0.05}
    # Collisions grow with the square of the number of rods, unless rods stick together (e = 0).
    if 0 < chain.restitution < 1:
        chain = chain.replace(size=min(chain.size, 150))
    return result(Case(case.job, chain, settings))


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize("study", QUICK, ids=lambda study: study.name)
def test_it_is_drawn_and_every_claim_gets_a_verdict(study):
    results = {name: short_run(case) for name, case in study.cases("quick").items()}
    for claim in study.claims(results):
        assert claim.verdict in get_args(Verdict)
        assert claim.statement
        if study.name not in STEP_LESS:
            assert any("dt = " in choice for choice in claim.elsewhere), claim.statement
    drawn = study.draw(results)
    assert drawn.axes
    drawn.canvas.draw()  # formulas are read only here
    plt.close(drawn)
