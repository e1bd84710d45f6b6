"""The commands that put simulated chains and their theories side by side: compare and relax."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

from typer import Option

from crazybilliards.apps.commands.options import Json, Output, Seed, Threads, chain_options, numbers
from crazybilliards.apps.commands.output import conclude, picture, table, writing_to

if TYPE_CHECKING:
    import xarray as xr

    from crazybilliards.model import Chain

_COLUMNS = {
    "amplitude": "A",
    "restitution": "e",
    "theory": "theory",
    "density_maximum": "rho\nmax\n[%]",
    "density_rms": "rho\nrms\n[%]",
    "density_maximum_in_errors": "rho\nmax\n[se]",
    "velocity_width_largest": "W_v\nmax\n[%]",
    "velocity_width_stated": "W_v\nstated\n[%]",
    "velocity_width_centre": "W_v\nmid\n[%]",
    "velocity_width_border": "W_v\nends\n[%]",
    "velocity_width_largest_in_errors": "W_v\nmax\n[se]",
}
_CAPTION = (
    "How far theories are from the simulation. rho, smoothed as in the paper, in % of close "
    "packing 1/(2R): largest vertical difference, root mean square, and the largest in standard "
    "errors (se) of the simulation; 3 to 4 is normal for the largest of many. W_v, theory minus "
    "simulation: the largest of the particles 3 to L-2; the largest that the theory states (-: not "
    "measured for chains like this one); of the middle tenth; of the first and the last; the "
    "largest of all in standard errors."
)


@chain_options("amplitude", "restitution")
def compare(
    chain: Chain,
    *,
    output: Output = None,
    amplitude: str | None = Option(
        None, help="Values of A [M R/t_0^(3/2)], separated by commas; default: 1,3,10,30, with e 1."
    ),
    restitution: str | None = Option(None, help="Values of e, separated by commas; default: 1."),
    duration: float = Option(100_000.0, help="Simulated time of each of two replicas [t_0]."),
    seed: Seed = 0,
    processes: int | None = Option(None, help="Processes; default: this one, in threads."),
    threads: Threads = None,
    as_json: Json = False,
) -> None:
    """Compare simulated chains with their theories.

    Several values of the amplitude, or of the restitution, make as many chains. If all are elastic
    they are compared with the exact equilibrium and force balances, otherwise with the gas. Draws
    everything over one another and prints how far apart it is. After Ctrl-C, a crash, or with more
    chains, the same command computes what FOLDER/cases lacks.

    Example: crazybilliards compare --output results --amplitude 1,10 --gap 0.2

    Example: crazybilliards compare --output results --restitution 0.9,0.95,0.98
    """
    from crazybilliards.comparison.side_by_side import grid
    from crazybilliards.comparison.side_by_side import grid_figures as figures

    amplitude = amplitude or ("1,3,10,30" if restitution is None else "1")
    values = {
        "amplitude": numbers("amplitude", amplitude),
        "restitution": numbers("restitution", restitution or "1"),
    }
    if min(map(len, values.values())) > 1:
        raise ValueError("give several values of amplitude or of restitution, not of both")
    several = [name for name, listed in values.items() if len(listed) > 1]
    [over] = several or ["amplitude" if restitution is None else "restitution"]
    chain = chain.replace(**{name: listed[0] for name, listed in values.items()})
    with writing_to(output, "comparison.nc"):
        tree = grid.compare(
            chain,
            {over: values[over]},
            folder=output and output / "cases",
            duration=duration,
            seed=seed,
            processes=processes,
            threads=threads,
        )
        rows = _deviations(over, tree)
        known = {name for row in rows for name in row}  # chains may have no theory
        shown = table({n: _COLUMNS[n] for n in _COLUMNS if n in known}, rows, _CAPTION)
        # A chain that diverged before anything was measured cannot be drawn.
        names = {n for n, group in tree.children.items() if "particle" in group["simulation"].dims}
        drawn = tree.filter(lambda node: node.path.split("/")[1] in names)
        pictures = {
            "density.png": picture(figures.draw_density, drawn),
            "displacement.png": picture(figures.draw_displacement, drawn),
            "widths.png": picture(figures.draw_widths, drawn),
        }
        conclude(
            tree,
            output,
            "comparison.nc",
            pictures if names else {},
            as_json,
            {"deviations": rows},
            shown,
        )


def _deviations(over: str, tree: xr.DataTree) -> list[dict[str, Any]]:
    """Return how far each theory is from its simulation."""
    from crazybilliards.comparison.distances import deviations

    rows = []
    for name, group in tree.children.items():
        status = group["simulation"].attrs["status"]
        named = {over: float(name.removeprefix(f"{over}_")), "status": status}
        for key, found in deviations(group).items():
            row = named | {"theory": key}
            row |= {f"density_{name}": value for name, value in asdict(found.density).items()}
            if found.velocity_width:
                width = found.velocity_width._asdict()
                row |= {f"velocity_width_{name}": value for name, value in width.items()}
                row["velocity_width_stated"] = group[key].attrs["velocity_width_model_error"]
            rows.append(row)
        if status == "diverged" or len(group.children) == 1:  # no theory to compare with
            rows.append(named)
    return rows


@chain_options(amplitude=30.0)
def relax(
    chain: Chain,
    *,
    output: Output = None,
    release: Literal[
        "compressed", "displaced", "quenched", "gathered", "wave", "confined"
    ] = Option("compressed", help="What it starts from; the last three in a box."),
    by: float | None = Option(
        None,
        help="Factor of y (compressed), thermal lengths (displaced), factor of the amplitude "
        "(quenched); default: 0.3, 2, 3. In a box share of the room, or height of a wave: 0.5.",
    ),
    duration: float = Option(40.0, help="Time to follow [t_0]."),
    every: float = Option(0.5, help="Time between outputs [t_0]."),
    replicas: int = Option(300, help="Simulated chains to average over."),
    seed: Seed = 0,
    threads: Threads = None,
    film: bool = Option(False, "--film", help="Also write relaxation.html, a film."),
    as_json: Json = False,
) -> None:
    """Release a chain and follow it: rods, fluids and, at e = 1, the exact solution.

    Prints how far the rods are from where each theory has them, and draws the densities, which
    relaxation.nc holds smoothed. Ctrl-C or SIGTERM stops early: what has been computed is written
    under names with "-interrupted".

    Example: crazybilliards relax --output results --release gathered --box 400 --stiffness 0
    """
    from crazybilliards.comparison import film as write_film
    from crazybilliards.comparison.side_by_side import relaxation
    from crazybilliards.comparison.side_by_side import relaxation_figures as figures

    if film and output is None:
        raise ValueError("film needs --output FOLDER, into which it is written")
    if by is None:
        by = {"compressed": 0.3, "displaced": 2.0, "quenched": 3.0}.get(release, 0.5)
    with writing_to(output, "relaxation.nc"):
        tree = relaxation.compare_relaxation(
            chain,
            release,
            by,
            duration=duration,
            every=every,
            replicas=replicas,
            seed=seed,
            threads=threads,
        )
        tree = relaxation.condensed(tree)
        pictures: dict[str, Any] = {
            "spacetime.png": picture(figures.draw_spacetime, tree),
            "profiles.png": picture(figures.draw_profiles, tree),
            "cloud.png": picture(figures.draw_cloud, tree),
        }
        if film:
            pictures["relaxation.html"] = partial(write_film, tree)
        distances = [
            {"theory": key, "title": relaxation.LEGEND[key], "distance": distance}
            for key, distance in relaxation.label_distances(tree).items()
        ]
        shown = table(
            {"title": "theory", "distance": "rms distance"},
            distances,
            "Of the rods' mean positions in theory from those simulated, in thermal "
            "lengths, without springs in halves of the free room, at the time when it is largest.",
        )
        conclude(tree, output, "relaxation.nc", pictures, as_json, {"distances": distances}, shown)
