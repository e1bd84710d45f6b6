"""Kills of the real commands, by each signal at a random moment: start-up and workers included.

As in `test_kill.py`, the same command goes on, ends with the files of an undisturbed one, and no
process is left.
"""

import os
import subprocess
import sys
import time

import numpy as np
import pytest
from test_kill import GRID, PATIENCE, SIGNALS, check, contents, leave_nobody

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")

COMMAND = [sys.executable, "-c", "from crazybilliards.apps.commands.line import main; main()"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["sweep", "grid.toml", "--processes", "2"],
        ["reproduce", "16", "--processes", "2"],
        ["compare", "--size", "10", "--duration", "1000", "--amplitudes", "5"],
    ],
)
def test_a_killed_command_goes_on_to_the_same_files(arguments, tmp_path):
    (tmp_path / "grid.toml").write_text(GRID)

    def start(folder):
        return subprocess.Popen(
            [*COMMAND, *arguments, "--output", str(folder)],
            cwd=tmp_path,
            start_new_session=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )

    begun = time.monotonic()
    clean, folder = tmp_path / "undisturbed", tmp_path / "results"
    with start(clean) as process:
        assert process.wait(10 * PATIENCE) == 0
    duration = time.monotonic() - begun
    generator = np.random.default_rng(3)
    for how in SIGNALS:
        with start(folder) as process:
            time.sleep(generator.uniform(0.1, 1) * duration)
            if process.poll() is None:
                os.killpg(process.pid, how)
            process.communicate(timeout=PATIENCE)
            leave_nobody(process.pid)
        check(contents(folder), contents(clean))
    with start(folder) as process:
        assert process.wait(10 * PATIENCE) == 0
    check(contents(folder), contents(clean))
    final = {path.name for path in folder.rglob("*") if "-interrupted" not in path.name}
    assert final == {path.name for path in clean.rglob("*")}
