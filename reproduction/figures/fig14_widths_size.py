"""Figure 14: velocity widths of flippers for several sizes: concave, convex, then divergence."""

from __future__ import annotations

from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.widths import central_width
from crazybilliards.kinetic.kinetic_equation.weak_damping import weak_damping_critical_size
from crazybilliards.model import Chain, chain_of
from crazybilliards.reproduction.chains import (
    flippers,
    flippers_name,
    kinetic_equation,
    kinetic_name,
)
from crazybilliards.reproduction.claims.repetition import (
    estimate,
    members,
    pooled,
    repeated,
    share_of_runs,
)
from crazybilliards.reproduction.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, positive_claim
from crazybilliards.reproduction.figures.fig12_widths_damping import bulge

_DAMPING, _RESTITUTION = 4.0, 1.05
_SIZES = (25, 50, 75, 100, 105)
_UNSTEADY = 150
_SOURCE = "section Anti-Dissipation, fig:antidiss_diff_L"


def cases(quality: Quality) -> Cases:
    """E = 1.05, gamma = 4, five sizes with the kinetic equation, and one that diverges."""
    cases: Cases = {}
    for size in _SIZES:
        cases |= flippers(size, _DAMPING, quality)
        cases |= kinetic_equation(size, _RESTITUTION, _DAMPING, quality)
    chain = Chain(size=_UNSTEADY, restitution=_RESTITUTION, damping=_DAMPING)
    return cases | repeated("unsteady", chain, 4, duration=1000.0, warmup=0.0, observe=["energy"])


def claims(results: Results) -> list[Claim]:
    """Check: concave for short chains, convex for long ones, then no steady state."""
    found = {size: estimate(results, flippers_name(size, _DAMPING), bulge) for size in _SIZES}
    theory = {size: bulge(results[kinetic_name(size, _RESTITUTION, _DAMPING)]) for size in _SIZES}
    critical = weak_damping_critical_size(Chain(restitution=_RESTITUTION, damping=_DAMPING))
    unsteady = members(results, "unsteady")
    diverged = sum(run.attrs["status"] == "diverged" for run in unsteady)
    short, long = _SIZES[0], _SIZES[-1]
    return [
        positive_claim(
            f"concave at L = {short}",
            "ln of the centre's width over the border's:",
            Estimate(-found[short].value, found[short].error),
            source=_SOURCE,
            theory=f"{-theory[short]:+.3f}",
        ),
        positive_claim(
            f"convex at L = {long}",
            "ln of the border's width over the centre's:",
            found[long],
            source=_SOURCE,
            theory=f"{theory[long]:+.3f}",
        ),
        positive_claim(
            "the longer the chain, the larger W_v",
            f"W_v in the centre at L = {long} less that at L = {short}:",
            estimate(results, flippers_name(long, _DAMPING), central_width).minus(
                estimate(results, flippers_name(short, _DAMPING), central_width)
            ),
            source=_SOURCE,
        ),
        positive_claim(
            f"without a steady state at L = {_UNSTEADY}",
            f"{diverged} of {len(unsteady)} runs, released from rest, diverged; their share, as "
            "far as so few runs show it:",
            share_of_runs(diverged, len(unsteady)),
            source=_SOURCE,
            ours="the size that is too large",
            theory=f"no steady state beyond L = {critical:.0f} (weak damping)",
        ),
    ]


def draw(results: Results) -> Figure:
    """Draw W_v(i) for every size with the kinetic equation."""
    figure, [ax] = panels(1, 1, height=3.1, wanted=1)
    for number, size in enumerate(_SIZES):
        run = pooled(results, flippers_name(size, _DAMPING))
        unit = chain_of(run).free_velocity_width
        draw_rods(ax, run, "velocity_width", number=number, unit=unit, label=f"$L = {size}$")
        theory = results[kinetic_name(size, _RESTITUTION, _DAMPING)]
        ax.plot(theory.normalized_particle, theory.velocity_width / unit, color=COLOURS[number])
    along_the_chain(ax)
    ax.set(ylabel="velocity width $W_v/W$")
    ax.plot([], [], color="0.4", label="kinetic equation")
    legend_above(figure, ax)
    return figure


FIGURE = PaperFigure(
    number=14,
    name="widths-size",
    title="Velocity widths of flippers for several sizes",
    caption="W_v against the normalized particle number, e = 1.05, gamma = 4. Lines: the kinetic "
    "equation. Longer chains have no steady state: L = 150 diverges.",
    cases=cases,
    draw=draw,
    claims=claims,
)
