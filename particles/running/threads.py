"""Replicas in threads: progress bar, Ctrl-C and the like, checkpoints during the run."""

from collections.abc import Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from signal import SIGINT
from threading import Event, Lock

from crazybilliards.model.process import interrupts_noted
from crazybilliards.model.progress import progress_bar
from crazybilliards.particles.running.checkpoint import Checkpoint
from crazybilliards.particles.running.replica import Replica

# Collisions of each rod after which a step is given up at Ctrl-C; others take seconds in all.
_PATIENCE = 64


def run_all(
    replicas: Sequence[Replica], threads: int, checkpoint: Checkpoint | None, progress: bool | str
) -> bool:
    """Run the replicas in threads; return whether Ctrl-C, or a signal like it, stopped them."""
    stop, one_by_one = Event(), Lock()
    total = sum(replica.total for replica in replicas)
    futures: list[Future[None]] = []
    with (
        interrupts_noted() as signals,
        progress_bar(
            progress,
            total=total,
            initial=sum(replica.done for replica in replicas),
            desc=progress if isinstance(progress, str) else "simulating",
            unit=" time units",
            unit_scale=True,
            bar_format="{l_bar}{bar}| {elapsed}<{remaining}, {rate_fmt}",
        ) as bar,
    ):

        def work(replica: Replica) -> None:
            for done in replica.work(stop):
                with one_by_one:
                    # Rounded up, so that many short times never add up to less than all.
                    bar.update(min(done * (1 + 1e-9), total - bar.n))

        try:
            with ThreadPoolExecutor(min(threads, len(replicas))) as pool:
                try:
                    futures.extend(pool.submit(work, replica) for replica in replicas)
                    _wait(futures, replicas, checkpoint, signals)
                except KeyboardInterrupt:  # from a handler that is not ours
                    signals.append(SIGINT)
                finally:
                    stop.set()  # otherwise leaving the block would wait for the end of the run
                    for replica in replicas:
                        replica.patience[0] = _PATIENCE * replica.y.size
        finally:  # also where such a handler ends the program
            whole = not any(replica.broken for replica in replicas)  # else the last one stays
            if checkpoint and whole and not any(future.exception() for future in futures):
                checkpoint.save(replicas)
        for future in futures:
            future.result()
    return bool(signals)


def _wait(
    futures: list[Future[None]],
    replicas: Sequence[Replica],
    checkpoint: Checkpoint | None,
    signals: Sequence[int],
) -> None:
    """Wait for all, for the first failure or for a signal; save checkpoints that are due."""
    timeout = min(max(0.02, 1e-4 * len(futures)), 0.5)  # to look at many futures takes time
    if checkpoint is not None:
        timeout = min(timeout, checkpoint.interval)
    while not signals:
        done, pending = wait(futures, timeout=timeout, return_when=FIRST_EXCEPTION)
        if not pending or any(future.exception() for future in done):
            return
        if checkpoint is not None:
            checkpoint.save_if_due(replicas)
