"""The command ``relax``: pictures, a film if asked for, data, and what Ctrl-C leaves of them."""

import pytest
import xarray as xr

from crazybilliards.model import load

RELAX = ["relax", "--size", "10", "--duration", "4", "--replicas", "8", "--every", "1"]


@pytest.mark.compiled
def test_relax_writes_pictures_the_data_and_a_film(run, tmp_path):
    """Without --film there is none, as the table of interrupted commands shows."""
    done = run(*RELAX, "--release", "quenched", "--output", str(tmp_path), "--film")
    assert done.returncode == 0, done.stderr
    pictures = ["cloud.png", "profiles.png", "spacetime.png"]
    written = {*pictures, "relaxation.html", "relaxation.nc"}
    assert {path.name for path in tmp_path.iterdir()} == written
    page = (tmp_path / "relaxation.html").read_text()
    assert "<h1>10 rods, A = 30, g = 0, quenched by 3 and released" in page
    assert "<video" in page
    tree = load(tmp_path / "relaxation.nc")
    assert set(tree.children) == {"particles", "isothermal", "evolving", "rods", "exact"}
    assert "rms distance" in done.stdout


@pytest.mark.compiled
@pytest.mark.filterwarnings("ignore:equal elastic rods")
def test_relax_knows_a_box(run, tmp_path):
    gas = ["--box", "40", "--stiffness", "0", "--output", str(tmp_path)]
    done = run(*RELAX, "--release", "gathered", *gas)
    assert done.returncode == 0, done.stderr
    assert "rms distance / h" in done.stdout
    assert load(tmp_path / "relaxation.nc").attrs["by"] == 0.5


def test_a_film_needs_a_folder(refused):
    refused("film needs --output FOLDER", *RELAX, "--film")


def test_one_ctrl_c_is_enough_while_the_fluids_are_computed(run, monkeypatch):
    calls = []

    def interrupted(*arguments, **settings):
        calls.append(settings)
        return xr.Dataset(attrs={"status": "interrupted"})

    monkeypatch.setattr(
        "crazybilliards.comparison.side_by_side.relaxation.hydrodynamics", interrupted
    )
    assert run(*RELAX).returncode == 130
    assert len(calls) == 1
