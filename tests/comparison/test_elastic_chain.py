"""The main comparison: what it promises about simulation and theory at e = 1."""

import os
import re
import signal
from functools import wraps
from pathlib import Path

import numpy as np
import pytest

from crazybilliards.comparison import compare, smooth
from crazybilliards.comparison.distances import deviations
from crazybilliards.comparison.side_by_side import grid
from crazybilliards.comparison.side_by_side.grid import ELASTIC
from crazybilliards.comparison.side_by_side.grid_figures import draw_density, draw_displacement
from crazybilliards.comparison.stationary_theories import TITLES
from crazybilliards.comparison.sweeps import case, run_cases, running
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.process import terminated_like_interrupted
from crazybilliards.particles import simulate

pytestmark = pytest.mark.compiled
AMPLITUDES = {"amplitude": [1, 3, 10, 30]}
WITHOUT_FIT = ("equilibrium", "force_balance", "rod_by_rod")


@pytest.fixture(scope="module")
def tree():
    return compare(Chain(), AMPLITUDES, duration=15_000, seed=1, progress=False)


@pytest.fixture(scope="module")
def found(tree):
    return [deviations(group) for group in tree.children.values()]


@pytest.mark.validate
def test_the_start_page_has_the_numbers_that_make_run_prints():
    """Every number of its table, and the sentence below it."""
    page = (Path(__file__).parents[2] / "docs/index.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| *(\d+) \|(.*)\|$", page, re.MULTILINE)
    told = {f"amplitude_{a}": [float(cell) for cell in cells.split("|")] for a, cells in rows}
    groups = compare(Chain(), AMPLITUDES, progress=False).children
    found = {name: deviations(group) for name, group in groups.items()}
    assert told == {
        name: [round(100 * found[name][key].density.maximum, 2) for key in ELASTIC]
        for name in found
    }
    largest = max(
        by_theory["equilibrium"].density.maximum_in_errors for by_theory in found.values()
    )
    assert f"by at most {largest:.1f} standard errors in any bin" in page


def test_simulation_and_exact_density_agree_and_every_velocity_width_is_the_free_one(found):
    """Within 1 % of close packing, and within 5 standard errors everywhere."""
    for by_theory in found:
        exact = by_theory["equilibrium"].density
        assert exact.maximum < 0.01
        assert exact.maximum_in_errors < 5
        assert exact.rms_in_errors < 1.5
        assert by_theory["force_balance_arctanh"].velocity_width is None
        for name in WITHOUT_FIT:
            assert by_theory[name].velocity_width.largest_in_errors < 5


def test_the_arctanh_closure_is_as_good_as_it_was_measured(found):
    """Largest deviation from the simulation, in units of close packing; 0.003 of it is noise."""
    off = [each["force_balance_arctanh"].density.maximum for each in found]
    assert off == pytest.approx([0.150, 0.110, 0.032, 0.014], abs=0.005)


def test_the_tree_holds_everything_with_its_chain(tree):
    assert tree.attrs["status"] == "completed"
    assert list(tree.children) == [f"amplitude_{a}" for a in (1, 3, 10, 30)]
    for group in tree.children.values():
        assert set(group.children) == {"simulation", *ELASTIC}
        assert len({chain_of(each.to_dataset()) for each in group.children.values()}) == 1
    arctanh = tree["amplitude_10/force_balance_arctanh"]
    for name, share in (("scale", 6.1e-4), ("steepness", 2.2e-4)):  # as of the force balance
        assert arctanh.attrs[f"{name}_error"] == pytest.approx(share * arctanh.attrs[name], rel=0.2)


def test_rods_that_hardly_touch_go_without_the_arctanh_but_lose_nothing(monkeypatch):
    """Whether a fit of noise finds an arctanh is chance."""

    def fail(run):
        raise ValueError("no arctanh fits")

    monkeypatch.setattr(grid, "fit_arctanh", fail)
    with pytest.warns(UserWarning, match="has no arctanh fit: no arctanh fits"):
        tree = compare(Chain(size=20), {"amplitude": [1]}, duration=500, seed=1, progress=False)
    assert set(tree["amplitude_1"].children) == {"simulation", *WITHOUT_FIT}
    assert set(deviations(tree["amplitude_1"])) == {*WITHOUT_FIT}


@pytest.mark.parametrize("mass_ratio", [1, 3])
def test_a_gas_in_a_box_goes_without_the_fit_and_has_its_pressure(mass_ratio):
    chain = Chain(size=10, box=30, stiffness=0, mass_ratio=mass_ratio)
    tree = compare(chain, {"amplitude": [1]}, duration=2000, seed=1, progress=False)
    [group] = tree.children.values()
    assert list(group.children) == ["simulation", *WITHOUT_FIT]
    run, law = group["simulation"], 10 * chain.temperature / 10
    assert (np.abs(run.wall_force - law) < 5 * run.wall_force_error).all()
    for key, found in deviations(group).items():
        np.testing.assert_allclose(group[key].wall_force, law, rtol=1e-9)
        assert found.velocity_width.largest_in_errors < 5
    assert deviations(group)["rod_by_rod"].density.maximum_in_errors < 5
    for draw in (draw_density, draw_displacement):
        figure = draw(tree)
        figure.canvas.draw()
        assert figure.get_axes()[0].get_title(loc="left") == "$A = 1$"


def test_what_the_folder_holds_is_not_computed_again(monkeypatch, tmp_path):
    """A larger comparison computes what is new; other settings and random numbers are new."""
    computed = []  # the amplitudes

    @wraps(simulate)
    def noted(chain, **settings):
        computed.append(chain.amplitude)
        return simulate(chain, **settings)

    monkeypatch.setitem(case.JOBS, "simulate", noted)
    how = {"folder": tmp_path, "progress": False, "duration": 500}
    first = compare(Chain(size=5), {"amplitude": [1, 2]}, **how)
    assert compare(Chain(size=5), {"amplitude": [1, 2]}, **how).identical(first)
    assert computed == [1, 2]
    assert compare(Chain(size=5), {"amplitude": [2]}, **how, processes=1).equals(
        first.filter(lambda node: "amplitude_1" not in node.path)
    )
    compare(Chain(size=5), {"amplitude": [1, 3]}, **how)
    compare(Chain(size=5), {"amplitude": [1]}, seed=1, **how)
    assert computed == [1, 2, 3, 1]


@pytest.mark.posix
def test_a_signal_keeps_what_was_computed(monkeypatch, tmp_path):
    """In a command. A program that calls this has the handlers that it sets."""
    write = running.write_sealed

    def stop(path, content):
        write(path, content)
        os.kill(os.getpid(), signal.SIGTERM)

    how = {"folder": tmp_path, "progress": False, "duration": 500}
    with monkeypatch.context() as patch, terminated_like_interrupted():
        patch.setattr(running, "write_sealed", stop)
        cut = compare(Chain(size=5), {"amplitude": [1, 2]}, **how)
    assert cut.attrs["status"] == "interrupted"
    assert list(cut.children) == ["amplitude_1"]
    assert set(cut["amplitude_1"].children) == {"simulation", *ELASTIC}
    whole = compare(Chain(size=5), {"amplitude": [1, 2]}, **how)
    assert whole.attrs["status"] == "completed"
    assert whole["amplitude_1/simulation"].identical(cut["amplitude_1/simulation"])


def test_a_completed_comparison_lacks_no_chain(monkeypatch, tmp_path):
    """A file that cannot be read when all are there is an error, and not a chain less."""

    def damaged(cases, folder, *executor, **how):
        failed = run_cases(cases, folder, *executor, **how)
        cases[1].file(folder).write_bytes(b"")
        return failed

    monkeypatch.setattr(grid, "run_cases", damaged)
    with pytest.raises(ValueError, match="truncated"):
        compare(Chain(size=5), {"amplitude": [1, 2]}, duration=500, folder=tmp_path, progress=False)


def test_pictures_show_simulation_and_exact_solution_and_the_differences_of_all_theories(tree):
    results = {key: each.to_dataset() for key, each in tree["amplitude_1"].children.items()}
    smoothed = {key: smooth(each).density for key, each in results.items()}
    shift = {key: each.mean_displacement for key, each in results.items()}
    chain = chain_of(results["equilibrium"])
    for draw, values, unit in (
        (draw_density, smoothed, chain.close_packed_density),
        (draw_displacement, shift, chain.thermal_length),
    ):
        figure = draw(tree)
        above, below = figure.get_axes()[0], figure.get_axes()[len(tree.children)]
        assert set(above.get_legend_handles_labels()[1]) == {"simulation", TITLES["equilibrium"]}
        assert len(figure.legends[0].get_texts()) == 5
        lines = {line.get_label(): line for line in below.lines}
        for key in ELASTIC[1:]:  # the largest difference is at the end
            percent = 100 * float(np.abs(values[key] - values["equilibrium"]).max()) / unit
            assert np.abs(lines[TITLES[key]].get_ydata()).max() == pytest.approx(percent, rel=1e-6)
