"""What surrounds a program: home folders and units."""

from pathlib import Path

from small_sweeps import AtOnce

import crazybilliards as cb
from crazybilliards.comparison.sweeps import read_sweep, run_cases
from crazybilliards.model.vocabulary import VOCABULARY, described, unit_of

CHAIN = cb.Chain(size=3)


def test_a_tilde_is_the_home_folder(tmp_path, monkeypatch):
    home, here = tmp_path / "home", tmp_path / "here"
    for folder in (home, here):
        folder.mkdir()
    for name in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(name, str(home))
    monkeypatch.chdir(here)
    exact = cb.equilibrium(CHAIN)
    assert cb.save(exact, "~/a/exact.nc") == home / "a" / "exact.nc"
    assert cb.load("~/a/exact.nc").identical(exact)
    cb.simulate(CHAIN, duration=100, checkpoint=Path("~/run.ckpt"), progress=False)
    (home / "grid.toml").write_text("[grid]\nsize = [2, 3]\n[force_balance]\n")
    sweep = read_sweep("~/grid.toml")
    assert not run_cases(sweep, "~/sweep", AtOnce(), progress=False)
    assert cb.load_sweep("~/sweep").sizes["size"] == 2
    assert (home / "run.ckpt").exists()
    assert not list(here.iterdir())


def test_units_are_not_those_of_a_unit_library():
    for _, unit in VOCABULARY.values():
        written = described("", unit)["units"]
        for word in written.replace("^", " ").replace("/", " ").split():
            assert word.strip("()").isdecimal() or word in ("R_0", "M_0", "t_0")
    width = cb.equilibrium(CHAIN).velocity_width
    assert width.attrs["units"] == "R_0/t_0"
    assert unit_of(width) == unit_of(width.assign_attrs(units="R_0/T_0")) == "R/t_0"
    assert (
        cb.overlay({"exact": cb.equilibrium(CHAIN)}, "velocity_width").get_ylabel()[-9:]
        == "[$R/t_0$]"
    )
