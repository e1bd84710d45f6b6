"""The chain: what it accepts, and the scales it derives."""

import ast
import inspect
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.model import Chain
from crazybilliards.model import chain as chain_module
from crazybilliards.model.chain import middle_tenth

positive = st.floats(min_value=1e-6, max_value=1e6)
gaps = st.floats(0, 10).map(lambda gap: round(gap, 6))


WRONG = [-1, -1e-9, 1e70, 10**400, np.nan, np.inf, 1j, None, True, "1", "x" * 999, ["linear"]]


@pytest.mark.parametrize("name", Chain().parameters())
def test_a_wrong_parameter_is_one_short_line(name):
    for value in [*WRONG, np.array(-1.0), np.array([1.0]), np.zeros((9, 9)), np.array(["a"] * 2)]:
        with pytest.raises(ValueError, match=f"^{name} must be .*, got ") as caught:
            Chain(**{name: value})
        assert "\n" not in str(caught.value)
        assert len(str(caught.value)) < 250


@pytest.mark.parametrize("name", ["size", "mass", "radius"])
def test_what_must_be_positive_is_not_zero(name):
    with pytest.raises(ValueError, match=f"^{name} must be"):
        Chain(**{name: 0})


def test_zero_amplitude_damping_and_stiffness_are_chains_without_a_steady_state():
    for name in ("amplitude", "damping", "stiffness"):
        chain = Chain(**{name: 0})
        with pytest.raises(ValueError, match=f"no steady state: {name}=0"):
            chain.require_steady_state()
    assert Chain(damping=0).temperature == math.inf
    assert Chain(amplitude=0, damping=0).temperature == 0


def test_numpy_numbers_become_plain_ones():
    chain = Chain(size=np.int64(7), amplitude=np.float32(2), gap=1)
    assert chain == Chain(size=7, amplitude=2.0, gap=1.0)
    assert type(chain.size) is int
    assert type(chain.gap) is float


def test_is_frozen_and_replace_checks():
    with pytest.raises(AttributeError):
        Chain().gap = 1
    with pytest.raises(ValueError, match="gap must be"):
        Chain().replace(gap=-1)
    with pytest.raises(ValueError, match=r"Chain takes any of .*, got 'length'"):
        Chain().replace(length=3)


def test_scales_of_the_reference_chain():
    chain = Chain()
    assert chain.temperature == pytest.approx(0.5)
    assert chain.free_velocity_width == pytest.approx(1 / math.sqrt(2 * 4 * math.pi / 3))
    assert chain.thermal_length == pytest.approx(math.sqrt(0.5))
    assert Chain(spring="quadratic").thermal_length == pytest.approx(0.5 ** (1 / 3))


@given(size=st.integers(1, 40), gap=gaps, radius=positive)
def test_reduced_and_physical_coordinates_are_inverse(size, gap, radius):
    chain = Chain(size=size, gap=gap, radius=radius)
    np.testing.assert_allclose(
        chain.reduced(chain.anchors), chain.reduced_anchors, atol=1e-9 * radius * size
    )
    y = np.linspace(-3, 3, size)
    np.testing.assert_allclose(chain.reduced(chain.physical(y)), y, atol=1e-9 * max(radius, 1))
    np.testing.assert_allclose(np.diff(chain.anchors), 2 * radius + gap)
    np.testing.assert_allclose(chain.anchors, -chain.anchors[::-1])


def test_parameters_round_trip():
    chain = Chain(size=3, gap=0.25, spring="quadratic")
    assert Chain(**chain.parameters()) == chain


@pytest.mark.parametrize(
    ("places", "found"),
    [(1, [0]), (2, [0, 1]), (3, [1]), (10, [4, 5]), (30, [13, 14, 15, 16]), (99, range(45, 54))],
)
def test_the_middle_tenth_is_in_the_middle(places, found):
    assert [*range(places)[middle_tenth(places)]] == [*found]


def test_the_middle_tenth_is_within_a_twentieth_of_the_middle():
    for places in range(10, 2001):
        off = np.abs(Chain(size=places).rank)
        taken = np.zeros(places, dtype=bool)
        taken[middle_tenth(places)] = True
        np.testing.assert_array_equal(taken, 20 * off <= places)


def test_type_checkers_read_the_parameters_that_there_are():
    """They read an ``__init__`` of their own, which takes integers of numpy."""
    tree = ast.parse(inspect.getsource(chain_module))
    [start] = [each for each in ast.walk(tree) if getattr(each, "name", "") == "__init__"]
    names = [each.arg for each in start.args.kwonlyargs]
    values = [eval(ast.unparse(each)) for each in start.args.kw_defaults]
    assert dict(zip(names, values, strict=True)) == Chain().parameters()
