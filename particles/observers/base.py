"""The interface of observers: they receive snapshots, keep sums, and report variables.

Every replica (in an ensemble every group of replicas) has its own observers. They are joined in
order, so that results do not depend on the number of threads.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from types import NoneType
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Array, Chain
from crazybilliards.model.arrays import merge_pairs
from crazybilliards.particles.laws.avalanche import Tally
from crazybilliards.particles.observers.error_bars import jackknife
from crazybilliards.particles.run import Run

Integers = NDArray[np.int64]
Variables = dict[str, tuple[tuple[str, ...], ArrayLike]]

# Attributes of an observer that never change, as functions do not. A checkpoint keeps none.
_CONSTANT = (NoneType, Chain, Run)


class Snapshots(NamedTuple):
    """Some successive snapshots, all of one block, that observers receive."""

    block: int
    first: int  # number of the first one within the replica, from 0
    copy: int  # number of the replica among those that share this observer
    y: Array  # (snapshots, L), reduced coordinates
    v: Array  # (snapshots, L)
    collisions: Integers  # since the last snapshots, by contact; empty if not counted


class Observer(ABC):
    """A measurement. It holds its parameters and, once prepared for a run, its sums.

    ``observe`` of ``simulate`` takes observers by their names or as objects:
    ``observe=["widths", Velocities(bins=801)]``. The constructor takes the parameters, if there
    are any. :meth:`prepare` makes the arrays for the sums.
    """

    name: ClassVar[str]  #: its name in ``observe``
    gives: ClassVar[tuple[str, ...]]  #: the variables that it reports
    #: ``{name: (meaning, unit)}`` of its variables and coordinates, as far as they are not in
    #: ``VOCABULARY`` of ``crazybilliards.model.vocabulary``. Units consist of R, M and t_0.
    vocabulary: ClassVar[Mapping[str, tuple[str, str]]] = {}
    along: ClassVar[tuple[str, ...]] = ()  #: the coordinates that it adds, e.g. ``("wave",)``
    least_rods: ClassVar[int] = 1  #: the size of the shortest chain that it can measure
    single_collisions: ClassVar[bool] = False  #: it needs every collision, not only snapshots
    ensemble: ClassVar[bool] = True  #: it can be averaged over replicas at equal times
    shares_time: ClassVar[bool] = False  #: beside one like it, it has the times of all snapshots
    meets_walls: ClassVar[bool] = False  #: it needs every impulse on a wall, and a chain in a box
    #: It reads more of the chain than the places of its anchors, and refuses a chain with a new
    #: parameter. One that only averages ``y`` and ``v`` says False.
    reads_chain: ClassVar[bool] = True
    #: New parameters with which it is right all the same; see *Extend the package*.
    knows: ClassVar[frozenset[str]] = frozenset()

    def __str__(self) -> str:
        """Return the name and, if there are any, the parameters."""
        given = {name: value for name, value in vars(self).items() if value is not None}
        parameters = ", ".join(f"{name}={value!r}" for name, value in given.items())
        return f"{self.name}({parameters})" if parameters else self.name

    def interval(self, chain: Chain) -> float:
        """Return the longest time between snapshots that serves it where ``every`` is not given."""
        return math.inf

    @abstractmethod
    def memory(self, run: Run) -> float:
        """Return the bytes that it keeps for one replica of the run, or one group of replicas."""

    @abstractmethod
    def prepare(self, run: Run, copies: int) -> None:
        """Make the arrays for the sums, for a run and the number of replicas that share it."""

    def prepared(self, run: Run, copies: int) -> Self:
        """Return an observer with the same parameters, prepared."""
        observer = copy(self)
        observer.prepare(run, copies)
        return observer

    def state(self) -> dict[str, Any]:
        """Return the attributes that a checkpoint keeps: all arrays, numbers and texts."""
        return {
            name: value
            for name, value in vars(self).items()
            if not (isinstance(value, _CONSTANT) or callable(value))
        }

    def tally(self, tally: Tally) -> Tally:
        """Return the record of single collisions, with the arrays of this observer if any."""
        return tally

    @abstractmethod
    def observe(self, snapshots: Snapshots) -> None:
        """Take some snapshots."""

    def merge(self) -> None:  # noqa: B027
        """Add up neighbouring blocks in pairs, because all are full; here there are none."""

    @abstractmethod
    def join(self, others: Sequence[Self]) -> None:
        """Append the measurements of other replicas or groups."""

    @abstractmethod
    def report(self, counts: Integers) -> Variables:
        """Return the variables measured.

        ``counts``: the snapshots in every block, shape (blocks of all replicas,), or in an ensemble
        at every time, shape (groups, times).
        """

    def coordinates(self) -> dict[str, Array]:
        """Return the coordinates that only these variables have, such as x or velocity."""
        return {}


class Averaged(Observer):
    """An observer that keeps ``sums``, shape (blocks, ...), and reports averages of them.

    :meth:`shape` says what a block has. An observer that keeps anything else extends
    :meth:`prepare` and, if that is large, :meth:`memory`. Joining puts the blocks of all replicas
    one after the other. In an ensemble a block is a time, the joined shape is (groups, times, ...),
    and averages are over groups.
    """

    run: Run
    sums: Array

    def shape(self, run: Run) -> tuple[int, ...]:
        """Return the shape of the sums of one block: one number a rod."""
        return (run.chain.size,)

    def memory(self, run: Run) -> float:
        return 8.0 * run.blocks * math.prod(self.shape(run))

    def prepare(self, run: Run, copies: int) -> None:
        self.run = run
        self.sums = np.zeros((run.blocks, *self.shape(run)))

    def merge(self) -> None:
        merge_pairs(self.sums)

    def join(self, others: Sequence[Self]) -> None:
        parts = [self.sums, *(other.sums for other in others)]
        self.sums = np.stack(parts) if self.run.ensemble else np.concatenate(parts)

    def averages(
        self, quantities: Mapping[str, Callable[[Array], Array]], counts: Integers, *dimensions: str
    ) -> Variables:
        """Return every quantity, which is a function of the averaged sums, and its error."""
        sums = self.sums
        if self.run.ensemble:
            # Times at the end that not every group reached are left out.
            dimensions, sums = ("time", *dimensions), sums[:, : counts.shape[1]]
        variables: Variables = {}
        for name, quantity in quantities.items():
            value, error = jackknife(quantity, sums, counts)
            variables[name] = (dimensions, value)
            variables[f"{name}_error"] = (dimensions, error)
        return variables
