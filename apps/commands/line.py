"""The command ``crazybilliards``: one subcommand per job."""

from __future__ import annotations

import inspect
import sys
import warnings
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

import crazybilliards as cb
from crazybilliards.apps.commands import compare, explore, relax, reproduce, simulate, sweep, theory
from crazybilliards.apps.commands.answers import with_json
from crazybilliards.apps.commands.mistakes import explained
from crazybilliards.apps.commands.output import INTERRUPTED
from crazybilliards.apps.commands.streams import READER_GONE, plain_streams
from crazybilliards.model.checks import meant, shown

_LONGEST = 400  # characters of an error message


class _Commands(TyperGroup):
    """Takes the first letters of a command for it, and ``help`` for ``--help``.

    No name of a command is the beginning of another.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        return super().parse_args(ctx, [*args[1:2], "--help"] if args[:1] == ["help"] else args)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        name = args[0]
        near = [each for each in self.commands if each.startswith(name)]
        if len(near) == 1:
            return super().resolve_command(ctx, [*near, *args[1:]])
        if name in dir(cb):
            from crazybilliards.comparison.stationary_theories import THEORIES

            solved = f"crazybilliards theory {name} solves it"
            hint = f"; {solved if name in THEORIES else f'in Python it is crazybilliards.{name}'}"
        else:
            hint = f"; did you mean {' or '.join(near)}?" if near else meant(name, self.commands)
        known = ", ".join(self.commands)
        raise ValueError(f"no command {shown(name)}{hint or f'; the commands are {known}'}")


app = typer.Typer(
    cls=_Commands,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"crazybilliards {version('crazybilliards')}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def crazybilliards(
    context: typer.Context,
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
    if context.invoked_subcommand is None:
        print(context.get_help())


for module in (compare, simulate, theory, relax, reproduce, sweep, explore):
    app.command(
        module.__name__.rpartition(".")[2],
        # Given like this it is not cut to one line.
        short_help=(inspect.getdoc(module.command) or "").partition("\n")[0],
    )(module.command if module is explore else with_json(module.command))


def main() -> None:
    """Entry point: a user's mistake is one line on standard error and exit status 2."""
    from crazybilliards.model.process import terminated_like_interrupted

    # Commands state the expected errors of theories, unknown ones too.
    warnings.filterwarnings("ignore", "the error of .* was not measured")
    with plain_streams() as output, terminated_like_interrupted() as signals:
        status = _run()
    if isinstance(output.failed, BrokenPipeError):  # crazybilliards ... | head, say
        status = status or READER_GONE
    elif output.failed is not None:
        status = _complain(f"standard output: {output.failed.strerror}")
    if status == INTERRUPTED and signals:
        status = 128 + signals[0]  # as shells say that a signal ended it: 143 for SIGTERM
    elif status == INTERRUPTED:
        # Python then ends by the signal itself. After an exit status a loop of a shell goes on.
        sys.excepthook = lambda *_: None
        raise KeyboardInterrupt
    sys.exit(status)


def _run() -> int | None:
    try:
        status = app(standalone_mode=False)
        if status == INTERRUPTED:
            print("crazybilliards: interrupted", file=sys.stderr)
    except typer.TyperException as error:
        status = _complain(explained(error))
    except ValueError as error:
        status = _complain(str(error))
    except OSError as error:
        status = _complain(f"{error.filename or 'file'}: {error.strerror or error}")
    return status


def _complain(message: str) -> int:
    message = " ".join(message.split())
    if len(message) > _LONGEST:  # it quotes an argument without end
        message = f"{message[:_LONGEST]} ..."
    print(f"crazybilliards: error: {message}", file=sys.stderr)
    return 2
