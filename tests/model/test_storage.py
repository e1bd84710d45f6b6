"""Files: what is saved comes back, what is damaged is refused in one line."""

import os
import re
import signal
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from small_sweeps import AtOnce

from crazybilliards.comparison import load_sweep
from crazybilliards.comparison.sweeps import Case, read_sweep, run_cases
from crazybilliards.model import Chain, chain_of, load, save
from crazybilliards.model.storage import load_attributes, locked, write_sealed
from crazybilliards.model.vocabulary import result
from crazybilliards.particles import simulate


@pytest.fixture
def dataset():
    names = ("mean_displacement", "mean_displacement_error")
    variables = dict.fromkeys(names, ("particle", np.linspace(0, 1, 5)))
    how = {"source": "simulation", "method": {"seed": 3}, "end_time": 12.5}
    return result(Chain(size=5, gap=0.5), variables, **how)


def test_what_is_saved_comes_back_the_same_and_other_programs_can_read_it(dataset, tmp_path):
    path = save(dataset, tmp_path / "deep" / "run.nc")
    back = load(path)
    xr.testing.assert_identical(back, dataset)
    assert chain_of(back) == Chain(size=5, gap=0.5)
    assert back.mean_displacement.attrs["units"] == "R_0"
    with xr.open_dataset(path, engine="netcdf4") as plain:
        xr.testing.assert_equal(plain, dataset)
    named = dataset.rename(mean_displacement="a")  # like a group
    tree = xr.DataTree.from_dict({"a/simulation": dataset, "b": named})
    xr.testing.assert_identical(load(save(tree, path)), tree)
    assert [each.name for each in path.parent.iterdir()] == ["run.nc"]


@pytest.mark.posix
@pytest.mark.timeout(120, method="thread")  # the other method has the same alarm
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # files left open
def test_ctrl_c_while_files_are_read_and_written_is_not_lost(dataset, tmp_path):
    """In h5py some became a SystemError, and xarray kept a lock that the next read waited for."""
    generator = np.random.default_rng(0)
    before = signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    interrupted = 0
    for call in (load, load_attributes, partial(save, dataset)) * 70:
        path = save(dataset, tmp_path / "run.nc")
        start = time.perf_counter()
        call(path)
        took = time.perf_counter() - start
        try:
            signal.setitimer(signal.ITIMER_REAL, generator.uniform(1e-5, took))
            call(path)
            signal.setitimer(signal.ITIMER_REAL, 0)
        except KeyboardInterrupt:
            interrupted += 1
    signal.signal(signal.SIGALRM, before)
    assert interrupted > 20
    assert load(path).identical(dataset)


def test_a_file_of_an_old_sweep_is_read_with_its_types(dataset, tmp_path):
    """Up to version 0.5 sweeps were classic NetCDF, which has no integers of 64 bits."""
    counted = dataset.assign(count=("particle", np.arange(5)))
    write_sealed(tmp_path / "old.nc", bytes(counted.to_netcdf(engine="scipy")))
    xr.testing.assert_identical(load(tmp_path / "old.nc"), counted)
    assert load(tmp_path / "old.nc")["count"].dtype == np.int64
    assert load_attributes(tmp_path / "old.nc") == counted.attrs


def test_a_tilde_is_the_home_folder(dataset, tmp_path, monkeypatch):
    home, here = tmp_path / "home", tmp_path / "here"
    for folder in (home, here):
        folder.mkdir()
    for name in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(name, str(home))
    monkeypatch.chdir(here)
    assert save(dataset, "~/a/run.nc") == home / "a" / "run.nc"
    assert load("~/a/run.nc").identical(dataset)
    simulate(Chain(size=3), duration=100, checkpoint=Path("~/run.ckpt"), progress=False)
    (home / "grid.toml").write_text("[grid]\nsize = [2, 3]\n[force_balance]\n")
    sweep = read_sweep("~/grid.toml")
    assert not run_cases(sweep, "~/sweep", AtOnce(), progress=False)
    assert load_sweep("~/sweep").sizes["size"] == 2
    assert (home / "run.ckpt").exists()
    assert not list(here.iterdir())


def test_two_writers_of_one_file_do_not_meet(dataset, tmp_path, monkeypatch):
    """While one writes, another one does; the first goes on undisturbed, and nothing is left."""
    path, sync = tmp_path / "run.nc", os.fsync

    def meanwhile(descriptor):
        sync(descriptor)
        monkeypatch.undo()
        save(dataset * 2, path)
        xr.testing.assert_identical(load(path), dataset * 2)

    monkeypatch.setattr("os.fsync", meanwhile)
    save(dataset, path)
    xr.testing.assert_identical(load(path), dataset)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.posix
def test_a_symbolic_link_stays_and_the_file_it_names_is_written(dataset, tmp_path):
    for name in ("run.nc", "run.ckpt", "sweep"):
        (tmp_path / name).symlink_to(tmp_path / "scratch" / name)
    save(dataset, tmp_path / "run.nc")
    chain = Chain(size=3)
    simulate(chain, duration=100, checkpoint=tmp_path / "run.ckpt", progress=False)
    run_cases([Case("force_balance", chain, {})], tmp_path / "sweep", progress=False)
    assert all(path.is_symlink() for path in tmp_path.iterdir() if path.name != "scratch")
    assert len(list(tmp_path.glob("scratch/*"))) == 3
    (tmp_path / "loop.nc").symlink_to(tmp_path / "loop.nc")
    (tmp_path / "null.nc").symlink_to(os.devnull)
    for name in ("loop.nc", "null.nc"):
        with pytest.raises(OSError, match=f"a link to itself, not a file: .*{name}"):
            save(dataset, tmp_path / name)


@pytest.mark.parametrize("letter", ["a", "\N{GREEK SMALL LETTER GAMMA}"])
def test_a_name_may_be_as_long_as_the_disk_allows(letter, dataset, tmp_path):
    path = tmp_path / f"{letter * (252 // len(os.fsencode(letter)))}.nc"
    assert load(save(dataset, path)).identical(dataset)
    with locked(path), pytest.raises(BlockingIOError), locked(path):
        pass


def test_foreign_files_are_refused(dataset, tmp_path):
    foreign = tmp_path / "foreign.nc"
    for engine in ("netcdf4", "scipy"):
        dataset.to_netcdf(foreign, engine=engine)
        with pytest.raises(ValueError, match=r"without the checksum of .*save; xarray.open_data"):
            load(foreign)
    for content in (b"", b"not a NetCDF file" * 20):
        foreign.write_bytes(content)
        with pytest.raises(ValueError, match=r"not a file that crazybilliards saved$"):
            load(foreign)
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "missing.nc")


def test_the_package_unpickles_nothing():
    """A pickle runs whatever it says."""
    modules = "pickle|cPickle|dill|cloudpickle|joblib|shelve|marshal"
    wrong = re.compile(
        rf"\b(import|from) ({modules})\b|(?<![.\w])(eval|exec|compile)\(|read_pickle|"
        r"np\.load\((?!.*allow_pickle=False)"
    )
    root = Path(load.__code__.co_filename).parents[1]
    rooms = ("model", "particles", "kinetic", "comparison")
    sources = [path for room in rooms for path in (root / room).rglob("*.py")]
    assert len(sources) > 100
    assert not [path for path in sources if wrong.search(path.read_text())]


def test_threads_save_and_load_side_by_side_and_files_are_no_longer_than_they_need_be(
    dataset, tmp_path
):
    """The library of NetCDF files ends the process if two threads call it at the same time."""

    def read_and_written(number):
        path = save(dataset.assign_attrs(number=number), tmp_path / f"{number}.nc")
        assert load_attributes(path)["number"] == load(path).attrs["number"] == number
        return path.stat().st_size

    with ThreadPoolExecutor(4) as pool:
        assert max(pool.map(read_and_written, range(40))) < 20_000
