"""The command ``relax``: pictures, animations, data, and what Ctrl-C leaves of them."""

import re

import pytest
import xarray as xr

from crazybilliards.model import load

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
    # It is a page with a heading, plays, and is as wide as the window.
    assert "<h1>10 rods, A = 30, g = 0, quenched by 3 and released" in page
    assert re.search(r"= new Animation\([^)]*\);\s*if \(!matchMedia.*play_animation\(\)", page)
    assert "input[type=range].anim-slider { width: 100%; }" in page
    tree = load(tmp_path / "relaxation.nc")
    assert set(tree.children) == {"particles", "isothermal", "evolving", "rods", "exact"}
    assert "rms distance" in done.stdout


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
