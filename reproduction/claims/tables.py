"""Tables of numbers in Markdown, and how a number and its error are written in them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def markdown_table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table of texts, every row as long as the heads."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def percent(*shares: float) -> str:
    """Return deviations in per cent with their signs: ``-0.145, 0.02`` gives ``-14.5, +2.0``."""
    return ", ".join(f"{100 * share:+.1f}" for share in shares)
