"""Shared by the tests of the theories."""

from functools import cache

import pytest

from crazybilliards.kinetic import phase_space


@pytest.fixture(scope="session")
def solved():
    """``phase_space(chain, **settings)``, solved once: do not change it."""
    return cache(phase_space)
