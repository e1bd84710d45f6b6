"""A file is read back as it was written, or refused in one line.

Promised of every file that the package reads again: results, trees of results, checkpoints, cases
of a sweep. Each is cut at every twentieth of its length, gets single bits flipped, and is replaced
by a file of the package of another kind, and by sealed files whose content is not what it should
be. Reading must give the same bits or one ValueError of one line. Damage must be found before the
NetCDF libraries see a byte.
"""

import io
import re
import shutil

import h5py
import numpy as np
import pytest
import xarray as xr

from crazybilliards.comparison.sweeps import load_sweep
from crazybilliards.comparison.sweeps.case import Case, compute
from crazybilliards.model import Chain, chain_of, load, save
from crazybilliards.model.storage import load_attributes, write_sealed
from crazybilliards.particles import simulate
from crazybilliards.particles.start import given_start

CHAIN = Chain(size=3)
RUN = {"duration": 100.0, "warmup": 1.0, "observe": "widths", "progress": False}
CASE = Case("simulate", CHAIN, {"duration": 100, "warmup": 1, "observe": "widths"})


def read_checkpoint(path):
    """Go on from a checkpoint; the file itself is put back for the next reading."""
    kept = path.read_bytes() if path.is_file() else None
    run = simulate(CHAIN, checkpoint=path, **RUN)
    if kept is not None:
        path.write_bytes(kept)
    return run


def alone(path, name):
    """Return a folder with nothing but a copy of the file."""
    folder = path.with_suffix(".folder")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(path, folder / name)
    return folder


READERS = {
    "result": load,
    "tree": load,
    "attributes": load_attributes,
    "checkpoint": read_checkpoint,
    "case": lambda path: CASE.load(alone(path, CASE.file(path).name)),
    "sweep": lambda path: load_sweep(alone(path, "case.nc")),
}


def what_is_wrong(read, path):
    """Return the message of the ValueError that reading raises; nothing if it succeeds."""
    try:
        read(path)
    except ValueError as error:
        message = str(error)
    else:
        message = ""
    assert "\n" not in message
    return message


def refused(read, path):
    """Whether reading was refused, in one line that names the file."""
    message = what_is_wrong(read, path)
    assert not message or str(path.parent) in message, message
    return bool(message)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Write one sound file of each kind."""
    folder = tmp_path_factory.mktemp("sound")
    run = simulate(CHAIN, **RUN)[["velocity_width"]]
    paths = {name: folder / f"{name}.nc" for name in READERS}
    save(run, paths["result"])
    save(run, paths["attributes"])
    save(xr.DataTree.from_dict({"a": run, "b/c": run}), paths["tree"])
    simulate(CHAIN, checkpoint=paths["checkpoint"], **RUN)
    for name in ("case", "sweep"):
        write_sealed(paths[name], compute(CASE, CASE.source))
    return paths


@pytest.mark.parametrize("flips", [40, pytest.param(1000, marks=pytest.mark.torture)])
@pytest.mark.parametrize("kind", READERS)
def test_a_damaged_file_is_refused_or_read_right(kind, flips, files, tmp_path, monkeypatch):
    whole, sound = files[kind].read_bytes(), READERS[kind](files[kind])
    broken = tmp_path / "broken.nc"
    for number in range(20):
        broken.write_bytes(whole[: number * len(whole) // 20])
        assert refused(READERS[kind], broken)

    def unsealed(*arguments, **options):
        # No Exception, which would become another error on its way.
        pytest.fail("a library was given the bytes of a damaged file")

    for library in ("h5py.File", "netCDF4.Dataset", "numpy.load", "xarray.open_datatree"):
        monkeypatch.setattr(library, unsealed)
    generator = np.random.default_rng(3)
    for position in generator.integers(len(whole) - 1, size=flips):
        flipped = bytearray(whole)
        flipped[position] ^= 1 << int(generator.integers(8))
        broken.write_bytes(bytes(flipped))
        assert re.search("truncated|damaged", what_is_wrong(READERS[kind], broken))
    monkeypatch.undo()
    broken.write_bytes(whole[:-1] + b"x")  # the newline at the very end seals nothing
    again = READERS[kind](broken)
    assert again.identical(sound) if hasattr(sound, "identical") else str(again) == str(sound)


def virtual(file, other):
    layout = h5py.VirtualLayout((1,), float)
    layout[:] = h5py.VirtualSource(other, "d", (1,))
    file.create_virtual_dataset("v", layout)


# What HDF5 can hold beside arrays: another file's data, itself, and more than its length.
HOSTILE = {
    "external link": lambda file, other: file.update(x=h5py.ExternalLink(other, "/d")),
    "external storage": lambda file, other: file.create_dataset("x", 1, "f8", external=other),
    "virtual": virtual,
    "soft link": lambda file, _: file.update(x=h5py.SoftLink("/velocity_width")),
    "in itself": lambda file, _: file.update({"group/in/itself": file["/"]}),
    "two names": lambda file, _: file.update(x=file["velocity_width"]),
    "huge": lambda file, _: file.create_dataset("x", 10**13, "f8"),
    "huge in chunks": lambda file, _: file.create_dataset("x", 10**13, "f8", chunks=True),
}


@pytest.fixture(scope="module")
def strangers(files, tmp_path_factory):
    """Write files that are sealed well, and are not what they should be."""
    run, folder = load(files["result"]), tmp_path_factory.mktemp("strangers")

    def netcdf(dataset):
        return bytes(dataset.to_netcdf(engine="netcdf4"))

    contents = {
        "nothing": b"",
        "text": b"no file of this kind\n" * 30,
        "hdf5": b"\x89HDF\r\n\x1a\n" + bytes(500),
        "classic": b"CDF\x02" + b"\xff" * 500,
        "zip": b"PK\x03\x04" + bytes(100),
        "npy": b"\x93NUMPY\x01\x00" + bytes(100),
        "json": b'{"identity": 3}',
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
    with h5py.File(folder / "other.h5", "w") as other:
        other["d"] = [1.0]
    for name, change in HOSTILE.items():
        with h5py.File(buffer := io.BytesIO(contents["no provenance"]), "r+") as file:
            change(file, str(folder / "other.h5"))
        contents[name] = buffer.getvalue()
    np.savez_compressed(buffer := io.BytesIO(), header=np.zeros(10**6))
    contents["bomb"] = buffer.getvalue()
    for name, content in contents.items():
        write_sealed(folder / f"{name}.nc", content)
    for kind, path in files.items():
        shutil.copy(path, folder / f"another {kind}.nc")
    return sorted(folder.glob("*.nc"))


# NetCDF files that are no results are read as what they are, and name no chain.
NETCDF = {"empty", "no provenance", "wrong types", "no json", "a list", "no keys"}
NETCDF |= {"wrong chain", "other chain"} | {f"another {kind}" for kind in READERS}
READABLE = {
    "checkpoint": {"another checkpoint"},
    "case": {"another case", "another sweep"},
    "sweep": {"another case", "another sweep"},
}


@pytest.mark.parametrize("kind", [kind for kind in READERS if kind != "tree"])  # read as a result
def test_a_file_of_another_kind_is_refused_and_kept(kind, strangers):
    before = [path.read_bytes() for path in strangers]
    readable = {path.stem for path in strangers if not refused(READERS[kind], path)}
    assert readable == READABLE.get(kind, NETCDF - {"another checkpoint"})
    assert [path.read_bytes() for path in strangers] == before
    assert len(strangers) == 31


@pytest.mark.parametrize(
    "changed",
    [
        *({"duration": 50.0}, {"warmup": 2.0}, {"seed": 5}, {"replicas": 2}, {"particles": [1]}),
        *({"time_step": 0.09}, {"every": 0.5}, {"stepper": "euler"}, {"merging": 0.02}),
        *({"observe": "density"}, {"average": "ensemble"}, {"method": "contact-dynamics"}),
        {"start": given_start(CHAIN, CHAIN.anchors + 0.1)},
        *({"gap": 0.1}, {"size": 4}, {"spring": "quadratic"}),
    ],
)
def test_a_checkpoint_of_another_call_is_refused_and_kept(changed, files):
    chain, [name] = CHAIN, changed
    if name in CHAIN.parameters():
        chain, changed = CHAIN.replace(**changed), {}
    before = files["checkpoint"].read_bytes()
    with pytest.raises(ValueError, match=f"another call, which differs in .*{name}.*; remove"):
        simulate(chain, checkpoint=files["checkpoint"], **RUN | changed)
    assert files["checkpoint"].read_bytes() == before


def test_a_result_names_its_chain_or_is_refused(strangers):
    messages = [what_is_wrong(lambda path: chain_of(load(path)), path) for path in strangers]
    assert messages.count("") == 4
