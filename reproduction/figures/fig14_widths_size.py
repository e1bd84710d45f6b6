"""Figure 14: velocity widths of flippers for several sizes: concave, convex, then divergence."""

from __future__ import annotations

from functools import partial

from matplotlib.figure import Figure

from crazybilliards.comparison.widths import central_width
from crazybilliards.model import Chain
from crazybilliards.reproduction.chains import flippers, kinetic_equation
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
_BESIDE = [each[size] for size in _SIZES for each in (_RUNS, _THEORIES)]
_claim = partial(Claim, source="section Anti-Dissipation, fig:antidiss_diff_L")
cases = partial(all_of, [*_BESIDE, _UNSTEADY])


def claims(results: Results) -> list[Claim]:
    """Check: concave for short chains, convex for long ones, then no steady state."""
    found = {size: runs.estimate(results, bulge) for size, runs in _RUNS.items()}
    unsteady = _UNSTEADY.members(results)
    diverged = sum(run.attrs["status"] == "diverged" for run in unsteady)
    short, long = _SIZES[0], _SIZES[-1]
    return [
        _claim(
            f"concave at L = {short}",
            "ln of the centre's width over the border's:",
            found=-found[short],
        ),
        _claim(
            f"convex at L = {long}",
            "ln of the border's width over the centre's:",
            found=found[long],
        ),
        _claim(
            "the longer the chain, the larger W_v",
            f"W_v in the centre at L = {long} less that at L = {short}:",
            found=_RUNS[long]
            .estimate(results, central_width)
            .minus(_RUNS[short].estimate(results, central_width)),
        ),
        _claim(
            f"without a steady state at L = {_UNSTEADY.chain.size}",
            f"{diverged} of {len(unsteady)} runs, released from rest, diverged; their share, as "
            "far as so few runs show it:",
            found=share_of_runs(diverged, len(unsteady)),
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
