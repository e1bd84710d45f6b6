"""Every figure of the paper is drawn and its claims are checked, from runs that are far too short.

Right numbers are the business of ``crazybilliards reproduce``; here nothing may break on the way.
Figures that need the kinetic equation take minutes and are left to it.
"""

from functools import cache

import matplotlib.pyplot as plt
import pytest

from crazybilliards.comparison.paper.figures import FIGURES
from crazybilliards.comparison.sweeps.jobs import JOBS

SIMULATED = [
    figure
    for figure in FIGURES
    if all(case.job == "simulate" for case in figure.cases("quick").values())
]


@cache  # figures share cases
def short_run(case):
    settings = dict(case.settings)
    # Energies grow in time, and the tails of flippers are empty in short runs: those stay.
    if settings["average"] != "replicas" and case.chain.restitution <= 1:
        settings |= {"duration": 70.0, "warmup": 20.0, "time_step": 0.05}
    return JOBS[case.job].function(case.chain, **settings)


@pytest.mark.compiled
@pytest.mark.parametrize("figure", SIMULATED, ids=lambda figure: figure.name)
def test_a_figure_is_drawn_and_every_claim_gets_a_verdict(figure):
    results = {name: short_run(case) for name, case in figure.cases("quick").items()}
    for claim in figure.claims(results):
        assert claim.verdict in ("reproduced", "refuted", "undecided")
        assert claim.statement
    drawn = figure.draw(results)
    assert drawn.axes
    plt.close(drawn)
