"""Compute the theory's velocity widths that the chain's page draws without a server.

Run it to write apps/explore/page/curves.js. It solves the theory of the chains of the page's
challenges. It takes a second.
"""

import json
from pathlib import Path

from crazybilliards.comparison.stationary_theories import theory_of
from crazybilliards.model import Chain

CURVES = Path(__file__).parents[2] / "apps" / "explore" / "page" / "curves.js"
SHOWN = ("size", "restitution", "damping", "gap")  # all have A = 1 and linear springs
CHALLENGES = (
    Chain(size=20, restitution=0.9, damping=0.3, gap=0.5),
    Chain(size=20, restitution=0.9),
)


def solved(chain: Chain) -> dict[str, object]:
    """Return a chain, the errors of its theory and the widths of its left half, in free widths."""
    theory = theory_of(chain)
    result = theory.solve(chain)
    half = result.velocity_width.values[: (chain.size + 1) // 2] / chain.free_velocity_width
    errors = {
        key: result.attrs[f"{name}_model_error"]
        for key, name in (("error", "velocity_width"), ("border", "border"))
    }
    return {
        **{name: getattr(chain, name) for name in SHOWN},
        "title": theory.title,
        # NaN, not measured, is null.
        **{key: round(error, 4) if error == error else None for key, error in errors.items()},
        "half": [round(width, 3) for width in half],
    }


def script() -> str:
    """Solve the theories; return the page's script with their curves."""
    lines = ",\n".join(
        f"    {json.dumps(solved(chain), separators=(',', ':'))}" for chain in CHALLENGES
    )
    return (
        "/* Velocity widths by the theory, of the rods of the left half, in free widths.\n"
        "   Written by docs/figures/chain_curves.py. */\n"
        f'"use strict";\n\nconst ChainCurves = {{\n  widths: [\n{lines},\n  ],\n}};\n'
    )


if __name__ == "__main__":
    CURVES.write_text(script(), encoding="utf-8")
