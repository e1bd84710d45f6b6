"""Every theory states how wrong it is itself, from the tables that the measurements wrote."""

import csv
from pathlib import Path

import numpy as np
import pytest

from crazybilliards.comparison import deviation, smooth
from crazybilliards.kinetic import (
    UnmeasuredWarning,
    accuracy,
    compressed,
    displaced,
    equilibrium,
    force_balance,
    hydrodynamics,
    steady_state,
)
from crazybilliards.model import Chain
from studies.relaxation_error import Place
from studies.stationary_errors import driven, gas, on_springs

ROOT = Path(__file__).parents[2]
EVOLVING = {"velocity_variance": "evolving", "progress": False}
QUANTITIES = accuracy.Accuracy._fields


def rows(file):
    with open(ROOT / file, encoding="utf-8", newline="") as open_file:
        return list(csv.DictReader(open_file))


def chain_of_row(row):
    kind, size = row["kind"], int(row["L"])
    e, damping, x = (float(row[name]) for name in ("e", "Gamma", "x"))
    if kind == "driven":  # its restitution is rounded
        return driven(size, x, damping, 1.0)
    if kind in ("gas in a box", "inelastic walls"):
        return gas(size, e, damping, x)
    own = {"gap": {"gap": x}, "box": {"room": x}, "quadratic": {"spring": "quadratic"}}
    return on_springs(size, e, damping, 1.0, **own.get(kind, {}))


def stated(chain):
    return accuracy.errors_of_steady_state(chain)


def test_a_measured_chain_states_no_less_than_its_row():
    """Every fourth one: neighbours are alike."""
    measured = rows("kinetic/measured/steady_state.csv")
    assert len(measured) > 300
    for row in measured[::4]:
        found = stated(chain_of_row(row))._asdict()
        for name in QUANTITIES:
            assert not row[name] or found[name] >= float(row[name]), (row, name)


@pytest.mark.parametrize(
    "changes",
    [
        *({"size": 2000}, {"gap": 5.0}, {"damping": 20}, {"damping": 0.1}),
        *({"spring": "quadratic", "gap": 0.3}, {"spring": "quadratic", "box": 64}),
        *({"box": 64, "wall_restitution": 0.9}, {"box": 64, "restitution": 0.0}, {"box": 100}),
        {"box": 64, "restitution": 1.01},
        {"stiffness": 0, "box": 63, "amplitude": 1e-3},
    ],
    ids=repr,
)
def test_what_was_not_measured_is_unknown(changes):
    chain = Chain(**{"size": 30, "restitution": 0.9} | changes)
    assert np.isnan(stated(chain)).all()


def test_results_state_the_errors_of_all_quantities_and_warn_of_unknown_ones():
    chain = Chain(size=10, restitution=0.9)
    names = [f"{quantity}_model_error" for quantity in QUANTITIES]
    found = list(map(steady_state(chain).attrs.get, names))
    np.testing.assert_array_equal(found, stated(chain))
    assert np.isfinite(found[:5]).all()
    assert np.isnan(found[5])  # there is no wall
    with pytest.warns(UnmeasuredWarning, match="the error of the steady state of the gas"):
        field = steady_state(chain, correlations=False)
    assert np.isnan([field.attrs[each] for each in names]).all()
    assert [equilibrium(Chain(size=5)).attrs[each] for each in names[:5]] == [0] * 5


def test_at_restitution_1_what_is_exact_has_no_error():
    """On quadratic springs with a gap only the velocities are exact."""
    for changes in ({}, {"gap": 0.5}, {"spring": "quadratic"}, {"box": 210}):
        assert stated(Chain(**changes))[:5] == (0, 0, 0, 0, 1e-3)
    both = stated(Chain(gap=0.5, spring="quadratic"))
    assert both[:2] == (0, 0)
    assert np.isnan(both[2:]).all()


def test_the_force_balance_states_its_density_and_its_displacements():
    errors = [
        force_balance(Chain(amplitude=amplitude)).attrs["density_model_error"]
        for amplitude in (0.5, 1, 2, 3, 10, 30, 100)
    ]
    assert errors[1:] == pytest.approx([0.138, 0.132, 0.099, 0.027, 0.007, 0.007], abs=1e-3)
    assert np.isnan(errors[0])
    assert np.isnan(force_balance(Chain(), velocity_variance=2.0).attrs["density_model_error"])
    boxed = Chain(size=8, amplitude=0.5, box=30, gap=2.0)
    for chain in (Chain(gap=8.0), boxed, Chain(size=1), Chain(size=2000)):
        assert np.isnan(force_balance(chain).attrs["density_model_error"])
    assert force_balance(boxed.replace(gap=0)).attrs["density_model_error"] > 0


@pytest.mark.parametrize(("size", "gap"), [(3, 0.2), (30, 0.0), (30, 2.0), (60, 0.2)])
def test_the_errors_of_the_force_balance_are_those_from_the_exact_solution(size, gap):
    for amplitude in (1.0, 10.0):
        chain = Chain(size=size, amplitude=amplitude)
        chain = chain.replace(gap=gap * chain.thermal_length)
        found, exact = force_balance(chain), equilibrium(chain)
        off = deviation(smooth(found), smooth(exact)).maximum
        assert off < found.attrs["density_model_error"] + 5e-4
        moved = np.abs(found.mean_displacement - exact.mean_displacement).max()
        stated = found.attrs["mean_displacement_model_error"] + 5e-4
        assert float(moved) < stated * chain.thermal_length


def test_chains_drawn_at_random_keep_to_the_stated_errors():
    """None is above the stated one by more than a standard error; four are above it at all."""
    known, beyond = 0, 0
    for row in rows("docs/tables/stationary_held_out.csv"):
        limits = stated(chain_of_row(row))._asdict()
        for name in filter(row.get, QUANTITIES):
            error, spread = map(float, row[name].split(" of ")[0].split(" ± "))
            known += not np.isnan(limits[name])
            beyond += error > limits[name]
            assert not error > limits[name] + spread
    assert known > 280
    assert beyond <= 4


def chain_and_start(start=compressed, by=0.9, **changes):
    chain = Chain(**({"size": 50, "restitution": 0.95} | changes))
    return chain, start(chain.replace(restitution=1.0), by)


def stated_in_time(*release, **changes):
    chain, _ = chain_and_start(**changes)
    return accuracy.expected_in_time(chain, *release)


def test_the_gas_states_the_largest_error_of_its_range():
    for row in rows("kinetic/measured/relaxation.csv"):
        least_gap, gap, least, most = (float(value) for value in list(row.values())[3:7])
        place = Place(50, 1 - (least + most) / 100, 1.0, 0.9, gap=(least_gap + gap) / 2)
        chain = place._replace(spring={"2": "linear", "3": "quadratic"}[row["n"]]).chain()
        error = float(row["error"]) + 2 * float(row["standard error"])
        found = accuracy.expected_in_time(chain, 0.9, 0.0, 1.0)
        assert found == pytest.approx(error), row
    assert stated_in_time(0.3, 0.0, 1.0, restitution=1.0) == 0
    for changes in (
        *({"gap": 1.0}, {"size": 10}, {"size": 300}, {"damping": 4.0}),
        *({"damping": 0.5}, {"restitution": 0.7}, {"restitution": 1.03}),
    ):
        assert np.isnan(stated_in_time(0.9, 0.0, 1.0, **changes)), changes


@pytest.mark.compiled
def test_the_error_is_that_of_the_chain_and_the_start():
    def at_rest(chain, _):
        return force_balance(chain)

    def hot(chain, _):
        return force_balance(chain.replace(amplitude=2.0))

    def found(**changes):
        chain, start = chain_and_start(**changes)
        flow = hydrodynamics(chain, start, 0.1, every=0.1, **EVOLVING)
        return flow.attrs["kinetic_energy_model_error"]

    assert found() == pytest.approx(stated_in_time(0.9, 0.0, 1.0))
    assert found(start=displaced, by=1.0) == found()
    for changes in (
        {"by": 1.5},
        {"start": displaced, "by": 3.0},
        {"size": 20, "box": 60.0, "amplitude": 10.0, "start": at_rest},
        {"start": hot},
    ):
        with pytest.warns(UnmeasuredWarning, match="error of the kinetic energy was not measured"):
            assert np.isnan(found(**changes))


def test_chains_released_later_keep_to_the_stated_error():
    released = rows("docs/tables/relaxation_held_out.csv")
    assert len(released) == 14
    for row in released:
        numbers = [float(value) for value in list(row.values())[1:6]]
        place = Place(int(row["L"]), *numbers, spring=row["spring"])
        release = place.factor, place.shift, 1.0
        largest, error = map(float, row["largest error, %"].split(" ± "))
        limit = accuracy.expected_in_time(place.chain(), *release)
        assert abs(largest) <= 100 * limit + 2 * error, row
