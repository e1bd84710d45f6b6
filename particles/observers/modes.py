"""Mean squares of the velocities of waves along the chain."""

import numpy as np

from crazybilliards.model import WALLS_AND_MASSES, Chain
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.run import Run


def momentum_weights(chain: Chain) -> Array:
    """Return the mass of every rod over the mean mass; exactly 1 if all are equal."""
    masses = chain.rod_masses / chain.mass
    return np.asarray(masses / masses.mean())


class Modes(Averaged):
    """mode_velocity_variance: <|v_q|^2> of the waves cos(pi q (i - 1/2)/L), q = 0 to L - 1.

    v_q = sum_i sqrt((2 or, for q = 0, 1)/L) cos(pi q (i - 1/2)/L) v_i is an orthogonal transform,
    the discrete cosine transform of type II, so the sum over the modes is that of <v_i^2> over the
    rods. If velocities are independent and equal, all modes have W_v^2. Rods that move together
    have more in the long waves. On linear springs v_0, that of the centre of mass, has the variance
    W^2 of a free rod at any restitution.

    Of two masses the modes are those of the momentum: v_i is multiplied by m_i over the mean mass
    <m>. At e = 1 all have T/<m>. The sums take 8 L bytes per block.
    """

    name = "modes"
    gives = ("mode_velocity_variance",)
    along = ("mode",)
    knows = WALLS_AND_MASSES

    def prepare(self, run: Run, copies: int) -> None:
        super().prepare(run, copies)
        self.weights = momentum_weights(run.chain)

    def observe(self, snapshots: Snapshots) -> None:
        from scipy.fft import dct  # takes half a second, and few runs observe modes

        waves = dct(self.weights * snapshots.v, axis=1, norm="ortho")
        self.sums[snapshots.block] += np.einsum("sq,sq->q", waves, waves)

    def report(self, counts: Integers) -> Variables:
        return self.averages({"mode_velocity_variance": lambda average: average}, counts, "mode")

    def coordinates(self) -> dict[str, Array]:
        return {"mode": np.arange(self.sums.shape[-1], dtype=np.float64)}
