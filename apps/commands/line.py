"""The command ``crazybilliards``: one subcommand per job."""

from __future__ import annotations

import inspect
import os
import sys
import warnings
from typing import Annotated

import typer

from crazybilliards.apps.commands import batches, chains
from crazybilliards.apps.commands.output import INTERRUPTED

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"crazybilliards {version('crazybilliards')}")
        raise typer.Exit


@app.callback()
def crazybilliards(
    version: Annotated[
        bool,
        typer.Option(
            "--version", "-V", callback=_show_version, is_eager=True, help="Show the version."
        ),
    ] = False,
) -> None:
    """Noisy rods on springs colliding in one dimension: simulation and theory side by side.

    Lengths are in R, masses in M, times in T: by default a rod has the radius 1 R and the mass
    4 pi/3 M, and a spring the stiffness 1 M/T^2. Results are written as NetCDF files; with --json a
    command prints its tables for machines.

    Example: crazybilliards compare --output results
    """


def explore(
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port to serve the page at; 0: any free one.")
    ] = 5006,
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
    """Watch a chain move in the browser and turn its knobs, theory beside it, until Ctrl-C.

    Example: crazybilliards explore --port 5007
    """
    from crazybilliards.apps.explore.server import serve

    serve(port, address, browser, open_to_network, allow_host or ())


for command in (
    chains.compare,
    chains.simulate,
    chains.theory,
    chains.relax,
    batches.reproduce,
    batches.sweep,
    explore,
):
    # Given like this it is not cut to one line.
    short = (inspect.getdoc(command) or "").partition("\n")[0]
    app.command(command.__name__, short_help=short)(command)


def main() -> None:
    """Entry point: a user's mistake is one line on standard error and exit status 2."""
    from crazybilliards.model.process import terminated_like_interrupted

    # Pictures go to files. matplotlib would refuse a backend that it does not know.
    os.environ["MPLBACKEND"] = "agg"
    # Commands state the expected errors of theories, unknown ones too.
    warnings.filterwarnings("ignore", "the error of .* was not measured")
    with terminated_like_interrupted() as signals:
        status, why = _run()
    if why:
        print(f"crazybilliards: {why}", file=sys.stderr)
    if status == INTERRUPTED and not signals:
        # Python then ends by the signal itself. After an exit status a loop of a shell goes on.
        sys.excepthook = lambda *_: None
        raise KeyboardInterrupt
    sys.exit(128 + signals[0] if status == INTERRUPTED else status)  # 143 for SIGTERM


def _run() -> tuple[int, str]:
    try:
        status = app(standalone_mode=False) or 0
    except (KeyboardInterrupt, typer.Abort):
        status = INTERRUPTED
    except typer.TyperException as error:
        return 2, f"error: {error.format_message()}"
    except OSError as error:
        return 2, f"error: {error.filename or 'file'}: {error.strerror or error}"
    except ValueError as error:
        return 2, f"error: {' '.join(str(error).split())[:400]}"
    return status, "interrupted" if status == INTERRUPTED else ""
