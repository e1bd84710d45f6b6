"""The command ``crazybilliards``: one subcommand per job."""

import inspect
import os
import sys
import warnings
from importlib import metadata

import typer
from typer import Option

from crazybilliards.apps.commands.batches import reproduce, sweep
from crazybilliards.apps.commands.chains import simulate, theory
from crazybilliards.apps.commands.output import INTERRUPTED, complain
from crazybilliards.apps.commands.side_by_side import compare, relax

_LONGEST = 400  # characters of an error message, which may quote an argument without end

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback(invoke_without_command=True)
def crazybilliards(
    context: typer.Context,
    version: bool = Option(False, "--version", "-V", help="Show the version."),
) -> None:
    """Noisy rods on springs colliding in one dimension: simulation and theory side by side.

    Lengths are in R, masses in M, times in t_0: by default a rod has the radius 1 R and the mass
    4 pi/3 M, and a spring the stiffness 1 M/t_0^2. Results are written as NetCDF files; with --json
    a command prints its tables for machines.

    Example: crazybilliards compare --output results
    """
    if version:
        print(f"crazybilliards {metadata.version('crazybilliards')}")
    elif context.invoked_subcommand is None:
        print(context.get_help())


def explore(
    port: int = Option(5006, min=0, max=65535, help="Port to serve the page at; 0: any free one."),
    address: str = Option("127.0.0.1", help="Address to serve it at, by default this machine's."),
    allow_host: list[str] = Option([], help="Name of a hub that forwards to it; repeatable."),
    open_to_network: bool = Option(False, "--open-to-network", help="Allow other machines."),
    browser: bool = Option(True, help="Open the page in the browser."),
) -> None:
    """Watch a chain move in the browser and turn its knobs, theory beside it, until Ctrl-C.

    Example: crazybilliards explore --port 5007
    """
    from crazybilliards.apps.explore.server import serve

    serve(port, address, browser, open_to_network, allow_host)


for command in (compare, simulate, theory, relax, reproduce, sweep, explore):
    # Given like this it is not cut to one line.
    short = (inspect.getdoc(command) or "").partition("\n")[0]
    app.command(command.__name__, short_help=short)(command)


def main() -> None:
    """Entry point: a user's mistake is one line on standard error and exit status 2."""
    from crazybilliards.model.process import terminated_like_interrupted

    # Pictures go to files. matplotlib would refuse a backend that it does not know.
    os.environ["MPLBACKEND"] = "agg"
    # The matrices are small. Threads of the linear algebra only wait, in each worker of a sweep.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with warnings.catch_warnings(), terminated_like_interrupted() as signals:
        warnings.showwarning = lambda message, *_, **__: complain(f"warning: {message}")
        # Commands state the expected errors of theories, unknown ones too.
        warnings.filterwarnings("ignore", "the error of .* was not measured")
        status, message = _run()
        if message:
            complain(message[:_LONGEST])
    if status == INTERRUPTED and not signals:
        # Python then ends by the signal itself. After an exit status a loop of a shell goes on.
        sys.excepthook = lambda *_: None
        raise KeyboardInterrupt
    sys.exit(128 + signals[0] if status == INTERRUPTED else status)  # 143 for SIGTERM


def _run() -> tuple[int, str]:
    """Run the command; return its exit status, and what to say of it."""
    try:
        status = app(standalone_mode=False) or 0
    except (KeyboardInterrupt, typer.Abort):
        status = INTERRUPTED
    except typer.TyperException as error:
        return 2, f"error: {error.format_message()}"
    except (OSError, ValueError) as error:
        return 2, f"error: {error}"
    except RuntimeError as error:  # a worker process died
        return 1, str(error)
    return status, "interrupted" if status == INTERRUPTED else ""
