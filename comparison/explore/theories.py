"""The theories beside the moving chain, computed elsewhere so that it keeps moving."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Executor, Future

import xarray as xr

from crazybilliards.comparison.coverage import smooth
from crazybilliards.kinetic import equilibrium, force_balance, phase_space
from crazybilliards.model import Chain

Densities = Mapping[str, xr.Dataset]
Deliver = Callable[[Chain, Densities | BaseException], None]

_CELLS = 22  # of the kinetic equation's mesh: widths good to 0.1 %, in half the time of 0.04 %


def elastic_densities(chain: Chain) -> dict[str, xr.Dataset]:
    """Return the smoothed densities of a chain at e = 1: exact, and of the force balance."""
    return {"exact": smooth(equilibrium(chain)), "balance": smooth(force_balance(chain))}


def kinetic_density(chain: Chain) -> dict[str, xr.Dataset]:
    """Return the kinetic equation's smoothed density, and its widths ``velocity_width``."""
    theory = phase_space(chain, cells=_CELLS)
    return {"kinetic": smooth(theory).assign(velocity_width=theory.velocity_width)}


class Background:
    """A computation for whichever chain is asked for last, one at a time.

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
        self.busy = False

    def ask(self, chain: Chain) -> None:
        """Compute for this chain, as soon as the computation under way is done."""
        self._wanted = chain
        if not self.busy:
            self._start(chain)

    def _start(self, chain: Chain) -> None:
        self.busy = True

        def done(future: Future[Densities]) -> None:
            self._post(lambda: self._arrived(chain, future))

        self._executor.submit(self._job, chain).add_done_callback(done)

    def _arrived(self, chain: Chain, future: Future[Densities]) -> None:
        self.busy = False
        if self._wanted is not None and self._wanted != chain:
            self._start(self._wanted)
        else:
            self._deliver(chain, future.exception() or future.result())
