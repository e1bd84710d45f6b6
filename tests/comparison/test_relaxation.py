"""The relaxation of one chain in all descriptions."""

import numpy as np
import pytest

from crazybilliards.comparison import animate, compare_relaxation
from crazybilliards.comparison.side_by_side.relaxation import cloud, condensed, label_distances
from crazybilliards.comparison.side_by_side.relaxation_figures import (
    draw_cloud,
    draw_profiles,
    draw_spacetime,
)
from crazybilliards.model import Chain, chain_of, load, save

pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def tree():
    return compare_relaxation(
        Chain(size=50, amplitude=20), "compressed", 0.3, duration=20, replicas=300, progress=False
    )


def test_the_isothermal_fluid_is_wrong_and_the_one_with_temperature_right(tree):
    distances = label_distances(tree)
    assert distances["isothermal"] > 0.5
    assert distances["evolving"] < 0.05
    assert distances["exact"] < 0.05
    # Rod by rod the fluid with a temperature is exact: what is left is the grid.
    rods, exact = tree["rods"].mean_displacement, tree["exact"].mean_displacement
    assert (
        float(np.abs(rods - exact).max())
        < 1e-3 * chain_of(tree["rods"].to_dataset()).thermal_length
    )


@pytest.mark.parametrize(("release", "by"), [("displaced", 2.0), ("quenched", 3.0)])
def test_with_a_gap_the_fluid_with_temperature_stays_close(release, by):
    chain = Chain(size=50, gap=0.2, amplitude=5)
    tree = compare_relaxation(chain, release, by, duration=20, replicas=100, progress=False)
    assert "exact" not in tree
    distances = label_distances(tree)
    assert distances["evolving"] < 0.1
    if release == "quenched":
        assert distances["isothermal"] > 4 * distances["evolving"]


def test_the_pictures_show_every_description(tree):
    titles = [ax.get_title(loc="left") for ax in draw_spacetime(tree).axes]
    assert titles == [
        *("(a)  simulation", "(b)  isothermal fluid", "(c)  fluid with temperature"),
        *("(d)  rods of this fluid", ""),
    ]
    assert len(draw_profiles(tree).axes) == 4
    labels = draw_cloud(tree).axes[0].get_legend_handles_labels()[1]
    assert set(labels) == {"simulation", "isothermal fluid", "fluid with temperature", "exact"}


def test_the_cloud_of_the_ensemble_is_the_exact_one_within_its_error_bars(tree):
    """The errors are bounds, so three of them are more than three standard errors."""
    found, exact = cloud(tree["particles"].to_dataset()), tree["exact"]
    for name in ("centre", "cloud_width"):
        off = (found[name] - exact[name]) / found[f"{name}_error"]
        assert float(np.abs(off).max()) < 3
        assert float(np.abs(off).max()) > 0.1


def test_what_is_stored_is_a_tenth_and_drawn_like_the_whole(tree, tmp_path):
    stored = load(save(condensed(tree), tmp_path / "stored.nc"))
    whole = save(tree, tmp_path / "whole.nc")
    assert (tmp_path / "stored.nc").stat().st_size < whole.stat().st_size / 10
    assert label_distances(stored) == label_distances(tree)
    for kept, drawn in zip(
        draw_profiles(stored).axes[0].lines, draw_profiles(tree).axes[0].lines, strict=True
    ):
        ours, theirs = (np.asarray(line.get_ydata(), dtype=float) for line in (kept, drawn))
        np.testing.assert_allclose(ours, theirs, rtol=1e-6, atol=1e-9)


def test_the_animation_moves_lines_through_every_bin(tree):
    animation = animate(tree)
    ax = animation._fig.axes[0]
    [rods] = [line for line in ax.lines if line.get_label() == "simulation"]
    x = tree["particles"].x.values
    shown = rods.get_xdata()
    np.testing.assert_array_equal(shown, x[(x >= shown[0]) & (x <= shown[-1])])
    before = [line.get_ydata().copy() for line in ax.lines]
    animation._func(10)
    moved = [
        not np.array_equal(a, line.get_ydata()) for a, line in zip(before, ax.lines, strict=True)
    ]
    assert sum(moved) >= 3
    animation._draw_was_started = True  # it need not be shown
