"""The figures of arXiv:1404.7460, one module each: ``figNN_name.py`` with a ``FIGURE`` in it."""

from importlib import import_module
from pkgutil import iter_modules

from crazybilliards.reproduction.claims.study import Study

FIGURES: tuple[Study, ...] = tuple(
    import_module(f"{__name__}.{module.name}").FIGURE
    for module in iter_modules(__path__)  # in the order of their names
    if module.name.startswith("fig")
)
