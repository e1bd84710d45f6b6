"""The figures of arXiv:1404.7460, one module each: ``figNN_name.py`` with a ``FIGURE`` in it."""

from importlib import import_module
from pkgutil import iter_modules

from crazybilliards.comparison.claims.study import PaperFigure

FIGURES: tuple[PaperFigure, ...] = tuple(
    import_module(f"{__name__}.{module.name}").FIGURE
    for module in iter_modules(__path__)  # in the order of their names
    if module.name.startswith("fig") and module.name != "figure"
)


def find_figures(which: str) -> list[PaperFigure]:
    """Return the figures that a number, a name or ``all`` stands for.

    Raises
    ------
    ValueError
        If there is no such figure.
    """
    if which == "all":
        return list(FIGURES)
    for figure in FIGURES:
        if which in (str(figure.number), figure.name):
            return [figure]
    names = ", ".join(f"{figure.number} {figure.name}" for figure in FIGURES)
    raise ValueError(f"no figure {which!r}; there are: all, {names}")
