"""Overlays: symbols for simulations, lines for theories; the style of pictures in print."""

import os
import re
import sys

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from installation import run

from crazybilliards.apps.commands.output import picture
from crazybilliards.comparison import film, overlay
from crazybilliards.comparison.curves import axis_label
from crazybilliards.comparison.drawing import house_style, legend_above, mark_clipped, panels
from crazybilliards.comparison.side_by_side.grid_figures import draw_profile
from crazybilliards.comparison.stationary_theories import TITLES
from crazybilliards.kinetic import equilibrium, steady_state
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.model.vocabulary import result as described
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import Covariances
from crazybilliards.reproduction.claims.report import reproduce
from crazybilliards.reproduction.figures import find_figures

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
    ax = overlay({"exact": exact}, "mean_displacement", along="mean_position")
    assert ax.get_xlabel() == r"mean position $\langle x_i\rangle$ [R]"
    np.testing.assert_array_equal(ax.lines[0].get_xdata(), exact.mean_position)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_of_many_values_all_are_drawn_as_a_line_and_some_as_symbols(scale):
    """Symbols alone would show waves that do not exist. NaN leaves a gap in the line."""
    x = np.arange(1.0, 2802.0)
    values = 0.4 + 0.03 * np.cos(2 * np.pi * x / 25)
    values[1000] = np.nan
    units = {"units": "1/R", "long_name": "density"}
    rods = xr.Dataset(
        {"density": ("x", values, units), "density_error": ("x", 0 * values + 1e-4, units)},
        coords={"x": ("x", x, {"units": "R", "long_name": "position x"})},
        attrs={"source": "simulation"},
    )
    _, ax = plt.subplots()
    ax.set_xscale(scale)
    overlay({"rods": rods}, ax=ax)
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


@pytest.fixture(scope="module")
def pair():
    """Return a run with all that the gas gives, and the gas."""
    chain = Chain(size=12, restitution=0.9)
    observe = ["widths", Covariances(separations=11), "modes", "impacts", "velocities"]
    run = simulate(chain, duration=400, every=0.5, observe=observe, progress=False)
    return {"rods": run, "theory": steady_state(chain)}


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("quantity", "abscissa", "label"),
    [
        ("neighbour_covariance", "normalized_contact", "normalized particle $i_n$"),
        ("contact_force", "normalized_contact", "normalized particle $i_n$"),
        ("mode_velocity_variance", "mode", "mode $q$"),
    ],
)
def test_what_both_have_is_drawn_over_its_dimension(pair, quantity, abscissa, label):
    ax = overlay(pair, quantity)
    assert ax.get_xlabel() == label
    for line, result in zip(ax.lines, pair.values(), strict=True):
        np.testing.assert_array_equal(line.get_xdata(), result[abscissa])
        np.testing.assert_array_equal(line.get_ydata(), result[quantity])
        rods = result.normalized_particle.values
        between = (rods[1:] + rods[:-1]) / 2
        np.testing.assert_allclose(result.normalized_contact, between, rtol=1e-12)


def test_labels_of_axes_are_set_as_in_print():
    """Indices and powers of names and units; a name in mathtext stays as it is."""

    def label(name, long_name, unit):
        return axis_label(
            xr.DataArray(0.0, name=name, attrs={"long_name": long_name, "units": unit})
        )

    for name, (long_name, unit) in VOCABULARY.items():
        words = label(name, long_name, unit)
        assert not set("_^") & set(re.sub(r"\$.*?\$", "", words)), words
        plt.figtext(0, 0, words)
    plt.gcf().draw_without_rendering()  # formulas are read only here
    assert label("kinetic_energy", "", "M R^2/t_0^2") == "kinetic energy $E$ [$M R^2/t_0^2$]"
    assert label("own", "<v_i v_i+1>", "1") == "<v$_{i}$ v$_{i+1}$>"
    assert label("own", "my_value $E^2$", "kg m^-1") == "my_value $E^2$ [kg m$^{-1}$]"
    assert label("own", "my_value", "R") == "my_value [R]"


@pytest.mark.compiled
def test_velocity_densities_are_of_one_rod_or_of_one_picked_at_random(pair):
    """The latter are the mean over all rods; empty bins are left out."""
    rods, rod = pair["rods"], pair["rods"].isel(particle=3)
    for each, density in (
        (rods, rods.velocity_density.mean("particle").values),
        (rod, rod.velocity_density.values),
    ):
        ax = overlay({"rods": each}, "velocity_density")
        assert ax.get_xlabel() == "velocity $v$ [$R/t_0$]"
        assert ax.get_ylabel() == "probability density of $v$ [$t_0/R$]"
        [line] = ax.lines
        np.testing.assert_allclose(line.get_ydata(), np.where(density > 0, density, np.nan))
    with pytest.raises(ValueError, match="velocity_density: rod is of one rod, rods of all"):
        overlay({"rod": rod, "rods": rods}, "velocity_density")
    few = rods.isel(particle=slice(3), contact=slice(3))
    with pytest.raises(ValueError, match="over one dimension"):
        overlay({"rods": few}, "velocity_density")


@pytest.mark.parametrize(("columns", "width"), [(1, 3.4), (3, 7.0)])
def test_a_figure_is_one_or_two_columns_wide_with_letters_of_8_points(columns, width):
    before = dict(plt.rcParams)
    with house_style():
        figure, axes = panels(2, columns, sharey=True)
        for ax in axes:
            ax.plot([1, 2], [3, 4], label="a rather long name of a curve")
            ax.set_xlabel("x")
        legend_above(figure, *axes)
        figure.draw_without_rendering()
        texts = [text for ax in axes for text in (ax.xaxis.label, *ax.get_xticklabels())]
        assert figure.legends[0].get_window_extent().width < figure.bbox.width
    assert figure.get_figwidth() == width
    assert {text.get_fontsize() for text in texts} == {8}
    assert [ax.get_title(loc="left") for ax in axes[:2]] == ["(a)", "(b)"]
    assert len(figure.legends[0].get_texts()) == 1
    assert dict(plt.rcParams) == before


# Settings of a reader that no picture in a file depends on. "dark_background" is a style.
HOSTILE = {
    "no LaTeX": {"text.usetex": True, "text.latex.preamble": r"\nonsense"},
    "lines and letters": {"font.size": 30, "font.family": "cursive", "axes.unicode_minus": False}
    | {"axes.prop_cycle": plt.cycler(color=["w"]), "lines.linewidth": 9, "axes.grid": True}
    | {"savefig.format": "pdf", "savefig.bbox": "tight", "savefig.transparent": True},
    "dark": mpl.style.library["dark_background"]
    | {"figure.dpi": 5, "savefig.dpi": 5, "path.sketch": (9, 9, 9), "interactive": True}
    | {"animation.writer": "html", "animation.bitrate": 1, "animation.codec": "nonsense"},
}


def drawn(folder):
    """Return the bytes of a picture of a command, of a figure of the paper, and of a film."""
    picture(draw_profile, equilibrium(CHAIN), "exact")(folder / "profile.png")
    [figure] = reproduce(find_figures("1"), "quick", folder, formats=["svg"])
    still = dict.fromkeys(("position", "velocity"), (("time", "particle"), [CHAIN.anchors]))
    how = {"source": "simulation", "status": "completed", "method": {}}
    run = described(CHAIN, still, coordinates={"time": [0.0]}, **how)
    film(run, folder / "rods.gif", progress=False)
    return [path.read_bytes() for path in sorted(folder.iterdir())], figure.pictures


@pytest.fixture(scope="module")
def ours(tmp_path_factory):
    return drawn(tmp_path_factory.mktemp("ours"))


@pytest.mark.parametrize("settings", HOSTILE.values(), ids=HOSTILE)
def test_pictures_in_files_do_not_depend_on_the_settings_of_the_reader(settings, ours, tmp_path):
    with mpl.rc_context(settings):
        assert drawn(tmp_path) == ours


def test_commands_draw_whatever_the_backend_of_the_reader_and_his_matplotlibrc_are(tmp_path):
    (tmp_path / "matplotlibrc").write_text("text.usetex: True\nnonsense\nfigure.dpi: five\n")
    command = "from crazybilliards.apps.commands.line import main; main()"
    arguments = ("theory", "equilibrium", "--size", "4", "--output", tmp_path)
    environment = os.environ | {"MPLBACKEND": "nonsense", "MATPLOTLIBRC": str(tmp_path)}
    run(sys.executable, "-Wignore", "-c", command, *arguments, env=environment)
    picture(draw_profile, equilibrium(Chain(size=4)), TITLES["equilibrium"])(tmp_path / "own.png")
    assert (tmp_path / "profile.png").read_bytes() == (tmp_path / "own.png").read_bytes()


def test_an_overlay_can_be_seen_in_a_dark_style_with_data_of_ones_own():
    """Beside results, and without their units."""
    exact = equilibrium(CHAIN)
    values = exact.density.drop_attrs()
    own = {"array": values, "dataset": values.to_dataset(), "columns": (values.x, values.values)}
    own["rows of a file"] = np.column_stack(own["columns"])
    with plt.style.context("dark_background"):
        ax = overlay(own | {"run": exact.assign_attrs(source="simulation")})
    assert ax.get_xlabel() == "position $x$ [R]"
    assert ax.get_ylim()[0] == 0
    for line in ax.lines:
        np.testing.assert_array_equal(line.get_xydata().T, [exact.x, exact.density])
        assert np.linalg.norm(np.subtract(mpl.colors.to_rgb(line.get_color()), 0)) > 0.5
    assert mpl.colors.to_hex(ax.get_facecolor()) == "#000000"
