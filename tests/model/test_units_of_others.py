"""Numbers with a unit of another library are refused: numpy would drop the unit without a word."""

import numpy as np
import pytest
import xarray as xr

import crazybilliards as cb
from crazybilliards.reproduction.fits import fit_exponential

CHAIN = cb.Chain(size=3, gap=1.0)


class Quantity:
    """Numbers with a unit, as astropy (`unit`), pint and unyt (`units`) have them."""

    def __init__(self, values, name="unit"):
        self.values = np.asarray(values, dtype=float)
        setattr(self, name, "km")

    def __array__(self, dtype=None, copy=None):
        return self.values

    def __float__(self):
        return float(self.values)

    def __len__(self):
        return len(self.values)

    def __getitem__(self, which):
        return self.values[which]

    def item(self):
        return self.values.item()

    shape = property(lambda self: self.values.shape)


@pytest.mark.parametrize("name", ["unit", "units"])
def test_numbers_with_a_unit_are_refused(name):
    def km(values):
        return Quantity(values, name)

    three, x = [-10.0, 0.0, 10.0], np.linspace(-9, 9, 5)
    start = cb.displaced(CHAIN, 1.0)
    fit = fit_exponential([0.1, 0.5, 0.9], [1.0, 2.0, 4.0], [0.1, 0.1, 0.1])
    calls = {
        "position": lambda: cb.given_start(CHAIN, km(three)),
        "position ": lambda: cb.given_start(CHAIN, [km(each) for each in three]),
        "position  ": lambda: cb.given_start(CHAIN, np.array([km(1.0)] * 3, dtype=object)),
        "position   ": lambda: cb.given_start(CHAIN, xr.DataArray(three, attrs={"units": "km"})),
        "radius": lambda: cb.Chain(radius=km(3.0)),
        "size": lambda: cb.Chain(size=km(3)),
        "x": lambda: CHAIN.reduced(km(three)),
        "displacement": lambda: CHAIN.force(km(three)),
        "displacement  ": lambda: cb.force_balance(CHAIN, displacement=(km(x), x)),
        "displacement   ": lambda: cb.force_balance(CHAIN, displacement=lambda x: km(x)),
        "velocity_variance": lambda: cb.force_balance(CHAIN, velocity_variance=km(3.0)),
        "start: density": lambda: cb.hydrodynamics(
            CHAIN, start.assign(density=start.density.assign_attrs(units="1/m")), 1.0
        ),
        "x ": lambda: fit(km(three)),
    }
    for argument, call in calls.items():
        with pytest.raises(ValueError, match=f"{argument.strip()} must be plain numbers") as caught:
            call()
        assert "\n" not in str(caught.value)


def test_units_of_results_are_ones_own():
    run = cb.simulate(CHAIN, duration=20, observe="snapshots", progress=False)
    last = run.isel(time=-1, replica=0)
    for position in (last.position, last.position.assign_attrs(units="R"), last.position.values):
        again = cb.given_start(CHAIN, position, last.velocity)
        np.testing.assert_array_equal(again.position[0], last.position)
    widths = cb.equilibrium(CHAIN)
    table = widths.mean_position.values, widths.velocity_width**2
    cb.force_balance(CHAIN, velocity_variance=table)
