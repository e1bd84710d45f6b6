"""The figures of arXiv:1404.7460, one module ``figNN_name.py`` each.

Such a module has the ``TITLE`` and the ``CAPTION`` of the figure, and what else a :class:`Study` is
made of: ``draw``, and ``cases`` and ``claims`` if it has any.
"""

from importlib import import_module
from pkgutil import iter_modules

from crazybilliards.reproduction.claims.study import Study


def _figure(module_name: str) -> Study:
    module = import_module(f"{__name__}.{module_name}")
    number, _, name = module_name.removeprefix("fig").partition("_")
    return Study(
        number=int(number),
        name=name.replace("_", "-"),
        title=module.TITLE,
        caption=module.CAPTION,
        draw=module.draw,
        **{part: getattr(module, part) for part in ("cases", "claims") if hasattr(module, part)},
    )


FIGURES: tuple[Study, ...] = tuple(
    _figure(module.name)
    for module in iter_modules(__path__)  # in the order of their names
    if module.name.startswith("fig")
)
