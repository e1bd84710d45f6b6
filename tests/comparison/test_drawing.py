"""Overlays: symbols for simulations, lines for theories, units on the axes."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from drawn_pictures import WAVES, X, drawn, simulated

from crazybilliards.comparison import overlay, smooth
from crazybilliards.comparison.drawing import mark_clipped
from crazybilliards.comparison.side_by_side.grid import KINETIC, SIMULATION
from crazybilliards.comparison.side_by_side.grid_figures import draw_widths
from crazybilliards.kinetic import equilibrium, equilibrium_states, force_balance
from crazybilliards.model import Chain
from crazybilliards.particles import simulate


def test_overlay_draws_symbols_with_errors_and_lines():
    chain = Chain(size=10, amplitude=3)
    run, exact = simulate(chain, duration=300, progress=False), equilibrium(chain)
    ax = overlay({"rods": smooth(run), "exact": smooth(exact)})
    assert len(ax.containers) == 1
    symbols, line = ax.containers[0].lines[0], ax.lines[-1]
    assert symbols.get_linestyle() == "None"
    assert line.get_linestyle() == "-"
    np.testing.assert_array_equal(line.get_ydata(), smooth(exact).density)
    assert ax.get_xlabel() == "position $x$ [R]"
    assert ax.get_ylabel() == r"density $\rho$ [1/R]"
    assert ax.get_legend_handles_labels()[1] == ["exact", "rods"]


def test_overlay_of_a_quantity_over_particles():
    theory = force_balance(Chain(size=10))
    ax = overlay({"theory": theory}, "mean_displacement")
    assert ax.get_xlabel() == "normalized particle $i_n$"
    assert ax.lines[0].get_xdata()[[0, -1]].tolist() == [-1, 1]
    ax = overlay({"theory": theory}, "mean_displacement", along="mean_position")
    assert ax.get_xlabel() == r"mean position $\langle x_i\rangle$ [R]"
    with pytest.raises(ValueError, match="no 'kinetic_energy'"):
        overlay({"theory": theory}, "kinetic_energy")


def test_overlay_draws_the_rods_at_both_ends_of_a_long_chain():
    run = simulate(Chain(size=107), duration=100, observe="widths", progress=False)
    ax = overlay({"rods": run}, "velocity_width")
    symbols = ax.containers[0].lines[0]
    # Every second one, but where symbols would hide waves.
    assert 40 < len(symbols.get_xdata()) <= 54
    assert symbols.get_xdata()[[0, -1]].tolist() == [-1, 1]
    assert symbols.get_ydata()[-1] == run.velocity_width[-1]


@pytest.mark.parametrize("count", [2, 60, 61, 100, 101, 108, 200, 201, 300])
@pytest.mark.parametrize("on_paper", [False, True])
def test_symbols_are_evenly_spaced_and_all_are_drawn_where_there_is_room(tmp_path, count, on_paper):
    run, how = simulated(np.arange(float(count)), np.ones(count)), {}
    if on_paper:
        how = {"paper": tmp_path / "a.png"}
    symbols, _, _ = drawn(overlay({"rods": run}, **how))
    most = 200 if on_paper else 60
    assert symbols.size == count if count <= most else most / 2.1 < symbols.size <= most
    assert np.unique(np.diff(symbols[:-1])).size <= 1
    assert symbols[[0, -1]].tolist() == [0, count - 1]
    if count in (101, 201):  # every second, or every fourth
        assert np.unique(np.diff(symbols)).size == 1


def test_overlay_draws_every_node_of_a_density_with_waves_between_the_symbols():
    """Every 47th node of waves of 2.5 R would show a wave of 39 R."""
    ax = overlay({"rods": simulated(X, WAVES)})
    symbols, lined, curve = drawn(ax)
    assert symbols.size == 0
    np.testing.assert_array_equal(lined, X)
    np.testing.assert_array_equal(curve(X), WAVES)
    assert ax.get_legend_handles_labels()[1] == ["rods"]
    [band] = ax.collections  # of one standard error
    np.testing.assert_allclose(band.get_datalim(ax.transData).y1, WAVES.max() + 1e-4)


def test_overlay_draws_symbols_where_straight_lines_between_them_follow_the_curve():
    smooth_curve = 0.4 / (1 + np.exp((np.abs(X) - 100) / 8))
    symbols, lined, curve = drawn(overlay({"rods": simulated(X, smooth_curve)}))
    assert (symbols.size, lined.size) == (57, 0)
    assert np.abs(curve(X) - smooth_curve).max() < 0.01 * 0.4
    partly = np.where(X > 70, WAVES, 0.4)
    symbols, lined, curve = drawn(overlay({"rods": simulated(X, partly)}))
    assert symbols.size > 35
    assert symbols.max() < 70 < lined.max() == X[-1]
    assert np.abs(curve(X) - partly).max() < 0.01 * 0.06


def test_noise_is_drawn_as_symbols_and_waves_within_it_as_a_line():
    """All nodes together show a wave of two standard errors; two of them do not."""
    noise = np.random.default_rng(1).normal(size=X.size)
    symbols, _, _ = drawn(overlay({"rods": simulated(X, 0.4 + 0.02 * noise, 0.02)}))
    assert symbols.size == 57
    faint = WAVES + 0.015 * noise
    symbols, lined, _ = drawn(overlay({"rods": simulated(X, faint, 0.015)}))
    assert (symbols.size, lined.size) == (0, X.size)
    symbols, _, _ = drawn(overlay({"rods": simulated(X, 0.4 + 0.02 * noise, 0.002)}))
    assert symbols.size == 0


def test_two_simulations_differ_and_keywords_are_passed_through():
    chain = Chain(size=5)
    runs = {f"seed {n}": simulate(chain, duration=200, seed=n, progress=False) for n in (1, 2)}
    both = overlay(runs, "velocity_width").containers
    looks = {(each.lines[0].get_marker(), each.lines[0].get_color()) for each in both}
    assert len(looks) == 2
    style = {"seed 2": {"color": "red", "alpha": 0.5, "marker": "*"}}
    first, second = (
        each.lines[0] for each in overlay(runs, "velocity_width", style=style).containers
    )
    assert (first.get_marker(), first.get_color()) in looks
    assert (second.get_marker(), second.get_color(), second.get_alpha()) == ("*", "red", 0.5)
    line = overlay({"a": equilibrium(chain)}, style={"a": {"linewidth": 5}}).lines[0]
    assert line.get_linewidth() == 5
    with pytest.raises(ValueError, match=r"style: .*, got 'seed 3'; did you mean 'seed [12]'"):
        overlay(runs, "velocity_width", style={"seed 3": {}})


def looks_of(ax):
    """Return colour with symbol of every simulation, and colour with line style of every theory."""
    symbols = [each.lines[0] for each in ax.containers]
    drawn = [(each.get_color(), each.get_marker()) for each in symbols]
    lines = [each for each in ax.lines if each not in symbols]
    return drawn, [(each.get_color(), each.get_linestyle()) for each in lines]


def many(of, number):
    return {str(label): of for label in range(number)}


EXACT = equilibrium(Chain(size=3))
ERRORS = {
    f"{name}_error": 0.1 + 0 * EXACT[name] for name in ("velocity_width", "mean_displacement")
}
MEASURED = EXACT.assign(ERRORS).assign_attrs(source="simulation")


@pytest.mark.parametrize("on_paper", [False, True])
def test_every_curve_has_its_own_look(tmp_path, on_paper):
    how = {"paper": tmp_path / "a.png"} if on_paper else {}
    results = many(MEASURED, 7) | {f"theory {each}": EXACT for each in range(7)}
    symbols, lines = looks_of(overlay(results, "velocity_width", **how))
    assert len({colour for colour, _ in symbols}) == len({symbol for _, symbol in symbols}) == 7
    assert len({colour for colour, _ in lines}) == 7
    assert [symbol for _, symbol in symbols[:4]] == ["o", "s", "D", "^"]
    assert [line for _, line in lines[:4]] == ["-", "--", ":", "-."]


@pytest.mark.parametrize(
    ("of", "number", "full"),
    [
        (MEASURED, 49, {"color": "red", "marker": "*"}),
        (EXACT, 28, {"color": "red", "linestyle": "-"}),
    ],
)
def test_there_are_as_many_looks_as_colours_times_symbols_or_line_styles(of, number, full):
    symbols, lines = looks_of(overlay(many(of, number), "velocity_width"))
    assert len({*symbols, *lines}) == number
    before = plt.get_fignums()
    with pytest.raises(ValueError, match=f"style= must give color and .* there are {number} looks"):
        overlay(many(of, number + 1), "velocity_width", style={"3": {"color": "red"}})
    assert plt.get_fignums() == before
    symbols, lines = looks_of(overlay(many(of, number + 1), "velocity_width", style={"3": full}))
    assert len({*symbols, *lines}) == number + 1


def test_every_chain_of_a_picture_has_its_own_look():
    theory = list(KINETIC)[-1]
    groups = {f"restitution_{n}": {SIMULATION: MEASURED, theory: EXACT} for n in range(9)}
    every = {f"{name}/{key}": each for name, group in groups.items() for key, each in group.items()}
    for ax in draw_widths(xr.DataTree.from_dict(every)).axes:
        symbols, lines = looks_of(ax)
        solved = {look for look in lines if look[0] != "0.4"}  # that one is in the legend only
        assert len(set(symbols)) == len(solved) == 9


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
    chain = Chain(size=5)
    exact = equilibrium(chain)
    moving = xr.concat([exact, exact], dim=xr.Variable("time", [0.0, 1.0]), data_vars="all")
    assert moving.density.dims == ("time", "x")
    with pytest.raises(ValueError, match=r"^fluid: density is over \(time, x\); choose a time: "):
        overlay({"exact": exact, "fluid": moving})
    assert plt.get_fignums() == []  # nothing was begun
    ax = overlay({"exact": exact, "fluid": moving.isel(time=1)})
    assert len(ax.lines) == 2
    states = equilibrium_states(chain, 3)
    with pytest.raises(ValueError, match=r"over \(replica, particle\); choose a replica: \.isel"):
        overlay({"states": states}, "position")
