"""The cache of kernels: outdated entries are not used, and a cache that fails costs no run."""

import os
import subprocess
import sys
import warnings
from importlib.util import module_from_spec, spec_from_file_location

import pytest
from numba.core import config

from crazybilliards.model import kernels

DOUBLED = """
from crazybilliards.model.kernels import kernel

@kernel
def doubled(x):
    return 2 * x
"""


@pytest.fixture
def doubled(tmp_path, monkeypatch):
    """Return a function that doubles a number as a new process would, and what it warns of."""
    script = tmp_path / "script.py"
    script.write_text(DOUBLED)

    def doubled(cache=None):
        """``cache``: the folder that NUMBA_CACHE_DIR names; without one there is none at all."""
        (tmp_path / "__pycache__").unlink(missing_ok=True)
        (tmp_path / "__pycache__").touch()
        for name in ("HOME", "XDG_CACHE_HOME"):
            monkeypatch.setenv(name, str(script / "none"))
        monkeypatch.setattr(config, "CACHE_DIR", str(cache or ""))
        kernels._warn.cache_clear()
        spec = spec_from_file_location("script", script)
        module = module_from_spec(spec)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            spec.loader.exec_module(module)
            assert module.doubled(1) == 2
        compiled = sum(module.doubled.stats.cache_misses.values())
        return compiled, [str(warning.message) for warning in caught]

    return doubled


@pytest.mark.compiled
def test_kernels_of_other_source_code_are_compiled_anew(doubled, tmp_path, monkeypatch):
    """Numba itself looks only at the file of a kernel, and not at the kernels that it calls."""
    for source, compiled in (("old", 1), ("old", 0), ("new", 1)):
        monkeypatch.setattr(kernels, "room_fingerprint", lambda *_, source=source: source)
        assert doubled(tmp_path / "cache") == (compiled, [])


@pytest.mark.compiled
def test_without_a_folder_for_the_cache_kernels_are_compiled_all_the_same(doubled):
    _, (warning,) = doubled()
    assert "compiled anew in every process" in warning
    assert "NUMBA_CACHE_DIR" in warning


@pytest.mark.compiled
@pytest.mark.posix
def test_a_cache_that_cannot_be_written_costs_no_run_and_a_damaged_one_is_made_anew(
    doubled, tmp_path
):
    from resource import RLIMIT_FSIZE, getrlimit, setrlimit

    cache = tmp_path / "cache"
    room, most = getrlimit(RLIMIT_FSIZE)
    setrlimit(RLIMIT_FSIZE, (100, most))
    try:
        _, (warning,) = doubled(cache)
    finally:
        setrlimit(RLIMIT_FSIZE, (room, most))
    assert "File too large" in warning
    assert doubled(cache) == (1, [])  # there is room again
    for kind in ("nbi", "nbc"):
        damaged = next(cache.rglob(f"*.{kind}"))
        damaged.write_bytes(damaged.read_bytes()[:-10])
        assert [doubled(cache), doubled(cache)] == [(1, []), (0, [])]


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
def total(x):
    return x.sum()

import numpy as np
try:
    total(np.ones(2))
except KeyboardInterrupt:
    print(total(np.ones(2)))
"""


@pytest.mark.compiled
def test_ctrl_c_while_a_kernel_is_compiled_leaves_it_usable(tmp_path):
    """Without its functions, which are registered once, numba would not know ``sum`` any more.

    They are registered in a new process.
    """
    (tmp_path / "script.py").write_text(INTERRUPTED)
    process = [sys.executable, "-B", "script.py"]
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    done = subprocess.run(
        process, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.stderr) == ("2.0\n", "")
