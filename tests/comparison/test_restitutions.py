"""Simulation against the theory that a chain has: which one, what comes out, and the pictures."""

import re
from itertools import product

import numpy as np
import pytest

from crazybilliards.comparison import compare
from crazybilliards.comparison.distances import deviations, width_deviation
from crazybilliards.comparison.side_by_side.grid import GAS, SIMULATION
from crazybilliards.comparison.side_by_side.grid_figures import (
    draw_density,
    draw_displacement,
    draw_profile,
    draw_widths,
)
from crazybilliards.comparison.stationary_theories import THEORIES, TITLES, theory_of
from crazybilliards.kinetic import UnmeasuredWarning, equilibrium, force_balance, steady_state
from crazybilliards.model import Chain

CHAIN = Chain(size=20)
QUIET = {"progress": False, "threads": 1}

pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def tree():
    return compare(CHAIN, {"restitution": [0.9, 1.0]}, duration=500, **QUIET)


def test_both_are_there_and_agree(tree):
    assert list(tree.children) == ["restitution_0.9", "restitution_1"]
    assert tree.attrs["status"] == "completed"
    for group in tree.children.values():
        assert set(group.children) == {SIMULATION, GAS}
        [(density, width)] = deviations(group).values()
        assert abs(width.centre) < 0.02 + 5 * width.error
        assert abs(width.largest) < 0.02 + 5 * width.error
        assert density.rms < 0.02


def test_width_deviation_of_a_known_difference():
    theory = steady_state(CHAIN)
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


@pytest.mark.filterwarnings("ignore")  # of a simulation that diverges or is short
@pytest.mark.parametrize(
    ("chain", "over", "why"),
    [
        (Chain(size=60, damping=1.0), {"restitution": [1.1]}, "no steady state"),
        (CHAIN.replace(restitution=0.9), {"mass_ratio": [2]}, "not know the chain's mass_ratio"),
    ],
)
def test_a_chain_without_a_theory_is_simulated_with_a_warning(chain, over, why):
    with pytest.warns(UserWarning, match=f"no theory: .*{why}"):
        [group] = compare(chain, over, duration=100, **QUIET).children.values()
    assert set(group.children) == {SIMULATION}
    assert deviations(group) == {}


def test_a_theory_is_a_line_in_a_band_of_the_error_that_it_states(tree):
    theory = tree[f"restitution_0.9/{GAS}"].to_dataset()
    theory.attrs |= {"velocity_width_model_error": 0.4, "mean_displacement_model_error": 2.0}
    widths, displacement = draw_profile(theory, "gas").axes
    for ax, name, error in (
        (widths, "velocity_width", 0.4 * theory.velocity_width.max()),
        (displacement, "mean_displacement", 2 * CHAIN.thermal_length),
    ):
        np.testing.assert_array_equal(ax.lines[0].get_ydata(), theory[name])
        top = ax.collections[0].get_datalim(ax.transData).y1
        assert top == pytest.approx(float(theory[name].max() + error))
    assert widths.get_ylabel() == "velocity width $W_v$ [$R/t_0$]"


def test_pictures(tree):
    """Also those of simulations alone."""
    titles = {TITLES[name] for name in (SIMULATION, GAS)}
    alone = tree.filter(lambda node: node.name != GAS)
    for draw, shown in product((draw_density, draw_displacement), (tree, alone)):
        above, *_, below = draw(shown).get_axes()
        assert "e = 0.9" in above.get_title(loc="left")
        drawn = titles if shown is tree else {TITLES[SIMULATION]}
        assert set(below.get_legend_handles_labels()[1]) == drawn
        assert not below.lines[0].get_ydata().any()  # the simulation, from which others differ
    widths = draw_widths(tree)
    assert widths.axes[0].get_ylabel() == "velocity width $W_v/W$"
    assert {text.get_text() for text in widths.legends[0].get_texts()} > titles - {SIMULATION}


def test_any_parameter_may_vary():
    """The theories are those of elastic chains only if nothing takes energy in any of them."""
    few = CHAIN.replace(size=4)
    tree = compare(few.replace(restitution=0.9), {"amplitude": [2]}, duration=200, **QUIET)
    assert list(tree.children) == ["amplitude_2"]
    assert GAS in tree["amplitude_2"]
    gas = Chain(size=5, stiffness=0, box=20)
    tree = compare(gas, {"wall_restitution": [0.8, 1]}, duration=200, **QUIET)
    assert GAS in tree["wall_restitution_0.8"]
    draw_displacement(tree)
    tree = compare(few, {"size": [6, 7]}, duration=200, **QUIET)
    assert "equilibrium" in tree["size_7"]
    titles = [ax.get_title(loc="left") for ax in draw_displacement(tree).axes]
    assert titles == ["(a)  $L = 6$", "(b)  $L = 7$", "", ""]
    spring = compare(few, {"spring": ["linear", "quadratic"]}, duration=200, **QUIET)
    assert list(spring.children) == ["spring_linear", "spring_quadratic"]
    draw_widths(spring)


BOX = CHAIN.replace(box=60)


def test_what_keeps_its_energy_in_collisions_has_an_exact_equilibrium():
    elastic = CHAIN, CHAIN.replace(gap=0.5), CHAIN.replace(spring="quadratic"), BOX
    others = [CHAIN.replace(restitution=e) for e in (0.9, 1.05)]
    others += [BOX.replace(**{name: 0.9}) for name in ("restitution", "wall_restitution")]
    for name, chains in {"equilibrium": elastic, "steady_state": others}.items():
        for chain in chains:
            assert theory_of(chain).name == name
            theory_of(chain).check(chain)


@pytest.mark.parametrize("name", THEORIES)
@pytest.mark.parametrize("changed", [{"damping": 0.0}, {"restitution": 0.9, "mass_ratio": 2.0}])
def test_a_theory_is_checked_by_the_error_that_it_raises(name, changed):
    chain, theory = CHAIN.replace(**changed), THEORIES[name]
    with pytest.raises(ValueError, match=r"\w") as caught:
        theory.check(chain)
    with pytest.raises(ValueError, match=f"^{re.escape(str(caught.value))}$"):
        theory.solve(chain)


def test_an_unknown_error_is_said_where_the_theory_is_called():
    with pytest.warns(UnmeasuredWarning, match="force balance was not measured") as caught:
        force_balance(CHAIN.replace(spring="quadratic"))
    assert caught[0].filename == __file__
