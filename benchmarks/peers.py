"""The same chain in other programs: what a step costs, and how far its result is off.

    python -m venv peers
    peers/bin/python -m pip install . pymunk==7.3.1 mujoco==4.0.0
    peers/bin/python benchmarks/peers.py [PYTHON_WITH_SICONOS]

The last argument is an interpreter that has Siconos, as Debian's own Python has after ``apt install
python3-siconos``. Each program gets rods as discs, spheres or coordinates on a line, and moves them
and solves their contacts. It has no noise, so that kicks by noise, and by springs and damping where
it has none, are added between its steps. Only its own step is timed. As in the paper the time step
is 1e-3 and e = 0. A plain event-driven program takes e = 1, because a thousand rods that touch
collide without end even at e = 0.95. The mean of v^2 over all rods and times is compared with
``simulate`` at the same step. Takes eight minutes.
"""

import heapq
import json
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path
from typing import Any

import mujoco
import numba
import numpy as np
import pymunk

from crazybilliards.model import Chain
from crazybilliards.particles import simulate

TIME_STEP, LONG, SHORT = 1e-3, 1000, 30
WARMUP, MEASURED, TIMED = 20_000, 800_000, 1000  # steps
BLOCKS = 16  # of the measured steps, whose scatter gives the error


class Pymunk:
    """Discs on a line."""

    name, restitution = "pymunk", 0.0

    def __init__(self, chain: Chain) -> None:
        self.chain, self.space = chain, pymunk.Space()
        self.space.collision_slop, self.space.collision_bias = 0.0, 0.0
        for anchor in chain.anchors:
            body = pymunk.Body(chain.mass, float("inf"))
            body.position = float(anchor), 0.0
            disc = pymunk.Circle(body, chain.radius)
            disc.elasticity = disc.friction = 0.0
            self.space.add(body, disc)
        self.bodies = self.space.bodies

    def velocities(self) -> np.ndarray:
        """Return the velocities of all rods."""
        return np.array([body.velocity.x for body in self.bodies])

    def kick(self, noise: np.ndarray) -> None:
        """Add a step's noise, a change of momentum, and the forces that the program lacks."""
        chain, v = self.chain, self.velocities()
        x = np.array([body.position.x for body in self.bodies])
        force = chain.stiffness * (x - chain.anchors) + chain.damping * v
        v += (noise - TIME_STEP * force) / chain.mass
        for body, velocity in zip(self.bodies, v, strict=True):
            body.velocity = velocity, 0.0

    def step(self) -> None:
        """Move the rods and solve their contacts."""
        self.space.step(TIME_STEP)


class Mujoco:
    """Spheres on slide joints, whose springs and dampers the program integrates itself."""

    name, restitution = "mujoco", 0.0

    def __init__(self, chain: Chain) -> None:
        rods = "".join(
            f'<body pos="{x} 0 0"><joint type="slide" axis="1 0 0" stiffness="{chain.stiffness}" '
            f'damping="{chain.damping}"/><geom type="sphere" size="{chain.radius}" '
            f'mass="{chain.mass}" friction="0 0 0" condim="1"/></body>'
            for x in chain.anchors
        )
        model = (
            f'<mujoco><option timestep="{TIME_STEP}" gravity="0 0 0" jacobian="sparse"/>'
            f'<size memory="1G"/><worldbody>{rods}</worldbody></mujoco>'
        )
        self.model = mujoco.MjModel.from_xml_string(model)
        self.chain, self.data = chain, mujoco.MjData(self.model)

    def velocities(self) -> np.ndarray:
        """Return the velocities of all rods."""
        return self.data.qvel

    def kick(self, noise: np.ndarray) -> None:
        """Add a step's noise, a change of momentum, and the forces that the program lacks."""
        self.data.qfrc_applied[:] = noise / TIME_STEP

    def step(self) -> None:
        """Move the rods and solve their contacts."""
        mujoco.mj_step(self.model, self.data)


@numba.njit
def fly(x: np.ndarray, v: np.ndarray, width: float, restitution: float, duration: float) -> None:
    """Let rods fly freely and collide in the order of a heap of all meetings of neighbours."""
    at, collided = np.zeros(x.size), np.zeros(x.size, np.int64)  # moved to this time, how often
    meetings = [(duration, -1, 0, 0)]
    i, j, now = 0, x.size - 1, 0.0
    while True:
        for k in range(max(i, 0), min(j, x.size - 1)):
            closing = v[k] - v[k + 1]
            if closing > 0.0:
                between = x[k + 1] + v[k + 1] * (now - at[k + 1]) - x[k] - v[k] * (now - at[k])
                meeting = now + max(between - width, 0.0) / closing
                if meeting < duration:
                    heapq.heappush(meetings, (meeting, k, collided[k], collided[k + 1]))
        now, k, left, right = heapq.heappop(meetings)
        if k < 0:
            break
        i, j = k, k  # nothing to look for, if one of the two has collided since
        if collided[k] == left and collided[k + 1] == right:
            for rod in (k, k + 1):
                x[rod] += v[rod] * (now - at[rod])
                at[rod] = now
                collided[rod] += 1
            mean, half = (v[k] + v[k + 1]) / 2, restitution * (v[k] - v[k + 1]) / 2
            v[k], v[k + 1] = mean - half, mean + half
            i, j = k - 1, k + 2
    x += v * (duration - at)


class Events:
    """A plain event-driven program, compiled."""

    name, restitution = "heap of events", 1.0

    def __init__(self, chain: Chain) -> None:
        self.chain, self.x, self.v = chain, chain.anchors.copy(), np.zeros(chain.size)

    def velocities(self) -> np.ndarray:
        """Return the velocities of all rods."""
        return self.v

    def kick(self, noise: np.ndarray) -> None:
        """Add a step's noise, a change of momentum, and the forces."""
        chain = self.chain
        force = chain.stiffness * (self.x - chain.anchors) + chain.damping * self.v
        self.v += (noise - TIME_STEP * force) / chain.mass

    def step(self) -> None:
        """Move the rods and let them collide."""
        fly(self.x, self.v, 2 * self.chain.radius, self.restitution, TIME_STEP)


Program = Pymunk | Mujoco | Events


def run(program: Program, noise: np.random.Generator, steps: int) -> tuple[float, float]:
    """Return the seconds of a step without the kicks, and the mean of v^2."""
    strength = program.chain.amplitude * np.sqrt(TIME_STEP)
    seconds, squares = 0.0, 0.0
    for _ in range(steps):
        program.kick(strength * noise.standard_normal(program.chain.size))
        started = time.process_time()
        program.step()
        seconds += time.process_time() - started
        squares += np.mean(program.velocities() ** 2)
    return seconds / steps, squares / steps


def cost_of_simulate(chain: Chain) -> float:
    """Return the seconds of a step of ``simulate``, noise included."""
    options: dict[str, Any] = {"time_step": TIME_STEP, "seed": 1, "observe": "snapshots"}
    options |= {"every": 1, "warmup": 0, "progress": False}
    simulate(chain, duration=WARMUP * TIME_STEP, **options)  # compiles
    started = time.process_time()
    simulate(chain, duration=WARMUP * TIME_STEP, **options)
    return (time.process_time() - started) / WARMUP


def measure(kind: type[Program]) -> tuple[float, list[float]]:
    """Return the seconds of a step of many rods, and blocks of the mean of v^2 of few rods."""
    noise = np.random.default_rng(1)
    program = kind(Chain(size=LONG, restitution=kind.restitution))
    run(program, noise, TIMED)
    cost, _ = run(program, noise, TIMED)
    program = kind(Chain(size=SHORT, restitution=kind.restitution))
    run(program, noise, WARMUP)
    return cost, [run(program, noise, MEASURED // BLOCKS)[1] for _ in range(BLOCKS)]


def measure_siconos(python: str) -> tuple[float, list[float]]:
    """Return the same for Siconos, which needs another version of numpy than this package."""
    chain = Chain(size=LONG)
    same = {name: getattr(chain, name) for name in ("mass", "damping", "stiffness")}
    asked: dict[str, Any] = {"sizes": [LONG, SHORT], "chain": same | {"time_step": TIME_STEP}}
    asked |= {"warmup": WARMUP, "measured": MEASURED, "blocks": BLOCKS}
    script = Path(__file__).with_name("siconos_steps.py")
    answer = subprocess.check_output([python, script, json.dumps(asked)], text=True)
    return json.loads(answer.splitlines()[-1])


def main() -> None:
    expected = {}
    print("program,e,ns per rod and step (L = 1000),mean of v^2 over that of simulate (L = 30)")
    for restitution in (0.0, 1.0):
        short, long = (Chain(size=size, restitution=restitution) for size in (SHORT, LONG))
        ours = simulate(short, duration=20_000, time_step=TIME_STEP, seed=1, progress=False)
        expected[restitution] = float((ours.velocity_width**2).mean())
        cost = 1e9 * cost_of_simulate(long) / LONG
        print(
            f"crazybilliards {version('crazybilliards')},{restitution:g},{cost:.0f},1", flush=True
        )
    for kind in (Pymunk, Mujoco, Events):
        show(kind.name, kind.restitution, *measure(kind), expected)
    for python in sys.argv[1:]:
        show("siconos", 0.0, *measure_siconos(python), expected)


def show(
    name: str, restitution: float, cost: float, squares: list[float], expected: dict[float, float]
) -> None:
    """Print a row of the table."""
    found = np.array(squares) / expected[restitution]
    error = found.std(ddof=1) / np.sqrt(BLOCKS)
    print(
        f"{name},{restitution:g},{1e9 * cost / LONG:.0f},{found.mean():.3f} ± {error:.3f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
