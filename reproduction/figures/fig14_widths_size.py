"""Figure 14: velocity widths of flippers for several sizes: concave, convex, then divergence."""

from __future__ import annotations

from functools import partial

from matplotlib.figure import Figure

from crazybilliards.comparison.widths import central_width
from crazybilliards.model import Chain
from crazybilliards.reproduction.chains import OTHER_STEP, at_other_step, flippers, kinetic_equation
from crazybilliards.reproduction.claims.repetition import Runs, share_of_runs
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim
from crazybilliards.reproduction.figures.fig12_widths_damping import bulge
from crazybilliards.reproduction.predictions import draw_flippers

TITLE = "Velocity widths of flippers for several sizes"
CAPTION = (
    "W_v against the normalized particle number, e = 1.05, gamma = 4. Lines: the kinetic equation. "
    "Longer chains have no steady state: L = 150 diverges."
)

_DAMPING, _RESTITUTION = 4.0, 1.05
_SIZES = (25, 50, 75, 100, 105)
_RUNS = {size: flippers(size, _DAMPING) for size in _SIZES}
_THEORIES = {size: kinetic_equation(size, _RESTITUTION, _DAMPING) for size in _SIZES}
_UNSTEADY = Runs(
    "unsteady",
    Chain(size=150, restitution=_RESTITUTION, damping=_DAMPING),
    {"quick": (4, {}), "full": (4, {})},
    {"duration": 1000.0, "warmup": 0.0, "observe": ["energy"]},
)
_AGAIN = {size: at_other_step(runs) for size, runs in _RUNS.items()}
_UNSTEADY_AGAIN = _UNSTEADY.at_step(OTHER_STEP, _UNSTEADY.granted)
_THERE = f"dt = {OTHER_STEP:g}"
_BESIDE = [each[size] for size in _SIZES for each in (_RUNS, _THEORIES)]
_claim = partial(Claim, source="section Anti-Dissipation, fig:antidiss_diff_L")
cases = partial(all_of, [*_BESIDE, *_AGAIN.values(), _UNSTEADY, _UNSTEADY_AGAIN])


def claims(results: Results) -> list[Claim]:
    """Check: concave for short chains, convex for long ones, then no steady state."""
    found, again = (
        {size: runs.estimate(results, bulge) for size, runs in every.items()}
        for every in (_RUNS, _AGAIN)
    )
    growth, growth_again = (
        every[_SIZES[-1]]
        .estimate(results, central_width)
        .minus(every[_SIZES[0]].estimate(results, central_width))
        for every in (_RUNS, _AGAIN)
    )
    diverged, diverged_again = (
        [run.attrs["status"] == "diverged" for run in runs.members(results)]
        for runs in (_UNSTEADY, _UNSTEADY_AGAIN)
    )
    short, long = _SIZES[0], _SIZES[-1]
    return [
        _claim(
            f"concave at L = {short}",
            "ln of the centre's width over the border's:",
            found=-found[short],
            elsewhere={_THERE: -again[short]},
        ),
        _claim(
            f"convex at L = {long}",
            "ln of the border's width over the centre's:",
            found=found[long],
            elsewhere={_THERE: again[long]},
        ),
        _claim(
            "the longer the chain, the larger W_v",
            f"W_v in the centre at L = {long} less that at L = {short}:",
            found=growth,
            elsewhere={_THERE: growth_again},
        ),
        _claim(
            f"without a steady state at L = {_UNSTEADY.chain.size}",
            f"{sum(diverged)} of {len(diverged)} runs, released from rest, diverged; their "
            "share, as far as so few runs show it:",
            found=share_of_runs(sum(diverged), len(diverged)),
            elsewhere={_THERE: share_of_runs(sum(diverged_again), len(diverged_again))},
            ours="the size that is too large",
        ),
    ]


def draw(results: Results) -> Figure:
    """Draw W_v(i) for every size with the kinetic equation."""
    shown = {
        f"$L = {size}$": (runs, _THEORIES[size], runs.chain.free_velocity_width)
        for size, runs in _RUNS.items()
    }
    return draw_flippers(results, shown, "velocity width $W_v/W$")
