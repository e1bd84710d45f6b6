"""The cache of kernels: outdated entries are not used, and a cache that fails costs no run."""

import os
import subprocess
import sys

import pytest

FINGERPRINT = """
import sys
from crazybilliards.model import fingerprint
fingerprint.room_fingerprint = lambda *_: sys.argv[1]
from crazybilliards.model.kernels import kernel

@kernel
def doubled(x):
    return 2 * x

doubled(1)
print(sum(doubled.stats.cache_misses.values()))
"""


@pytest.mark.compiled
def test_kernels_of_other_source_code_are_compiled_anew(tmp_path):
    """Numba itself looks only at the file of a kernel, and not at the kernels that it calls."""
    (tmp_path / "script.py").write_text(FINGERPRINT)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    misses = [
        subprocess.run(
            [sys.executable, "-B", "script.py", source],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for source in ("old", "old", "new")
    ]
    assert misses == ["1\n", "0\n", "1\n"]


TWO = """
from crazybilliards.model.kernels import kernel

@kernel
def doubled(x):
    return 2 * x

@kernel
def tripled(x):
    return 3 * x

print(doubled(1), tripled(1))
"""
FULL = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))"


def run_two(folder, text=TWO, **environment):
    """Run kernels of two files; no cache can be kept but where ``environment`` says."""
    (folder / "file").touch()
    (folder / "__pycache__").touch()
    script = folder / "two.py"
    if not script.exists() or script.read_text() != text:  # older numba looks at its time
        script.write_text(text)
    nowhere = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR"), str(folder / "file/x"))
    done = subprocess.run(
        [sys.executable, "-B", "two.py"],
        cwd=folder,
        env=os.environ | nowhere | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "2 3\n"), done.stderr
    return [line for line in done.stderr.splitlines() if "Warning" in line]


@pytest.mark.compiled
def test_without_a_folder_for_the_cache_kernels_are_compiled_all_the_same(tmp_path):
    (warning,) = run_two(tmp_path)
    assert "compiled anew in every process" in warning
    assert "NUMBA_CACHE_DIR" in warning


@pytest.mark.compiled
@pytest.mark.posix
def test_a_cache_that_cannot_be_written_or_read_costs_no_run(tmp_path):
    cache = tmp_path / "cache"
    (warning,) = run_two(tmp_path, FULL + TWO, NUMBA_CACHE_DIR=str(cache))
    assert "File too large" in warning
    assert run_two(tmp_path, NUMBA_CACHE_DIR=str(cache)) == []  # there is room again
    for kind in ("nbi", "nbc"):
        damaged = next(cache.rglob(f"*.{kind}"))
        damaged.write_bytes(damaged.read_bytes()[:-10])
        (warning,) = run_two(tmp_path, NUMBA_CACHE_DIR=str(cache))
        assert "cache fails" in warning


INTERRUPTED = """
import signal
from numba.core.base import BaseContext

register, calls = BaseContext.insert_func_defn, []

def and_interrupt(self, *arguments):
    calls.append(1)
    if len(calls) == 100:
        signal.raise_signal(signal.SIGINT)
    return register(self, *arguments)

BaseContext.insert_func_defn = and_interrupt
from crazybilliards.model.kernels import kernel

@kernel
def doubled(x):
    return x.sum()

import numpy as np
try:
    doubled(np.ones(2))
except KeyboardInterrupt:
    print(int(doubled(np.ones(2))), 3)
"""


@pytest.mark.compiled
def test_ctrl_c_while_a_kernel_is_compiled_leaves_it_usable(tmp_path):
    """Without its functions, which are registered once, numba would not know ``sum`` any more."""
    assert run_two(tmp_path, INTERRUPTED, NUMBA_CACHE_DIR=str(tmp_path / "cache")) == []
