"""Figure 6: sizes of avalanches in the perfectly inelastic chain, by origin."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from crazybilliards.comparison.claims.repetition import estimate, pooled, repeated
from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim, Estimate, number_claim, positive_claim
from crazybilliards.comparison.fits import fit_avalanches
from crazybilliards.comparison.paper.chains import LARGE
from crazybilliards.comparison.paper.distributions import draw_sizes
from crazybilliards.model import Chain

_STEPS = (1e-2, 1e-3)
_DURATION = {"quick": (2, 50.0), "full": (6, 300.0)}
_ORIGINS = {"centre": slice(451, 550), "quarter": slice(201, 300), "border": slice(51, 150)}
_FITTED = (20, 150)  # sizes: beyond the clusters of one step, below the length of the chain
_PAPER, _PRECISION = -2.2, 0.1


def cases(quality: Quality) -> Cases:
    """L = 1000, e = 0, at two time steps."""
    number, duration = _DURATION[quality]
    cases: Cases = {}
    for step in _STEPS:
        cases |= repeated(
            f"dt={step:g}",
            Chain(size=LARGE, restitution=0.0),
            number,
            duration=duration,
            warmup=60.0,
            time_step=step,
            observe=["avalanches"],
        )
    return cases


def _counts(run: xr.Dataset, origin: str) -> NDArray[np.float64]:
    chosen = run.avalanche_count.sel(particle=_ORIGINS[origin])
    return np.asarray(chosen.sum("particle"), dtype=float)


def _exponent(results: Results, origin: str, step: float) -> Estimate:
    smallest, largest = _FITTED

    def fitted(run: xr.Dataset) -> float:
        return -fit_avalanches(_counts(run, origin), smallest=smallest, largest=largest).exponent

    return estimate(results, f"dt={step:g}", fitted)


def claims(results: Results) -> list[Claim]:
    """Check: a power law near -2.2."""
    found = {step: _exponent(results, "centre", step) for step in _STEPS}
    coarse, fine = _STEPS
    border = _exponent(results, "border", coarse)
    sizes = f"N_c = {_FITTED[0]} to {_FITTED[1]}"
    return [
        *(
            number_claim(
                f"p(N_c) ~ N_c^-2.2 near the centre ({sizes}, dt = {step:g})",
                _PAPER,
                _PRECISION,
                found[step],
                reason="the exponent depends on the time step: rods in contact are kicked apart "
                "and collide again in every step, and the shorter the step, the sooner a wave "
                f"meets such a collision; dt = {coarse:g}: {found[coarse]}, dt = {fine:g}: "
                f"{found[fine]}",
            )
            for step in _STEPS
        ),
        positive_claim(
            "steeper towards the border",
            f"exponent of the centre less that of origins 51 to 150 ({border}), dt = {coarse:g}:",
            found[coarse].minus(border),
        ),
    ]


def draw(results: Results) -> Figure:
    """Draw p(N_c) by origin for both time steps."""
    figure, axes = plt.subplots(1, 2, figsize=(9.2, 3.7), layout="constrained", sharey=True)
    for ax, step in zip(axes, _STEPS, strict=True):
        run = pooled(results, f"dt={step:g}")
        for number, origin in enumerate(_ORIGINS):
            counts = _counts(run, origin)
            edges = np.unique(np.round(np.geomspace(1, LARGE, 28)).astype(int))
            total = np.add.reduceat(counts, edges[:-1] - 1)
            p = total / counts.sum() / np.diff(edges)
            middle = np.sqrt(edges[:-1] * (edges[1:] - 1.0))
            at = _ORIGINS[origin]
            label = f"origins {at.start} to {at.stop}"
            draw_sizes(ax, middle, p, total, number=number, label=label)
        line = np.array([3.0, 400.0])
        anchor = np.interp(30, middle, p)
        ax.plot(line, anchor * (line / 30) ** _PAPER, "k--", linewidth=1, label="$N_c^{-2.2}$")
        ax.set(title=f"dt = {step:g}", ylim=(1e-9, 1))
    axes[0].set_ylabel("probability $p(N_c)$")
    axes[0].legend(frameon=False, fontsize=8)
    return figure


FIGURE = PaperFigure(
    number=6,
    name="avalanches-inelastic",
    title="Avalanche sizes at e = 0",
    caption="Probability of a rightward wave of N_c collisions, by origin, L = 1000, e = 0, at two "
    "time steps. Rods that stick together pass a push on from one to the next. Error bars: "
    "counting statistics. The exponents in the table are maximum-likelihood estimates.",
    cases=cases,
    draw=draw,
    claims=claims,
)
