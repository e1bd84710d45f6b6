"""The command ``crazybilliards theory``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.answers import answer_rods, note, say, table_of, wrote
from crazybilliards.apps.commands.options import path_option, with_chain_options
from crazybilliards.apps.commands.output import conclude, write_figures, writing_to

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from crazybilliards.comparison.stationary_theories import Theory
    from crazybilliards.model import Chain

_IN_WORDS = {
    "velocity_width": "W_v of the particles 3 to L-2",
    "border": "of the first and the last",
    "displacement_width": "W_x",
    "mean_displacement": "<dx> (of s)",
    "density": "smoothed density (of close packing)",
}


@with_chain_options()
def command(
    chain: Chain,
    name: Annotated[
        str | None,
        typer.Argument(
            help="equilibrium, force_balance, phase_space (the kinetic equation) or "
            "correlated_phase_space (that with pair correlations); default: the one with the "
            "smallest expected error for the chain.",
            show_default=False,
        ),
    ] = None,
    listed: Annotated[
        bool,
        typer.Option(
            "--list", help="Only list the theories: which take the chain, their errors and times."
        ),
    ] = False,
    output: Annotated[
        Path | None,
        path_option(
            "Folder for theory.nc, density.png, profile.png and, of the kinetic equation, "
            "phase_space.png, made if missing; without it nothing is written."
        ),
    ] = None,
) -> None:
    """Predict a chain's steady state from a theory, without a simulation.

    Prints velocity widths and displacements of some rods; draws the density and the rods, of the
    kinetic equations also the phase-space density f(y, v). Without a name it takes the theory with
    the smallest expected error, and says which. Refuses where there is no steady state.

    Example: crazybilliards theory --list --restitution 0.5

    Example: crazybilliards theory --output results --restitution 1.05 --damping 4

    Example: crazybilliards theory equilibrium --amplitude 10 --gap 0.2
    """
    from crazybilliards.comparison.stationary_theories import THEORIES, choose_theory
    from crazybilliards.model.checks import check_choice

    if listed:
        _list(chain)
        return
    why = ""
    if name is None:
        theory, why = choose_theory(chain)
    else:
        theory = THEORIES[check_choice("name", name, tuple(THEORIES))]
        if reason := theory.refusal(chain):
            raise ValueError(reason)
    with writing_to(output):
        result = theory.solve(chain)
        if why:
            say(f"{why}.")
        conclude(output, result, partial(_write, theory), partial(_print, theory))


def _list(chain: Chain) -> None:
    """Print the table of theories for a chain."""
    from crazybilliards.comparison import theories

    found = theories(chain)
    rows: list[dict[Any, Any]] = found.to_dataframe().reset_index().to_dict("records")
    headings = ("W_v", "border", "W_x", "<dx>", "density")
    errors = [str(name) for name in found if str(name).endswith("_model_error")]
    columns = {name: (head, _percent) for name, head in zip(errors, headings, strict=True)}
    note(best=found.attrs["best"], theories=rows)
    table_of(
        {"theory": ("theory", str)} | columns | {"expected_seconds": ("time", "{:.2g} s".format)},
        [row for row in rows if row["takes"]],
        title=f"Theories for L = {chain.size}, e = {chain.restitution:g}; best of W_v: "
        + (found.attrs["best"] or "none"),
        caption="Largest errors of the theory itself on chains like this one: relative ones of W_v "
        "(particles 3 to L-2; border: the two at the ends) and of W_x; of the mean displacement "
        "in thermal lengths; of the smoothed density, of close packing. -: not measured. "
        "Times on one core, within a factor of three.",
    )
    for row in rows:
        if not row["takes"]:
            say(f"{row['theory']} does not take the chain: {row['reason']}")


def _percent(error: float) -> str:
    return f"{100 * error:.2g} %"


def _print(theory: Theory, result: xr.Dataset) -> None:
    from crazybilliards.comparison.widths import free_widths
    from crazybilliards.model.vocabulary import chain_of

    chain = chain_of(result)
    accuracy = {"residual": "Residual", "mesh_error": "Error due to the mesh"}
    numbers = {name: result.attrs[name] for name in accuracy if name in result.attrs}
    free = " or ".join(f"{width:.4g}" for width in free_widths(chain))
    caption = f"A free rod has W_v = {free} R/T."
    caption += "".join(f" {accuracy[name]}: {value:.1e}." for name, value in numbers.items())
    stated = theory.accuracy(chain)._asdict()
    known = {name: error for name, error in stated.items() if not math.isnan(error)}
    numbers |= {f"{name}_model_error": error for name, error in known.items()}
    if "wall_force" in result:
        numbers["wall_force"] = float(result.wall_force.mean())
        caption += f" Mean force on a wall: {numbers['wall_force']:.4g} M R/T^2."
    caption += "\n" + _caveat(known)
    note(theory=theory.name, free_velocity_width=chain.free_velocity_width, **numbers)
    title = f"{theory.title.capitalize()}, L = {chain.size}, e = {chain.restitution:g}"
    answer_rods(result, title, caption)


def _caveat(known: Mapping[str, float]) -> str:
    """Return the errors of the theory itself in words."""
    if not known:
        return "The errors of the theory were not measured for chains like this one."
    if not any(known.values()):
        return "The theory is exact for this chain."
    listed = ", ".join(f"{_IN_WORDS[name]} {_percent(error)}" for name, error in known.items())
    return f"Largest errors of the theory on chains like this one: {listed}."


def _write(theory: Theory, result: xr.Dataset, folder: Path, suffix: str) -> None:
    from crazybilliards.comparison.side_by_side.grid_figures import draw_phase_space, draw_profile
    from crazybilliards.model import save

    wrote(save(result, folder / f"theory{suffix}.nc"))
    drawings = {
        "density": partial(_draw_density, theory, result),
        "profile": partial(draw_profile, result, theory.title),
    }
    if "phase_space_density" in result:
        drawings["phase_space"] = partial(draw_phase_space, result)
    write_figures(folder, suffix, drawings)


def _draw_density(theory: Theory, result: xr.Dataset) -> Figure:
    from crazybilliards.comparison.drawing import overlay
    from crazybilliards.comparison.layout import panels
    from crazybilliards.comparison.side_by_side.grid_figures import fade, stated_error

    figure, [ax] = panels(1, 1, wanted=1)
    overlay({theory.title: result}, ax=ax).legend(loc="lower center")
    fade([(ax, ax.lines[0], stated_error(result, "density"))])
    return figure
