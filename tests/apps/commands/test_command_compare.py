"""The command ``compare``: writes all or nothing, refuses in one line, keeps on Ctrl-C."""

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
