"""Long runs neither drift nor grow.

Ten thousand million particle steps of an elastic chain without gap, whose energies are known
exactly: m v^2/T summed over L rods has the chi-squared distribution with L degrees of freedom, and
so has the sum of k d^2/T, as the rods' places are L independent Gaussian draws in order. The flight
is exact, so the step does not matter.
"""

import threading
from contextlib import contextmanager

import numpy as np
import psutil
from scipy import stats

from crazybilliards.model import Chain
from crazybilliards.particles import simulate

PARTICLE_STEPS = 1e10
REPLICAS = 2
MEGABYTE = 2**20
SIGNIFICANCE = 1e-6  # of a Gaussian, 5 standard errors


@contextmanager
def memory():
    """Look at this process's resident memory every tenth of a second."""
    seen, over = [], threading.Event()

    def look():
        while not over.wait(0.1):
            seen.append(psutil.Process().memory_info().rss)

    threading.Thread(target=look, daemon=True).start()
    yield seen
    over.set()


def test_ten_thousand_million_particle_steps():
    chain = Chain(size=100)
    time_step = 0.1
    duration = PARTICLE_STEPS / chain.size / REPLICAS * time_step
    how = {"duration": duration, "time_step": time_step, "every": duration / 5000}
    how |= {"observe": ("snapshots", "widths", "density"), "replicas": REPLICAS}
    with memory() as seen:
        run = simulate(chain, progress=False, **how)
    method = run.attrs["provenance"]
    print(method)
    # While the run went on: at the end the replicas' snapshots are joined, at first compiled code
    # is loaded.
    early, late = np.quantile(np.arange(len(seen)), [0.2, 0.9]).astype(int)
    growth = (seen[late] - seen[early]) / MEGABYTE
    print(f"memory grew by {growth:.2f} MiB over {late - early} looks")
    assert growth < 4  # one byte kept in every step would be 48

    y = run.position.values  # no gap: the rods' places are the points'
    assert (np.diff(y, axis=-1) >= 0).all()
    assert np.isfinite(run.velocity.values).all()
    kinetic = (chain.mass * run.velocity.values**2).sum(axis=-1) / chain.temperature
    displacement = y - chain.anchors
    potential = (chain.stiffness * displacement**2).sum(axis=-1) / chain.temperature
    for name, energy in {"kinetic": kinetic, "spring": potential}.items():
        halves = np.array_split(energy, 2, axis=1)
        for part, each in {"whole": energy, "first half": halves[0], "second": halves[1]}.items():
            test = stats.kstest(each.ravel(), stats.chi2(chain.size).cdf)
            print(f"{name}, {part}: D = {test.statistic:.4f}, p = {test.pvalue:.3f}")
            assert test.pvalue > SIGNIFICANCE
        assert stats.ks_2samp(*(half.ravel() for half in halves)).pvalue > SIGNIFICANCE
