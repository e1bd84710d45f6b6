"""The kernel cache must notice a change in a kernel that is called from another file."""

import os
import subprocess
import sys

import pytest


@pytest.mark.compiled
def test_a_changed_callee_is_recompiled(tmp_path):
    caller = (
        "from callee import inner\n"
        "from crazybilliards.model.kernel import kernel\n"
        "@kernel\n"
        "def outer(x):\n"
        "    return inner(x) + 1\n"
        "print(outer(1))\n"
    )
    callee = (
        "from crazybilliards.model.kernel import kernel\n"
        "@kernel\n"
        "def inner(x):\n"
        "    return {} * x\n"
    )
    (tmp_path / "caller.py").write_text(caller)
    outputs = []
    for factor in (2, 2, 5):
        (tmp_path / "callee.py").write_text(callee.format(factor))
        done = subprocess.run(
            [sys.executable, "caller.py"],
            cwd=tmp_path,
            env={**os.environ, "NUMBA_CACHE_DIR": ""},
            capture_output=True,
            text=True,
            check=True,
        )
        outputs.append(int(done.stdout))
    assert outputs == [3, 3, 6]
    assert list(tmp_path.glob("__pycache__/caller.outer*.nbi"))
