"""All commands: help at once, one line for a mistake, the parameters of a chain as options."""

import dataclasses
import functools
import inspect
import pkgutil
import subprocess
import sys
from typing import get_args

import pytest
from other_values import other_values

from crazybilliards.apps.commands import chain_options
from crazybilliards.apps.commands.line import app
from crazybilliards.model import Chain

COMMANDS = [each.name for each in app.registered_commands]


@pytest.mark.parametrize("arguments", [["-h"], [], *([each, "--help"] for each in COMMANDS)])
def test_help_shows_an_example_and_loads_nothing_heavy(arguments):
    script = (
        "import sys\n"
        "from crazybilliards.apps.commands.line import main\n"
        "try:\n    main()\n"
        "finally:\n"
        "    heavy = {'numpy', 'numba', 'scipy', 'matplotlib', 'xarray'}\n"
        "    heavy &= set(sys.modules)\n"
        "    assert not heavy, heavy\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, *arguments], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "Usage: " in done.stdout
    assert "Example: crazybilliards " in done.stdout
    assert done.stderr == ""


def test_an_error_that_quotes_an_endless_argument_is_cut(run):
    done = run("compare", "--json", "9" * 5000)
    assert done.returncode == 2
    assert "unexpected extra argument" in done.stderr
    assert len(done.stderr) < 500


def test_an_unknown_command_and_an_unusable_folder_are_one_line(run, tmp_path):
    done = run("simulat")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    file = tmp_path / "file"
    file.write_text("mine")
    done = run("compare", "--output", str(file))
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert str(file) in done.stderr
    assert file.read_text() == "mine"


# What a command chooses itself.
CHOSEN = {
    "compare": {"amplitude", "restitution"},
    "relax": {"restitution"},
    "simulate": set(),
    "theory": set(),
}
OTHER = other_values()
TAKES_IT = {
    "compare": "crazybilliards.comparison.side_by_side.grid.compare_elastic",
    "relax": "crazybilliards.comparison.side_by_side.relaxation.compare_relaxation",
    "simulate": "crazybilliards.particles.simulation.simulate",
    "theory": "crazybilliards.kinetic.kinetic_equation.stationary.phase_space",
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

    _, room, *_, name = TAKES_IT[command].split(".")
    # The name is replaced in its room first, because a room fetches it from the module at the first
    # use. In the other order monkeypatch would save, and later restore, the replacement.
    monkeypatch.setattr(f"crazybilliards.{room}.{name}", stop)
    monkeypatch.setattr(TAKES_IT[command], stop)
    options = [f"--{name.replace('_', '-')}={value}" for name, value in asked.items()]
    refused("far enough", command, *options)
    assert chains == [Chain(**asked)]


def test_a_new_parameter_of_a_chain_is_an_option_of_itself(monkeypatch):
    @dataclasses.dataclass(frozen=True, kw_only=True)
    class More(chain_options.Parameters):
        tilt: float = dataclasses.field(
            default=0.5, metadata={"meaning": "Constant force", "unit": "N", "check": float}
        )

    monkeypatch.setattr(chain_options, "Parameters", More)

    @chain_options.with_chain_options(size=3)
    def command(chain, seed: int = 0):
        """Do nothing."""

    parameters = inspect.signature(command).parameters
    assert [*parameters] == [*(each.name for each in dataclasses.fields(More)), "seed"]
    assert parameters["size"].default == 3
    assert parameters["tilt"].default == 0.5
    kind, option = get_args(parameters["tilt"].annotation)
    assert kind is float
    assert option.help == "Constant force [N]."
