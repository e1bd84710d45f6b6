"""Checkpoints: the whole state of a run in one file, from which the run can continue.

A checkpoint holds the positions, the velocities, the state of the noise and the sums of the
observers of every replica. It also holds the identity of the run: parameters, schedule, seed, and a
fingerprint of the source code. Without the fingerprint an edited kernel would continue the old run.
The file is written atomically, carries a checksum, and is used by one process at a time. Replicas
are saved between two chunks. The boundaries of chunks do not depend on the time of saving, so a
resumed run gives the same bits as an undisturbed one.

The state does not depend on the duration. So the checkpoint of a run, finished or not, is also that
of every longer one. Only a duration that ends within a chunk cuts it short. The file then holds the
state before this chunk, and the longer run takes it as a whole.
"""

from __future__ import annotations

import io
import json
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.model.locks import locked
from crazybilliards.model.process import interrupts_held_back
from crazybilliards.model.storage import make_folder, read_sealed, write_sealed
from crazybilliards.particles.run import Run
from crazybilliards.particles.running.replica import Replica

# Computed when the code is loaded: this process does not run later edits.
_SOURCE = room_fingerprint("model", "particles")


# Planned from the other arguments. Where these differ, they say nothing more.
_PLANNED = ("time_step", "every", "warmup", "duration")


class Checkpoint:
    """The checkpoint file of one run, which continues only if ``identity`` agrees.

    ``run`` is one that may be longer than that in the file. Without it the durations must agree.
    """

    def __init__(
        self, path: Path, identity: Mapping[str, Any], interval: float, run: Run | None = None
    ) -> None:
        self.path, self.run = path, run
        self.identity = json.loads(json.dumps(identity))  # as it will be read back
        self.interval = interval
        self.saved = time.monotonic()

    @contextmanager
    def resumed(self, replicas: Sequence[Replica]) -> Iterator[None]:
        """Set the replicas to the state in the file, if there is one, and lock the file.

        Raises
        ------
        OSError
            If the file cannot be read or written, or another run is using it.
        ValueError
            If it is damaged, or not a checkpoint of this run.
        """
        make_folder(self.path.parent)
        with locked(self.path):
            if self.path.exists():
                self._restore(replicas)
            self._write(replicas)  # this shows before any work that the file can be written
            yield

    def save_if_due(self, replicas: Sequence[Replica]) -> None:
        """Save if the interval has passed since the last time."""
        if time.monotonic() - self.saved >= self.interval:
            self.save(replicas)

    def save(self, replicas: Sequence[Replica]) -> None:
        """Write the state of all replicas; only warn if the disk is full, to keep the run."""
        try:
            self._write(replicas)
        except OSError as error:
            warnings.warn(
                f"{self.path}: no checkpoint written: {error.strerror}; the run continues, and the "
                "last checkpoint stays valid",
                RuntimeWarning,
                stacklevel=2,
            )
            self.saved = time.monotonic()

    def _write(self, replicas: Sequence[Replica]) -> None:
        """Write the state of all replicas, each at the end of its chunk."""
        header = json.dumps({"identity": self.identity}).encode()
        arrays = {"header": np.frombuffer(header, dtype=np.uint8)}
        for number, replica in enumerate(replicas):
            with replica.lock:
                for name, value in replica.state().items():
                    arrays[f"{number}/{name}"] = np.array(value)
        buffer = io.BytesIO()
        with interrupts_held_back():  # zipfile would turn a signal into another error
            np.savez(buffer, **arrays)  # type: ignore[arg-type]
        write_sealed(self.path, buffer.getvalue())
        self.saved = time.monotonic()

    def _restore(self, replicas: Sequence[Replica]) -> None:
        content = read_sealed(self.path)
        try:
            arrays = dict(np.load(io.BytesIO(content), allow_pickle=False))
            found = dict(json.loads(bytes(arrays["header"]))["identity"])
        # numpy may raise anything for a file of another kind with a valid checksum, e.g. a result.
        except Exception as error:
            raise ValueError(f"{self.path}: not a checkpoint") from error
        self._require_same_run(found)
        if self.run is not None and found["duration"] != self.identity["duration"]:
            replicas[0].require_continuing(replace(self.run, duration=found["duration"]))
        states: dict[str, dict[str, np.ndarray]] = {}
        for name, value in arrays.items():
            number, _, own = name.partition("/")
            states.setdefault(number, {})[own] = value
        try:
            for place, replica in enumerate(replicas):
                replica.restore(states[str(place)])
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"{self.path}: a checkpoint without a part of the run") from error

    def _require_same_run(self, found: Mapping[str, Any]) -> None:
        here = self.identity
        differing = [name for name in here if found.get(name) != here[name]]
        if "source" in differing:
            raise ValueError(
                f"{self.path}: a checkpoint that other source code of crazybilliards has written, "
                f"version {found.get('version')}: its run cannot be continued to the same numbers; "
                "remove the file to start anew, or go back to that code"
            )
        if differing == ["duration"] and self.run is not None:
            if found["duration"] < here["duration"]:
                return
            raise ValueError(
                f"{self.path}: a checkpoint of another run: duration is "
                f"{_in_short(found['duration'])} there and {_in_short(here['duration'])} here, and "
                "a run can be made longer, but not shorter; remove the file to start anew"
            )
        if differing:
            all_of_them = ", ".join(
                f"{name} is {_in_short(found.get(name))} there and {_in_short(here[name])} here"
                for name in [each for each in differing if each not in _PLANNED] or differing
            )
            raise ValueError(
                f"{self.path}: a checkpoint of another run: {all_of_them}; remove the file to "
                "start anew"
            )


def _in_short(value: Any) -> str:
    """Return a value for an error: a number without its last digits, a digest without its end."""
    if isinstance(value, float):
        return f"{value:.10g}"
    return f"{value[:15]}..." if str(value).startswith("sha256 ") else str(value)


def identity(run: Run) -> dict[str, Any]:
    """Return everything that determines the bits of a run, by the names of the arguments."""
    depends, schedule = run.provenance(), run.schedule
    del depends["schedule"]
    return {
        **run.chain.parameters(),
        **depends,
        "average": run.average,
        "time_step": schedule.time_step,
        "every": schedule.stride * schedule.time_step,
        "warmup": schedule.warmup,
        "duration": schedule.duration,
        "version": version("crazybilliards"),
        "source": _SOURCE,
    }
