"""The page of ``crazybilliards explore``.

``session``, ``sums`` and ``presets`` need only this package. The other modules may need Panel, the
extra ``explore``, so this file imports nothing.
"""
