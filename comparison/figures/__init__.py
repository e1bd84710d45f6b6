"""The figures of arXiv:1404.7460, one module each, in the paper's order; here is their list."""

from crazybilliards.comparison.figures import (
    fig01_model,
    fig02_velocities_inelastic,
    fig03_widths_inelastic,
    fig04_central_width,
    fig05_displacements_inelastic,
    fig06_avalanches_inelastic,
    fig07_widths_restitution,
    fig08_velocities_elastic,
    fig09_displacements_restitution,
    fig10_velocities_flippers,
    fig11_velocities_flippers_damped,
    fig12_widths_damping,
    fig13_avalanches_flippers,
    fig14_widths_size,
    fig15_energy,
    fig16_arctanh,
    fig17_density,
    fig18_amplitude,
    fig19_gap,
)
from crazybilliards.comparison.figures.figure import PaperFigure

FIGURES: tuple[PaperFigure, ...] = tuple(
    module.FIGURE
    for module in (
        fig01_model,
        fig02_velocities_inelastic,
        fig03_widths_inelastic,
        fig04_central_width,
        fig05_displacements_inelastic,
        fig06_avalanches_inelastic,
        fig07_widths_restitution,
        fig08_velocities_elastic,
        fig09_displacements_restitution,
        fig10_velocities_flippers,
        fig11_velocities_flippers_damped,
        fig12_widths_damping,
        fig13_avalanches_flippers,
        fig14_widths_size,
        fig15_energy,
        fig16_arctanh,
        fig17_density,
        fig18_amplitude,
        fig19_gap,
    )
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
