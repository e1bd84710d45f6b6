"""Studies beyond the paper, one module each, with a ``STUDY`` in it."""

from importlib import import_module
from pkgutil import iter_modules

from crazybilliards.reproduction.claims.study import Study

STUDIES: tuple[Study, ...] = tuple(
    import_module(f"{__name__}.{module.name}").STUDY
    for module in iter_modules(__path__)  # in the order of their names
)
