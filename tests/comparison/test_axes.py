"""Axes fit what is drawn with its errors, and do not magnify noise."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from drawn_pictures import share_of_the_axis

from crazybilliards.comparison import overlay
from crazybilliards.comparison.drawing import draw_rods
from crazybilliards.comparison.side_by_side.grid import KINETIC, SIMULATION
from crazybilliards.comparison.side_by_side.grid_figures import draw_profile, draw_widths
from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain

EXACT = equilibrium(Chain(size=100))
UNIT = EXACT.velocity_width.values[0]
NOISE = np.random.default_rng(1).normal(size=100)
PLACE = EXACT.normalized_particle.values


def measured(widths, error):
    """Return widths of rods as a simulation would report them, in units of the free rod's."""
    found = EXACT.assign(velocity_width=EXACT.velocity_width.copy(data=UNIT * widths))
    errors = {
        f"{name}_error": ("particle", size * np.ones(100))
        for name, size in (("velocity_width", UNIT * error), ("mean_displacement", 1e-9))
    }
    return found.assign(errors).assign_attrs(source="simulation")


def by_overlay(widths, error):
    return overlay({"run": measured(widths, error)}, "velocity_width"), UNIT


def by_draw_rods(widths, error):
    _, ax = plt.subplots()
    draw_rods(ax, measured(widths, error), "velocity_width", number=0, label="run", unit=UNIT)
    return ax, 1.0


def by_draw_widths(widths, error):
    tree = xr.DataTree.from_dict({f"size_100/{SIMULATION}": measured(widths, error)})
    return draw_widths(tree).axes[0], 1.0


PICTURES = pytest.mark.parametrize("draw", [by_overlay, by_draw_rods, by_draw_widths])


@PICTURES
@pytest.mark.parametrize("error", [1e-4, 1e-3, 0.02])
def test_noise_does_not_fill_the_axis(draw, error):
    """A hundred rods are within three standard errors of a flat line."""
    ax, unit = draw(1 + error * NOISE, error)
    assert share_of_the_axis(ax, unit * error * NOISE) < 0.3


@PICTURES
@pytest.mark.parametrize(("lowest", "highest"), [(0.9, 1.1), (0.3, 0.7), (2.0, 40.0)])
def test_widths_that_differ_fill_the_axis(draw, lowest, highest):
    widths = lowest + (highest - lowest) * PLACE**2
    ax, unit = draw(widths, 0.001)
    assert share_of_the_axis(ax, unit * widths) > 0.85
    low, high = ax.get_ylim()
    assert low < unit * (widths.min() - 0.001)
    assert high > unit * (widths.max() + 0.001)


@pytest.mark.parametrize("bend", [1e-6, 0.4])
def test_a_theory_alone_is_not_magnified_and_fills_the_axis_if_it_bends(bend):
    bent = EXACT.assign(velocity_width=EXACT.velocity_width * (1 - bend * PLACE**2))
    theory = draw_profile(bent, "theory").axes[0]
    both = {f"size_100/{SIMULATION}": measured(np.ones(100), 1e-9)}
    beside = draw_widths(xr.DataTree.from_dict(both | {f"size_100/{next(iter(KINETIC))}": bent}))
    for ax, unit in ((theory, UNIT), (beside.axes[0], 1.0)):
        share = share_of_the_axis(ax, [0, unit * bend])
        assert share < 1e-4 if bend < 1e-3 else share > 0.8


def test_large_errors_of_a_few_rods_leave_the_axis_to_the_others():
    """Those of the outermost are often ten times the others, and the bars are seen whole."""
    errors = np.where(np.abs(PLACE) > 0.97, 0.1, 0.01)
    widths = 0.3 + 0.4 * PLACE**2
    ax, unit = by_draw_widths(widths, errors)
    assert share_of_the_axis(ax, unit * widths) > 0.6
    low, high = ax.get_ylim()
    assert low > 0.2
    assert high > (widths + errors).max()


def test_a_second_curve_widens_the_axis_of_the_first():
    ax, unit = by_overlay(1 + 1e-4 * NOISE, 1e-4)
    overlay({"other": measured(0.5 + 0 * NOISE, 1e-4)}, "velocity_width", ax=ax)
    low, high = ax.get_ylim()
    assert low < 0.5 * unit
    assert high > unit
