"""The relaxation of one chain in all descriptions."""

from functools import cache

import numpy as np
import pytest
import xarray as xr

from crazybilliards.comparison import compare_relaxation, deviation, film, smooth
from crazybilliards.comparison.drawing import house_style
from crazybilliards.comparison.side_by_side import relaxation
from crazybilliards.comparison.side_by_side.relaxation import cloud, condensed, label_distances
from crazybilliards.comparison.side_by_side.relaxation_figures import (
    draw_cloud,
    draw_profiles,
    draw_spacetime,
    relaxation_film,
)
from crazybilliards.model import Chain, chain_of, load, save

pytestmark = pytest.mark.compiled


def columns_without_numbers(figure):
    """Return the columns of panels whose lowest has no numbers or no name below it."""
    figure.draw_without_rendering()
    lowest = {ax.get_subplotspec().colspan.start: ax for ax in figure.axes if ax.get_title("left")}
    below = {
        column: [each.get_text() for each in ax.get_xticklabels() if each.get_visible()]
        for column, ax in lowest.items()
        if ax.get_xlabel()
    }
    return [column for column in lowest if not any(below.get(column, []))]


@pytest.fixture(scope="module")
def tree():
    how = {"duration": 10, "every": 1, "replicas": 400, "progress": False}
    return compare_relaxation(Chain(size=20, amplitude=20), "compressed", 0.3, **how)


def test_the_isothermal_fluid_is_wrong_and_the_one_with_temperature_right(tree):
    distances = label_distances(tree)
    assert distances["isothermal"] > 0.5
    assert distances["evolving"] < 0.05
    assert distances["exact"] < 0.05
    # Rod by rod the fluid with a temperature is exact: what is left is the grid.
    rods, exact = tree["rods"].mean_displacement, tree["exact"].mean_displacement
    s = chain_of(tree["rods"].to_dataset()).thermal_length
    assert float(np.abs(rods - exact).max()) < 1e-3 * s


def test_with_a_gap_the_fluid_with_temperature_stays_close():
    chain = Chain(size=50, gap=0.2, amplitude=5)
    how = {"duration": 5, "every": 1, "replicas": 200, "progress": False}
    tree = compare_relaxation(chain, "quenched", 3.0, **how)
    assert "exact" not in tree
    distances = label_distances(tree)
    assert 8 * distances["evolving"] < min(distances["isothermal"], 8 * 0.12)


def test_inelastic_chains_are_followed_by_the_fluid_with_temperature_and_heat_flux():
    chain = Chain(size=20, restitution=0.95, amplitude=20)
    how = {"duration": 10, "replicas": 200, "progress": False}
    tree = compare_relaxation(chain, "compressed", 0.8, **how)
    assert set(tree.children) == {"simulation", "evolving", "rods"}
    assert label_distances(tree)["rods"] < 0.05
    assert len(draw_spacetime(condensed(tree)).axes) == 4


def test_a_fluid_that_diverges_is_refused_before_the_simulation(monkeypatch):
    diverged = xr.Dataset(attrs={"status": "diverged", "end_time": 0.5})
    monkeypatch.setattr(relaxation, "hydrodynamics", lambda *_, **__: diverged)
    with pytest.raises(ValueError, match=r"the energy diverges after t = 0\.5: give a shorter"):
        compare_relaxation(Chain(size=5, restitution=1.05), progress=False)


GAS = Chain(size=20, box=80, stiffness=0, mass=1, damping=0.01, amplitude=0.02**0.5)


@cache
def released(chain, release, by):
    """Follow a gas in a box until its points have crossed it; do not change what is returned."""
    how = {"duration": 24, "every": 8, "replicas": 200, "progress": False}
    return compare_relaxation(chain, release, by, **how)


@pytest.mark.parametrize(
    ("release", "by"), [("gathered", 0.5), ("wave", -0.4), ("confined", 0.5), ("quenched", 2.0)]
)
@pytest.mark.filterwarnings("ignore:equal elastic rods", "ignore:the error of the force balance")
def test_a_gas_in_a_box_moves_as_its_points_do_and_not_as_a_fluid(release, by):
    tree = released(GAS, release, by)
    run, exact = tree["simulation"].to_dataset(), tree["exact"].to_dataset()
    off = (run.mean_displacement - exact.mean_displacement) / run.mean_displacement_error
    assert float(np.abs(off).max()) < 5
    for time in range(run.sizes["time"]):
        found = deviation(  # the error of the few rods whose ends reach a wall is not known
            *(smooth(each).isel(time=time).sel(x=slice(-40, 40)) for each in (run, exact))
        )
        assert found.maximum_in_errors < 6  # the largest of a thousand in all
    h, start = GAS.walls[1], exact.mean_displacement[0]
    assert float(np.abs(tree["rods"].mean_displacement[0] - start).max()) < 0.02 * h
    if release != "quenched":  # which leaves the density even
        assert tree["isothermal"].attrs["wave_model_error"] > 0.4
        distances = label_distances(tree)
        assert distances["isothermal"] > 2 * distances["exact"]


@pytest.mark.filterwarnings("ignore:equal elastic rods")
def test_pictures_of_a_gas_in_a_box_have_walls_and_five_descriptions():
    tree = released(GAS, "gathered", 0.5)
    titles = [ax.get_title(loc="left") for ax in draw_spacetime(tree).axes]
    assert titles[3:] == ["(d)  this fluid, rod by rod", "(e)  exact", ""]
    walls = {line.get_xdata()[0] for line in draw_profiles(tree).axes[0].lines} & {-40, 40}
    assert walls == {-40, 40}
    assert draw_cloud(tree).axes[1].get_ylabel() == "centre / $h$"


def test_two_masses_make_a_fluid_of_the_gas():
    tree = released(GAS.replace(mass_ratio=3), "wave", 0.5)
    assert "exact" not in tree
    distances = label_distances(tree)
    assert distances["evolving"] < 0.8 * distances["isothermal"]


def test_the_pictures_show_every_description(tree):
    titles = [ax.get_title(loc="left") for ax in draw_spacetime(tree).axes]
    assert titles == [
        *("(a)  simulation", "(b)  isothermal fluid", "(c)  fluid with a temperature"),
        *("(d)  this fluid, rod by rod", ""),
    ]
    assert len(draw_profiles(tree).axes) == 4
    assert columns_without_numbers(draw_profiles(tree)) == []
    labels = draw_cloud(tree).axes[0].get_legend_handles_labels()[1]
    assert set(labels) == {"simulation", "isothermal fluid", "fluid with a temperature", "exact"}


@pytest.mark.parametrize("number", [3, 4])
def test_every_column_of_panels_has_numbers_below_it(tree, number):
    """Of an odd number of panels the last one is missing."""
    keys = ["simulation", "isothermal", "evolving", "rods"][:number]
    short = tree["evolving"].to_dataset().isel(time=slice(3))
    with house_style():
        figure = draw_spacetime(xr.DataTree.from_dict(dict.fromkeys(keys, short)))
        assert len([ax for ax in figure.axes if ax.get_title("left")]) == number
        assert columns_without_numbers(figure) == []


@pytest.mark.parametrize("number", [1, 3, 7])
def test_profiles_are_of_different_times_and_no_density_is_below_0(tree, number):
    short = tree.map_over_datasets(lambda each: each.isel(time=slice(number)) if each else each)
    axes = draw_profiles(short).axes
    assert len({ax.get_title(loc="left")[3:] for ax in axes}) == len(axes) == min(number, 4)
    assert {ax.get_ylim()[0] for ax in axes} == {0}


def test_the_noise_of_a_centre_at_rest_does_not_fill_the_axis(tree):
    resting = tree["evolving"].to_dataset().isel(time=slice(3))
    resting["mean_displacement"] = 1e-9 * resting.mean_displacement
    picture = draw_cloud(xr.DataTree.from_dict({"simulation": resting, "evolving": resting}))
    assert picture.axes[1].get_ylim() == (-0.1, 0.1)


def test_the_cloud_of_the_ensemble_is_the_exact_one_within_its_error_bars(tree):
    """The errors are bounds, so three of them are more than three standard errors."""
    found, exact = cloud(tree["simulation"].to_dataset()), tree["exact"]
    for name in ("centre", "cloud_width"):
        off = (found[name] - exact[name]) / found[f"{name}_error"]
        assert float(np.abs(off).max()) < 3
        assert float(np.abs(off).max()) > 0.1


def test_what_is_stored_is_a_tenth_and_drawn_like_the_whole(tree, tmp_path):
    stored = load(save(condensed(tree), tmp_path / "stored.nc"))
    whole = save(tree, tmp_path / "whole.nc")
    assert (tmp_path / "stored.nc").stat().st_size < whole.stat().st_size / 10
    assert label_distances(stored) == label_distances(tree)
    pairs = zip(*(draw_profiles(each).axes[0].lines for each in (stored, tree)), strict=True)
    for kept, drawn in pairs:
        ours, theirs = (np.asarray(line.get_ydata(), dtype=float) for line in (kept, drawn))
        np.testing.assert_allclose(ours, theirs, rtol=1e-6, atol=1e-9)


def test_a_film_shows_all_densities_in_motion(tree):
    figure, show, number = relaxation_film(tree, 5)
    [ax] = figure.axes
    assert number == 5
    for picture, moment in ((0, 0), (4, -1)):
        show(picture)
        for line, key in zip(
            ax.lines, ("simulation", "isothermal", "evolving", "rods"), strict=True
        ):
            density = smooth(tree[key].to_dataset()).density.isel(time=moment)
            np.testing.assert_array_equal(line.get_ydata(), density.sel(x=line.get_xdata()))
    with pytest.raises(ValueError, match=r"must be what compare_relaxation returns, got a tree"):
        film(tree.filter(lambda node: "simulation" not in node.path))
