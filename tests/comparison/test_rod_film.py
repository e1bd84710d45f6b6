"""Films show every rod where it is, and collisions when they happen, in whole files only."""

import io
import os
import sys
from base64 import b64decode
from types import SimpleNamespace

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

from crazybilliards.comparison import encoding, film, moving_pictures, rod_film
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

CHAIN = Chain(size=6, restitution=0.9, gap=0.5)


@pytest.fixture(scope="module")
def run():
    return simulate(CHAIN, duration=4, every=0.05, observe="snapshots", progress=False)


def test_rods_are_drawn_in_their_places_in_the_colours_of_their_velocities(run):
    motion = rod_film.motion_of(run, 5)
    pictures = list(rod_film.rod_pictures(motion, False))
    for x, v, picture in zip(motion.x, motion.v, pictures, strict=True):
        line = picture[130, :860, :3].astype(int)  # through the rods, left of the key
        inside = np.flatnonzero((line != 255).any(axis=1))
        left, right = inside[0], inside[-1]
        a_pixel = (x[-1] - x[0] + 2 * CHAIN.radius) / (right - left)
        for place, velocity in zip(x, v, strict=True):
            red, _, blue = line[round(left + (place - x[0] + CHAIN.radius) / a_pixel)]
            assert (red > blue) == (velocity > 0) or abs(velocity) < 0.05
    assert motion.time[[0, -1]].tolist() == run.time.values[[0, -1]].tolist()


@pytest.mark.parametrize(("ratio", "tall"), [(3.0, 1), (0.2, 0)])
def test_walls_are_where_they_are_and_the_heavier_rods_are_the_taller_ones(ratio, tall):
    chain = Chain(size=4, box=20, stiffness=0, mass_ratio=ratio)
    run = simulate(chain, duration=1, every=0.1, observe="snapshots", progress=False)
    motion = rod_film.motion_of(run.isel(particle=[1, 2, 3]), 2)
    picture = next(rod_film.rod_pictures(motion, False))[..., :3].astype(int)
    grey = np.flatnonzero((picture[50, :860] == picture[50, 10:60].min(axis=0)).all(axis=1))
    inner = grey[np.diff(grey, append=0) > 1][0], grey[np.diff(grey, prepend=0) > 1][-1]
    a_pixel = chain.box / (inner[1] - inner[0])
    for place, number in zip(motion.x[0], (1, 2, 3), strict=True):
        column = picture[:, round(inner[0] + (place + chain.box / 2) / a_pixel)]
        outlines = np.flatnonzero((column[40:180] < 80).all(axis=1))
        assert (np.ptp(outlines) > 60) == (number % 2 == tall)


@pytest.mark.compiled
def test_bars_are_the_collisions():
    observe = ["snapshots", "collisions"]
    chain = Chain(size=10, restitution=0.8, gap=0.2)
    run = simulate(chain, duration=500, every=0.01, observe=observe, seed=3, progress=False)
    x, v = (run[name].values[0] for name in ("position", "velocity"))
    met = rod_film._met(chain, run.time.values, x, v).sum()
    counted = run.collision_rate.sum().item() * 500
    assert counted > 1000
    assert met == pytest.approx(counted, rel=0.02)


def test_bars_fade_and_rods_that_are_no_neighbours_have_none():
    chain = CHAIN.replace(gap=0.0)
    run = simulate(
        chain, duration=4, every=0.05, observe="snapshots", particles=[1, 2, 5], progress=False
    )
    flash = rod_film.motion_of(run, 80).flash
    assert flash.shape == (80, 2)
    assert not flash[:, 1].any()
    just = np.flatnonzero(flash[:-1, 0] == 1)
    assert just.size
    assert set(flash[just + 1, 0]) <= {1.0, rod_film._FADING}


@pytest.mark.parametrize("kind", ["mp4", "gif", "html"])
def test_a_film_has_all_its_pictures(run, kind, tmp_path):
    path = film(run, tmp_path / f"rods.{kind}", seconds=0.8, springs=True, progress=False)
    assert [path] == list(tmp_path.iterdir())
    if kind == "gif":
        with Image.open(path) as pictures:
            assert pictures.n_frames == 20
        return
    if kind == "html":
        data = path.read_text().partition("base64,")[2].partition('"')[0]
        path = tmp_path / "rods.mp4"
        path.write_bytes(b64decode(data))
    assert imageio_ffmpeg.count_frames_and_secs(str(path)) == (20, pytest.approx(0.8, abs=0.01))


def drawn(motion):
    return list(rod_film.rod_pictures(motion, True))


def test_a_gif_has_the_colours_that_were_drawn(run):
    pictures = drawn(rod_film.motion_of(run, 20))
    film = Image.open(io.BytesIO(encoding.encoded(iter(pictures), "gif")))
    for number, picture in enumerate(pictures):
        film.seek(number)
        rods = np.array(film.convert("RGB"))[100:150, :860].astype(int)
        assert abs(rods - picture[100:150, :860, :3]).max() < 40  # of 255


def test_rods_that_are_far_apart_are_seen():
    run = simulate(
        Chain(size=5, gap=5000), duration=1, every=0.1, observe="snapshots", progress=False
    )
    motion = rod_film.motion_of(run, 2)
    fast = np.abs(motion.v) > 0.3 * np.abs(motion.v).max()
    for picture, rods in zip(drawn(motion), fast, strict=True):
        line = picture[130, 10:850, :3]
        assert rods.sum() <= (line < 230).any(axis=1).sum() <= 2 * rods.size


def test_successive_pictures_have_different_times():
    for step in (1e-6, 0.01, 1.0, 1e4):
        times = step * np.arange(5.0)
        assert len({f"{time:.{rod_film._digits(times)}f}" for time in times}) == 5
    assert rod_film._digits(np.zeros(1)) == 2


def test_a_chain_is_simulated_and_a_notebook_gets_a_player():
    player = film(CHAIN, seconds=0.2, duration=1.0, progress=False)
    assert player._repr_html_().startswith("<video")


def test_without_ffmpeg_an_mp4_is_refused_before_any_work_and_a_page_has_a_gif(monkeypatch, run):
    monkeypatch.setattr(encoding, "_ffmpeg", lambda: None)
    with pytest.raises(ValueError, match=r"needs ffmpeg.*crazybilliards\[film\]"):
        film(CHAIN, "rods.mp4")
    html = film(run, seconds=0.2, progress=False).html
    data = b64decode(html.partition("base64,")[2].partition('"')[0])
    assert Image.open(io.BytesIO(data)).n_frames == 5


def test_the_order_of_dimensions_does_not_matter(run):
    assert np.array_equal(rod_film.motion_of(run.transpose(), 5).x, rod_film.motion_of(run, 5).x)


@pytest.mark.compiled
def test_what_cannot_be_filmed_is_refused(run):
    hot, none = Chain(size=100, restitution=1.3), "no snapshots in time"
    for what, how, said in (
        (run.isel(particle=0), {}, none),
        (run.drop_vars("velocity"), {}, none),
        (run * np.nan, {}, "no snapshot in which all velocities are known"),
        (CHAIN, {"duration": -1}, "duration must be positive"),
        (run, {"duration": 5}, "duration is that of a chain to simulate"),
        (hot, {"progress": False}, "no steady state to film: its simulation diverged"),
    ):
        with pytest.raises(ValueError, match=said):
            film(what, **how)


@pytest.mark.parametrize("place", ["folder.gif", "file/rods.gif", "locked/rods.gif"])
def test_a_place_that_cannot_be_written_is_refused_before_any_work(place, tmp_path, monkeypatch):
    monkeypatch.setattr(moving_pictures, "simulate", lambda *_, **__: pytest.fail("it works"))
    monkeypatch.setattr(os, "access", lambda folder, _: folder != tmp_path / "locked")
    (tmp_path / "folder.gif").mkdir()
    (tmp_path / "file").touch()
    with pytest.raises(OSError, match=place.split("/")[0]):
        film(CHAIN, tmp_path / place)


# imageio-ffmpeg cannot close the pipe to a program that has ended before it was written to.
@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")
def test_ffmpeg_that_breaks_off_is_an_error_and_leaves_the_former_file(run, tmp_path, monkeypatch):
    path = tmp_path / "rods.mp4"
    path.write_text("former")
    fewer = SimpleNamespace(
        write_frames=imageio_ffmpeg.write_frames, count_frames_and_secs=lambda _: (1, 0.04)
    )
    with monkeypatch.context() as patched:
        patched.setattr(encoding, "_ffmpeg", lambda: fewer)
        with pytest.raises(OSError, match="the temporary folder may be full"):
            film(run, path, seconds=0.2, progress=False)
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", sys.executable)  # fails at once
    with pytest.raises(OSError, match="the temporary folder may be full"):
        film(run, path, seconds=0.2, progress=False)
    assert path.read_text() == "former"


@pytest.mark.parametrize("kind", ["mp4", "gif"])
def test_a_film_that_is_interrupted_leaves_the_former_file(run, kind, tmp_path, monkeypatch):
    path = tmp_path / f"rods.{kind}"
    path.write_text("former")
    drawn = rod_film._pictures

    def interrupted(*arguments):
        pictures = drawn(*arguments)
        yield next(pictures)
        yield next(pictures)
        raise KeyboardInterrupt

    monkeypatch.setattr(rod_film, "_pictures", interrupted)
    with pytest.raises(KeyboardInterrupt):
        film(run, path, progress=False)
    assert [path] == list(tmp_path.iterdir())
    assert path.read_text() == "former"
