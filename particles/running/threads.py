"""Replicas in threads: progress bar, Ctrl-C and the like, checkpoints during the run."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from signal import SIGINT
from threading import Event, Lock

from crazybilliards.model.process import interrupts_noted
from crazybilliards.model.progress import progress_bar
from crazybilliards.particles.running.checkpoint import Checkpoint
from crazybilliards.particles.running.replica import Replica


def run_all(
    replicas: Sequence[Replica], threads: int, keeper: Checkpoint | None, progress: bool | str
) -> bool:
    """Run the replicas in threads; return whether Ctrl-C, or a signal like it, stopped them.

    ``progress``: whether to show a bar; a text stands in front of it.
    """
    stop, one_by_one = Event(), Lock()
    total = sum(replica.total for replica in replicas)
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
        ThreadPoolExecutor(min(threads, len(replicas))) as pool,
    ):

        def work(replica: Replica) -> None:
            for done in replica.work(stop):
                with one_by_one:
                    # Rounded up, so that many short times never add up to less than all.
                    bar.update(min(done * (1 + 1e-9), total - bar.n))

        futures: list[Future[None]] = []
        try:
            futures.extend(pool.submit(work, replica) for replica in replicas)
            _finish(futures, replicas, keeper, signals, stop)
        except KeyboardInterrupt:  # from a handler that is not ours
            signals.append(SIGINT)
            _finish(futures, replicas, keeper, signals, stop)
        except SystemExit:  # from such a handler of SIGTERM
            stop.set()
            _finish(futures, replicas, keeper, signals, stop)
            raise
        finally:
            stop.set()  # otherwise leaving the block would wait for the end of the run
    return bool(signals)


def _finish(
    futures: list[Future[None]],
    replicas: Sequence[Replica],
    keeper: Checkpoint | None,
    signals: Sequence[int],
    stop: Event,
) -> None:
    """Wait for all, or for the first failure; save checkpoints and react to signals soon."""
    timeout = min(max(0.02, 1e-4 * len(futures)), 0.5)  # to look at many futures takes time
    if keeper is not None:
        timeout = min(timeout, keeper.interval)
    while True:
        if signals:
            stop.set()
        done, pending = wait(futures, timeout=timeout, return_when=FIRST_EXCEPTION)
        for future in done:
            future.result()
        if not pending:
            break
        if keeper is not None:
            keeper.save_if_due(replicas)
    if keeper is not None:
        keeper.save(replicas)
