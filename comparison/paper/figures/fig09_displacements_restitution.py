"""Figure 9: mean displacements for several restitutions."""

from __future__ import annotations

import itertools

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from crazybilliards.comparison.claims.repetition import estimate, pooled
from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim, positive_claim
from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods
from crazybilliards.comparison.paper.chains import LARGE, dissipative, dissipative_name
from crazybilliards.comparison.paper.figures import fig07_widths_restitution
from crazybilliards.comparison.paper.figures.fig05_displacements_inelastic import swelling
from crazybilliards.model import chain_of

_RESTITUTIONS = (0.0, 0.75, 0.85, 0.92, 0.95)


def cases(quality: Quality) -> Cases:
    """L = 1000 at five restitutions, and the kinetic equation."""
    wanted = fig07_widths_restitution.cases(quality)
    cases = {name: case for name, case in wanted.items() if name.startswith("theory")}
    for restitution in _RESTITUTIONS:
        cases |= dissipative(LARGE, restitution, quality)
    return cases


def claims(results: Results) -> list[Claim]:
    """Check: displacements grow with e."""
    found = {e: estimate(results, dissipative_name(LARGE, e), swelling) for e in _RESTITUTIONS}
    predicted = {
        e: swelling(theory) for e, theory in fig07_widths_restitution.theories(results).items()
    }
    return [
        positive_claim(
            f"the mean displacement grows from e = {low:g} to {high:g}",
            f"slope of <dx> against i_n: {found[low]} and {found[high]}, difference",
            found[high].minus(found[low]),
            source="section seq:e_larger, fig.5",
            theory=", ".join(f"{e:g}: {predicted[e]:.3f}" for e in (low, high) if e in predicted),
        )
        for low, high in itertools.pairwise(_RESTITUTIONS)
    ]


def draw(results: Results) -> Figure:
    """Draw <dx> against i_n with the kinetic equation."""
    figure, ax = plt.subplots(figsize=(5.6, 4.2), layout="constrained")
    predicted = fig07_widths_restitution.theories(results)
    for number, e in enumerate(_RESTITUTIONS):
        run = pooled(results, dissipative_name(LARGE, e))
        s = chain_of(run).thermal_length
        draw_rods(ax, run, "mean_displacement", number=number, unit=s, label=f"e = {e:g}")
        if e in predicted:
            theory = predicted[e]
            ax.plot(theory.normalized_particle, theory.mean_displacement / s, color=COLOURS[number])
    along_the_chain(ax)
    ax.set_ylim(-0.7, 0.7)
    ax.set(ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
    ax.legend(frameon=False, title="symbols: simulation\nlines: kinetic equation")
    return figure


FIGURE = PaperFigure(
    number=9,
    name="displacements-restitution",
    title="Mean displacements for several restitutions",
    caption="Mean displacement against the normalized particle number, L = 1000, in units of the "
    "thermal length s. Lines: the kinetic equation. The outermost rods lie beyond the frame.",
    cases=cases,
    draw=draw,
    claims=claims,
)
