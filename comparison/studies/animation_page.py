"""An animation as a page that loads nothing from other hosts and plays without a network.

Matplotlib's own page loads the signs on its buttons from another host.
"""

from __future__ import annotations

import re

from matplotlib.animation import FuncAnimation

# The classes of matplotlib's buttons, and the characters shown instead.
_SIGNS = {
    "minus": r"\2212",
    "fast-backward": r"|\25C0",
    "step-backward": r"\25C0|",
    "play": r"\25B6",
    "pause": r"||",
    "step-forward": r"|\25B6",
    "fast-forward": r"\25B6|",
    "plus": "+",
}
_STYLE = "\n".join(
    [
        ".fa { font-style: normal; display: inline-block; }",
        ".fa-flip-horizontal { transform: scaleX(-1); }",
        *(f'.fa-{name}::before {{ content: "{sign}"; }}' for name, sign in _SIGNS.items()),
    ]
)


def standalone_page(animation: FuncAnimation, fps: int | None = None) -> str:
    """Return an animation as HTML with embedded frames, for a notebook or a file.

    Parameters
    ----------
    animation
        The animation, e.g. of :func:`crazybilliards.comparison.animate`.
    fps
        Frames per second; default: those of the animation.
    """
    page = animation.to_jshtml(fps, embed_frames=True)
    return re.sub(
        r'<link rel="stylesheet"\s+href="http[^"]*">', lambda _: f"<style>{_STYLE}</style>", page
    )
