"""The page of ``crazybilliards explore``: a chain that moves in the browser, beside its theory.

The simulation and the presets need nothing but this package; ``drawing``, ``page`` and ``server``
need Panel, the extra ``explore``. Hence nothing is imported here.
"""
