"""Figure 13: avalanche sizes of flippers: system-spanning where the damping is weak."""

from __future__ import annotations

import matplotlib.pyplot as plt
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.claims.repetition import estimate, pooled
from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim, positive_claim
from crazybilliards.comparison.paper.chains import flippers, flippers_name
from crazybilliards.comparison.paper.distributions import draw_sizes

_SIZE = 100
_DAMPINGS = (4.0, 10.0)
_ORIGINS = slice(1, 10)
_SPANNING = 80  # collisions of a wave that began at one of those origins


def cases(quality: Quality) -> Cases:
    """L = 100, e = 1.05, gamma = 4 and 10."""
    cases: Cases = {}
    for damping in _DAMPINGS:
        cases |= flippers(_SIZE, damping, quality)
    return cases


def _spanning(run: xr.Dataset) -> float:
    counts = run.avalanche_count.sel(particle=_ORIGINS).sum("particle").values
    return float(counts[_SPANNING - 1 :].sum() / counts.sum())


def claims(results: Results) -> list[Claim]:
    """Check: system-spanning avalanches at gamma = 4, more than at gamma = 10."""
    weak, strong = (
        estimate(results, flippers_name(_SIZE, damping), lambda run: 1e4 * _spanning(run))
        for damping in _DAMPINGS
    )
    what = f"of 10^4 waves from origins 1 to 10, those of {_SPANNING} collisions or more:"
    return [
        positive_claim("avalanches span the system at gamma = 4", what, weak),
        positive_claim(
            "more so than at gamma = 10",
            f"{what} {weak} and {strong}, difference",
            weak.minus(strong),
        ),
    ]


def draw(results: Results) -> Figure:
    """Draw p(N_c) for both dampings."""
    figure, ax = plt.subplots(figsize=(5.4, 3.9), layout="constrained")
    for number, damping in enumerate(_DAMPINGS):
        run = pooled(results, flippers_name(_SIZE, damping))
        counts = run.avalanche_count.sel(particle=_ORIGINS).sum("particle").values.astype(float)
        sizes = run.avalanche_size.values
        p = counts / counts.sum()
        draw_sizes(ax, sizes, p, counts, number=number, label=rf"$\gamma$ = {damping:g}")
    ax.axvspan(_SPANNING, _SIZE, color="0.9", zorder=0)
    ax.text(_SPANNING, ax.get_ylim()[1], "spanning ", va="top", ha="right", fontsize=8)
    ax.set_ylabel("probability $p(N_c)$")
    ax.legend(frameon=False)
    return figure


FIGURE = PaperFigure(
    number=13,
    name="avalanches-flippers",
    title="Avalanche sizes at e = 1.05",
    caption="Probability of a rightward wave of N_c collisions that began at one of the first ten "
    "rods, L = 100, e = 1.05. Error bars: counting statistics.",
    cases=cases,
    draw=draw,
    claims=claims,
)
