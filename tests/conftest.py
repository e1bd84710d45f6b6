"""Shared by all tests."""

import matplotlib as mpl
from hypothesis import settings

mpl.use("Agg")

# The first example of a kernel compiles it, which is no sign of a slow test.
settings.register_profile("crazybilliards", deadline=None, derandomize=True)
settings.load_profile("crazybilliards")
