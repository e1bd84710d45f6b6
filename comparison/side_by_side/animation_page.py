"""An animation as a page that loads nothing from other hosts and plays without a network.

Matplotlib's own page loads the signs on its buttons from another host.
"""

from __future__ import annotations

import re
from html import escape

from matplotlib.animation import FuncAnimation

from crazybilliards.model.calls import public

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
        ".animation, .animation img, input[type=range].anim-slider { width: 100%; }",
        ".fa { font-style: normal; display: inline-block; }",
        ".fa-flip-horizontal { transform: scaleX(-1); }",
        *(f'.fa-{name}::before {{ content: "{sign}"; }}' for name, sign in _SIGNS.items()),
    ]
)
_PAGE = "body { margin: 0 auto; max-width: 75rem; padding: 1rem; font-family: sans-serif; }"
# It plays at once, unless the reader has asked the browser for little motion.
_PLAYING = (
    r"\g<0>\n        if (!matchMedia('(prefers-reduced-motion: reduce)').matches)"
    r" { \1.play_animation(); }"
)


@public
def standalone_page(
    animation: FuncAnimation, fps: int | None = None, *, title: str = "", text: str = ""
) -> str:
    """Return an animation as HTML with embedded frames, for a notebook or a file.

    It is as wide as the page, and plays.

    Parameters
    ----------
    animation
        The animation, e.g. of :func:`crazybilliards.comparison.animate`.
    fps
        Frames per second; default: those of the animation.
    title, text
        For a whole page: its heading, and what to see in it. Without a title the HTML is to be put
        into a page.
    """
    player = animation.to_jshtml(fps, embed_frames=True)
    player = re.sub(r'<link rel="stylesheet"\s+href="http[^"]*">', "", player)
    player = re.sub(r"(anim\w+) = new Animation\([^)]*\);", _PLAYING, player)
    player += f"<style>{_STYLE}</style>"  # after the player's own, which it changes
    if not title:
        return player
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        f"<title>{escape(title)}</title><style>{_PAGE}</style></head>\n<body><h1>{escape(title)}</h1>"
        f"<p>{escape(text)}</p>\n{player}</body></html>\n"
    )
