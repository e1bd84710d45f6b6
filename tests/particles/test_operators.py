"""What every collision operator must keep, and where they must agree with one another."""

import numpy as np
import pytest
from drifts import OPERATORS, UNSEEN, Around, drift, drifted, require_alike, require_kept
from gauss_seidel import solve
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from crazybilliards.model.kernels import kernel
from crazybilliards.particles.laws import sort
from crazybilliards.particles.laws.law import CONTACTS, EVENTS, ISOTONIC, SORT, Law, make_scratch


@st.composite
def states(draw):
    """Draw up to 15 points, some of them possibly in contact, and their velocities.

    On a lattice there are exact ties, equal speeds, rows of touching rods and rods at rest.
    """
    generator = np.random.default_rng(draw(st.integers(0, 2**32)))
    size = draw(st.integers(1, 15))
    gaps = generator.exponential(size=size) / size
    if draw(st.booleans()):
        gaps[generator.random(size) < 0.5] = 0
    y, v = np.cumsum(gaps), generator.normal(size=size)
    if draw(st.booleans()):
        y, v = np.round(4 * y) / 2, np.round(v)
    return y - (y[0] + y[-1]) / 2, v


def surroundings(room, wall):
    """Draw none, walls, two masses, or both."""
    masses = st.sampled_from([(1.0, 1.0), (1.0, 3.0), (1.0, 0.01)])
    return st.builds(Around, room, wall, masses)


rooms = st.sampled_from([np.inf, 0.0, 0.3])
arounds = surroundings(rooms, st.sampled_from([0.0, 0.5, 1.0]))
LONG = 500.0
steps = st.floats(1e-3, 2)
gaps = st.sampled_from([0.0, 0.05, 1.0])
pulls = st.sampled_from([0.0, 0.2])
restitutions = st.sampled_from([0.0, 0.16, 0.5, 0.95, 0.9999, 1.0, 1.05])


@settings(max_examples=200)
@given(
    state=states(),
    dt=steps | st.just(LONG),
    e=restitutions,
    operator=st.sampled_from(OPERATORS),
    around=arounds,
    gap=gaps,
    pull=pulls,
    exponent=st.sampled_from([2, 3]),
)
def test_what_every_operator_keeps(state, dt, e, operator, around, gap, pull, exponent):
    e = min(e, 1.0) if around.room < np.inf else e  # with flippers in a box nothing is bounded
    pull = 0.0 if dt == LONG else pull
    springs = {"gap": gap, "pull": pull, "exponent": exponent}
    require_kept(operator, state, dt, e, around=around, **springs)


@given(state=states(), dt=steps, gap=gaps, around=surroundings(rooms, st.just(0.0)))
def test_isotonic_is_event_driven_without_restitution(state, dt, gap, around):
    require_alike(ISOTONIC, EVENTS, state, dt, 0.0, gap=gap, pull=0.2, around=around)


@given(state=states(), dt=steps)
def test_sort_is_event_driven_at_restitution_one(state, dt):
    require_alike(SORT, EVENTS, state, dt, 1.0)


def test_where_rounding_parts_a_cluster_no_rod_is_counted_twice():
    """Nine rods arrive at one point, to a few units in the last place.

    Rounded, the mean of the first six is not above the seventh, which their block therefore leaves
    out, though that rod has fallen behind its neighbour: the fall starts where a block has ended.
    """
    units = np.array([6, 6, 5, 5, 5, 5, 4, 4, 0])
    v = np.linspace(1, 0, 9)
    y = 1.9 + units * np.spacing(1.9) - v  # exact, and so is y + v
    after_y, after_v, closed, *_ = drifted(ISOTONIC, (y, v), 1.0, 0.0)
    assert closed == 8
    assert (np.diff(after_y) >= 0).all()
    np.testing.assert_allclose(after_y, 1.9, rtol=2e-15)
    assert after_v.sum() == pytest.approx(v.sum(), rel=1e-14)


@pytest.mark.compiled
def test_a_cluster_may_swallow_two_rods_at_a_time():
    """The worst case for a cluster that is written whenever it has grown: minutes, not a moment."""
    size = 300_000
    v = np.where(np.arange(size) % 2 == 0, 1.0, -5.0) - 1e-6 * np.arange(size)
    y, w, closed, *_ = drifted(ISOTONIC, (np.zeros(size), v), 1e-3, 0.0)
    assert closed == size - 1
    np.testing.assert_allclose(w, v.mean(), rtol=1e-9)
    np.testing.assert_allclose(y, 1e-3 * v.mean(), rtol=1e-9)


@given(state=states(), dt=steps, e=restitutions, gap=gaps, pull=pulls, around=arounds)
def test_contact_dynamics_is_what_gauss_seidel_converges_to(state, dt, e, gap, pull, around):
    """If there is a solution: rebounds between two walls may need more room than there is."""
    exact = drifted(CONTACTS, state, dt, e, gap=gap, pull=pull, around=around)
    law, ends = exact.law, 1 if around.room < np.inf else 0
    y = np.array([law.low, *state[0], law.high][1 - ends : state[0].size + 1 + ends])
    v, inverse = (np.pad(each, ends) for each in (state[1], 1 / exact.masses))
    half_kicks = np.pad(-pull / exact.masses * (state[0] - exact.anchors) * dt / 2, ends)
    for tolerance in (np.inf, 1e-14):
        swept, (impulses, bounds) = v.copy(), np.zeros((2, v.size - 1))
        more = inverse, around.wall
        solve(y, swept, half_kicks, dt, e, tolerance, impulses, bounds, *more)
        assume(not ends or bounds.sum() < 0)
    np.testing.assert_allclose(exact.v, swept[ends : v.size - ends], atol=1e-9)


def test_inelastic_collapse_takes_a_bounded_number_of_collisions():
    """A hundred rods thrown at one another at e = 0.5 end in clusters that fly apart."""
    generator = np.random.default_rng(4)
    y = np.sort(generator.random(100))
    v = 0.5 - y + 0.1 * generator.normal(size=100)
    after, _, collisions, *_ = drifted(EVENTS, (y, v), 100.0, 0.5, merge_speed=1e-3)
    assert 100 < collisions < 10_000
    assert (np.diff(after) >= 0).all()
    assert len(np.unique(after)) < 60
    # Without clusters the same drift does not end.
    endless = Law(EVENTS, 0.5, 0.0, 100_000)
    assert drift(y, v, np.zeros(100), 100.0, endless, make_scratch(100), UNSEEN) == -1


# -- the sort of the drift at e = 1 ----------------------------------------------------------------


@kernel
def sort_and_fly(y, v, dt, scratch):
    sort.drift(y, v, dt, scratch)


PLACES = {
    "normal": lambda generator, size: generator.normal(size=size),
    "far away": lambda generator, size: 1e200 * generator.standard_cauchy(size),
    "in one bucket": lambda generator, size: np.append(1e6, 1e-6 * generator.normal(size=size - 1)),
    "together after a time": lambda generator, size: (
        generator.integers(0, size // 3 + 1, size) - np.arange(float(size))
    ),
    "at one place": lambda generator, size: np.full(size, 3.0),
    "hardly apart": lambda generator, size: 1 + 2.0**-52 * generator.integers(0, size, size),
    "next to nothing": lambda generator, size: 5e-324 * generator.integers(0, size, size),
}


@pytest.mark.parametrize("size", [2, 15, 16, 17, 64, 65, 128, 1000, 10_001])
@pytest.mark.parametrize("places", PLACES)
def test_rods_are_sorted_wherever_they_are(size, places):
    """Below 16 rods by insertion, beyond by buckets; beyond 64 runs are merged.

    Rods at the same place keep their order.
    """
    start, names = PLACES[places](np.random.default_rng(size), size), np.arange(float(size))
    for time in (0.0, 1.0):
        y, v, free = start.copy(), names.copy(), start + time * names
        sort_and_fly(y, v, time, make_scratch(size))
        order = np.argsort(free, kind="stable")
        np.testing.assert_array_equal(y, free[order])
        np.testing.assert_array_equal(v, order)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_a_chain_that_diverges_harms_nothing(wrong):
    """Positions may be no numbers then: all rods are still there."""
    y, v = np.random.default_rng(1).normal(size=100), np.arange(100.0)
    y[[3, 50]] = wrong
    sort_and_fly(y, v, 0.0, make_scratch(100))
    assert sorted(v) == list(range(100))
