r"""Two chains under the same noise; the step of one is a multiple of the step of the other.

Between two snapshots a chain is kicked by the noise of these durations (``stepping.py``): half a
step, whole steps, half a step. For a ratio of three, in units of the finer step,

    finer    | 1/2 |  1  |  1  |  1  |  1  |  1  | 1/2 |
    coarser  |    3/2    |        3        |    3/2    |        two coarser steps

each coarser kick covers exactly the time of some finer ones. This holds for every odd ratio. With
an even ratio the end of a coarser kick would fall inside a finer one. After kicks of the durations
t_j, damping and noise alone have added to a velocity

    eta = sum_j exp(-(gamma/m) sum_(k > j) t_k) sigma(t_j) xi_j,

sigma(t)^2 = (T/m)(1 - exp(-2 gamma t/m)). Its variance is sigma(sum_j t_j)^2, that of one kick of
the whole duration. eta is the kick of the coarser chain, so both chains have exactly the same
noise. The eta/sigma of successive kicks are independent normal numbers, because no xi is in two of
them. The coarser chain therefore has the law of a chain at its own step. The finer chain even has
the bits of a single chain. The noise of closed contacts is made stronger in each chain where its
own contacts are closed (``laws/closed_contacts.py``).
"""

from __future__ import annotations

from crazybilliards.model.kernels import copy, kernel
from crazybilliards.particles.laws.closed_contacts import find_clusters
from crazybilliards.particles.stepping import FIRST, LAST, WHOLE, bounded, draw_kicks, take_step


@kernel
def advance_pair(  # type: ignore[no-untyped-def]
    y, v, noise, dynamics, ratio, scratch, tally, steps
):
    """Take ``steps`` coarser steps of ``ratio`` finer ones each; return -1 if a chain diverged.

    ``y`` and ``v`` have the shape (2, L), with the finer chain first. ``dynamics`` and ``scratch``
    are pairs in the same order. The other arguments are those of ``stepping.advance``.
    """
    if steps == 0:
        return 0
    finer, coarser = dynamics
    if finer.step.closed != 1.0:
        find_clusters(y[0], scratch[0].clusters)
        find_clusters(y[1], scratch[1].clusters)
    size = y.shape[1]
    kicks, together = scratch[0].kicks, scratch[1].kicks[:size]
    for i in range(size):
        together[i] = 0.0
    row, rows = 0, 0
    last, middle = ratio * steps, ratio // 2
    for taken in range(last + 1):
        if row == rows:
            row, rows = 0, draw_kicks(noise, kicks, size, last + 1 - taken)
        xi = kicks[row * size : (row + 1) * size]
        row += 1
        part = FIRST if taken == 0 else LAST if taken == last else WHOLE
        decay = finer.step.decay if part == WHOLE else finer.step.outer_decay
        sigma = finer.step.noise if part == WHOLE else finer.step.outer_noise
        for i in range(xi.size):
            together[i] = decay * together[i] + sigma * xi[i]
        met = take_step(y[0], v[0], xi, part, finer, scratch[0], tally)
        if met < 0:
            return -1
        tally.collisions[0] += met
        if taken % ratio != middle and part != LAST:
            continue
        if taken == middle:
            part = FIRST
        sigma = coarser.step.noise if part == WHOLE else coarser.step.outer_noise
        for i in range(size):
            together[i] /= sigma
        met = take_step(y[1], v[1], together, part, coarser, scratch[1], tally)
        if met < 0:
            return -1
        tally.collisions[1] += met
        for i in range(size):
            together[i] = 0.0
    return 0


@kernel
def record_pair(  # type: ignore[no-untyped-def]
    y, v, noise, dynamics, ratio, scratch, tally, stride, snapshots, y_buffer, v_buffer
):
    """Write the states after every ``stride`` coarser steps into the buffers, (2, rows, L).

    Return the number of valid snapshots, as ``stepping.record`` does.
    """
    for snapshot in range(snapshots):
        met = advance_pair(y, v, noise, dynamics, ratio, scratch, tally, stride)
        for chain in range(2):
            if met < 0 or not bounded(y[chain], v[chain], dynamics[chain].fastest):
                return snapshot
            copy(y[chain], y_buffer[chain, snapshot])
            copy(v[chain], v_buffer[chain, snapshot])
    return snapshots
