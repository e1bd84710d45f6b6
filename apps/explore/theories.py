"""Theories beside the simulation, computed outside the event loop."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Mapping
from concurrent.futures import Executor, Future
from multiprocessing.connection import Connection
from threading import Lock
from time import monotonic

import xarray as xr

from crazybilliards.comparison.coverage import smooth
from crazybilliards.kinetic import equilibrium, force_balance, phase_space
from crazybilliards.model import Chain

Densities = Mapping[str, xr.Dataset]
Deliver = Callable[[Chain, Densities | BaseException], None]

_CELLS = 22  # of the kinetic equation's mesh: widths good to 0.1 %, in half the time of 0.04 %


def balance_density(chain: Chain) -> dict[str, xr.Dataset]:
    """Return the smoothed density of the force balance, for e = 1."""
    return {"balance": smooth(force_balance(chain))}


def exact_density(chain: Chain) -> dict[str, xr.Dataset]:
    """Return the exact density for e = 1, smoothed."""
    return {"exact": smooth(equilibrium(chain))}


def kinetic_density(chain: Chain) -> dict[str, xr.Dataset]:
    """Return the kinetic equation's smoothed density, and its widths ``velocity_width``."""
    theory = phase_space(chain, cells=_CELLS)
    density = smooth(theory).assign(velocity_width=theory.velocity_width)
    return {"kinetic": density.assign_attrs(theory.attrs)}


class Background:
    """Short computation for the latest requested chain, one at a time.

    Parameters
    ----------
    executor
        Where it is computed.
    job
        What is computed of a chain.
    deliver
        Called with the chain and the outcome, or with what the job raised.
    post
        Called from any thread with a function that is to be called in the page's own.
    """

    def __init__(
        self,
        executor: Executor,
        job: Callable[[Chain], Densities],
        deliver: Deliver,
        post: Callable[[Callable[[], None]], object],
    ) -> None:
        self._executor, self._job, self._deliver, self._post = executor, job, deliver, post
        self._wanted: Chain | None = None
        self._busy = False

    def ask(self, chain: Chain) -> None:
        """Compute for this chain, as soon as the computation under way is done."""
        self._wanted = chain
        if not self._busy:
            self._start(chain)

    def _start(self, chain: Chain) -> None:
        self._busy = True

        def done(future: Future[Densities]) -> None:
            self._post(lambda: self._arrived(chain, future))

        self._executor.submit(self._job, chain).add_done_callback(done)

    def _arrived(self, chain: Chain, future: Future[Densities]) -> None:
        self._busy = False
        if self._wanted is not None and self._wanted != chain:
            self._start(self._wanted)
        else:
            self._deliver(chain, future.exception() or future.result())


class Solver:
    """Long computation in a process that can be stopped.

    Parameters
    ----------
    job
        What is computed of a chain: a function of a module.
    turn
        Shared by all solvers, of which one computes at a time.
    """

    def __init__(self, job: Callable[[Chain], Densities], turn: Lock) -> None:
        self._job, self._turn = job, turn
        self._process: multiprocessing.process.BaseProcess | None = None
        self._answer: Connection | None = None
        self._began = 0.0
        self.chain: Chain | None = None

    @property
    def seconds(self) -> float:
        """How long it has been computing; 0 while it waits for its turn."""
        return monotonic() - self._began if self._process else 0.0

    def ask(self, chain: Chain) -> None:
        """Compute for this chain; stop a computation under way."""
        self.cancel()
        self.chain = chain

    def poll(self) -> Densities | BaseException | None:
        """Start or check the computation; return its result or error once, else None."""
        if self.chain is None:
            return None
        if self._process is None or self._answer is None:
            return self._begin(self.chain) if self._turn.acquire(blocking=False) else None
        # A process that has ended without an answer has closed its end.
        if not self._answer.poll():
            return None
        try:
            outcome: Densities | BaseException = self._answer.recv()
        except (EOFError, OSError):
            outcome = ValueError("the computation was ended from outside")
        self.cancel()
        return outcome

    def cancel(self) -> None:
        """End the computation under way, if any."""
        self.chain = None
        if self._process is None or self._answer is None:
            return
        self._process.kill()
        self._process.join()
        self._process.close()
        self._answer.close()
        self._process = self._answer = None
        self._turn.release()

    def _begin(self, chain: Chain) -> OSError | None:
        """Start a process; return the error if the system refuses one."""
        context = multiprocessing.get_context("spawn")
        answer, there = context.Pipe(duplex=False)
        process = context.Process(target=_compute, args=(self._job, chain, there), daemon=True)
        try:
            process.start()
        except OSError as error:
            answer.close()
            self.chain = None
            self._turn.release()
            return error
        finally:
            there.close()
        self._process, self._answer, self._began = process, answer, monotonic()
        return None


def _compute(job: Callable[[Chain], Densities], chain: Chain, answer: Connection) -> None:
    """Send the outcome of a job, or its error."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the page's process ends this one
    try:
        answer.send(job(chain))
    except ValueError as error:
        answer.send(error)
    except Exception as error:
        answer.send(ValueError(f"{type(error).__name__}: {error}"))
