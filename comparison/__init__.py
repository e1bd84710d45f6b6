"""Simulation and theory side by side: binned densities, fits, deviations, overlays, commands.

The public names are listed in ``__init__.pyi``. Each loads its module when it is first used.
"""

from crazybilliards.model.public_names import hand_out

__getattr__, __dir__, __all__ = hand_out(__name__)
