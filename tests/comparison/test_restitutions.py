"""Simulation against the kinetic equation: what comes out, and the pictures of it."""

import warnings

import matplotlib
import numpy as np
import pytest

from crazybilliards.comparison import compare
from crazybilliards.comparison.distances import deviations
from crazybilliards.comparison.side_by_side.grid import KINETIC, SIMULATION, TITLES
from crazybilliards.comparison.side_by_side.grid_figures import (
    draw_density,
    draw_displacement,
    draw_phase_space,
    draw_profile,
    draw_widths,
)
from crazybilliards.comparison.widths import width_deviation
from crazybilliards.kinetic import equilibrium, phase_space
from crazybilliards.model import Chain

matplotlib.use("Agg")
CHAIN = Chain(size=20)
QUIET = {"progress": False, "threads": 1}

pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def tree():
    return compare(CHAIN, {"restitution": [0.9, 1.0]}, duration=500, **QUIET)


def test_tree_holds_both(tree):
    assert list(tree.children) == ["restitution_0.9", "restitution_1"]
    assert tree.attrs["status"] == "completed"
    for group in tree.children.values():
        assert set(group.children) == {SIMULATION, *KINETIC}


def test_deviations(tree):
    every = [found for group in tree.children.values() for found in deviations(group).values()]
    assert len(every) == 4
    for density, width in every:
        assert abs(width.centre) < 0.02 + 5 * width.error
        assert abs(width.largest) < 0.02 + 5 * width.error
        assert density.rms < 0.02


def test_width_deviation_of_a_known_difference():
    theory = phase_space(CHAIN, cells=16)
    wider = equilibrium(CHAIN)
    wider["velocity_width"] = wider.velocity_width * 1.1
    wider["velocity_width_error"] = wider.velocity_width * 0.01
    found = width_deviation(wider, theory)
    for value in (found.centre, found.border):
        assert value == pytest.approx(1 / 1.1 - 1, rel=1e-3)
    assert found.largest == pytest.approx(1 - 1 / 1.1, rel=1e-3)
    assert found.error == pytest.approx(0.01)
    assert found.border_error == pytest.approx(0.01 / 2**0.5)
    assert found.largest_in_errors == pytest.approx(100 * (1 - 1 / 1.1), rel=1e-3)


def test_without_a_steady_state_there_is_a_warning_and_no_theory():
    chain = Chain(size=60, damping=1.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        tree = compare(chain, {"restitution": [1.1]}, duration=40, **QUIET)
    assert any("no steady state" in str(each.message) for each in caught)
    assert set(tree["restitution_1.1"].children) == {SIMULATION}
    assert deviations(tree["restitution_1.1"]) == {}


def opacities(ax, label=None):
    return [each.get_alpha() for each in ax.lines if label in (None, each.get_label())]


def bands(ax):
    return [each for each in ax.collections if each.get_alpha() == 0.125]


@pytest.mark.parametrize("large", [False, True])
def test_a_curve_is_faint_in_a_band_of_its_stated_error_if_that_is_large(tree, large):
    """A fifth of the axis: the errors are made up, on one side of it."""
    tree = tree.copy(deep=True)
    names = ("mean_displacement_model_error", "velocity_width_model_error", "density_model_error")
    for key in KINETIC:
        tree[f"restitution_0.9/{key}"].attrs |= dict.fromkeys(names, 0.0)
    before = [ax.get_ylim() for ax in (*draw_widths(tree).axes, *draw_density(tree).axes)]
    stated = dict(zip(names, (2.0, 0.4, 0.4) if large else (0.01, 0.01, 0.01), strict=True))
    tree["restitution_0.9/kinetic_equation"].attrs |= stated
    widths, density = draw_widths(tree), draw_density(tree)
    for ax in widths.axes:
        assert opacities(ax).count(0.25) == len(bands(ax)) == large  # one of four theories
    above, below = density.axes[:2]
    theory, other = (TITLES[key] for key in KINETIC)
    for ax in (above, above.child_axes[0], below):
        assert opacities(ax, theory) == [0.25 if large else None]
        assert opacities(ax, other) == [None]
    assert len(bands(above)) == large
    if large:
        height = np.ptp(bands(above)[0].get_paths()[0].vertices[:, 1])
        assert height > 2 * 0.4 * CHAIN.close_packed_density
    assert [ax.get_ylim() for ax in (*widths.axes, *density.axes)] == before
    profile = draw_profile(tree["restitution_0.9/kinetic_equation"].to_dataset(), "theory")
    assert [opacities(ax)[0] for ax in profile.axes] == [0.25 if large else None] * 2


def test_pictures(tree):
    widths = draw_widths(tree)
    assert widths.axes[0].get_ylabel() == "velocity width $W_v/W$"
    theory = tree["restitution_0.9/kinetic_equation"].to_dataset()
    density = draw_density(tree)
    above, below = density.get_axes()[:2]
    assert "e = 0.9" in above.get_title(loc="left")
    labels = above.get_legend_handles_labels()[1]
    assert sorted(labels) == sorted(TITLES[name] for name in (SIMULATION, *KINETIC))
    assert below.has_data()  # the differences from the simulation
    labels = draw_displacement(tree).axes[0].get_legend_handles_labels()[1]
    assert sorted(labels) == sorted(TITLES[name] for name in (SIMULATION, *KINETIC))
    image = draw_phase_space(theory)
    assert "e = 0.9" in image.axes[0].get_title()
    assert len(draw_profile(theory, "kinetic equation").axes) == 2
    with pytest.raises(ValueError, match="phase_space_density"):
        draw_phase_space(tree[f"restitution_0.9/{SIMULATION}"].to_dataset())
    matplotlib.pyplot.close("all")


def test_any_parameter_may_vary():
    """The theories are those of elastic chains only if all are elastic."""
    tree = compare(CHAIN.replace(restitution=0.9), {"amplitude": [2]}, duration=200, **QUIET)
    assert list(tree.children) == ["amplitude_2"]
    assert "kinetic_equation" in tree["amplitude_2"]
    tree = compare(CHAIN, {"size": [10, 12]}, duration=200, **QUIET)
    assert "exact" in tree["size_12"]
    titles = [ax.get_title(loc="left") for ax in draw_displacement(tree).axes]
    assert [title[:14] for title in titles if title] == ["(a)  $L = 10$,", "(b)  $L = 12$,"]
    spring = compare(CHAIN, {"spring": ["linear", "quadratic"]}, duration=200, **QUIET)
    assert list(spring.children) == ["spring_linear", "spring_quadratic"]
    draw_widths(spring)
    matplotlib.pyplot.close("all")


@pytest.mark.parametrize(
    ("restitutions", "message"),
    [([], "at least one"), ([0.9, 0.9], "differ"), ([-1.0], "restitution"), ([np.nan], "restit")],
)
def test_bad_input(restitutions, message):
    with pytest.raises(ValueError, match=message):
        compare(CHAIN, {"restitution": restitutions}, **QUIET)
