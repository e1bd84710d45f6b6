"""Sweeps over many chains: a grid of parameters, one file per case, computed only once."""

from crazybilliards.comparison.sweeps.case import Case, OutdatedError
from crazybilliards.comparison.sweeps.engines import dask_cluster, process_pool
from crazybilliards.comparison.sweeps.grid import Sweep, load_sweep, read_sweep
from crazybilliards.comparison.sweeps.running import run_cases

__all__ = [
    "Case",
    "OutdatedError",
    "Sweep",
    "dask_cluster",
    "load_sweep",
    "process_pool",
    "read_sweep",
    "run_cases",
]
