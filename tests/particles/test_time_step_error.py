"""The stated error of a time step covers what was measured, and is not absurdly larger."""

import math

import pytest

from crazybilliards.model import Chain
from crazybilliards.particles.scales import time_step_error

# By how many % W_v of 100 rods changes from kicks of r_0 to r, in units of W_v, and the standard
# error (studies/time_step_law.py).
MEASURED = [  # restitution, r, r_0, change, error
    (0.2, 0.167, 0.056, -0.40, 0.03),
    (0.2, 0.292, 0.169, -0.53, 0.02),
    (0.2, 0.507, 0.169, -0.44, 0.02),
    (0.5, 0.176, 0.059, -0.13, 0.03),
    (0.5, 0.307, 0.178, -0.29, 0.03),
    (0.5, 0.533, 0.178, -0.23, 0.02),
    (0.9, 0.308, 0.178, +0.07, 0.06),
    (0.9, 0.533, 0.178, +0.33, 0.07),
    (0.9, 0.738, 0.246, +1.18, 0.06),
    (0.9, 1.278, 0.246, +9.56, 0.07),
    (0.97, 0.664, 0.221, +0.65, 0.05),
    (0.97, 1.150, 0.221, +5.46, 0.05),
]
SHORT = 0.35  # longer steps have two errors, which nearly cancel where they have the same size


def stated(restitution, r):
    """Return the error in % for kicks of r, in units of W_v."""
    chain = Chain(restitution=restitution)
    return 100 * time_step_error(chain, (r * chain.mass / chain.amplitude) ** 2, 1.0)


@pytest.mark.parametrize(("e", "r", "shorter", "change", "error"), MEASURED)
def test_the_stated_error_covers_the_measured_change(e, r, shorter, change, error):
    assert abs(change) - 3 * error < stated(e, r)
    if r < SHORT:
        assert stated(e, r) - stated(e, shorter) < 2 * abs(change) + 3 * error


@pytest.mark.parametrize("stepper", ["splitting", "euler"])
@pytest.mark.parametrize("method", ["event-driven", "contact-dynamics"])
def test_a_single_rod_has_no_error_of_collisions(stepper, method):
    errors = {
        time_step_error(
            Chain(size=1, restitution=e, gap=gap), 0.1, 0.3, stepper=stepper, method=method
        )
        for e in (0.0, 0.5, 1.0, 1.2)
        for gap in (0.0, 2.0)
    }
    assert len(errors) == 1
    assert (errors == {0.0}) == (stepper == "splitting")


def test_at_restitution_one_there_is_no_error_of_the_noise():
    assert stated(1.0, 5.0) == 0
    assert stated(1 - 1e-9, 0.3) < 0.05


def test_a_method_that_nobody_measured_has_no_stated_error():
    assert math.isnan(time_step_error(Chain(size=30, restitution=0.8), 0.1, 0.3, method="my own"))
