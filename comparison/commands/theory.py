"""The command ``crazybilliards theory``.

Only the standard library and typer are imported up here, so that ``--help`` answers at once.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crazybilliards.comparison.commands.output import check_folder, write_figures

if TYPE_CHECKING:
    import xarray as xr

    from crazybilliards.model import Chain


def theory(
    output: Annotated[
        Path | None,
        typer.Option(
            help="Folder for theory.nc, phase_space.png and profile.png, made if missing; without "
            "it nothing is written."
        ),
    ] = None,
    size: Annotated[int, typer.Option(help="Number of rods L.")] = 100,
    restitution: Annotated[float, typer.Option(help="Restitution e, near 1.")] = 0.95,
    amplitude: Annotated[float, typer.Option(help="Driving amplitude A.")] = 1.0,
    damping: Annotated[float, typer.Option(help="Damping gamma [M/T].")] = 1.0,
    gap: Annotated[float, typer.Option(help="Gap g between rods at their anchors [R].")] = 0.0,
    spring: Annotated[str, typer.Option(help="linear or quadratic.")] = "linear",
    tolerance: Annotated[
        float, typer.Option(help="Largest relative error of a width due to the mesh.")
    ] = 2e-3,
    critical: Annotated[
        bool, typer.Option(help="For e > 1 also work out the critical size (some 20 s).")
    ] = False,
) -> None:
    """Predict a chain's steady state from the kinetic equation, without a simulation.

    Prints velocity widths and displacements of some rods; draws them, and the phase-space density
    f(y, v). Good for restitutions of 0.9 to 1.05; refuses where there is no steady state.

    Example: crazybilliards theory --output results --restitution 1.05 --damping 4 --critical
    """
    from rich.console import Console

    from crazybilliards.kinetic import critical_size, phase_space
    from crazybilliards.model import Chain

    if output is not None:
        check_folder(output)
    chain = Chain(
        size=size,
        restitution=restitution,
        amplitude=amplitude,
        damping=damping,
        gap=gap,
        spring=spring,  # type: ignore[arg-type]
    )
    waiting = Console(stderr=True)  # shows nothing unless it is a terminal
    if critical:
        with waiting.status("working out the critical size"):
            value, error = critical_size(chain)
        print(f"critical size: {value:.1f} +- {error:.1f} rods")
    with waiting.status("solving the kinetic equation"):
        result = phase_space(chain, tolerance=tolerance)
    if output is not None:
        _write(result, output)
    _print(chain, result)
    if output is None:
        print("Nothing was written; --output FOLDER keeps the figures and the data.")


def _write(result: xr.Dataset, folder: Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from crazybilliards.comparison.studies.restitution_figures import (
        draw_phase_space,
        draw_profile,
    )
    from crazybilliards.model import save

    print(f"wrote {save(result, folder / 'theory.nc')}")
    write_figures(folder, "", phase_space=draw_phase_space(result), profile=draw_profile(result))


def _print(chain: Chain, result: xr.Dataset) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(
        title=f"Kinetic equation, L = {chain.size}, e = {chain.restitution:g}",
        caption=f"A free rod has W_v = {chain.free_velocity_width:.4g}. Error due to the mesh: "
        f"{result.attrs['mesh_error']:.1e}.",
    )
    for name in ("particle", "W_v", "<dx>"):
        table.add_column(name, justify="right")
    L = chain.size
    for i in sorted({1, 2, max(L // 10, 1), max(L // 4, 1), max(L // 2, 1)} & set(range(1, L + 1))):
        rod = result.sel(particle=i)
        width, displacement = float(rod.velocity_width), float(rod.mean_displacement)
        table.add_row(str(i), f"{width:.4g}", f"{displacement:.4g}")
    Console().print(table)
