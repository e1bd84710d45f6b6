"""The command line: answers fast, refuses in one line, writes all or nothing, keeps on Ctrl-C.

Most commands run in this process. What only a process of its own can show (what it loads, how it
takes a signal) is shown by a few real ones.
"""

import dataclasses
import functools
import inspect
import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple, get_args

import matplotlib.pyplot as plt
import pytest
import xarray as xr

from crazybilliards.comparison.commands import chain_options
from crazybilliards.comparison.commands.main import app, main
from crazybilliards.comparison.theories import THEORIES
from crazybilliards.model import Chain, chain_of, load
from crazybilliards.particles import simulate

QUICK = ["compare", "--size", "10", "--duration", "1000", "--amplitudes", "1,5"]
COMMANDS = [each.name for each in app.registered_commands]


class Ended(NamedTuple):
    """How a command ended."""

    returncode: int
    stdout: str
    stderr: str


@pytest.fixture
def run(monkeypatch, capsys):
    """Run a command in this process."""

    def run(*arguments):
        monkeypatch.setattr("sys.argv", ["crazybilliards", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught:
            main()
        return Ended(caught.value.code or 0, *capsys.readouterr())

    yield run
    plt.close("all")


def require_refused(done, message):
    """Check that a command ended with one line that says why."""
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


# A command that says on standard error when its simulation has measured for a while.
MEASURING = """
import sys
from crazybilliards.comparison.commands.main import main
from crazybilliards.particles.observers.widths import Widths

observe, calls = Widths.observe, []

def and_say(self, *arguments):
    observe(self, *arguments)
    calls.append(1)
    if len(calls) == 20:
        print("measuring", file=sys.stderr, flush=True)

Widths.observe = and_say
main()
"""


def interrupted(*arguments):
    """Send Ctrl-C while a real command measures."""
    with subprocess.Popen(
        [sys.executable, "-c", MEASURING, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            said = []
            while not said or said[-1] not in ("measuring\n", ""):
                said.append(process.stderr.readline())
            assert said[-1] == "measuring\n", "".join(said)
            process.send_signal(signal.SIGINT)
            output, errors = process.communicate(timeout=100)
        finally:
            process.kill()
    return Ended(process.returncode, output, errors)


@pytest.mark.parametrize("arguments", [["-h"], [], *([each, "--help"] for each in COMMANDS)])
def test_help_shows_an_example_and_loads_nothing_heavy(arguments):
    script = (
        "import sys\n"
        "from crazybilliards.comparison.commands.main import main\n"
        "try:\n    main()\n"
        "finally:\n"
        "    heavy = {'numpy', 'numba', 'scipy', 'matplotlib', 'xarray', 'panel'}\n"
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


# -- the parameters of a chain -------------------------------------------------------------------

# What a command chooses itself.
CHOSEN = {
    "compare": {"amplitude", "restitution"},
    "relax": {"restitution"},
    "simulate": set(),
    "theory": set(),
}
OTHER = {
    "size": 7,
    "restitution": 0.9,
    "amplitude": 2.0,
    "damping": 3.0,
    "stiffness": 4.0,
    "gap": 0.5,
    "radius": 0.6,
    "mass": 7.0,
    "spring": "quadratic",
}
TAKES_IT = {
    "compare": "crazybilliards.comparison.studies.elastic_chain.compare_elastic",
    "relax": "crazybilliards.comparison.studies.relaxation.compare_relaxation",
    "simulate": "crazybilliards.particles.simulation.simulate",
    "theory": "crazybilliards.kinetic.kinetic_equation.stationary.phase_space",
}


@pytest.mark.parametrize("command", CHOSEN)
def test_every_parameter_of_a_chain_is_an_option_that_reaches_the_chain(command, run, monkeypatch):
    assert set(OTHER) == {field.name for field in dataclasses.fields(Chain)}
    asked = {name: value for name, value in OTHER.items() if name not in CHOSEN[command]}
    chains = []

    def stop(chain, *arguments, **settings):
        chains.append(chain)
        raise ValueError("far enough")

    monkeypatch.setattr(TAKES_IT[command], stop)
    if command == "theory":
        theory = THEORIES["phase_space"]._replace(solve=stop)
        monkeypatch.setitem(THEORIES, "phase_space", theory)
    if command == "simulate":
        monkeypatch.setattr("crazybilliards.particles.simulate", stop, raising=False)
    options = [f"--{name}={value}" for name, value in asked.items()]
    require_refused(run(command, *options), "far enough")
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


# -- compare -------------------------------------------------------------------------------------


@pytest.mark.compiled
def test_compare_writes_both_figures_and_the_data(run, tmp_path):
    folder = tmp_path / "new" / "folder"
    done = run(*QUICK, "--output", str(folder))
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in folder.iterdir()) == [
        "comparison.nc",
        "density.png",
        "displacement.png",
    ]
    tree = load(folder / "comparison.nc")
    assert tree.attrs["status"] == "completed"
    assert (folder / "density.png").read_bytes().startswith(b"\x89PNG")
    assert "close packing" in done.stdout
    # Not a terminal: no progress bar, no colours.
    assert "simulating" not in done.stderr
    assert "\x1b" not in done.stdout
    # A second run with the same seed gives the same data.
    again = run(*QUICK, "--output", str(folder), "--threads", "1")
    assert again.returncode == 0
    assert load(folder / "comparison.nc").identical(tree)


def test_what_cannot_be_written_is_shown_at_least(run, tmp_path):
    (tmp_path / "comparison.nc").mkdir()
    done = run(*QUICK, "--output", str(tmp_path))
    assert done.returncode == 2
    assert "close packing" in done.stdout
    [error] = [line for line in done.stderr.splitlines() if "compiling" not in line]
    assert f"{tmp_path / 'comparison.nc'}: Is a directory" in error
    assert [path.name for path in tmp_path.iterdir()] == ["comparison.nc"]


def test_without_output_nothing_is_written(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run(*QUICK)
    assert done.returncode == 0
    assert "Nothing was written" in done.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--size", "2"], "size"),
        (["--size", "ten"], "size"),
        (["--size", "-1"], "size"),
        (["--amplitudes", "1,x"], "amplitudes takes numbers"),
        (["--amplitudes", ""], "amplitudes takes numbers"),
        (["--amplitudes", "0"], "no steady state: amplitude=0"),
        (["--amplitudes", "nan"], "amplitude must be"),
        (["--amplitudes", "1,1"], "differ"),
        (["--gap", "-1"], "gap must be"),
        (["--gap", "inf"], "gap must be"),
        (["--duration", "0"], "duration must be"),
        (["--duration", "1"], "duration must be at least"),
        (["--restitution", "0.9,x"], "restitution takes numbers"),
        (["--restitution", "-1"], "restitution must be"),
        (["--restitution", "0.9", "--amplitudes", "1"], "give restitution or amplitudes"),
        (["--restitution", "0.9", "--damping", "0"], "no steady state"),
        (["--seed", "-5"], "seed"),
        (["--threads", "0"], "threads must be"),
        (["--colour"], "No such option"),
        (["extra"], "unexpected extra argument"),
    ],
)
def test_bad_input_is_one_line_exit_two_and_nothing_written(arguments, message, run, tmp_path):
    folder = tmp_path / "results"
    done = run("compare", *arguments, "--output", str(folder))
    require_refused(done, message)
    assert not folder.exists()


@pytest.mark.compiled
def test_compare_restitutions(run, tmp_path):
    arguments = ["--restitution", "0.9,1", "--size", "10", "--duration", "200"]
    done = run("compare", *arguments, "--output", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "comparison.nc",
        "phase_space_restitution_0.9.png",
        "phase_space_restitution_1.png",
        "widths.png",
    ]
    assert set(load(tmp_path / "comparison.nc").children) == {"restitution_0.9", "restitution_1"}
    assert "kinetic equation minus simulation" in " ".join(done.stdout.split())


# -- theory --------------------------------------------------------------------------------------


@pytest.fixture
def solved(monkeypatch):
    """Take down what a command gives to theories, and gets: (chain, settings, result)."""
    calls = []

    def watched(theory):
        @functools.wraps(theory.solve)
        def solve(chain, **settings):
            calls.append((chain, settings, theory.solve(chain, **settings)))
            return calls[-1][2]

        return theory._replace(solve=solve)

    for name, theory in THEORIES.items():
        monkeypatch.setitem(THEORIES, name, watched(theory))
    return calls


@pytest.mark.parametrize("name", THEORIES)
def test_every_theory_by_its_name(name, run, solved, tmp_path):
    done = run("theory", name, "--size", 10, "--amplitude", 5, "--output", tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    [(chain, settings, result)] = solved
    assert (chain, settings) == (Chain(size=10, amplitude=5), {})
    assert load(tmp_path / "theory.nc").identical(result)
    pictures = {"density.png", "profile.png"}
    pictures |= {"phase_space.png"} if name == "phase_space" else set()
    assert {path.name for path in tmp_path.iterdir()} == pictures | {"theory.nc"}
    assert THEORIES[name].title.capitalize() in done.stdout
    assert f"{result.velocity_width[0]:.4g}" in done.stdout
    assert name in run("theory", "--help").stdout


def test_the_settings_of_a_theory_reach_it(run, monkeypatch):
    """The kinetic equation is the theory that is taken if none is named."""

    def solve(chain, tolerance, cells):
        raise ValueError(f"asked for {tolerance=} {cells=}")

    theory = THEORIES["phase_space"]._replace(solve=solve)
    monkeypatch.setitem(THEORIES, "phase_space", theory)
    done = run("theory", "--cells", 8, "--tolerance", 1)
    require_refused(done, "asked for tolerance=1.0 cells=8")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--spring", "cubic"], "spring must be"),
        (["--size", "0"], "size must be"),
        (["--tolerance", "0"], "tolerance must be"),
        (["--amplitude", "0"], "no steady state"),
        (["--cells", "1"], "cells must be"),
        (["fluid"], "name must be one of ('equilibrium', "),
        (["equilibrium", "--tolerance", "0.1"], "tolerance: equilibrium has no such setting"),
        (["force_balance", "--cells", "9"], "cells: force_balance has no such setting"),
        (["equilibrium", "--restitution", "0.9"], "restitution must be 1"),
        (["--critical", "--restitution", "0.95"], "every size has a steady state"),
        (["--restitution", "1.3", "--damping", "4"], "the energy grows without bound"),
    ],
)
def test_theory_refuses_in_one_line(arguments, message, run, tmp_path):
    folder = tmp_path / "results"
    done = run("theory", *arguments, "--output", str(folder))
    require_refused(done, message)
    assert not folder.exists()


# -- relax ---------------------------------------------------------------------------------------

RELAX = ["relax", "--size", "10", "--duration", "4", "--replicas", "8", "--every", "1"]


@pytest.mark.compiled
def test_relax_writes_pictures_animations_and_the_data(run, tmp_path):
    done = run(*RELAX, "--release", "quenched", "--output", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "cloud.png",
        "profiles.png",
        "relaxation.gif",
        "relaxation.html",
        "relaxation.nc",
        "spacetime.png",
    ]
    assert (tmp_path / "relaxation.gif").read_bytes().startswith(b"GIF8")
    page = (tmp_path / "relaxation.html").read_text()
    assert "<script" in page
    # It plays without a network, with signs on its buttons.
    assert "://" not in page
    for sign in re.findall(r'class="fa (fa-[a-z-]+)', page):
        assert f".{sign}::before" in page
    tree = load(tmp_path / "relaxation.nc")
    assert set(tree.children) == {"particles", "isothermal", "evolving", "exact"}
    assert "rms distance" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--release", "dropped"], "release must be one of"),
        (["--by", "-1"], "by must be"),
        (["--by", "nan"], "by must be"),
        (["--every", "100"], "every must be at most"),
        (["--replicas", "1"], "replicas must be"),
        (["--amplitude", "0"], "no steady state"),
        (["--seed", "-1"], "seed must be"),
    ],
)
def test_relax_refuses_bad_input_in_one_line(arguments, message, run, tmp_path):
    folder = tmp_path / "results"
    done = run(*RELAX, *arguments, "--output", str(folder))
    require_refused(done, message)
    assert not folder.exists()


@pytest.mark.compiled
@pytest.mark.skipif(os.name == "nt", reason="sends a POSIX signal")
def test_ctrl_c_keeps_what_relaxed(tmp_path):
    long = ["--size", "100", "--replicas", "10000", "--duration", "40", "--every", "10"]
    done = interrupted("relax", *long, "--output", tmp_path)
    assert done.returncode == 130, done.stderr
    assert "Traceback" not in done.stderr
    assert load(tmp_path / "relaxation-interrupted.nc").attrs["status"] == "interrupted"
    assert (tmp_path / "cloud-interrupted.png").exists()


def test_an_unknown_command_and_an_unusable_folder_are_one_line(run, tmp_path):
    done = run("simulat")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    file = tmp_path / "file"
    file.write_text("mine")
    done = run(*QUICK, "--output", str(file))
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert str(file) in done.stderr
    assert file.read_text() == "mine"


@pytest.mark.compiled
@pytest.mark.skipif(os.name == "nt", reason="sends a POSIX signal")
def test_ctrl_c_saves_what_was_computed_beside_a_finished_result(tmp_path):
    (tmp_path / "comparison.nc").write_text("finished")
    done = interrupted(*QUICK[:3], "--duration", "1e9", "--output", tmp_path)
    assert done.returncode == 130, done.stderr
    assert "Traceback" not in done.stderr
    tree = load(tmp_path / "comparison-interrupted.nc")
    assert tree.attrs["status"] == "interrupted"
    assert tree["amplitude_1/simulation"].attrs["status"] == "interrupted"
    assert (tmp_path / "density-interrupted.png").exists()
    assert (tmp_path / "comparison.nc").read_text() == "finished"
    assert "close packing" in done.stdout
    assert not [path for path in Path(tmp_path).iterdir() if path.suffix == ".part"]


# -- simulate ------------------------------------------------------------------------------------


def test_simulate_writes_what_the_function_returns(run, tmp_path):
    file = tmp_path / "new" / "run.nc"
    options = ["--size", 6, "--restitution", 0.9, "--duration", 30, "--warmup", 3, "--seed", 7]
    options += ["--time-step", 0.01, "--every", 0.5, "--replicas", 2, "--particles", "1,6"]
    options += ["--observe", "widths, energy", "--stepper", "euler", "--threads", 1]
    options += ["--method", "contact-dynamics", "--checkpoint", tmp_path / "state"]
    done = run("simulate", *options, "--output", file)
    assert done.returncode == 0, done.stderr
    expected = simulate(
        Chain(size=6, restitution=0.9),
        duration=30.0,
        warmup=3.0,
        time_step=0.01,
        every=0.5,
        replicas=2,
        particles=[1, 6],
        observe=["widths", "energy"],
        method="contact-dynamics",
        stepper="euler",
        seed=7,
        progress=False,
    )
    xr.testing.assert_identical(load(file), expected)
    assert f"completed at t = {expected.attrs['end_time']:g}, time step 0.01" in done.stdout
    assert "error of the smallest W_v due to the time step" in done.stdout
    first = expected.isel(particle=0)
    assert f"{first.velocity_width:.4g} +- {first.velocity_width_error:.1g}" in done.stdout
    assert {path.name for path in tmp_path.iterdir()} == {"new", "state"}


def test_simulate_an_ensemble_without_a_file(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options = ["--average", "ensemble", "--size", 3, "--replicas", 2, "--duration", 1]
    done = run("simulate", *options)
    assert done.returncode == 0, done.stderr
    assert "at the last time" in done.stdout
    assert "Nothing was written" in done.stdout
    assert "Some rods" not in run("simulate", *options, "--observe", "energy").stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--observe", "width"], "observe takes any of"),
        (["--particles", "1,x"], "particles takes numbers"),
        (["--particles", "1.0"], "particles takes numbers"),
        (["--particles", "101"], "particles must ascend within 1..100"),
        (["--method", "guess"], "method must be one of"),
        (["--stepper", "guess"], "stepper must be one of"),
        (["--average", "median"], "average must be one of"),
        (["--time-step", "-1"], "time_step must be"),
        (["--gap", "-1"], "gap must be"),
        (["--output", "run.txt"], "a file whose name ends in .nc"),
        (["--output", "."], "a file whose name ends in .nc"),
    ],
)
def test_simulate_refuses_in_one_line(arguments, message, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    require_refused(run("simulate", "--output", "run.nc", *arguments), message)
    assert list(tmp_path.iterdir()) == []


def test_a_chain_that_diverges_ends_with_status_1(run, tmp_path):
    options = ["--size", 50, "--restitution", 2, "--damping", 0.01, "--duration", 1e5]
    done = run("simulate", *options, "--output", tmp_path / "run.nc")
    assert done.returncode == 1
    assert "diverged at t = " in done.stdout
    result = load(tmp_path / "run-diverged.nc")
    assert (result.attrs["status"], chain_of(result).size) == ("diverged", 50)


@pytest.mark.compiled
@pytest.mark.skipif(os.name == "nt", reason="sends a POSIX signal")
def test_ctrl_c_saves_what_was_measured(tmp_path):
    done = interrupted("simulate", "--size", 10, "--duration", 1e9, "--output", tmp_path / "run.nc")
    assert done.returncode == 130, done.stderr
    assert done.stderr == "crazybilliards: interrupted\n"
    assert load(tmp_path / "run-interrupted.nc").attrs["status"] == "interrupted"
    assert [path.name for path in tmp_path.iterdir()] == ["run-interrupted.nc"]
