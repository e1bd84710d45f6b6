"""Tables of a study's numbers, and how a number and its error are written in them."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence

Table = Sequence[Sequence[str]]
"""Rows of texts, the first one with the heads of the columns."""

Tables = Mapping[str, Table]
"""Tables by the names of their files."""


def as_csv(table: Table) -> bytes:
    """Return a table as a file of comma-separated values."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(table)
    return text.getvalue().encode()


def percent(*shares: float) -> str:
    """Return deviations in per cent with their signs: ``-0.145, 0.02`` gives ``-14.5, +2.0``."""
    return ", ".join(f"{100 * share:+.1f}" for share in shares)
