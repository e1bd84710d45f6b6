"""Sweeps over many chains: a grid of parameters, one file per case, computed only once."""

from crazybilliards.comparison.sweeps.case import Case
from crazybilliards.comparison.sweeps.grid import Sweep, load_sweep, read_sweep
from crazybilliards.comparison.sweeps.running import process_pool, run_cases

__all__ = ["Case", "Sweep", "load_sweep", "process_pool", "read_sweep", "run_cases"]
