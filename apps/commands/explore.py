"""The command ``crazybilliards explore``."""

from __future__ import annotations

from typing import Annotated

import typer

from crazybilliards.apps.commands.output import INTERRUPTED


def command(
    port: Annotated[int, typer.Option(help="Port to serve the page at; 0: any free one.")] = 5006,
    address: Annotated[
        str, typer.Option(help="Address to serve it at; the default is this machine only.")
    ] = "127.0.0.1",
    allow_host: Annotated[
        list[str] | None,
        typer.Option(help="Name of a hub that forwards to the page; may be repeated."),
    ] = None,
    open_to_network: Annotated[
        bool, typer.Option("--open-to-network", help="Allow an address that other machines reach.")
    ] = False,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
) -> None:
    """Watch a chain move in the browser and turn its knobs, theory beside it.

    Sliders for the parameters, rods in motion, density, velocity widths and energy as they are
    measured, challenges, presets for figures of the paper, and the best theory on request. The
    address of the page restores its setting. Runs until Ctrl-C.

    Example: crazybilliards explore --port 5007
    """
    from crazybilliards.apps.explore.server import serve

    try:
        serve(port, address, browser, open_to_network, allow_host or ())
    except KeyboardInterrupt as error:
        raise typer.Exit(INTERRUPTED) from error
