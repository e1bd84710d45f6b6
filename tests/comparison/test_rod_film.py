"""Films show every rod where it is, and collisions when they happen, in whole files only."""

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

from crazybilliards.comparison import film, films
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

CHAIN = Chain(size=6, restitution=0.9, gap=0.5)


@pytest.fixture(scope="module")
def run():
    return simulate(CHAIN, duration=4, every=0.05, observe="snapshots", progress=False)


def rods_of(figure):
    """Return the centres, lengths and heights of the rods in a picture, and their colours."""
    bodies = figure.axes[0].collections[1]
    bodies.update_scalarmappable()
    corners = np.array([path.vertices[:4] for path in bodies.get_paths()])
    return corners.mean(axis=1)[:, 0], *np.ptp(corners, axis=1).T, bodies.get_facecolor()


@pytest.mark.parametrize("transposed", [False, True])
def test_rods_are_drawn_in_their_places_in_the_colours_of_their_velocities(run, transposed):
    figure, show, number = films._rod_film(run.transpose() if transposed else run, 5, True)
    assert number == 5
    for picture, moment in ((0, 0), (2, run.time.size // 2), (4, -1)):
        show(picture)
        now = run.isel(replica=0, time=moment)
        places, lengths, _, colours = rods_of(figure)
        np.testing.assert_allclose(places, now.position)
        np.testing.assert_allclose(lengths, 2 * CHAIN.radius)
        fast = np.abs(now.velocity.values) > 0.05
        redder = colours[:, 0] > colours[:, 2]
        np.testing.assert_array_equal(redder[fast], now.velocity.values[fast] > 0)
        springs = figure.axes[0].collections[0].get_segments()
        np.testing.assert_allclose(np.array(springs)[:, 0, 0], CHAIN.anchors)
    assert figure.axes[0].get_xlabel() == "position $x$ [R]"


@pytest.mark.parametrize(("ratio", "tall"), [(3.0, 1), (0.2, 0)])
def test_walls_are_where_they_are_and_the_heavier_rods_are_the_taller_ones(ratio, tall):
    chain = Chain(size=4, box=20, stiffness=0, mass_ratio=ratio)
    run = simulate(chain, duration=1, every=0.1, observe="snapshots", progress=False)
    figure, show, _ = films._rod_film(run.isel(particle=[1, 2, 3]), 2, False)
    show(0)
    walls = [patch.get_x() for patch in figure.axes[0].patches]
    assert walls == [-10, 10]
    _, _, heights, _ = rods_of(figure)
    np.testing.assert_array_equal(heights == heights.max(), np.arange(1, 4) % 2 == tall)


@pytest.mark.compiled
def test_bars_are_the_collisions():
    observe = ["snapshots", "collisions"]
    chain = Chain(size=10, restitution=0.8, gap=0.2)
    run = simulate(chain, duration=500, every=0.01, observe=observe, seed=3, progress=False)
    x, v = (run[name].values[0] for name in ("position", "velocity"))
    met = films._met(chain, run.time.values, x, v).sum()
    counted = run.collision_rate.sum().item() * 500
    assert counted > 1000
    assert met == pytest.approx(counted, rel=0.02)


def test_bars_fade_and_rods_that_are_no_neighbours_have_none():
    run = simulate(
        CHAIN, duration=4, every=0.05, observe="snapshots", particles=[1, 2, 5], progress=False
    )
    figure, show, number = films._rod_film(run, 80, False)
    sizes = np.empty((number, 2))
    for picture in range(number):
        show(picture)
        sizes[picture] = figure.axes[0].collections[2].get_sizes()
    assert not sizes[:, 1].any()
    just = np.flatnonzero(sizes[:-1, 0] == sizes.max())
    assert just.size
    assert set(sizes[just + 1, 0]) <= {sizes.max(), films._FADING * sizes.max()}


@pytest.mark.parametrize("kind", ["mp4", "gif", "html", "html without ffmpeg"])
def test_a_film_has_all_its_pictures(run, kind, tmp_path, monkeypatch):
    if kind == "html without ffmpeg":
        monkeypatch.setattr(films, "has_ffmpeg", lambda: False)
    kind, *without = kind.split()
    path = film(run, tmp_path / f"rods.{kind}", seconds=0.2, springs=True, progress=False)
    assert [path] == list(tmp_path.iterdir())
    if kind == "gif":
        with Image.open(path) as pictures:
            assert pictures.n_frames == 5
    elif without:
        assert path.read_text().count("data:image/png;base64") == 5
    elif kind == "html":
        assert path.read_text().count("data:video/mp4;base64") == 1
    else:
        shown = imageio_ffmpeg.count_frames_and_secs(str(path))
        assert shown == (5, pytest.approx(0.2, abs=0.01))


def test_rods_that_are_far_apart_are_seen():
    chain = Chain(size=5, gap=5000)
    run = simulate(chain, duration=1, every=0.1, observe="snapshots", progress=False)
    figure, show, _ = films._rod_film(run, 2, False)
    show(0)
    low, high = figure.axes[0].get_xlim()
    assert (rods_of(figure)[1] > (high - low) / 1000).all()


@pytest.mark.parametrize("step", [1e-6, 0.01, 1.0, 1e4])
def test_successive_pictures_have_different_times(run, step):
    rods = run.assign_coords(time=run.time.copy(data=step * np.arange(run.time.size)))
    figure, show, number = films._rod_film(rods, 5, False)
    times = set()
    for picture in range(number):
        show(picture)
        times.add(figure.axes[0].texts[-1].get_text())
    assert len(times) == number


def test_a_chain_is_simulated_and_a_notebook_gets_a_player():
    player = film(CHAIN, seconds=0.2, duration=1.0, progress=False)
    assert player._repr_html_().count("data:video/mp4;base64") == 1


def test_without_ffmpeg_an_mp4_is_refused_before_any_work(monkeypatch):
    monkeypatch.setattr(films, "has_ffmpeg", lambda: False)
    with pytest.raises(ValueError, match=r"needs ffmpeg.*crazybilliards\[film\]"):
        film(CHAIN, "rods.mp4")


@pytest.mark.parametrize("kind", ["mp4", "gif"])
def test_a_film_that_is_interrupted_leaves_the_former_file(run, kind, tmp_path, monkeypatch):
    path = tmp_path / f"rods.{kind}"
    path.write_text("former")

    def interrupted(*_, **__):
        yield from (0, 1)
        raise KeyboardInterrupt

    monkeypatch.setattr(films, "progress_bar", interrupted)
    with pytest.raises(KeyboardInterrupt):
        film(run, path, progress=False)
    assert [path] == list(tmp_path.iterdir())
    assert path.read_text() == "former"
