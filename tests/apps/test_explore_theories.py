"""The theories that the page computes beside the moving chain."""

import multiprocessing
from threading import Lock

from crazybilliards.apps.explore.theories import Solver, kinetic_density
from crazybilliards.model import Chain


def test_a_process_that_cannot_start_is_an_outcome_and_blocks_no_other_page(monkeypatch):
    def refuse(process):
        raise OSError("no more processes")

    turn = Lock()
    solver = Solver(kinetic_density, turn)
    monkeypatch.setattr(multiprocessing.get_context("spawn").Process, "start", refuse)
    solver.ask(Chain(size=5, restitution=0.9))
    outcome = solver.poll()
    assert isinstance(outcome, OSError)
    assert solver.chain is None
    assert solver.poll() is None
    solver.cancel()
    assert turn.acquire(blocking=False)


def test_a_solver_waits_for_its_turn():
    turn = Lock()
    turn.acquire()
    solver = Solver(kinetic_density, turn)
    solver.ask(Chain(size=5, restitution=0.9))
    assert solver.poll() is None
    assert solver.seconds == 0
    solver.cancel()
    assert not turn.acquire(blocking=False)
