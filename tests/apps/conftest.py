"""The page of ``crazybilliards explore`` and a browser, for the tests that look at it."""

import os

import pytest
from browser import CHROMIUM, DRIVER, chromium, served


@pytest.fixture(scope="package")
def address():
    if os.name == "nt":
        pytest.skip("sends a POSIX signal")
    with served() as address:
        yield address


@pytest.fixture(scope="package")
def browser():
    if not (CHROMIUM.exists() and DRIVER.exists()):
        pytest.skip(f"needs {CHROMIUM} and {DRIVER}: apt-get install chromium chromium-driver")
    with chromium() as driver:
        yield driver
