"""What walls and a second mass cost: steps of a chain with them and of one without, in turns.

    python benchmarks/walls_and_masses.py [--rounds 300]

Both chains of a row take steps of the same length, from near their steady states. Walls stand
where they are met but leave the density of rods about as it is. Printed are nanoseconds a rod and
step (the minimum of the rounds), collisions a rod and step, the ratio of the minima, and the median
of the rounds' ratios.
"""

import argparse
import time
from collections.abc import Iterator
from statistics import median

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.particles import stepping
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.scales import centre_width, default_time_step

SIZES = (10, 100, 1000)
RODS_AND_STEPS = 50_000  # of a round
UNSEEN = make_tally(2, contacts=False)


def pairs(size: int) -> Iterator[tuple[str, Chain, Chain, float]]:
    """Return chains with walls or masses, each after the plain one, and the step of both."""
    elastic, lossy = Chain(size=size), Chain(size=size, restitution=0.9)
    step = default_time_step(lossy)
    rods, length = 2 * size * elastic.radius, 6 * elastic.thermal_length
    walls, near = {"box": rods + length}, {"box": rods + length * centre_width(lossy)}
    yield "fold, e = 1", elastic, elastic.replace(stiffness=0, **walls), default_time_step(elastic)
    yield "walls, e = 0.9", lossy, lossy.replace(wall_restitution=0.9, **near), step
    yield "two masses, e = 0.9", lossy, lossy.replace(mass_ratio=2), step


class Steps:
    """A chain that takes steps of one length, and how long each round of them took."""

    def __init__(self, chain: Chain, time_step: float) -> None:
        generator = np.random.default_rng(0)
        width = centre_width(chain)
        y = np.sort(generator.normal(scale=width * Chain().thermal_length, size=chain.size))
        v = generator.normal(scale=width * chain.free_velocity_width, size=chain.size)
        dynamics = make_dynamics(chain, time_step, speed=1.0)
        noise = make_noise(np.random.SeedSequence(0))
        scratch = make_scratch(chain.size, dynamics.inverse)
        self.state = np.clip(y, *chain.walls), v, noise, dynamics, scratch, UNSEEN
        self.size, self.steps = chain.size, RODS_AND_STEPS // chain.size
        for _ in range(30):
            stepping.advance(*self.state, self.steps)
        self.times: list[float] = []
        self.collisions = 0

    def go(self) -> None:
        """Take the steps of a round."""
        begin = time.perf_counter()
        self.collisions += stepping.advance(*self.state, self.steps)
        self.times.append(1e9 * (time.perf_counter() - begin) / (self.size * self.steps))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=300)
    rounds = parser.parse_args().rounds
    print("chain,L,plain: ns,collisions,with: ns,collisions,ratio of the minima,median ratio")
    for size in SIZES:
        for name, plain, other, step in pairs(size):
            both = [Steps(chain, step) for chain in (plain, other)]
            for _ in range(rounds):
                for each in both:
                    each.go()
            columns = [
                f"{min(each.times):.1f},{each.collisions / (rounds * RODS_AND_STEPS):.2f}"
                for each in both
            ]
            least = min(both[1].times) / min(both[0].times)
            ratio = median(b / a for a, b in zip(*(each.times for each in both), strict=True))
            print(name, size, *columns, f"{least:.2f},{ratio:.2f}", sep=",", flush=True)


if __name__ == "__main__":
    main()
