"""The kernel cache must notice a change in anything that a kernel calls, wherever it stands."""

import linecache
import os
import subprocess
import sys

import pytest

from crazybilliards.model import kernels

CALLER = """
import inner.middle
from constants import SHIFT
from crazybilliards.model.kernels import kernel

@kernel
def outer(x):
    return inner.middle.middle(x) + SHIFT

print(outer(1))
"""
MIDDLE = """
from crazybilliards.model.kernels import inlined
from inner.deep.innermost import innermost

@inlined
def middle(x):
    return innermost(x)
"""
INNERMOST = """
from crazybilliards.model.kernels import kernel

@kernel
def innermost(x):
    return {} * x
"""


@pytest.mark.compiled
def test_a_changed_callee_is_recompiled_however_far_away(tmp_path):
    """A callee of a callee, in a folder below, reached through a module; a constant."""
    (tmp_path / "inner" / "deep").mkdir(parents=True)
    (tmp_path / "caller.py").write_text(CALLER)
    (tmp_path / "inner" / "middle.py").write_text(MIDDLE)
    outputs = []
    for factor, shift in ((2, 1), (2, 1), (5, 1), (5, 3)):
        (tmp_path / "inner" / "deep" / "innermost.py").write_text(INNERMOST.format(factor))
        (tmp_path / "constants.py").write_text(f"SHIFT = {shift}\n")
        done = subprocess.run(
            [sys.executable, "-B", "caller.py"],
            cwd=tmp_path,
            env={**os.environ, "NUMBA_CACHE_DIR": ""},
            capture_output=True,
            text=True,
            check=True,
        )
        outputs.append(int(done.stdout))
    assert outputs == [3, 3, 6, 8]
    assert list(tmp_path.glob("__pycache__/caller.outer*.nbi"))


def test_a_kernel_of_a_notebook_has_no_file():
    found = set()
    for number, factor in enumerate((2, 2, 3)):
        source, name = f"def scaled(x):\n    return {factor} * x\n", f"/nowhere/cell{number}.py"
        linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
        scope = {}
        exec(compile(source, name, "exec"), scope)
        found.add(kernels._fingerprint(scope["scaled"]))
    assert len(found) == 2
