"""The command ``compare``: writes all or nothing, refuses in one line, keeps on Ctrl-C."""

import signal
import warnings

import pytest

from crazybilliards.comparison.side_by_side import grid_figures
from crazybilliards.model import load

QUICK = ["compare", "--size", "10", "--duration", "1000", "--amplitudes", "1,5"]


@pytest.mark.compiled
def test_compare_writes_both_figures_and_the_data(run, tmp_path):
    folder = tmp_path / "new" / "folder"
    done = run(*QUICK, "--output", str(folder))
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in folder.iterdir()) == [
        "cases",
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
    # A second run takes the chains from the folder; elsewhere it gives the same data.
    before = {path: path.stat().st_mtime_ns for path in (folder / "cases").iterdir()}
    assert run(*QUICK, "--output", str(folder)).returncode == 0
    assert {path: path.stat().st_mtime_ns for path in (folder / "cases").iterdir()} == before
    assert load(folder / "comparison.nc").identical(tree)
    other = ["--output", str(tmp_path / "other"), "--processes", "2"]
    assert run(*QUICK, *other).returncode == 0
    assert load(tmp_path / "other" / "comparison.nc").identical(tree)


def test_what_cannot_be_written_is_shown_at_least(run, tmp_path):
    (tmp_path / "comparison.nc").mkdir()
    done = run(*QUICK, "--output", str(tmp_path))
    assert done.returncode == 2
    assert "close packing" in done.stdout
    [error] = [line for line in done.stderr.splitlines() if "compiling" not in line]
    assert f"{tmp_path / 'comparison.nc'}: Is a directory" in error
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cases", "comparison.nc"]


def test_without_output_nothing_is_written(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run(*QUICK)
    assert done.returncode == 0
    assert "Nothing was written" in done.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.compiled
def test_compare_restitutions(run, tmp_path):
    arguments = ["--restitution", "0.9,1", "--size", "10", "--duration", "200"]
    done = run("compare", *arguments, "--output", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "cases",
        "comparison.nc",
        "density.png",
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

    monkeypatch.setattr(grid_figures, "draw_phase_space", stopped)
    arguments = ["--restitution", "0.9", "--size", "10", "--duration", "200"]
    done = run("compare", *arguments, "--output", str(tmp_path))
    assert done.returncode == 130
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"cases", "comparison.nc", "density.png", "widths.png"}
    assert "theory minus simulation" in " ".join(done.stdout.split())


@pytest.mark.compiled
def test_a_chain_that_diverges_is_told_and_drawn_as_far_as_it_can_be(run, tmp_path):
    arguments = ["--restitution", "1.5,0.9", "--size", "30", "--damping", "0.1"]
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        done = run("compare", *arguments, "--duration", "300", "--output", str(tmp_path))
    assert done.returncode == 1
    assert "warning: e = 1.5 has no kinetic equation: no steady state" in done.stderr
    assert "e = 1.5: the simulation diverged" in done.stderr
    assert {path.name for path in tmp_path.glob("*.png")} == {
        "density-diverged.png",
        "phase_space_restitution_0.9-diverged.png",
        "widths-diverged.png",
    }


@pytest.mark.compiled
@pytest.mark.posix
def test_ctrl_c_in_the_first_chain_leaves_a_finished_result(interrupted, tmp_path):
    (tmp_path / "comparison.nc").write_text("finished")
    done = interrupted(*QUICK[:3], "--duration", "1e9", "--output", tmp_path)
    assert done.returncode == -signal.SIGINT, done.stderr
    assert "Traceback" not in done.stderr
    assert (tmp_path / "comparison.nc").read_text() == "finished"
    assert {path.name for path in tmp_path.iterdir()} == {"cases", "comparison.nc"}
    assert list((tmp_path / "cases").iterdir()) == []
