"""Overlays of what simulation and theory share, over whatever dimension it has."""

import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

from crazybilliards.comparison import overlay
from crazybilliards.comparison.curves import axis_label
from crazybilliards.kinetic import steady_state
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import Covariances


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
def test_a_contact_lies_half_way_between_its_rods(pair):
    for result in pair.values():
        rods = result.normalized_particle.values
        np.testing.assert_allclose(
            result.normalized_contact, (rods[1:] + rods[:-1]) / 2, rtol=1e-12
        )


@pytest.mark.compiled
def test_velocity_densities_of_a_rod_picked_at_random(pair):
    """They are the mean over all rods; empty bins are left out."""
    run = pair["rods"]
    ax = overlay({"rods": run}, "velocity_density")
    assert ax.get_xlabel() == "velocity $v$ [$R/t_0$]"
    assert ax.get_ylabel() == "probability density of $v$ [$t_0/R$]"
    mean = run.velocity_density.mean("particle").values
    np.testing.assert_allclose(ax.lines[0].get_ydata(), np.where(mean > 0, mean, np.nan))


@pytest.mark.compiled
def test_velocity_densities_of_one_rod_are_not_mixed_with_those_of_all(pair):
    run = pair["rods"].isel(particle=3)
    density = run.velocity_density.values
    [line] = overlay({"rods": run}, "velocity_density").lines
    np.testing.assert_array_equal(line.get_ydata(), np.where(density > 0, density, np.nan))
    with pytest.raises(ValueError, match="velocity_density: rod is of one rod, rods of all"):
        overlay({"rod": run, "rods": pair["rods"]}, "velocity_density")
    few = pair["rods"].isel(particle=slice(3), contact=slice(3))
    with pytest.raises(ValueError, match="over one dimension"):
        overlay({"rods": few}, "velocity_density")
