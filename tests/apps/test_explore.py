"""The live chain by itself, the presets, and the command."""

import subprocess
import sys
import time

import numpy as np
import pytest

from crazybilliards.apps.explore.presets import PRESETS
from crazybilliards.apps.explore.session import Session
from crazybilliards.apps.explore.sums import Sums
from crazybilliards.model import Chain
from crazybilliards.model.grid import position_grid

# -- the live chain -------------------------------------------------------------------------


def test_order_is_never_broken_whatever_is_changed():
    chain = Chain(size=30, gap=0.5)
    session = Session(chain)
    for changes in (
        {"restitution": 0.0},
        {"restitution": 0.7, "gap": 0.0},
        {"restitution": 1.05, "damping": 6.0},
        {"amplitude": 10.0, "spring": "quadratic"},
        {"restitution": 1.0, "gap": 2.0},
    ):
        session.change(chain.replace(**changes))
        for _ in range(50):
            session.advance(0.37)
            assert np.isfinite(session.y).all()
            assert (np.diff(session.y) >= -1e-12).all()


@pytest.mark.compiled
def test_elastic_widths_are_those_of_a_free_rod():
    chain = Chain(size=20, gap=0.3, amplitude=3.0)
    shares = []
    for seed in range(25):
        session = Session(chain, seed)
        session.advance(300.0)
        measured = session.observed()
        shares.append(float((measured.velocity_width**2).mean()) / chain.free_velocity_width**2)
        spacing = float(measured.x[1] - measured.x[0])
        assert float(measured.density.sum()) * spacing == pytest.approx(chain.size)
    error = np.std(shares, ddof=1) / np.sqrt(len(shares))
    assert error < 0.01
    assert abs(np.mean(shares) - 1) < 5 * error


def test_parameters_change_while_the_rods_stay_where_they_are():
    chain = Chain(size=10)
    session = Session(chain)
    session.advance(100.0)
    assert session.settled
    positions, velocities, now = session.positions.copy(), session.v.copy(), session.time
    session.change(chain.replace(restitution=0.5, amplitude=2.0, gap=1.0))
    assert np.array_equal(session.positions, positions)
    assert np.array_equal(session.v, velocities)
    assert session.time == now
    # The chain forgets what it was before it is measured. What is seen until then is shown, too.
    assert not session.settled
    assert session.observed() is None
    session.advance(session.measured_from - session.time - 1.0)
    assert not session.settled
    assert session.observed() is not None
    seen = session.sums
    session.advance(10.0)
    # Nothing of that is measured.
    assert session.sums is not seen
    assert session.sums.snapshots < seen.snapshots
    assert 8.0 < session.measured_duration < 10.0
    assert session.settled


def test_another_number_of_rods_starts_from_rest_off_restitution_one():
    session = Session(Chain(size=10))
    session.advance(10.0)
    longer = Chain(size=12, gap=0.5, restitution=0.9)
    session.change(longer)
    assert session.time == 0
    assert session.positions == pytest.approx(longer.anchors)
    assert not session.v.any()


def test_a_short_duration_is_not_lost():
    session = Session(Chain(size=3))
    for _ in range(1000):
        session.advance(0.01)
    assert session.time == pytest.approx(10.0, abs=0.2)


def test_a_budget_ends_what_would_take_for_ever():
    session = Session(Chain(size=10))
    session.advance(1.0)
    begin = time.process_time()
    session.advance(1e9, budget=0.01)
    assert time.process_time() - begin < 5.0
    assert session.time > 1.0


@pytest.mark.compiled
def test_divergence_is_reported_and_the_chain_stands_still():
    chain = Chain(size=100, restitution=1.1, damping=0.4)
    session = Session(chain)
    session.advance(1e4)
    assert session.diverged
    ended = session.time
    assert ended < 1e4
    assert np.isfinite(session.y).all()
    assert (np.diff(session.y) >= 0).all()
    session.advance(1.0)
    assert session.time == ended
    session.change(chain.replace(restitution=1.0))
    assert not session.diverged
    assert session.time == 0


@pytest.mark.parametrize("reach", [20.0, 150.0, 1100.0])
def test_the_density_follows_the_rods_however_far_they_get(reach):
    chain = Chain(size=60, restitution=1.05)
    sums = Sums(chain)
    near, far = chain.anchors, np.linspace(-reach, reach, 60)
    for positions in (near, far, near):
        sums.add(positions, np.zeros(60))
    assert sums.x[-1] == -sums.x[0] > reach
    assert np.allclose(np.diff(sums.x), position_grid(chain)[1] - position_grid(chain)[0])
    spacing = sums.x[1] - sums.x[0]
    assert float(sums.density().sum()) * spacing == pytest.approx(60)
    # Two thirds of the snapshots are where they would be on a grid that never grew.
    assert float(sums.density()[abs(sums.x) < 61].sum()) * spacing > 40


def test_an_elastic_chain_starts_in_equilibrium_and_a_reset_one_at_rest():
    chain = Chain(size=300)
    session = Session(chain)
    assert session.measured_from == session.time == 0
    share = float((session.v**2).mean()) / chain.free_velocity_width**2
    assert abs(share - 1) < 5 * np.sqrt(2 / 300)
    session.restart()
    assert not session.v.any()
    assert session.measured_from > 0
    assert not Session(chain.replace(restitution=0.9)).v.any()


@pytest.mark.parametrize("restitution", [0.0, 0.7, 1.0, 1.05])
def test_a_step_ends_with_the_first_collision(restitution):
    session = Session(Chain(size=10, gap=1.0, restitution=restitution), seed=3)
    for _ in range(5):
        before = session.collisions
        met = []
        while not met:
            assert session.collisions == before
            met = session.advance_to_collision(0.05)
        assert session.collisions > before
        room = np.diff(session.positions) - 2
        assert room[met].max() < 0.05
        assert (room >= -1e-12).all()


def test_slow_motion_tells_which_contacts_met():
    session = Session(Chain(size=10, gap=0.5))
    session.pace(0.01, resolved=True)
    session.contacts_met()
    before, contacts = session.collisions, set()
    for _ in range(3000):
        session.advance(0.01)
        contacts |= set(session.contacts_met())
    assert session.collisions > before
    assert contacts == set(range(9))
    assert session.contacts_met() == []


def test_a_rod_that_is_held_pushes_others_aside_and_nothing_is_measured():
    session = Session(Chain(size=10, gap=1.0), seed=1)
    session.advance(20.0)
    before = session.positions
    # Where the mouse takes hold, within the rod, it stays.
    session.hold(before[3] + 0.7)
    assert session.positions == pytest.approx(before, abs=1e-12)
    session.hold(10.7)
    for _ in range(20):
        session.advance(0.3)
        assert session.positions[3] == pytest.approx(10.0)
        assert (np.diff(session.positions) >= 2 - 1e-12).all()
    session.release()
    assert not session.settled
    session.advance(0.5)
    assert session.positions[3] < 10.0
    session.advance(session.measured_from - session.time + 1.0)
    assert session.settled


def test_a_rod_that_is_held_is_let_go_when_the_chain_changes_or_is_pushed():
    chain = Chain(size=10, gap=1.0)
    for act in (lambda session: session.change(chain), lambda session: session.push(0, 1.0)):
        session = Session(chain, seed=1)
        session.hold(session.positions[3])
        session.hold(10.0)
        act(session)
        assert not session.holds
        assert np.isfinite(session.measured_from)
        session.advance(3.0)
        assert session.positions[3] != pytest.approx(10.0)


def test_avalanches_are_counted_only_while_measured():
    session = Session(Chain(size=20, restitution=0.5))
    session.pace(np.inf, resolved=True, avalanches=True)
    session.advance(session.measured_from * 0.9)
    assert session.collisions > 0
    assert not session.avalanche_sizes().any()
    session.advance(session.measured_from)
    assert session.avalanche_sizes().any()
    session.restart()
    assert not session.avalanche_sizes().any()


def test_a_push_adds_momentum_to_one_rod():
    session = Session(Chain(size=10, gap=1.0))
    before = session.v.copy()
    session.push(0, 5.0)
    assert session.v - before == pytest.approx([5.0] + [0.0] * 9)


def test_thinning_keeps_the_extremes_of_an_oscillating_curve():
    from crazybilliards.apps.explore.plots import thinned

    x = np.arange(9000) / 10
    values = 1 + np.cos(2 * np.pi * x / 3)
    seen, shown = thinned(x, values, 500)
    assert seen.size <= 500
    assert (np.diff(seen) > 0).all()
    # Every stretch shows a crest and a trough; every 18th point would show a wave of 9.
    pairs = shown[: shown.size // 2 * 2].reshape(-1, 2)
    assert (pairs.max(axis=1) > 1.9).all()
    assert (pairs.min(axis=1) < 0.1).all()
    few = thinned(x[:400], values[:400], 500)
    assert np.array_equal(few[1], values[:400])
    # A step at the very end belongs to no whole interval.
    step = np.where(np.arange(1499) < 1495, 0.0, 1.0)
    seen, shown = thinned(np.arange(1499.0), step, 500)
    assert shown[-1] == 1
    assert (np.diff(seen) >= 0).all()


@pytest.mark.parametrize("wrong", [{"damping": 0}, {"amplitude": 0}, {"stiffness": 0}])
def test_chains_without_a_scale_are_refused_in_one_line(wrong):
    session = Session(Chain(size=5))
    with pytest.raises(ValueError, match="no steady state") as refusal:
        session.change(Chain(size=5, **wrong))
    assert "\n" not in str(refusal.value)
    # Nothing has changed.
    assert session.chain == Chain(size=5)


def test_presets_have_names_of_their_own_within_the_sliders():
    from crazybilliards.apps.explore.setting import Setting

    assert len({preset.label for preset in PRESETS}) == len(PRESETS)
    for preset in PRESETS:
        setting = Setting()
        setting.take(preset.chain)
        assert setting.chain() == preset.chain


def test_an_address_is_taken_whole_or_not_at_all():
    from crazybilliards.apps.explore.setting import Setting

    setting = Setting()
    before = setting.chain()
    for wrong in ("amplitude=100", "size=2.5", "gap=nan", "spring=cubic", "damping="):
        with pytest.raises(ValueError, match=wrong.split("=")[0]) as refused:
            setting.take_query(f"?size=30&restitution=0.5&{wrong}&theme=dark")
        assert "theme" not in str(refused.value)
        assert "restitution" not in str(refused.value)
        assert setting.chain() == before
    setting.take_query("?size=30&restitution=0.5&other=1")
    assert setting.chain() == before.replace(size=30, restitution=0.5)
    copy = Setting()
    copy.take_query("&".join(f"{name}={value}" for name, value in setting.query().items()))
    assert copy.chain() == setting.chain()


# -- the command ----------------------------------------------------------------------------


def test_without_panel_it_says_what_to_install():
    script = (
        "import sys; sys.modules['panel'] = None; sys.argv[1:] = ['explore']\n"
        "from crazybilliards.apps.commands.line import main; main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "pip install 'crazybilliards[explore]'" in done.stderr
    assert done.stderr.count("\n") == 1
