"""The command ``compare``: writes all or nothing, refuses in one line, keeps on Ctrl-C."""

import json
import warnings
from contextlib import nullcontext

import pytest
from small_sweeps import AtOnce

from crazybilliards.comparison.side_by_side import grid, grid_figures
from crazybilliards.model import load

QUICK = ["compare", "--size", "10", "--duration", "300", "--amplitude", "1,5"]


@pytest.mark.compiled
def test_compare_writes_figures_and_the_data(run, tmp_path, monkeypatch):
    folder = tmp_path / "new" / "folder"
    done = run(*QUICK, "--output", str(folder))
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in folder.iterdir()) == [
        "cases",
        "comparison.nc",
        "density.png",
        "displacement.png",
        "widths.png",
    ]
    tree = load(folder / "comparison.nc")
    assert tree.attrs["status"] == "completed"
    assert (folder / "density.png").read_bytes().startswith(b"\x89PNG")
    assert "close packing" in done.stdout
    # Not a terminal: no progress bar, no colours.
    assert "simulating" not in done.stderr
    assert "\x1b" not in done.stdout
    # A second run takes the chains from the folder; elsewhere it gives the same data.
    monkeypatch.setattr("crazybilliards.apps.commands.compare.write_figures", lambda *_: None)
    before = {path: path.stat().st_mtime_ns for path in (folder / "cases").iterdir()}
    assert run(*QUICK, "--output", str(folder)).returncode == 0
    assert {path: path.stat().st_mtime_ns for path in (folder / "cases").iterdir()} == before
    assert load(folder / "comparison.nc").identical(tree)
    # So do other processes; this one stands for them.
    monkeypatch.setattr(grid, "process_pool", lambda number: nullcontext(AtOnce()))
    other = ["--output", str(tmp_path / "other"), "--processes", "2"]
    assert run(*QUICK, *other).returncode == 0
    assert load(tmp_path / "other" / "comparison.nc").identical(tree)


@pytest.mark.compiled
def test_compare_knows_a_box(run, tmp_path):
    done = run(*QUICK, "--box", "30", "--stiffness", "0", "--output", str(tmp_path), "--json")
    rows = json.loads(done.stdout)["deviations"]
    assert [row["theory"] for row in rows[:3]] == ["exact", "labels", "rods"]
    for row in rows:
        off = row["measured_wall_force"] - row["wall_force"]
        assert abs(off) < 5 * row["measured_wall_force_error"]
    assert (tmp_path / "widths.png").exists()


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


@pytest.fixture
def without_pairs(monkeypatch):
    """Leave out the theory with pair correlations, which takes longer than the other one."""
    monkeypatch.setattr(grid, "KINETIC", {"kinetic_equation": "phase_space"})


@pytest.mark.compiled
def test_other_restitutions_and_ctrl_c_while_a_picture_is_drawn(
    run, tmp_path, monkeypatch, without_pairs
):
    def stopped(theory):
        raise KeyboardInterrupt

    options = ["--size", 10, "--duration", 200, "--output", tmp_path]
    with monkeypatch.context() as patch:
        patch.setattr(grid_figures, "draw_phase_space", stopped)
        done = run("compare", "--restitution", "0.9", *options)
    assert done.returncode == 130
    before = {"cases", "comparison.nc", "density.png", "displacement.png", "widths.png"}
    assert {path.name for path in tmp_path.iterdir()} == before
    assert "from the simulation" in " ".join(done.stdout.split())
    done = run("compare", "--restitution", "0.9,1", *options)
    assert done.returncode == 0, done.stderr
    pictures = {f"phase_space_restitution_{e}.png" for e in ("0.9", "1")}
    assert {path.name for path in tmp_path.iterdir()} == before | pictures
    assert set(load(tmp_path / "comparison.nc").children) == {"restitution_0.9", "restitution_1"}
    assert "from the simulation" in " ".join(done.stdout.split())


OVER = """
| amplitude: 1, 3, 10, 30; restitution 1
--amplitude 2 | amplitude: 2; restitution 1
--amplitude 2,3 --restitution 0.9 | amplitude: 2, 3; restitution 0.9
--restitution 0.8 | restitution: 0.8; amplitude 1
--restitution 0.8,0.9 --amplitude 3 | restitution: 0.8, 0.9; amplitude 3
"""


@pytest.mark.parametrize(("options", "said"), [line.split("| ") for line in OVER.split("\n")[1:-1]])
def test_several_values_of_one_parameter_make_as_many_chains(options, said, refused, monkeypatch):
    def stop(chain, over, **settings):
        [(name, values)] = over.items()
        other = "restitution" if name == "amplitude" else "amplitude"
        listed = ", ".join(f"{value:g}" for value in values)
        raise ValueError(f"{name}: {listed}; {other} {getattr(chain, other):g}")

    monkeypatch.setattr(grid, "compare", stop)
    refused(said, "compare", *options.split())


@pytest.mark.compiled
def test_a_chain_that_diverges_is_told_and_drawn_as_far_as_it_can_be(run, tmp_path, without_pairs):
    arguments = ["--restitution", "1.5,0.9", "--size", "10", "--damping", "0.1"]
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        done = run("compare", *arguments, "--duration", "300", "--output", str(tmp_path))
    assert done.returncode == 1
    assert "warning: e = 1.5 has no kinetic equation: no steady state" in done.stderr
    assert "e = 1.5: the simulation diverged" in done.stderr
    assert {path.name for path in tmp_path.glob("*.*")} == {
        "comparison-diverged.nc",
        "density-diverged.png",
        "displacement-diverged.png",
        "phase_space_restitution_0.9-diverged.png",
        "widths-diverged.png",
    }
