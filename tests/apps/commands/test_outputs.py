"""Where commands write to: a wrong place costs no work, and what is written arrives whole."""

import json
import sys
from contextlib import contextmanager, nullcontext
from dataclasses import asdict
from types import SimpleNamespace

import pytest
from small_sweeps import AtOnce

from crazybilliards.comparison import sweeps
from crazybilliards.comparison.distances import deviations
from crazybilliards.comparison.side_by_side import grid_figures
from crazybilliards.comparison.side_by_side.relaxation import label_distances
from crazybilliards.model import load
from crazybilliards.model.storage import locked

IN_A_BOX = "--release gathered --box 40 --stiffness 0"
SMALL = {
    "compare": "--size 4 --duration 300 --amplitude 10",
    "relax": f"--size 10 --duration 1 --replicas 2 --every 1 {IN_A_BOX}",
    "reproduce": "1",
    "simulate": "--size 4 --duration 100",
    "theory": "equilibrium --size 4",
}


@pytest.fixture
def arguments(tmp_path):
    """Give a small job of a command; the sweep is that of one case in one process."""
    grid = tmp_path / "grid.toml"
    grid.write_text("[grid]\nsize = [3]\n[simulate]\nduration = 100\n")
    return lambda name: [name, *(SMALL | {"sweep": f"{grid} --processes 1"})[name].split()]


@pytest.mark.parametrize("name", ["compare", "relax", "reproduce", "theory", "sweep"])
def test_a_folder_belongs_to_one_process_at_a_time(name, arguments, run, tmp_path):
    folder = tmp_path / "results"
    folder.mkdir()
    with locked(folder):
        done = run(*arguments(name), "--output", folder)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    assert "in use by another process" in done.stderr
    assert str(folder) in done.stderr
    assert list(folder.iterdir()) == []


@pytest.mark.usefixtures("sketched")
@pytest.mark.compiled
@pytest.mark.filterwarnings("ignore:equal elastic rods")
@pytest.mark.parametrize("name", [*SMALL, "sweep"])
def test_json_is_one_object_with_every_file_written(name, arguments, run, tmp_path, monkeypatch):
    """Numbers in full, as the functions return them; nothing else on standard output."""
    monkeypatch.setattr(sweeps, "process_pool", lambda *_: nullcontext(AtOnce()))
    folder = tmp_path / "results"
    done = run(*arguments(name), "--json", "--output", folder)
    assert done.returncode == 0, done.stderr
    facts = json.loads(done.stdout)
    if name == "sweep":
        assert facts == {"cases": 1, "folder": str(folder), "failed": []}
        return
    assert sorted(facts["written"]) == sorted(map(str, folder.glob("*.*")))
    if name == "compare":
        tree = load(folder / "comparison.nc")
        [exact] = [row for row in facts["deviations"] if row["theory"] == "equilibrium"]
        found = deviations(tree["amplitude_10"])["equilibrium"]
        assert exact["amplitude"] == 10
        for name, value in asdict(found.density).items():
            assert exact[f"density_{name}"] == value
        for name, value in found.velocity_width._asdict().items():
            assert exact[f"velocity_width_{name}"] == value
    if name == "relax":
        tree = load(folder / "relaxation.nc")
        assert tree.attrs["by"] == 0.5
        found = {row["theory"]: row["distance"] for row in facts["distances"]}
        assert found == label_distances(tree)


@pytest.mark.usefixtures("sketched")
def test_a_picture_that_fails_costs_no_other_file(arguments, run, tmp_path, monkeypatch):
    def failing(*_):
        raise RuntimeError("no room for the legend")

    monkeypatch.setattr(grid_figures, "draw_density_alone", failing)
    done = run(*arguments("theory"), "--output", tmp_path)
    assert (done.returncode, done.stderr) == (1, "crazybilliards: no room for the legend\n")
    assert {path.name for path in tmp_path.glob("*.[np]*")} == {"theory.nc", "profile.png"}


def test_a_sweep_is_computed_on_a_dask_cluster(arguments, run, tmp_path, monkeypatch):
    """Whose client stands here for it."""

    @contextmanager
    def client(scheduler, set_as_default):
        assert (scheduler, set_as_default) == ("tcp://here:1", False)
        yield SimpleNamespace(get_executor=lambda pure: AtOnce())

    monkeypatch.setitem(sys.modules, "distributed", SimpleNamespace(Client=client))
    file = arguments("sweep")[1]
    done = run("sweep", file, "--output", tmp_path / "results", "--scheduler", "tcp://here:1")
    assert done.returncode == 0, done.stderr
    assert len([*tmp_path.glob("results/*.nc")]) == 1
