"""The studies beyond the paper: every module of this folder that holds a ``STUDY``."""

from importlib import import_module
from pkgutil import iter_modules

import crazybilliards.comparison.studies as folder
from crazybilliards.comparison.claims.study import Study

STUDIES: tuple[Study, ...] = tuple(
    module.STUDY
    for module in (
        import_module(f"{folder.__name__}.{each.name}")
        for each in iter_modules(folder.__path__)  # in the order of their names
        if f"{folder.__name__}.{each.name}" != __name__
    )
    if hasattr(module, "STUDY")
)
