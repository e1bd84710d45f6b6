"""Steps of the chain in Siconos, measured for ``peers.py``, which calls this script.

It runs in an interpreter that has Siconos and numpy, without this package, and prints the seconds
of a step of the long chain, and blocks of the mean of v^2 of the short one, as JSON. The contacts
of a step are a linear complementarity problem with a full matrix, which Lemke's method solves, the
default of Siconos. The mass, the springs and the damping are 1, and e = 0.
"""

import itertools
import json
import sys
import time

import numpy as np
import siconos.kernel as kernel

TIMED = 20  # steps of the long chain, of which one takes a second


class Rods:
    """Coordinates on a line, whose neighbours cannot pass each other."""

    def __init__(
        self, size: int, time_step: float, mass: float, damping: float, stiffness: float
    ) -> None:
        model = kernel.NonSmoothDynamicalSystem(0, 1e6)
        matrices = [np.eye(1) * each for each in (mass, stiffness, damping)]
        self.rods = [kernel.LagrangianLinearTIDS([0.0], [0.0], *matrices) for _ in range(size)]
        for rod in self.rods:
            model.insertDynamicalSystem(rod)
        impact = kernel.NewtonImpactNSL(0.0)
        for left, right in itertools.pairwise(self.rods):
            distance = kernel.LagrangianLinearTIR(np.array([[-1.0, 1.0]]), np.zeros(1))
            model.link(kernel.Interaction(impact, distance), left, right)
        self.simulation = kernel.TimeStepping(
            model, kernel.TimeDiscretisation(0, time_step), kernel.MoreauJeanOSI(0.5), kernel.LCP()
        )
        self.time_step = time_step

    def run(self, noise: np.random.Generator, steps: int) -> tuple[float, float]:
        """Return the seconds of a step, and the mean of v^2."""
        seconds = squares = 0.0
        for _ in range(steps):
            forces = noise.standard_normal(len(self.rods)) / np.sqrt(self.time_step)
            for rod, force in zip(self.rods, forces, strict=True):
                rod.setFExtPtr(np.array([force]))
            started = time.process_time()
            self.simulation.computeOneStep()
            self.simulation.nextStep()
            seconds += time.process_time() - started
            squares += np.mean([rod.velocity()[0] ** 2 for rod in self.rods])
        return seconds / steps, squares / steps


asked = json.loads(sys.argv[1])
random = np.random.default_rng(1)
long, short = (Rods(size, **asked["chain"]) for size in asked["sizes"])
long.run(random, TIMED)
cost, _ = long.run(random, TIMED)
short.run(random, asked["warmup"])
each = asked["measured"] // asked["blocks"]
print(json.dumps([cost, [short.run(random, each)[1] for _ in range(asked["blocks"])]]))
