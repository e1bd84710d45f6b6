"""The table of a folder's cases: which parameters differ between them, and which file is whose."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from crazybilliards.comparison.sweeps.case import stored_parameters
from crazybilliards.model import Chain
from crazybilliards.model.checks import as_written
from crazybilliards.model.process import interrupts_held_back
from crazybilliards.model.storage import load_attributes, write_atomically

INDEX = "index.csv"
CHAIN = [field.name for field in fields(Chain)]


def write_index(folder: Path) -> None:
    """Write ``index.csv``: the parameters in which the cases of a folder differ, and their files.

    A file that is damaged or holds no case is left out. Nothing is written without a case, or if
    the table is there already.
    """
    points, names = [], []
    for path in sorted(folder.glob("*.nc")):
        try:
            point = stored_parameters(load_attributes(path))
        except (OSError, ValueError):
            continue
        if point:
            points.append(point)
            names.append(path.name)
    if not points:
        return
    with interrupts_held_back():  # as in ``varied``
        table = varied(points).assign(file=names)
        first = table.iloc[:, 0]
        order = np.argsort(first.astype(str) if first.dtype == object else first, kind="stable")
        text = table.iloc[order].to_csv(index=False)
    content, file = text.encode(), folder / INDEX
    if not file.is_file() or file.read_bytes() != content:
        write_atomically(file, content)


# A Ctrl-C in Python code that numpy calls to look at a kind of data would be lost.
@interrupts_held_back()
def varied(points: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return a column for each parameter that differs between the cases, those of a chain first."""
    table = pd.DataFrame([{name: scalar(value) for name, value in each.items()} for each in points])
    names = [*CHAIN, *(str(name) for name in table if name not in CHAIN)]
    columns = {}
    for name in names:
        tidy, different = table[name].map(as_written), table[name].nunique(dropna=False)
        if different > 1:  # old cases may be at .3 and at .1 + .2
            columns[name] = tidy if tidy.nunique(dropna=False) == different else table[name]
    return pd.DataFrame(columns, index=table.index)


def scalar(value: Any) -> Any:
    """Return a value that can be a coordinate; a list becomes text."""
    return json.dumps(value) if isinstance(value, list) else value
