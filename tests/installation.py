"""The folders of the package, and what a user types, by whatever way it was installed."""

import subprocess
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).parent.parent
ROOMS = ("model", "particles", "kinetic", "comparison")  # those with public names
FOLDERS = {"api": ""} | {room: f".{room}" for room in (*ROOMS, "reproduction", "apps")}
EXPECTED = ["Chain", "simulate", "force_balance", "overlay", "load", "save", "equilibrium"]
TRY = f"""
import sys
import crazybilliards as cb
assert not {{"numpy", "numba", "xarray"}} & set(sys.modules)
assert set({EXPECTED}) <= set(dir(cb))
assert cb.Chain(size=3).size == 3 and cb.__version__ == {version("crazybilliards")!r}
from crazybilliards import kinetic, simulate
print(cb.__file__)
"""


def run(*command, **options):
    done = subprocess.run(
        [*map(str, command)], capture_output=True, text=True, timeout=600, check=False, **options
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done
