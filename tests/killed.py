"""A script that is sent a signal while it runs, for tests of checkpoints."""

import subprocess
import sys
import time


def run_and_signal(script, checkpoint, output, how=None, after=0.0):
    """Run the script; send it a signal some time ``after`` it has first written its checkpoint."""
    before = checkpoint.stat().st_mtime_ns if how and checkpoint.exists() else None
    with subprocess.Popen([sys.executable, "-c", script, str(checkpoint), str(output)]) as process:
        try:
            if how is not None:
                while not checkpoint.exists() or checkpoint.stat().st_mtime_ns == before:
                    time.sleep(0.01)
                    assert process.poll() is None
                time.sleep(after)
                process.send_signal(how)
            return process.wait(300)
        finally:
            process.kill()  # otherwise leaving the block would wait for a process that hangs
