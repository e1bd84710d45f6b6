"""Noisy rods on springs colliding in one dimension: simulation and gas-kinetic theory.

The names that most users need are taken from here, ``cb.simulate`` for example; observers from
``cb.observers``; fits and others from their rooms, ``cb.comparison.fit_arctanh``. Each name loads
its module when it is first used. Above the rooms ``model``, ``particles``, ``kinetic`` and
``comparison`` stand ``reproduction``, the paper's figures and claims, and ``apps``, the command
line and the page.

Examples
--------
>>> import crazybilliards as cb
>>> chain = cb.Chain(size=20, amplitude=10)
>>> run = cb.simulate(chain, duration=1000, progress=False)
>>> theory = cb.force_balance(chain)
>>> cb.deviation(cb.smooth(run), cb.smooth(theory)).rms < 0.02
True
"""

from typing import Any

import lazy_loader

_public_name, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

# Where the names are that version 0.5 had here, and what to use in the place of others.
_MOVED = {
    "observers": "Avalanches Collisions Covariances Density Energy Impacts Modes Raw "
    "TimeCorrelations TriggeredCollisions Velocities Walls Widths",
    "comparison": "Deviation Fit Player fit_arctanh fit_border_power_law",
    "kinetic": "UnmeasuredWarning",
    "particles": "ShortRunWarning",
}
_GONE = {
    "simulate_limit": "a second run, with half the time_step, shows the error of the step, which "
    "time_step_error of every run estimates",
    "theories": "cb.equilibrium is exact at restitution 1, cb.steady_state is for all others",
    "best_theory": "cb.equilibrium is exact at restitution 1, cb.steady_state is for all others",
    "phase_space": "cb.steady_state(chain, correlations=False) is the mean field",
    "correlated_phase_space": "cb.steady_state(chain) takes its place for every chain",
    "relax_phase_space": "cb.hydrodynamics(chain, start, duration, velocity_variance='evolving') "
    "takes every restitution",
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("crazybilliards")
    for place, names in _MOVED.items():
        if name in names.split():
            raise AttributeError(f"{name} is cb.{place}.{name}")
    if name in _GONE:
        raise AttributeError(f"{name} is gone: {_GONE[name]}")
    return _public_name(name)
