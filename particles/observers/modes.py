"""Mean squares of the velocities of waves along the chain."""

import numpy as np

from crazybilliards.model import WALLS_AND_MASSES, Chain
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables


def waves_of(chain: Chain, values: Array) -> Array:
    """Return the waves of the values times the masses of the rods over the mean mass."""
    from scipy.fft import dct  # takes half a second, and few runs observe waves

    masses = chain.rod_masses / chain.mass  # exactly 1 if all are equal
    return np.asarray(dct(masses / masses.mean() * values, axis=-1, norm="ortho"))


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

    def observe(self, snapshots: Snapshots) -> None:
        waves = waves_of(self.run.chain, snapshots.v)
        self.sums[snapshots.block] += np.einsum("sq,sq->q", waves, waves)

    def report(self, counts: Integers) -> Variables:
        return self.averages({"mode_velocity_variance": lambda average: average}, counts, "mode")

    def coordinates(self) -> dict[str, Array]:
        return {"mode": np.arange(self.sums.shape[-1], dtype=np.float64)}
