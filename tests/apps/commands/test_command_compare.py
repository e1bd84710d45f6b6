"""The command ``compare``: writes all or nothing, refuses in one line, keeps on Ctrl-C."""

import signal
from pathlib import Path

import pytest

from crazybilliards.comparison.side_by_side import parameter_series, restitution_figures
from crazybilliards.model import chain_of, load
from crazybilliards.particles import simulate

QUICK = ["compare", "--size", "10", "--duration", "1000", "--amplitudes", "1,5"]


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
def test_bad_input_is_one_line_exit_two_and_nothing_written(refused, arguments, message, tmp_path):
    folder = tmp_path / "results"
    refused(message, "compare", *arguments, "--output", str(folder))
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
    assert "theory minus simulation" in " ".join(done.stdout.split())


@pytest.mark.compiled
def test_ctrl_c_while_a_picture_is_drawn_keeps_those_before(run, tmp_path, monkeypatch):
    def stopped(theory):
        raise KeyboardInterrupt

    monkeypatch.setattr(restitution_figures, "draw_phase_space", stopped)
    arguments = ["--restitution", "0.9", "--size", "10", "--duration", "200"]
    done = run("compare", *arguments, "--output", str(tmp_path))
    assert done.returncode == 130
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["comparison-interrupted.nc", "widths-interrupted.png"]
    assert "theory minus simulation" in " ".join(done.stdout.split())


@pytest.mark.compiled
@pytest.mark.parametrize("fails", [False, True])
def test_a_picture_of_one_chain_is_there_while_the_next_is_computed(
    fails, run, tmp_path, monkeypatch
):
    """One that fails costs no computation, and is drawn once more at the end."""
    draw, drawn, seen = restitution_figures.draw_phase_space, [], []

    def drawing(theory):
        drawn.append(chain_of(theory).restitution)
        if fails and len(drawn) == 1:
            raise OSError("no room")
        return draw(theory)

    def simulating(*arguments, **settings):
        seen.append(sorted(path.name for path in tmp_path.glob("*.png")))
        return simulate(*arguments, **settings)

    monkeypatch.setattr(restitution_figures, "draw_phase_space", drawing)
    monkeypatch.setattr(parameter_series, "simulate", simulating)
    arguments = ["--restitution", "0.9,1", "--size", "10", "--duration", "200"]
    done = run("compare", *arguments, "--output", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert seen == [[], [] if fails else ["phase_space_restitution_0.9-interrupted.png"]]
    assert drawn == ([0.9, 1.0, 0.9] if fails else [0.9, 1.0])
    names = ["phase_space_restitution_0.9.png", "phase_space_restitution_1.png", "widths.png"]
    assert sorted(path.name for path in tmp_path.glob("*.png")) == names


@pytest.mark.compiled
@pytest.mark.posix
def test_ctrl_c_saves_what_was_computed_beside_a_finished_result(interrupted, tmp_path):
    (tmp_path / "comparison.nc").write_text("finished")
    done = interrupted(*QUICK[:3], "--duration", "1e9", "--output", tmp_path)
    assert done.returncode == -signal.SIGINT, done.stderr
    assert "Traceback" not in done.stderr
    tree = load(tmp_path / "comparison-interrupted.nc")
    assert tree.attrs["status"] == "interrupted"
    assert tree["amplitude_1/simulation"].attrs["status"] == "interrupted"
    assert (tmp_path / "density-interrupted.png").exists()
    assert (tmp_path / "comparison.nc").read_text() == "finished"
    assert "close packing" in done.stdout
    assert not [path for path in Path(tmp_path).iterdir() if path.suffix == ".part"]
