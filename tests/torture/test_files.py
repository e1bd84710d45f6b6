"""A file is read back as it was written, or refused in one line.

Promised of every file that the package reads again: results, trees of results, checkpoints,
cases of a sweep, descriptions of a sweep. Each is cut at every fiftieth of its length, gets 1000
single bits flipped, and is replaced by an empty file, a folder, a text, a foreign NetCDF file, a
file of the package of another kind, and by sealed files whose content is not what it should be.
Reading must give the same bits or one ValueError of one line. Damage must be found before the
NetCDF libraries see a byte. Nothing is ever unpickled.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from refusals import refused, what_is_wrong

from crazybilliards.comparison.sweeps import load_sweep
from crazybilliards.comparison.sweeps.case import Case, compute
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.kinetic import displaced, force_balance, hydrodynamics
from crazybilliards.model import Chain, chain_of, load, save
from crazybilliards.model.storage import load_attributes, write_sealed
from crazybilliards.particles import simulate
from crazybilliards.particles.start import given_start

CUTS, FLIPS = 50, 1000
CHAIN = Chain(size=3)
RUN = {"duration": 100.0, "warmup": 1.0, "progress": False}


def read_checkpoint(path):
    """Go on from a checkpoint; the file itself is put back for the next reading."""
    kept = path.read_bytes() if path.is_file() else None
    run = simulate(CHAIN, checkpoint=path, **RUN)
    if kept is not None:
        path.write_bytes(kept)
    return run


def read_case(path):
    case = Case("simulate", CHAIN, {"duration": 100, "warmup": 1})
    if path.name != f"{case.key}.nc":
        # A case is found by its name, in its folder.
        folder = path.with_suffix(".folder")
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        path = shutil.copy(path, folder / f"{case.key}.nc") if path.is_file() else path
    return case.load(Path(path).parent)


def read_folder(path):
    """Read a folder that holds one case."""
    if path.is_dir():
        return load_sweep(path)
    folder = path.with_suffix(".sweep")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(path, folder / "case.nc")
    return load_sweep(folder)


READERS = {
    "result": load,
    "tree": load,
    "attributes": load_attributes,
    "checkpoint": read_checkpoint,
    "case": read_case,
    "sweep": read_folder,
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Write one sound file of each kind."""
    folder = tmp_path_factory.mktemp("sound")
    run = simulate(CHAIN, **RUN)
    paths = {name: folder / f"{name}.nc" for name in READERS}
    save(run, paths["result"])
    save(run, paths["attributes"])
    save(xr.DataTree.from_dict({"a": run, "b/c": run}), paths["tree"])
    simulate(CHAIN, checkpoint=paths["checkpoint"], **RUN)
    case = Case("simulate", CHAIN, {"duration": 100, "warmup": 1})
    for name in ("case", "sweep"):
        write_sealed(paths[name], compute(case, case.source))
    return paths


def same(one, other):
    if isinstance(one, xr.Dataset | xr.DataTree):
        return one.identical(other)
    return str(one) == str(other)


@pytest.mark.parametrize("kind", READERS)
def test_a_damaged_file_is_refused_or_read_right(kind, files, tmp_path, monkeypatch):
    whole, sound = files[kind].read_bytes(), READERS[kind](files[kind])
    broken = tmp_path / "broken.nc"
    for number in range(CUTS):
        broken.write_bytes(whole[: number * len(whole) // CUTS])
        assert refused(READERS[kind], broken)

    def unsealed(*arguments, **options):
        raise AssertionError("a library was given the bytes of a damaged file")

    generator = np.random.default_rng(3)
    harmless = 0
    for _ in range(FLIPS):
        flipped = bytearray(whole)
        position = int(generator.integers(len(whole)))
        flipped[position] ^= 1 << int(generator.integers(8))
        broken.write_bytes(bytes(flipped))
        if position == len(whole) - 1:  # the newline at the very end, which seals nothing
            assert same(READERS[kind](broken), sound)
            harmless += 1
            continue
        with monkeypatch.context() as patched:
            patched.setattr("h5py.File", unsealed)
            patched.setattr("xarray.open_datatree", unsealed)
            patched.setattr("xarray.open_dataset", unsealed)
            patched.setattr("crazybilliards.model.storage.ScipyDataStore", unsealed)
            patched.setattr("numpy.load", unsealed)
            assert refused(READERS[kind], broken)
    assert harmless < FLIPS / 100


def sealed_strangers(folder, files):
    """Write files that are sealed well, and are not what they should be."""
    run = load(files["result"])

    def netcdf(dataset):
        return bytes(dataset.to_netcdf(engine="h5netcdf"))

    contents = {
        "nothing": b"",
        "text": b"no file of this kind\n" * 30,
        "hdf5": b"\x89HDF\r\n\x1a\n" + bytes(500),
        "classic": b"CDF\x02" + b"\xff" * 500,
        "zip": b"PK\x03\x04" + bytes(100),
        "npy": b"\x93NUMPY\x01\x00" + bytes(100),
        "pickle": b"\x80\x04cos\nsystem\n(S'exit 7'\ntR.",
        "empty": netcdf(xr.Dataset()),
        "no provenance": netcdf(run.drop_attrs()),
        "wrong types": netcdf(run.assign_attrs(provenance=3, case=4, status=5)),
        "no json": netcdf(run.assign_attrs(provenance="{", case="{")),
        "a list": netcdf(run.assign_attrs(provenance="[]", case="[]")),
        "no keys": netcdf(run.assign_attrs(provenance="{}", case="{}")),
        "wrong chain": netcdf(run.assign_attrs(provenance='{"chain": {"size": "x"}}')),
        "other chain": netcdf(run.assign_attrs(provenance='{"chain": {"length": 3}}')),
    }
    for name, content in contents.items():
        path = folder / f"{name}.nc"
        write_sealed(path, content)
        yield path
    for kind, path in files.items():
        yield Path(shutil.copy(path, folder / f"another {kind}.nc"))


# NetCDF files that are no results are read as what they are, and name no chain.
NETCDF = {"empty", "no provenance", "wrong types", "no json", "a list", "no keys"}
NETCDF |= {"wrong chain", "other chain"} | {f"another {kind}" for kind in READERS}
READABLE = {
    "checkpoint": {"another checkpoint"},
    "case": {"another case", "another sweep"},
    "sweep": {"another case", "another sweep"},
}


@pytest.mark.parametrize("kind", READERS)
def test_a_file_of_another_kind_is_refused(kind, files, tmp_path):
    paths = [*sealed_strangers(tmp_path, files)]
    readable = {path.stem for path in paths if not refused(READERS[kind], path)}
    assert readable == READABLE.get(kind, NETCDF - {"another checkpoint"})
    assert len(paths) == 21


@pytest.mark.parametrize("kind", READERS)
def test_a_foreign_file_is_refused(kind, files, tmp_path):
    read = READERS[kind]
    xr.Dataset({"density": ("x", [1.0])}).to_netcdf(tmp_path / "plain.nc", engine="h5netcdf")
    (tmp_path / "text.nc").write_text("no file of this kind\n" * 30)
    (tmp_path / "empty.nc").touch()
    np.save(tmp_path / "array.npy", np.zeros(3))
    with h5py.File(tmp_path / "hdf5.nc", "w") as file:
        file["density"] = np.zeros(3)
    for path in list(tmp_path.iterdir()):
        if path.is_file():
            assert refused(read, path), path
    if read is not read_case:  # whose folder is where it looks for its file
        (tmp_path / "folder").mkdir()
        assert refused(read, tmp_path / "folder")


def test_the_wrong_version_of_a_checkpoint_or_a_case_is_refused(files, tmp_path, monkeypatch):
    monkeypatch.setattr("crazybilliards.particles.running.checkpoint.version", lambda _: "0.0.1")
    other = replace(JOBS["simulate"], source="other source code")
    monkeypatch.setitem(JOBS, "simulate", other)
    with pytest.raises(ValueError, match="a checkpoint of another run: version is"):
        simulate(CHAIN, checkpoint=files["checkpoint"], **RUN)
    case = Case("simulate", CHAIN, {"duration": 100, "warmup": 1})
    shutil.copy(files["case"], case.file(tmp_path))
    with pytest.raises(ValueError, match="other source code"):
        case.load(tmp_path)


@pytest.mark.parametrize(
    "changed",
    [
        {"duration": 50.0},
        {"warmup": 2.0},
        {"seed": 1},
        {"replicas": 2},
        {"observe": "widths"},
        {"particles": [1]},
        {"time_step": 0.09},
        {"every": 0.5},
        {"stepper": "euler"},
        {"merging": 0.02},
        {"method": "contact-dynamics"},
        {"start": given_start(CHAIN, CHAIN.anchors + 0.1)},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_a_good_checkpoint_of_another_run_is_refused_and_kept(changed, files):
    before = files["checkpoint"].read_bytes()
    with pytest.raises(ValueError, match="a checkpoint of another run") as caught:
        simulate(CHAIN, checkpoint=files["checkpoint"], **RUN | changed)
    assert "\n" not in str(caught.value)
    for chain in (CHAIN.replace(gap=0.1), CHAIN.replace(size=4), CHAIN.replace(spring="quadratic")):
        with pytest.raises(ValueError, match="a checkpoint of another run"):
            simulate(chain, checkpoint=files["checkpoint"], **RUN)
    assert files["checkpoint"].read_bytes() == before


def test_a_result_of_another_chain_is_refused_where_it_would_be_used():
    few, many = simulate(CHAIN, **RUN), Chain(size=4)
    start = given_start(CHAIN, CHAIN.anchors)
    calls = [
        lambda: simulate(many, start=start, **RUN),
        lambda: simulate(CHAIN, start=few, **RUN),
        lambda: simulate(CHAIN, start=start, replicas=2, **RUN),
        lambda: simulate(CHAIN.replace(radius=2.0), start=start, **RUN),
        lambda: force_balance(many, displacement=few),
        lambda: force_balance(many, velocity_variance=few),
        lambda: hydrodynamics(many, displaced(CHAIN, 1.0), 1.0, progress=False),
        lambda: hydrodynamics(many, start, 1.0, progress=False),
    ]
    for call in calls:
        with pytest.raises(ValueError, match=r"\w") as caught:
            call()
        assert "\n" not in str(caught.value)


def test_a_result_names_its_chain_or_is_refused(files, tmp_path):
    named = 0
    for path in sealed_strangers(tmp_path, files):
        message = what_is_wrong(lambda path: chain_of(load(path)), path)
        assert "\n" not in message
        named += not message
    assert named == 4


def test_reading_a_file_runs_no_pickle(files, tmp_path):
    """Seen by Python itself: its audit event for every name that a pickle asks for."""
    script = """
import pathlib, sys
from crazybilliards.model import Chain, load
from crazybilliards.model.storage import load_attributes
from crazybilliards.particles import simulate
seen = []
sys.addaudithook(lambda event, details: seen.append(details) if "pickle" in event else None)
options = {"duration": 100.0, "warmup": 1.0, "progress": False}
for path in sys.argv[1:]:
    seen.clear()
    for read in (load, load_attributes, lambda p: simulate(Chain(size=3), checkpoint=p, **options)):
        before = len(seen)
        try:
            read(path)
        except ValueError:
            pass
    # numba's cache of compiled kernels, which it wrote itself, is no file of the package.
    assert not any("system" in str(details) for details in seen), seen
"""
    paths = [*sealed_strangers(tmp_path, files)]
    done = subprocess.run(
        [sys.executable, "-c", script, *map(str, paths)],
        capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
