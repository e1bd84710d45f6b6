"""Figure 13: avalanche sizes of flippers: system-spanning where the damping is weak."""

from __future__ import annotations

from functools import partial

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.layout import entitle, panels
from crazybilliards.reproduction.chains import OTHER_STEP, at_other_step, flippers
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim
from crazybilliards.reproduction.distributions import COUNTS, draw_sizes, waves

TITLE = "Avalanche sizes at e = 1.05"
CAPTION = (
    "Probability of a rightward wave of N_c >= 1 collisions that began at one of the first ten "
    "rods, L = 100, e = 1.05. (a) The paper's count, without the first hit. (b) Pushes, with it. "
    "Grey: waves of 80 to 100 collisions, which span the system. Error bars: counting statistics."
)

_SIZE = 100
_RUNS = {damping: flippers(_SIZE, damping) for damping in (4.0, 10.0)}
_AGAIN = {damping: at_other_step(runs) for damping, runs in _RUNS.items()}
_ORIGINS = slice(1, 10)
_SPANNING = 80  # collisions of a wave that began at one of those origins
cases = partial(all_of, [*_RUNS.values(), *_AGAIN.values()])


def _spanning(run: xr.Dataset, count: str) -> float:
    """Return how many of 10^4 waves span the system."""
    sizes, counts = waves(run, count, _ORIGINS)
    return float(1e4 * counts[sizes >= _SPANNING].sum() / counts.sum())


def claims(results: Results) -> list[Claim]:
    """Check: system-spanning avalanches at gamma = 4, more than at gamma = 10, in both counts."""
    return [_spanning_claim(results, count, name) for count, (name, _) in COUNTS.items()]


def _spanning_claim(results: Results, count: str, name: str) -> Claim:
    weak, strong, weak_again, strong_again = (
        runs.estimate(results, partial(_spanning, count=count))
        for runs in (*_RUNS.values(), *_AGAIN.values())
    )
    first = "; that the first hit must point right is ours" if count == "avalanche_count" else ""
    return Claim(
        f"avalanches span the system more often at gamma = 4 than at 10 ({name})",
        f"of 10^4 waves with N_c >= 1, those of {_SPANNING} collisions or more: {weak} and "
        f"{strong}, difference",
        found=weak.minus(strong),
        source="section Anti-Dissipation, fig:antidiss_trigger",
        ours=f"the origins (1 to 10) and what spans the system (80 collisions){first}",
        elsewhere={f"dt = {OTHER_STEP:g}": weak_again.minus(strong_again)},
    )


def draw(results: Results) -> Figure:
    """Draw p(N_c) for both dampings in both counts."""
    figure, axes = panels(1, 2, height=2.7, sharey=True)
    for ax, (count, (name, _)) in zip(axes, COUNTS.items(), strict=True):
        for number, (damping, runs) in enumerate(_RUNS.items()):
            sizes, counts = waves(runs.pooled(results), count, _ORIGINS)
            label = rf"$\gamma = {damping:g}$"
            draw_sizes(ax, sizes, counts / counts.sum(), counts, number=number, label=label)
        ax.axvspan(_SPANNING, _SIZE, color="0.9", zorder=0, label="spans the system")
        entitle(ax, name)
        ax.legend(loc="lower left")
    axes[0].set_ylabel("probability $p(N_c)$")
    return figure
