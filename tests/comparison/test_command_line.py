"""The command line: answers fast, refuses in one line, writes all or nothing, keeps on Ctrl-C."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from crazybilliards.model import load

COMMAND = [sys.executable, "-c", "from crazybilliards.comparison.commands.main import main; main()"]
QUICK = ["compare", "--size", "10", "--duration", "1000", "--amplitudes", "1,5"]


def run(*arguments, **options):
    return subprocess.run(
        [*COMMAND, *arguments], capture_output=True, text=True, timeout=300, check=False, **options
    )


def interrupted_after(seconds, *arguments):
    """Send Ctrl-C after some time; return exit status, output and errors. Leave nothing behind."""
    process = subprocess.Popen(
        [*COMMAND, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        time.sleep(seconds)
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=200)
    finally:
        process.kill()
    return process.returncode, output, errors


@pytest.mark.parametrize(
    "arguments",
    [
        ["--help"],
        ["compare", "--help"],
        ["relax", "--help"],
        ["theory", "--help"],
        ["explore", "--help"],
        ["-h"],
    ],
)
def test_help_shows_an_example_and_loads_nothing_heavy(arguments):
    script = (
        "import sys; sys.argv[1:] = sys.argv[1:]\n"
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
    assert "Example: crazybilliards " in done.stdout


@pytest.mark.compiled
def test_compare_writes_both_figures_and_the_data(tmp_path):
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


def test_what_cannot_be_written_is_shown_at_least(tmp_path):
    (tmp_path / "comparison.nc").mkdir()
    done = run(*QUICK, "--output", str(tmp_path))
    assert done.returncode == 2
    assert "close packing" in done.stdout
    [error] = [line for line in done.stderr.splitlines() if "compiling" not in line]
    assert f"{tmp_path / 'comparison.nc'}: Is a directory" in error
    assert [path.name for path in tmp_path.iterdir()] == ["comparison.nc"]


def test_without_output_nothing_is_written(tmp_path):
    done = run(*QUICK, cwd=tmp_path)
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
def test_bad_input_is_one_line_exit_two_and_nothing_written(arguments, message, tmp_path):
    folder = tmp_path / "results"
    done = run("compare", *arguments, "--output", str(folder))
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""
    assert not folder.exists()


@pytest.mark.compiled
def test_compare_restitutions(tmp_path):
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


def test_theory(tmp_path):
    done = run("theory", "--size", "20", "--restitution", "0.9", "--output", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "phase_space.png",
        "profile.png",
        "theory.nc",
    ]
    assert "W_v" in done.stdout
    assert done.stderr == ""
    assert "velocity_width" in load(tmp_path / "theory.nc")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--spring", "cubic"], "spring must be"),
        (["--size", "0"], "size must be"),
        (["--tolerance", "0"], "tolerance must be"),
        (["--amplitude", "0"], "no steady state"),
        (["--critical"], "every size has a steady state"),
        (["--restitution", "1.3", "--damping", "4"], "the energy grows without bound"),
    ],
)
def test_theory_refuses_in_one_line(arguments, message, tmp_path):
    folder = tmp_path / "results"
    done = run("theory", *arguments, "--output", str(folder))
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert not folder.exists()


RELAX = ["relax", "--size", "10", "--duration", "4", "--replicas", "8", "--every", "1"]


@pytest.mark.compiled
def test_relax_writes_pictures_animations_and_the_data(tmp_path):
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
    assert "Nothing was written" in run(*RELAX, "--gap", "0.5", cwd=tmp_path).stdout


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
def test_relax_refuses_bad_input_in_one_line(arguments, message, tmp_path):
    folder = tmp_path / "results"
    done = run(*RELAX, *arguments, "--output", str(folder))
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert not folder.exists()


@pytest.mark.compiled
@pytest.mark.skipif(os.name == "nt", reason="sends a POSIX signal")
def test_ctrl_c_keeps_what_relaxed(tmp_path):
    begin = time.monotonic()
    assert run(*RELAX).returncode == 0
    started = 1.5 * (time.monotonic() - begin)  # importing, compiling, the fluids, on this machine
    arguments = ["--size", "300", "--replicas", "10000", "--duration", "400", "--every", "40"]
    code, _, errors = interrupted_after(
        20 + started, "relax", *arguments, "--output", str(tmp_path)
    )
    assert code == 130, errors
    assert "Traceback" not in errors
    assert load(tmp_path / "relaxation-interrupted.nc").attrs["status"] == "interrupted"
    assert (tmp_path / "cloud-interrupted.png").exists()


def test_an_unknown_command_and_an_unusable_folder_are_one_line(tmp_path):
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
    begin = time.monotonic()
    assert run(*QUICK, "--output", str(tmp_path)).returncode == 0
    started = 1.5 * (time.monotonic() - begin)
    finished = (tmp_path / "comparison.nc").read_bytes()
    code, output, errors = interrupted_after(
        2 + started, *QUICK[:3], "--duration", "1e9", "--output", str(tmp_path)
    )
    assert code == 130, errors
    assert "Traceback" not in errors
    tree = load(tmp_path / "comparison-interrupted.nc")
    assert tree.attrs["status"] == "interrupted"
    assert tree["amplitude_1/simulation"].attrs["status"] == "interrupted"
    assert (tmp_path / "density-interrupted.png").exists()
    assert (tmp_path / "comparison.nc").read_bytes() == finished
    assert "close packing" in output
    assert not [path for path in Path(tmp_path).iterdir() if path.suffix == ".part"]
