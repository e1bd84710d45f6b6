"""Running replicas in threads: progress, Ctrl-C and SIGTERM, checkpoints on the way."""

from __future__ import annotations

from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from threading import Event

from tqdm import tqdm

from crazybilliards.model.process import terminated_like_interrupted
from crazybilliards.particles.run import Run
from crazybilliards.particles.running.checkpoint import Checkpoint
from crazybilliards.particles.running.replica import Replica


def run_all(
    run: Run, replicas: list[Replica], threads: int, keeper: Checkpoint | None, progress: bool
) -> bool:
    """Run the replicas in threads; return whether Ctrl-C or SIGTERM stopped them."""
    stop = Event()
    schedule, dynamics = run.schedule, run.dynamics()
    done = sum(replica.copy * schedule.steps + replica.steps for replica in replicas)
    with (
        tqdm(
            total=run.replicas * schedule.steps * schedule.time_step,
            initial=done * schedule.time_step,
            desc="simulating",
            unit=" time units",
            unit_scale=True,
            disable=None if progress else True,
        ) as bar,
        ThreadPoolExecutor(min(threads, len(replicas))) as pool,
        terminated_like_interrupted(),
    ):

        def work(replica: Replica) -> None:
            for steps in replica.work(dynamics, schedule, stop):
                bar.update(steps * schedule.time_step)

        futures: list[Future[None]] = []
        interrupted = False
        try:
            futures.extend(pool.submit(work, replica) for replica in replicas)
            _finish(futures, replicas, keeper)
        except KeyboardInterrupt:
            interrupted = True
            stop.set()
            _finish(futures, replicas, keeper)
        finally:
            stop.set()  # or leaving would wait for the end of the run
    return interrupted


def _finish(
    futures: list[Future[None]], replicas: list[Replica], keeper: Checkpoint | None
) -> None:
    """Wait for all, or for the first that fails, and keep the checkpoint; see signals soon."""
    timeout = 0.5 if keeper is None else min(0.5, keeper.interval)
    while True:
        done, pending = wait(futures, timeout=timeout, return_when=FIRST_EXCEPTION)
        for future in done:
            future.result()
        if not pending:
            break
        if keeper is not None:
            keeper.save_if_due(replicas)
    if keeper is not None:
        keeper.save(replicas)
