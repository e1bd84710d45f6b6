"""The same chain in programs for any geometry: what a step costs, and how far its result is off.

    python -m venv peers
    peers/bin/python -m pip install . pymunk==7.3.1 mujoco==4.0.0
    peers/bin/python benchmarks/peers.py

Each program gets rods as discs or spheres on a line, and moves them and solves their contacts. It
has no noise, so that kicks by noise and damping, and springs where it has none, are added by numpy
between its steps. Only its own step is timed. The time step is 1e-3 and e = 0, as in the
paper. The mean of v^2 over all rods and times is compared with ``simulate`` at the same step. Takes
five minutes.
"""

import time
from importlib.metadata import version

import mujoco
import numpy as np
import pymunk

from crazybilliards.model import Chain
from crazybilliards.particles import simulate

TIME_STEP, LONG, SHORT = 1e-3, 1000, 30
WARMUP, MEASURED, TIMED = 20_000, 800_000, 1000  # steps
BLOCKS = 16  # of the measured steps, whose scatter gives the error


class Pymunk:
    """Discs on a line."""

    name = "pymunk"

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

    name = "mujoco"

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
        self.chain, self.model = chain, mujoco.MjModel.from_xml_string(model)
        self.data = mujoco.MjData(self.model)

    def velocities(self) -> np.ndarray:
        """Return the velocities of all rods."""
        return self.data.qvel

    def kick(self, noise: np.ndarray) -> None:
        """Add a step's noise, a change of momentum, and the forces that the program lacks."""
        self.data.qfrc_applied[:] = noise / TIME_STEP

    def step(self) -> None:
        """Move the rods and solve their contacts."""
        mujoco.mj_step(self.model, self.data)


def run(program: Pymunk | Mujoco, noise: np.random.Generator, steps: int) -> tuple[float, float]:
    """Return the seconds of a step without the kicks, and the mean of v^2."""
    strength = program.chain.amplitude * np.sqrt(TIME_STEP)
    seconds, squares = 0.0, 0.0
    for _ in range(steps):
        program.kick(strength * noise.standard_normal(program.chain.size))
        started = time.perf_counter()
        program.step()
        seconds += time.perf_counter() - started
        squares += np.mean(program.velocities() ** 2)
    return seconds / steps, squares / steps


def cost_of_simulate(chain: Chain) -> float:
    """Return the seconds of a step of ``simulate``, noise and measurement included."""
    options = {"time_step": TIME_STEP, "seed": 1, "progress": False}
    simulate(chain, duration=1, warmup=0, **options)  # compiles
    started = time.perf_counter()
    simulate(chain, duration=WARMUP * TIME_STEP, warmup=0, **options)
    return (time.perf_counter() - started) / WARMUP


def main() -> None:
    noise = np.random.default_rng(1)
    short, long = (Chain(size=size, restitution=0) for size in (SHORT, LONG))
    ours = simulate(short, duration=20_000, time_step=TIME_STEP, seed=1, progress=False)
    expected = float((ours.velocity_width**2).mean())
    print("program,ns per rod and step,mean of v^2 over that of simulate")
    print(f"crazybilliards {version('crazybilliards')},{1e9 * cost_of_simulate(long) / LONG:.0f},1")
    for kind in (Pymunk, Mujoco):
        program = kind(long)
        run(program, noise, TIMED)
        cost, _ = run(program, noise, TIMED)
        program = kind(short)
        run(program, noise, WARMUP)
        found = [run(program, noise, MEASURED // BLOCKS)[1] / expected for _ in range(BLOCKS)]
        error = np.std(found, ddof=1) / np.sqrt(BLOCKS)
        print(
            f"{kind.name} {version(kind.name)},{1e9 * cost / LONG:.0f},"
            f"{np.mean(found):.3f} ± {error:.3f}"
        )


if __name__ == "__main__":
    main()
