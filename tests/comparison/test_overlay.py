"""Overlays of what simulation and theory share, over whatever dimension it has."""

import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from drawn_pictures import WAVES, X, drawn, simulated
from scipy.integrate import trapezoid

from crazybilliards.comparison import overlay
from crazybilliards.comparison.curves import axis_label
from crazybilliards.kinetic import correlated_phase_space, equilibrium
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.particles import Covariances, simulate


@pytest.fixture(scope="module")
def pair():
    """Return a run with all that the theory with pair correlations gives, and the theory."""
    chain = Chain(size=12, restitution=0.9)
    observe = ["widths", Covariances(separations=11), "modes", "impacts", "velocities"]
    run = simulate(chain, duration=400, every=0.5, observe=observe, progress=False)
    return {"rods": run, "theory": correlated_phase_space(chain, cells=8)}


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
    for line, result in ((ax.containers[0].lines[0], pair["rods"]), (ax.lines[-1], pair["theory"])):
        np.testing.assert_array_equal(line.get_xdata(), result[abscissa])
        np.testing.assert_array_equal(line.get_ydata(), result[quantity])


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
    assert label("kinetic_energy", "", "M R^2/T^2") == "kinetic energy $E$ [M R$^{2}$/T$^{2}$]"
    assert label("own", "<v_i v_i+1>", "1") == "<v$_{i}$ v$_{i+1}$>"
    assert label("own", "my_value $E^2$", "kg m^-1") == "my_value $E^2$ [kg m$^{-1}$]"
    assert label("own", "my_value", "R") == "my_value [R]"


@pytest.mark.compiled
def test_a_contact_lies_half_way_between_its_rods(pair):
    for result in pair.values():
        rods = result.normalized_particle.values
        np.testing.assert_allclose(
            result.normalized_contact, (rods[1:] + rods[:-1]) / 2, rtol=1e-12
        )


@pytest.mark.compiled
def test_a_symbol_at_nan_is_no_symbol(pair):
    """Of the fifth rod there are seven separations; the others lie beyond the chain."""
    with pytest.raises(ValueError, match=r"rods: velocity_covariance is over .*choose a particle"):
        overlay(pair, "velocity_covariance")
    one = {label: result.isel(particle=4) for label, result in pair.items()}
    ax = overlay(one, "velocity_covariance")
    assert ax.get_xlabel() == "separation $r$"
    symbols, _, _ = drawn(ax)
    np.testing.assert_array_equal(symbols, np.arange(8))
    with_gap = one["rods"].copy(deep=True)
    with_gap["velocity_covariance"][3] = np.nan
    symbols, *_ = drawn(overlay({"rods": with_gap}, "velocity_covariance"))
    np.testing.assert_array_equal(symbols, [0, 1, 2, 4, 5, 6, 7])
    nothing = with_gap.assign(velocity_covariance=with_gap.velocity_covariance * np.nan)
    nothing.velocity_covariance.attrs = with_gap.velocity_covariance.attrs
    assert not overlay({"rods": nothing}, "velocity_covariance").containers


def test_a_line_breaks_where_a_node_is_not_known():
    values = WAVES.copy()
    values[1000] = np.nan
    [line] = overlay({"rods": simulated(X, values)}).lines
    np.testing.assert_array_equal(line.get_ydata(), values)


def test_a_logarithmic_axis_leaves_out_what_it_cannot_show():
    run = simulated(np.arange(12.0), np.ones(12))
    _, ax = plt.subplots()
    ax.set_xscale("log")
    symbols, *_ = drawn(overlay({"rods": run}, ax=ax))
    np.testing.assert_array_equal(symbols, np.arange(1.0, 12))


def places(ax):
    """Return where the simulation is drawn, as symbols or as a line."""
    simulated = [line for line in ax.lines if line.get_color() == "#000000"]
    return np.sort(np.concatenate([line.get_xdata() for line in simulated]))


@pytest.mark.compiled
def test_velocity_densities_of_a_rod_picked_at_random(pair):
    """Both add up to one and have the mean square of all rods; the outermost bins are left out."""
    ax = overlay(pair, "velocity_density")
    assert ax.get_xlabel() == "velocity $v$ [R/T]"
    assert ax.get_ylabel() == "probability density of $v$ [T/R]"
    theory = pair["theory"]
    v, p = ax.lines[-1].get_data()
    assert trapezoid(p, v) == pytest.approx(1, abs=1e-6)
    square = float((theory.velocity_width**2).mean())
    assert trapezoid(v**2 * p, v) == pytest.approx(square, rel=0.02)
    run = pair["rods"]
    bins, curve = places(ax), drawn(ax)[2]
    mean = run.velocity_density.mean("particle")
    visited = mean.velocity_bin.values[mean.values > 0]
    assert bins[[0, -1]] == pytest.approx(visited[[0, -1]])
    assert curve(0.0) == pytest.approx(float(mean.interp(velocity_bin=0)))


@pytest.mark.compiled
def test_velocity_densities_of_one_rod_are_not_mixed_with_those_of_all(pair):
    run = pair["rods"].isel(particle=3)
    bins = places(overlay({"rods": run}, "velocity_density"))
    density = run.velocity_density
    assert bins[0] == density.velocity_bin.values[density.values > 0][0]
    with pytest.raises(ValueError, match="velocity_density: rods is of one rod, theory of all"):
        overlay({"rods": run, "theory": pair["theory"]}, "velocity_density")
    few = pair["rods"].isel(particle=slice(3), contact=slice(3))
    with pytest.raises(ValueError, match="choose a particle"):
        overlay({"rods": few}, "velocity_density")


def test_a_picture_for_print_is_one_column_wide_in_letters_of_type_42(tmp_path):
    exact = equilibrium(Chain(size=5))
    ax = overlay({"exact": exact}, "density", paper=tmp_path / "density.pdf")
    pdf = (tmp_path / "density.pdf").read_bytes()
    assert b"/FontFile2" in pdf  # TrueType: Type 42
    assert b"/Type3" not in pdf
    [width] = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ", pdf)
    assert float(width) == pytest.approx(3.4 * 72)
    assert ax.get_legend() is not None
    assert plt.rcParams["pdf.fonttype"] == 3  # the reader's own pictures stay as they are
    with pytest.raises(ValueError, match="paper must be one of"):
        overlay({"exact": exact}, paper=tmp_path / "density.doc")
    with pytest.raises(ValueError, match="ax must be None"):
        overlay({"exact": exact}, paper="density.pdf", ax=ax)
