"""Checkpoints: the whole state of a run in one file, so that it can go on where it stopped.

A checkpoint holds, for every replica, positions, velocities, the random generator and what its
observers have summed up; and the identity of the run: parameters, schedule, seed, version. It is
written atomically, sealed with a checksum, and kept by one process at a time. Replicas are caught
between two chunks, whose boundaries do not depend on when that is: a resumed run gives the same
bits as an undisturbed one.
"""

from __future__ import annotations

import hashlib
import io
import json
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from crazybilliards.model.locks import locked
from crazybilliards.model.storage import make_folder, read_sealed, write_sealed
from crazybilliards.particles.request import Request
from crazybilliards.particles.running.replica import Replica


class Checkpoint:
    """The checkpoint file of one run; ``identity`` is what has to agree to go on."""

    def __init__(self, path: Path, identity: Mapping[str, Any], interval: float) -> None:
        self.path = path
        self.identity = json.loads(json.dumps(identity))  # as it will be read back
        self.interval = interval
        self.saved = time.monotonic()

    @contextmanager
    def resumed(self, runs: Sequence[Replica]) -> Iterator[None]:
        """Bring the replicas to the state in the file, if there is one, and keep others off it.

        Raises
        ------
        OSError
            If the file cannot be read or written, or another run is keeping it.
        ValueError
            If it is damaged, or not a checkpoint of this run.
        """
        make_folder(self.path.parent)
        with locked(self.path):
            if self.path.exists():
                self._restore(runs)
            self._write(runs)  # shows before any work that the file can be written
            yield

    def save_if_due(self, runs: Sequence[Replica]) -> None:
        """Save if the interval has passed since the last time."""
        if time.monotonic() - self.saved >= self.interval:
            self.save(runs)

    def save(self, runs: Sequence[Replica]) -> None:
        """Write the state of all replicas, or warn: a full disk must not cost the run."""
        try:
            self._write(runs)
        except OSError as error:
            warnings.warn(
                f"{self.path}: no checkpoint written: {error.strerror}; the run goes on, and what "
                "was written before stays valid",
                RuntimeWarning,
                stacklevel=2,
            )
            self.saved = time.monotonic()

    def _write(self, runs: Sequence[Replica]) -> None:
        """Write the state of all replicas, each at the end of its chunk."""
        arrays: dict[str, np.ndarray] = {"header": _text({"identity": self.identity})}
        for number, run in enumerate(runs):
            with run.lock:
                for name, value in run.state().items():
                    arrays[f"{number}/{name}"] = np.array(value)
                generator = run.generator.bit_generator.state
            arrays[f"{number}/generator"] = _text(generator)
        buffer = io.BytesIO()
        np.savez(buffer, **arrays)  # type: ignore[arg-type]
        write_sealed(self.path, buffer.getvalue())
        self.saved = time.monotonic()

    def _restore(self, runs: Sequence[Replica]) -> None:
        content = read_sealed(self.path)
        try:
            arrays = dict(np.load(io.BytesIO(content), allow_pickle=False))
            found = dict(json.loads(bytes(arrays["header"]))["identity"])
        # Whatever numpy makes of a sealed file of another kind, a result for example.
        except Exception as error:
            raise ValueError(f"{self.path}: not a checkpoint") from error
        self._require_same_run(found)
        try:
            for number, run in enumerate(runs):
                _restore_replica(run, number, arrays)
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"{self.path}: a checkpoint without a part of the run") from error

    def _require_same_run(self, found: Mapping[str, Any]) -> None:
        for name, wanted in self.identity.items():
            if found.get(name) != wanted:
                raise ValueError(
                    f"{self.path}: a checkpoint of another run: {name} is {found.get(name)} there "
                    f"and {wanted} here; remove the file to start anew"
                )


def run_identity(request: Request) -> dict[str, Any]:
    """Everything that a run's bits depend on, by name; the start as a checksum."""
    states = (state.tobytes() for start in request.starts for state in start)
    return {
        "version": version("crazybilliards"),
        **request.chain.parameters(),
        **asdict(request.schedule),
        **request.settings,
        "observe": request.observe,
        "particles": (request.plan.chosen + 1).tolist(),
        "replicas": len(request.starts),
        "start": hashlib.sha256(b"".join(states)).hexdigest(),
    }


def _restore_replica(run: Replica, number: int, arrays: Mapping[str, np.ndarray]) -> None:
    prefix = f"{number}/"
    state = {
        name.removeprefix(prefix): value
        for name, value in arrays.items()
        if name.startswith(prefix)
    }
    run.generator.bit_generator.state = json.loads(bytes(state.pop("generator")))
    run.restore(state)


def _text(content: Any) -> np.ndarray:
    return np.frombuffer(json.dumps(content).encode(), dtype=np.uint8)
