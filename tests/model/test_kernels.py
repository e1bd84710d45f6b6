"""The kernel cache notices a change in anything a kernel calls, and costs no run if it fails."""

import linecache
import os
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from filelock import FileLock

from crazybilliards.model import kernels
from crazybilliards.model.grid import deposit
from crazybilliards.particles import stepping
from crazybilliards.particles.stepping import compile_kernels


@pytest.mark.compiled
def test_kernels_compile_no_texts():
    """A slice that is assigned to a slice brings in the message of an error: a third more time.

    numba's cache keeps the machine code of a kernel with the names of all functions in it.
    """
    compile_kernels()
    for each in (deposit, stepping.record_flight, stepping.record_steps):
        kept = each._cache._cache_file._load_index().values()
        codes = [Path(each.stats.cache_path, name).read_bytes() for name in kept]
        assert codes
        assert any(each.__name__.encode() in code for code in codes)
        assert not any(b"unicode" in code for code in codes), each


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
    for factor, shift in ((2, 1), (5, 1), (5, 3)):
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
    assert outputs == [3, 6, 8]
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
    assert f"{cache}" in warning
    assert "File too large" in warning
    assert run_two(tmp_path, NUMBA_CACHE_DIR=str(cache)) == []  # there is room again
    for kind in ("nbi", "nbc"):
        damaged = next(cache.rglob(f"*.{kind}"))
        damaged.write_bytes(damaged.read_bytes()[:-10])
        (warning,) = run_two(tmp_path, NUMBA_CACHE_DIR=str(cache))
        assert f"{cache}" in warning
        assert "cannot be read" in warning


TURN = """
from crazybilliards.model.kernels import kernel

@kernel
def cubed(x):
    return x**3

print("ready", flush=True)
input()
cubed(2.0)
print(sum(cubed.stats.cache_misses.values()))
"""


@pytest.mark.compiled
def test_of_processes_that_need_the_same_kernel_one_compiles_it(tmp_path):
    (tmp_path / "turn.py").write_text(TURN)
    start = partial(
        subprocess.Popen,
        [sys.executable, "-B", "turn.py"],
        cwd=tmp_path,
        env={**os.environ, "NUMBA_CACHE_DIR": ""},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    with start() as one, start() as other:
        assert [each.stdout.readline() for each in (one, other)] == ["ready\n"] * 2
        for each in (one, other):  # neither has ended when the other begins
            each.stdin.write("\n")
            each.stdin.flush()
        assert sorted(each.communicate()[0] for each in (one, other)) == ["0\n", "1\n"]


def test_a_process_that_was_stopped_while_it_compiled_holds_up_nobody_for_ever(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(kernels, "_LONGEST", 0.01)
    turn = kernels._Turn()
    with FileLock(tmp_path / ".compiling"):
        assert turn.begins(tmp_path)
        assert turn.ends_with(lambda signature: 2 * signature)(3) == 6
    assert turn.lock is None


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
