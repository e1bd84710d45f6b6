"""All commands: help at once, one line for a mistake, the parameters of a chain as options."""

import functools
import inspect
import pkgutil
import shlex
import signal
import subprocess
import sys
from dataclasses import dataclass, field, fields, replace
from typing import get_args

import pytest
from other_values import other_values

from crazybilliards.apps.commands import options
from crazybilliards.apps.commands.line import app
from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.model import Chain, load

COMMANDS = [each.name for each in app.registered_commands]


HELP = """
import sys
from crazybilliards.apps.commands.line import main
for line in sys.stdin.read().splitlines():
    print("asked", line)
    sys.argv = ["crazybilliards", *line.split()]
    try:
        main()
    except SystemExit as ended:
        assert not ended.code, line
    heavy = {"numpy", "numba", "scipy", "matplotlib", "xarray"} & set(sys.modules)
    assert not heavy, (line, heavy)
"""


def test_help_shows_an_example_and_loads_nothing_heavy():
    asked = ["-h", "", *(f"{each} --help" for each in COMMANDS)]
    process = [sys.executable, "-c", HELP]
    done = subprocess.run(
        process, input="\n".join(asked), capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    _, *answers = done.stdout.split("asked ")
    assert [answer.partition("\n")[0] for answer in answers] == asked
    for answer in answers:
        assert "Usage: " in answer
        assert "Example: crazybilliards " in answer


def test_the_usual_conventions_hold(run):
    assert run("-V").stdout == run("--version").stdout
    assert run("help").stdout == run("--help").stdout
    for name in COMMANDS:
        shown = run(name, "--help").stdout
        assert run("help", name).stdout == run(name[:3], "-h").stdout == shown
        assert name == "explore" or " -o" in shown


def test_an_error_that_quotes_an_endless_argument_is_cut(run):
    done = run("compare", "--json", "9" * 5000)
    assert done.returncode == 2
    assert "unexpected extra argument" in done.stderr
    assert len(done.stderr) < 500


def test_an_unusable_folder_is_one_line(run, tmp_path):
    file = tmp_path / "file"
    file.write_text("mine")
    done = run("compare", "--output", str(file))
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert str(file) in done.stderr
    assert file.read_text() == "mine"


REFUSED = """
compare --amplitude 1,x | amplitude takes numbers
compare --amplitudes 1 | No such option
compare --restitution 0.8,0.9 --amplitude 1,2 | several values of amplitude or of restitution, not
compare --colour | No such option
compare extra | unexpected extra argument 'extra'
compare --restitution 0.8 0.9 | restitution takes values separated by commas: --restitution 0.8,0.9
compare --amplitude=1 2 3 | amplitude takes values separated by commas: --amplitude 1,2
simulate --observe widths energy | observe takes values separated by commas: --observe widths,energy
simulate --observe widths --json energy | unexpected extra argument 'energy'
simulate --size 5 6 | unexpected extra argument '6'
simulate --size 1e3 | size must be an integer, got '1e3'; write 1000
simulate --size 2.5 | size must be an integer, got '2.5'
simulate --size x | size must be an integer, got 'x'
simulate --amplitude 0,9 | amplitude must be a number, got '0,9'; write 0.9
simulate --duration 1,500 | duration must be a number, got '1,500'
simulate --duration long | duration must be a number, got 'long'
explore --port abc | port must be an integer, got 'abc'
reproduce --quality best | quality must be one of ('quick', 'full'), got 'best'
reproduce --columns 3 | columns must be an integer from 1 to 2, got 3
reproduce --vector png | vector must be one of ('pdf', 'svg'), got 'png'
reproduce fig17 | no figure 'fig17'; did you mean 17?
reproduce 3,fig17_density.png | no figure 'fig17_density.png'; did you mean 17?
reproduce fig20 | no figure 'fig20'; there are: all, analytics, 1 model
reproduce arctan | no figure 'arctan'; did you mean 'arctanh'?
reproduce 16 17 | which takes values separated by commas: 16,17
relax --seed -1 | seed must be
simulate --stepper euler | No such option
simulate --particles 1,x | particles takes numbers
simulate --particles 1.0 | particles takes numbers
simulate --particles 101 | particles must ascend within 1..100
simulate --accuracy 0.01 --duration 50 | --duration has no meaning with --accuracy
simulate --output run.txt | a folder or a file whose name ends in .nc
simulate -o run.txt | a folder or a file whose name ends in .nc
simulat -o run.txt | a folder or a file whose name ends in .nc
theory -o run.nc | output must be a folder, got run.nc; only simulate takes a file
sweep grid.toml -o run.nc | output must be a folder, got run.nc; only simulate takes a file
simluate | no command 'simluate'; did you mean 'simulate'?
re | no command 're'; did you mean relax or reproduce?
film | no command 'film'; in Python it is crazybilliards.film
equilibrium | no command 'equilibrium'; crazybilliards theory equilibrium solves it
theory fluid | name must be one of ('equilibrium',
theory equilibrium --restitution 0.9 | the exact equilibrium
theory --restitution 1.3 --damping 4 | the energy grows without bound
"""


@pytest.mark.parametrize(
    ("line", "message"), [line.split(" | ") for line in REFUSED.strip().splitlines()]
)
def test_bad_input_is_one_line_exit_two_and_nothing_written(
    refused, line, message, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    command, *arguments = shlex.split(line)
    output = [] if command == "explore" or "-o" in arguments else ["--output", "results"]
    refused(message, command, *arguments, *([] if "--output" in arguments else output))
    assert list(tmp_path.iterdir()) == []


LONG = ["--size", "10", "--replicas", "100", "--duration", "40", "--every", "10"]


@pytest.mark.compiled
@pytest.mark.posix
def test_ctrl_c_saves_what_was_computed_beside_a_finished_result(interrupted, tmp_path):
    (tmp_path / "relaxation.nc").write_text("finished")
    done = interrupted("relax", *LONG, "--output", tmp_path)
    assert done.returncode == -signal.SIGINT, done.stderr
    assert "Traceback" not in done.stderr
    assert load(tmp_path / "relaxation-interrupted.nc").attrs["status"] == "interrupted"
    assert (tmp_path / "cloud-interrupted.png").exists()
    assert (tmp_path / "relaxation.nc").read_text() == "finished"
    assert "minus" in done.stdout
    assert not [path for path in tmp_path.iterdir() if path.suffix == ".part"]


@pytest.mark.compiled
@pytest.mark.posix
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_ctrl_c_saves_what_was_simulated(name, interrupted, tmp_path):
    """So do what batch systems send before they kill, and a lost connection."""
    number = getattr(signal, name)
    arguments = ("--size", 10, "--duration", 1e9, "--output", tmp_path / "run.nc")
    done = interrupted("simulate", *arguments, number=number)
    # Ctrl-C must also end a loop of a shell, which looks for the signal.
    assert done.returncode == (-number if name == "SIGINT" else 128 + number), done.stderr
    assert done.stderr == "crazybilliards: interrupted\n"
    assert load(tmp_path / "run-interrupted.nc").attrs["status"] == "interrupted"
    assert [path.name for path in tmp_path.iterdir()] == ["run-interrupted.nc"]


# What a command chooses itself.
CHOSEN = {
    "compare": {"amplitude", "restitution"},
    "relax": {"restitution"},
    "simulate": set(),
    "theory": set(),
}
OTHER = other_values()
TAKES_IT = {
    "compare": "crazybilliards.comparison.side_by_side.grid.compare",
    "relax": "crazybilliards.comparison.side_by_side.relaxation.compare_relaxation",
    "simulate": "crazybilliards.particles.simulation.simulate",
    "theory": "crazybilliards.kinetic.phase_space",
}


@pytest.mark.parametrize("command", CHOSEN)
def test_every_parameter_of_a_chain_is_an_option_that_reaches_the_chain(
    refused, command, monkeypatch
):
    asked = {name: value for name, value in OTHER.items() if name not in CHOSEN[command]}
    chains = []

    @functools.wraps(pkgutil.resolve_name(TAKES_IT[command]))
    def stop(chain, *arguments, **settings):
        chains.append(chain)
        raise ValueError("far enough")

    theory = replace(THEORIES["phase_space"], solve=stop)
    monkeypatch.setitem(THEORIES, "phase_space", theory)
    _, room, *_, name = TAKES_IT[command].split(".")
    # The name is replaced in its room first, because a room fetches it from the module at the first
    # use. In the other order monkeypatch would save, and later restore, the replacement.
    monkeypatch.setattr(f"crazybilliards.{room}.{name}", stop)
    monkeypatch.setattr(TAKES_IT[command], stop)
    options = [f"--{name.replace('_', '-')}={value}" for name, value in asked.items()]
    refused("far enough", command, *options)
    assert chains == [Chain(**asked)]


def test_a_new_parameter_of_a_chain_is_an_option_of_itself(monkeypatch):
    @dataclass(frozen=True, kw_only=True)
    class More(options.Parameters):
        tilt: float = field(
            default=0.5, metadata={"meaning": "Constant force", "unit": "N", "check": float}
        )

    monkeypatch.setattr(options, "Parameters", More)

    @options.with_chain_options(size=3)
    def command(chain, seed: int = 0):
        """Do nothing."""

    parameters = inspect.signature(command).parameters
    assert [*parameters] == [*(each.name for each in fields(More)), "seed"]
    assert parameters["size"].default == 3
    assert parameters["tilt"].default == 0.5
    kind, option = get_args(parameters["tilt"].annotation)
    assert kind is float
    assert option.help == "Constant force [N]."
