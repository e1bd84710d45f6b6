"""Overlays: symbols for simulations, lines for theories, in the reader's own style."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from drawn_pictures import simulated

from crazybilliards.comparison import overlay, smooth
from crazybilliards.comparison.drawing import mark_clipped
from crazybilliards.kinetic import equilibrium, force_balance
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

CHAIN = Chain(size=10, amplitude=3)


def test_overlay_draws_symbols_with_errors_and_lines():
    run, exact = simulate(CHAIN, duration=300, progress=False), equilibrium(CHAIN)
    ax = overlay({"rods": run, "exact": exact}, "velocity_width")
    [bars], [line] = ax.containers, ax.lines[1:]
    symbols = bars.lines[0]
    assert (symbols.get_linestyle(), symbols.get_marker()) == ("None", "o")
    np.testing.assert_array_equal(symbols.get_xdata(), run.normalized_particle)
    np.testing.assert_array_equal(symbols.get_ydata(), run.velocity_width)
    ends = np.array([bar[:, 1] for bar in bars.lines[2][0].get_segments()])
    np.testing.assert_allclose(np.diff(ends)[:, 0], 2 * run.velocity_width_error)
    assert (line.get_linestyle(), line.get_marker()) == ("-", "None")
    np.testing.assert_array_equal(line.get_ydata(), exact.velocity_width)
    assert ax.get_xlabel() == "normalized particle $i_n$"
    assert ax.get_ylabel() == "velocity width $W_v$ [$R/t_0$]"
    assert set(ax.get_legend_handles_labels()[1]) == {"exact", "rods"}


def test_displacements_over_the_mean_positions_of_the_rods():
    theory = force_balance(CHAIN)
    ax = overlay({"theory": theory}, "mean_displacement", along="mean_position")
    assert ax.get_xlabel() == r"mean position $\langle x_i\rangle$ [R]"
    np.testing.assert_array_equal(ax.lines[0].get_xdata(), theory.mean_position)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_of_many_values_all_are_drawn_as_a_line_and_some_as_symbols(scale):
    """Symbols alone would show waves that do not exist. NaN leaves a gap in the line."""
    x = np.arange(1.0, 2802.0)
    values = 0.4 + 0.03 * np.cos(2 * np.pi * x / 25)
    values[1000] = np.nan
    _, ax = plt.subplots()
    ax.set_xscale(scale)
    overlay({"rods": simulated(x, values)}, ax=ax)
    [bars] = ax.containers
    line = bars.lines[0]
    np.testing.assert_array_equal(line.get_ydata(), values)
    assert line.get_linestyle() == "-"
    symbols = x[line.get_markevery()]
    assert 20 <= symbols.size <= 60
    spacings = np.diff(symbols if scale == "linear" else np.log(symbols[5:]))
    assert np.ptp(spacings) < 0.3 * spacings.mean()
    assert len(bars.lines[2][0].get_segments()) == symbols.size


def test_curves_differ_and_are_drawn_in_the_style_of_the_reader():
    exact = equilibrium(Chain(size=3))
    run = exact.assign(velocity_width_error=0 * exact.velocity_width + 0.1)
    results = {f"run {n}": run.assign_attrs(source="simulation") for n in range(42)}
    results |= {f"theory {n}": exact for n in range(28)}
    colours = list(map("#0000{:02x}".format, range(7)))
    with plt.rc_context({"axes.prop_cycle": plt.cycler(color=colours)}):
        ax = overlay(results, "velocity_width")
    drawn = {
        label: (line.get_color(), line.get_marker(), line.get_linestyle())
        for container, label in zip(*ax.get_legend_handles_labels(), strict=True)
        for line in [container if label.startswith("theory") else container.lines[0]]
    }
    assert len(set(drawn.values())) == len(results) == len(drawn)
    assert {colour for colour, *_ in drawn.values()} == set(colours)
    ax = overlay({"run": results["run 0"]}, "velocity_width", style={"run": {"color": "red"}})
    assert ax.lines[0].get_color() == "red"


def test_symbols_beyond_the_frame_are_marked_on_it():
    _, ax = plt.subplots()
    ax.errorbar([1, 2, 3], [0.0, 5.0, -7.0], 0.1, fmt="o", color="green")
    ax.set_ylim(-1, 1)
    mark_clipped(ax)
    above, below = ax.lines[-2:]
    assert (above.get_marker(), *above.get_xydata()) == ("^", pytest.approx([2, 1]))
    assert (below.get_marker(), *below.get_xydata()) == ("v", pytest.approx([3, -1]))
    assert above.get_color() == "green"


def test_overlay_takes_one_curve_a_result():
    exact = smooth(equilibrium(CHAIN))
    moving = xr.concat([exact, exact], dim=xr.Variable("time", [0.0, 1.0]), data_vars="all")
    with pytest.raises(ValueError, match=r"^fluid: density is over \(time, x\); overlay draws "):
        overlay({"exact": exact, "fluid": moving})
    assert plt.get_fignums() == []  # nothing was begun
    ax = overlay({"exact": exact, "fluid": moving.isel(time=1)})
    assert len(ax.lines) == 2
