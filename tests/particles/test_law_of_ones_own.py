"""The collision law that a page adds to the package, line by line, does what the page says."""

import os
import shutil
import sys

import pytest
from installation import FOLDERS, ROOT, run

PAGE = ROOT / "docs" / "howto" / "extend.md"
TRY = """
import math
import crazybilliards as cb

def width(soft_speed, restitution=0.8, **how):
    chain = cb.Chain(size=3, restitution=restitution, gap=0.5, soft_speed=soft_speed)
    how = {"duration": 60, "time_step": 0.1, "progress": False} | how
    run = cb.simulate(chain, **how)
    assert math.isnan(run.attrs["time_step_error"]) == (soft_speed > 0 or "method" in how)
    return run.velocity_width.values

assert width(1e12, merging=0) == __import__("pytest").approx(width(1e12, 0.3, merging=0))
assert abs(width(1e-12) - width(0)).max() < 1e-6 < abs(width(0.3) - width(0)).max()
width(0.3, restitution=0.0), width(0.3, restitution=1.0), width(0.0, method="contact-dynamics")
try:
    width(0.3, method="contact-dynamics")
except ValueError as error:
    assert "contact-dynamics) does not know the chain's soft_speed" in str(error)
else:
    raise AssertionError("ignored")
"""


def added(root):
    """Make the changes of the page: each must fit into exactly one place."""
    changes = PAGE.read_text(encoding="utf-8").split("```diff\n")[1].split("```")[0]
    for change in changes.split("--- ")[1:]:
        name, hunks = change.split("\n", 1)
        file = root / name
        for hunk in hunks.split("@@\n"):
            lines = [(line[0], line[1:]) for line in hunk.splitlines()]
            before = "".join(f"{text}\n" for sign, text in lines if sign in " -")
            after = "".join(f"{text}\n" for sign, text in lines if sign in " +")
            text = file.read_text(encoding="utf-8")
            assert text.count(before) == 1, hunk
            file.write_text(text.replace(before, after), encoding="utf-8")


@pytest.mark.validate
def test_the_law_of_the_page(tmp_path):
    package = tmp_path / "crazybilliards"
    for folder, place in FOLDERS.items():
        shutil.copytree(ROOT / folder, package / place.removeprefix("."), dirs_exist_ok=True)
    added(package)
    plain = os.environ | {"PYTHONPATH": str(tmp_path), "NUMBA_DISABLE_JIT": "1"}
    # Where random numbers wrap around, numpy's scalars warn.
    run(sys.executable, "-W", "error::RuntimeWarning", "-c", TRY, env=plain, cwd=tmp_path)
