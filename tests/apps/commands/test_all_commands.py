"""All commands: help at once, one line for a mistake, the parameters of a chain as options."""

import functools
import pkgutil
import shlex
import signal
import subprocess
import sys
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest
from other_values import other_values

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
    asked = ["-h", *(f"{each} --help" for each in COMMANDS)]
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
    assert run().stdout == run("--help").stdout
    for name in COMMANDS:
        shown = run(name, "--help").stdout
        assert run(name, "-h").stdout == shown
        assert name == "explore" or " -o" in shown


REFUSED = """
simluate | No such command 'simluate'
simulate --stepper euler | No such option: --stepper
simulate --size x | Invalid value for '--size'
simulate --method euler | 'euler' is not one of 'event-driven', 'contact-dynamics'
simulate --particles 1,x | particles takes numbers separated by commas, got '1,x'
simulate --particles 101 | particles must ascend within 1..100
compare --restitution 0.8,0.9 --amplitude 1,2 | several values of amplitude or of restitution, not
relax --film | film needs --output FOLDER
relax --output grid.toml | Not a directory: 'grid.toml'
relax --output grid.toml/results | grid.toml/results'
reproduce fig20 | no figure 'fig20'
theory fluid | name must be one of ('equilibrium',
theory --restitution 1.3 --damping 4 --output results | no steady state
sweep none.toml --output results | No such file or directory: 'none.toml'
sweep wrong.toml --output results | size must be
sweep grid.toml --output results --processes 0 | processes must be
sweep grid.toml --output results --processes 2 --scheduler tcp://nowhere:1 | a dask cluster decides
"""


@pytest.mark.parametrize(
    ("line", "message"), [line.split(" | ") for line in REFUSED.strip().splitlines()]
)
def test_bad_input_is_one_line_exit_two_and_nothing_written(
    refused, line, message, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    for name, sizes in (("grid", [3]), ("wrong", [3, 0])):
        Path(f"{name}.toml").write_text(f"[grid]\nsize = {sizes}\n[simulate]\nduration = 100\n")
    refused(message, *shlex.split(line))
    assert {path.name for path in tmp_path.iterdir()} == {"grid.toml", "wrong.toml"}


# What is interrupted, a finished result of before, and what there is afterwards.
PICTURES = {f"{name}-interrupted.png" for name in ("cloud", "profiles", "spacetime")}
FOLLOWED = "--size 10 --replicas 100 --duration 8 --every 2"
INTERRUPTED = {
    "simulate": ("--size 10 --duration 1e9", "simulation.nc", {"simulation-interrupted.nc"}),
    "compare": ("--size 10 --duration 1e9", "comparison.nc", {"cases"}),  # no chain was done
    "relax": (FOLLOWED, "relaxation.nc", PICTURES | {"relaxation-interrupted.nc"}),
}


@pytest.mark.usefixtures("sketched")
@pytest.mark.compiled
@pytest.mark.posix
@pytest.mark.parametrize(
    ("name", "sent"), [*product(INTERRUPTED, ["SIGINT"]), ("simulate", "SIGTERM")]
)
def test_a_signal_saves_what_was_computed_beside_a_finished_result(
    name, sent, interrupted, tmp_path, monkeypatch
):
    """Ctrl-C, and what batch systems send before they kill."""
    monkeypatch.chdir(tmp_path)
    (line, finished, left), number = INTERRUPTED[name], getattr(signal, sent)
    (tmp_path / finished).write_text("finished")
    done = interrupted(name, *line.split(), "--output", ".", number=number)
    # Ctrl-C must also end a loop of a shell, which looks for the signal.
    assert done.returncode == (-number if sent == "SIGINT" else 128 + number), done.stderr
    assert done.stderr == "crazybilliards: interrupted\n"
    assert {path.name for path in tmp_path.iterdir()} == left | {finished}
    assert (tmp_path / finished).read_text() == "finished"
    for path in tmp_path.glob("*-interrupted.nc"):
        assert load(path).attrs["status"] == "interrupted"
    assert not list(tmp_path.glob("cases/*"))
    assert name != "relax" or "rms distance" in done.stdout


# What takes the chain of a command.
TAKES_IT = {
    "compare": "crazybilliards.comparison.side_by_side.grid.compare",
    "relax": "crazybilliards.comparison.side_by_side.relaxation.compare_relaxation",
    "simulate": "crazybilliards.particles.simulation.simulate",
    "theory": "crazybilliards.kinetic.steady_state",
}


@pytest.mark.parametrize("command", TAKES_IT)
def test_every_parameter_of_a_chain_is_an_option_that_reaches_the_chain(
    refused, command, monkeypatch
):
    asked, chains = other_values(), []
    if command == "compare":  # it chooses these itself
        del asked["amplitude"], asked["restitution"]

    @functools.wraps(pkgutil.resolve_name(TAKES_IT[command]))
    def stop(chain, *arguments, **settings):
        chains.append(chain)
        raise ValueError("far enough")

    theory = replace(THEORIES["steady_state"], solve=stop, check=lambda *_, **__: None)
    monkeypatch.setitem(THEORIES, "steady_state", theory)
    _, room, *_, name = TAKES_IT[command].split(".")
    # The name is replaced in its room first, because a room fetches it from the module at the first
    # use. In the other order monkeypatch would save, and later restore, the replacement.
    monkeypatch.setattr(f"crazybilliards.{room}.{name}", stop)
    monkeypatch.setattr(TAKES_IT[command], stop)
    refused("far enough", command, *(f"--{n.replace('_', '-')}={v}" for n, v in asked.items()))
    assert chains == [Chain(**asked)]
