"""Checkpoints: the whole state of a run in one file, from which the run can continue.

A checkpoint holds the positions, the velocities, the state of the noise and the sums of the
observers of every replica, and the identity of the run: parameters, times, seed, and a fingerprint
of the source code, because an edited kernel must not continue the old run. The file is written
atomically, carries a checksum, and is used by one process at a time. Replicas are saved between two
chunks, whose boundaries do not depend on the time of saving, so a resumed run gives the same bits.
"""

import errno
import io
import json
import time
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.model.storage import locked, make_folder, read_sealed, write_sealed
from crazybilliards.particles.run import Run
from crazybilliards.particles.running.replica import Replica

# Computed when the code is loaded: this process does not run later edits.
_SOURCE = room_fingerprint("model", "particles")
_LONGEST = 2.0  # seconds that a chunk may take, so that Ctrl-C need not wait for it


class Checkpoint:
    """The checkpoint file of one run, which continues only the same run."""

    def __init__(self, path: Path, run: Run, interval: float, replicas: Sequence[Replica]) -> None:
        self.path, self.interval, self.replicas = path, interval, replicas
        self.saved = time.monotonic()
        identity = {
            **run.chain.parameters(),
            **run.provenance,
            "average": run.average,
            "duration": run.duration,
            "warmup": run.warmup,
            "time_step": run.time_step,
            "every": run.every,
            "schedule": None,
            "version": version("crazybilliards"),
            "source code": _SOURCE,
        }
        self.identity = json.loads(json.dumps(identity))  # as it will be read back

    @contextmanager
    def resumed(self) -> Iterator[None]:
        """Set the replicas to the state in the file, if there is one, and lock the file.

        It is an OSError if the file cannot be read or written, or another run is using it, and a
        ValueError if it is damaged, or not a checkpoint of this run.
        """
        make_folder(self.path.parent)
        with locked(self.path):
            if self.path.exists():
                self._restore()
            self._write()  # this shows before any work that the file can be written
            yield

    def save_if_due(self) -> None:
        """Save if the interval has passed since the last time."""
        if time.monotonic() - self.saved >= self.interval:
            self.save()

    def save(self) -> None:
        """Write the state of all replicas; only warn if the disk is full, to keep the run."""
        try:
            self._write()
        except OSError as error:
            warnings.warn(
                f"{self.path}: no checkpoint written: {error.strerror}; the run continues, and the "
                "last checkpoint stays valid",
                RuntimeWarning,
                stacklevel=2,
            )
            self.saved = time.monotonic()

    def _write(self) -> None:
        """Write the state of all replicas, each at the end of its chunk."""
        header = json.dumps(self.identity).encode()
        arrays: dict[str, Any] = {"header": np.frombuffer(header, dtype=np.uint8)}
        for number, replica in enumerate(self.replicas):
            if not replica.lock.acquire(timeout=_LONGEST):
                raise TimeoutError(errno.ETIMEDOUT, "a time step takes very many collisions")
            try:
                for name, value in replica.state().items():
                    array = arrays[f"{number}/{name}"] = np.array(value)
                    if array.dtype.hasobject:  # numpy would pickle it, and not read it again
                        raise ValueError(f"a checkpoint holds arrays and numbers, {name} is none")
            finally:
                replica.lock.release()
        buffer = io.BytesIO()
        np.savez(buffer, **arrays)
        write_sealed(self.path, buffer.getvalue())
        self.saved = time.monotonic()

    def _restore(self) -> None:
        content = read_sealed(self.path)
        try:
            archive = np.load(io.BytesIO(content), allow_pickle=False)
            if sum(part.file_size for part in archive.zip.infolist()) > len(content):
                raise ValueError("compressed, which may fill any memory")
            arrays = dict(archive)
            identity = dict(json.loads(bytes(arrays["header"])))
        # numpy may raise anything for a file of another kind with a valid checksum, e.g. a result.
        except Exception as error:
            raise ValueError(f"{self.path}: not a checkpoint") from error
        differing = [name for name in self.identity if identity.get(name) != self.identity[name]]
        if differing:
            raise ValueError(
                f"{self.path}: the checkpoint of another call, which differs in "
                f"{', '.join(differing)}; remove the file to start anew"
            )
        try:
            for number, replica in enumerate(self.replicas):
                replica.restore(arrays, f"{number}/")
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"{self.path}: a checkpoint without a part of the run") from error
