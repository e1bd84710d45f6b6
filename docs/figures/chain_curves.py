"""Compute the theory's velocity widths that the chain's page draws without a server.

Run it to write apps/explore/page/curves.js. It solves the best theory for the chains of the page's
challenges and of a question, and finds the damping at which the profile of the latter turns. It
takes a minute.
"""

import json
from pathlib import Path

import numpy as np
import xarray as xr

from crazybilliards.comparison.stationary_theories import best_theory
from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.model import Chain

CURVES = Path(__file__).parents[2] / "apps" / "explore" / "page" / "curves.js"
SHOWN = ("size", "restitution", "damping", "gap")  # all have A = 1 and linear springs
TURNING = Chain(size=60, restitution=1.05)  # at which damping is it as hot outside as inside?
DAMPINGS = (2.5, 3.0, 3.5, 5.0)
SEEN = (2.5, 5.0)  # of which the page has a question
CHALLENGES = (
    Chain(size=20, restitution=0.9, damping=0.3, gap=0.5),
    Chain(size=20, restitution=0.9),
)


def solved(chain: Chain) -> xr.Dataset:
    """Solve the theory with the smallest stated error of W_v."""
    return best_theory(chain).solve(chain)


def stored(chain: Chain, theory: xr.Dataset) -> dict[str, object]:
    """Return a chain, the errors of its theory and the widths of its left half, in free widths."""
    best = best_theory(chain)
    widths = theory.velocity_width.values / chain.free_velocity_width
    half = widths[: (chain.size + 1) // 2]
    errors = best.accuracy(chain)
    return {name: getattr(chain, name) for name in SHOWN} | {
        "title": best.title,
        "error": None if np.isnan(errors.velocity_width) else round(errors.velocity_width, 4),
        "border": None if np.isnan(errors.border) else round(errors.border, 4),
        "half": [round(w, 3) for w in half],
    }


def turning(theories: dict[float, xr.Dataset]) -> float:
    """Interpolate where the border is as hot as the centre."""
    bulge = [np.log(border_width(each) / central_width(each)) for each in theories.values()]
    return float(np.interp(0.0, bulge[::-1], list(theories)[::-1]))


def script() -> str:
    """Solve the theories; return the page's script with their curves."""
    theories = {damping: solved(TURNING.replace(damping=damping)) for damping in DAMPINGS}
    curves = [stored(TURNING.replace(damping=g), theories[g]) for g in SEEN]
    curves += [stored(chain, solved(chain)) for chain in CHALLENGES]
    lines = ",\n".join(f"    {json.dumps(each, separators=(',', ':'))}" for each in curves)
    return (
        "/* Velocity widths by the best theory, of the rods of the left half, in free widths.\n"
        "   Written by docs/figures/chain_curves.py. */\n"
        f'"use strict";\n\nconst ChainCurves = {{\n  widths: [\n{lines},\n  ],\n'
        f"  turning: {{ damping: {turning(theories):.1f} }},\n}};\n"
    )


if __name__ == "__main__":
    CURVES.write_text(script(), encoding="utf-8")
