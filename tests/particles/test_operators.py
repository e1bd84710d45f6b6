"""What every collision operator must keep, and where they must agree with one another."""

import numpy as np
import pytest
from drifts import PLAIN, UNSEEN, Around, drift, drifted, mirrored, require_alike, require_kept
from gauss_seidel import solve
from hypothesis import assume, given
from hypothesis import strategies as st

from crazybilliards.particles.laws.law import CONTACTS, EVENTS, ISOTONIC, SORT, Law, make_scratch

OPERATORS = {"sort": SORT, "isotonic": ISOTONIC, "events": EVENTS, "contacts": CONTACTS}


@st.composite
def states(draw, touching=True):
    """Draw up to 15 points, some of them possibly in contact, and their velocities."""
    generator = np.random.default_rng(draw(st.integers(0, 2**32)))
    size = draw(st.integers(1, 15))
    gaps = generator.exponential(size=size) / size
    if touching and draw(st.booleans()):
        gaps[generator.random(size) < 0.5] = 0
    y = np.cumsum(gaps)
    return y - (y[0] + y[-1]) / 2, generator.normal(size=size)


def surroundings(room, wall):
    """Draw none, walls, two masses, or both."""
    masses = st.sampled_from([(1.0, 1.0), (1.0, 3.0), (1.0, 0.01)])
    return st.builds(Around, room, wall, masses)


rooms = st.sampled_from([np.inf, 0.0, 0.3])
arounds = surroundings(rooms, st.sampled_from([0.0, 0.5, 1.0]))
steps = st.floats(1e-3, 2)
gaps = st.sampled_from([0.0, 0.05, 1.0])
pulls = st.sampled_from([0.0, 0.2])
restitutions = st.sampled_from([0.0, 0.3, 0.8, 0.95, 1.0, 1.05])


@given(
    state=states(),
    dt=steps,
    e=restitutions,
    operator=st.sampled_from([EVENTS, CONTACTS]),
    around=arounds,
    gap=gaps,
    pull=pulls,
)
def test_what_every_operator_keeps(state, dt, e, operator, around, gap, pull):
    e = min(e, 1.0) if around.room < np.inf else e  # with flippers in a box nothing is bounded
    require_kept(operator, state, dt, e, around=around, gap=gap, pull=pull)


@given(state=states(touching=False), dt=steps)
def test_sort_keeps_order_momentum_and_energy(state, dt):
    require_kept(SORT, state, dt, 1.0)
    after = drifted(SORT, state, dt, 1.0).v
    assert (after**2).sum() == pytest.approx((state[1] ** 2).sum())


@given(e=st.floats(0, 1.5), closing=st.floats(0.1, 10), drift_speed=st.floats(-3, 3))
def test_energy_loss_of_a_binary_collision(e, closing, drift_speed):
    """(1 - e^2) m dv^2 / 4, and the relative velocity reversed by e."""
    v = np.array([drift_speed + closing, drift_speed])
    _, after, collisions, *_ = drifted(EVENTS, ([0.0, 0.01], v), 1.0, e, merge_speed=0.0)
    assert collisions == 1
    assert after[1] - after[0] == pytest.approx(e * closing)
    lost = (v**2).sum() / 2 - (after**2).sum() / 2
    assert lost == pytest.approx((1 - e**2) * closing**2 / 4, abs=1e-9)


@given(state=states(), dt=steps, gap=gaps, around=surroundings(rooms, st.just(0.0)))
def test_isotonic_is_event_driven_without_restitution(state, dt, gap, around):
    require_alike(ISOTONIC, EVENTS, state, dt, 0.0, gap=gap, pull=0.2, around=around)


@given(state=states(touching=False), dt=steps)
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
    size = 1_000_000
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


def determined(operator, state, dt, e, **springs):
    """Return a drift; pass over states near collapse, where rounding decides what comes out."""
    y, v = state
    one = drifted(operator, state, dt, e, **springs)
    other = drifted(operator, (y, v + 1e-12 * np.cos(np.arange(v.size))), dt, e, **springs)
    for ours, theirs in zip(one[:2], other[:2], strict=True):
        assume(np.allclose(ours, theirs, rtol=0, atol=1e-10))
    return one


names = st.sampled_from(sorted(OPERATORS))


@given(state=states(), dt=steps, e=restitutions, name=names, gap=gaps, around=arounds)
def test_reflection_symmetry(state, dt, e, name, gap, around):
    e, around = (e, PLAIN) if name == "sort" else (min(e, 1.0), around)
    springs = {"gap": gap, "pull": 0.2}
    one = determined(OPERATORS[name], state, dt, e, around=around, **springs)
    image, around = mirrored(state, around)
    other = drifted(OPERATORS[name], image, dt, e, around=around, **springs)
    np.testing.assert_allclose(-other.y[::-1], one.y, atol=1e-10)
    np.testing.assert_allclose(-other.v[::-1], one.v, atol=1e-9 / dt)


@given(state=states(), dt=steps, e=restitutions, name=names)
def test_galilean_invariance(state, dt, e, name):
    one = determined(OPERATORS[name], state, dt, e)
    moving = drifted(OPERATORS[name], (state[0], state[1] + 1.5), dt, e)
    np.testing.assert_allclose(moving.y, one.y + 1.5 * dt, atol=1e-9)
    np.testing.assert_allclose(moving.v, one.v + 1.5, atol=1e-9 / dt)


@pytest.mark.parametrize("rods", [3, 5])
def test_newtons_cradle_sends_off_the_last_rod(rods):
    """But in contact dynamics, which shares the impulse."""
    state = -np.eye(1, rods)[0], np.eye(1, rods)[0]
    for operator in (SORT, EVENTS):
        np.testing.assert_array_equal(drifted(operator, state, 1.5, 1.0).v, state[1][::-1])
    after = drifted(CONTACTS, ([0, 0, 0], [1, 0, 0]), 0.1, 1.0).v
    np.testing.assert_allclose(after, [-1 / 3, 2 / 3, 2 / 3])


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
