"""The live chain by itself, the presets, and the command."""

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from crazybilliards.comparison.explore.presets import PRESETS
from crazybilliards.comparison.explore.session import Session
from crazybilliards.model import Chain

COMMAND = [sys.executable, "-c", "from crazybilliards.comparison.commands.line import main; main()"]
CHROMIUM, DRIVER = Path("/usr/bin/chromium"), Path("/usr/bin/chromedriver")
FLAGS = (
    "--headless=new --no-sandbox --disable-gpu --disable-quic --no-first-run "
    "--disable-background-networking --disable-component-update --disable-sync "
    "--window-size=1400,1040"
)


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
        measured = session.measured()
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
    assert session.measured() is not None
    positions, velocities, now = session.positions.copy(), session.v.copy(), session.time
    session.change(chain.replace(restitution=0.5, amplitude=2.0, gap=1.0))
    assert np.array_equal(session.positions, positions)
    assert np.array_equal(session.v, velocities)
    assert session.time == now
    # The chain forgets what it was before it is measured.
    assert session.measured() is None
    session.advance(session.measured_from - session.time - 1.0)
    assert session.measured() is None
    session.advance(10.0)
    assert 8.0 < session.measured_duration < 10.0
    assert session.measured() is not None


def test_another_number_of_rods_starts_from_rest():
    session = Session(Chain(size=10))
    session.advance(10.0)
    longer = Chain(size=12, gap=0.5)
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


@pytest.mark.parametrize("wrong", [{"damping": 0}, {"amplitude": 0}, {"stiffness": 0}])
def test_chains_without_a_scale_are_refused_in_one_line(wrong):
    session = Session(Chain(size=5))
    with pytest.raises(ValueError, match="no steady state") as refusal:
        session.change(Chain(size=5, **wrong))
    assert "\n" not in str(refusal.value)
    # Nothing has changed.
    assert session.chain == Chain(size=5)


def test_presets_have_names_of_their_own_within_the_sliders():
    from crazybilliards.comparison.explore.setting import Setting

    assert len({preset.label for preset in PRESETS}) == len(PRESETS)
    for preset in PRESETS:
        setting = Setting()
        setting.take(preset.chain)
        assert setting.chain() == preset.chain


# -- the command ----------------------------------------------------------------------------


def test_without_panel_it_says_what_to_install():
    script = (
        "import sys; sys.modules['panel'] = None; sys.argv[1:] = ['explore']\n"
        "from crazybilliards.comparison.commands.line import main; main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "pip install 'crazybilliards[explore]'" in done.stderr
    assert done.stderr.count("\n") == 1
