"""The steppers: exact covariances of one rod, orders of convergence in dt, stated errors."""

import math

import numpy as np
import pytest
from drifts import moved
from scipy.linalg import solve_discrete_lyapunov

from crazybilliards.model import Chain
from crazybilliards.particles.dynamics import make_step
from crazybilliards.particles.timing import time_step_error


def stationary_widths(stepper, time_step, **parameters):
    """W_x, W_v of one rod: the linear map read off the kernel, its Lyapunov equation solved."""
    chain = Chain(size=1, **parameters)
    step = make_step(chain, time_step, stepper)
    quiet = step._replace(noise=0.0, outer_noise=0.0)
    # By kicks and drifts also where the rod can be flown exactly.
    columns = [moved(chain, ([y], [1 - y]), time_step, 1, step=quiet, counted=True) for y in (1, 0)]
    propagator = np.concatenate(columns, axis=1)
    # The noise enters where the decayed velocity does, and once more at the end if symmetric.
    first = propagator[:, 1] * step.outer_noise / step.outer_decay
    last = np.array([0.0, step.outer_noise if step.symmetric else 0.0])
    noise = np.outer(first, first) + np.outer(last, last)
    covariance = solve_discrete_lyapunov(propagator, noise)
    return np.sqrt(np.diag(covariance))


def test_splitting_has_the_exact_velocity_width_at_any_step_and_order_two_in_displacement():
    chain = Chain(size=1)
    for time_step in (0.1, 0.2, 0.4, 1.5):
        displacement, velocity = stationary_widths("splitting", time_step)
        assert velocity == pytest.approx(chain.free_velocity_width, rel=1e-12)
        rate = np.sqrt(chain.stiffness / chain.mass)
        shadow = chain.thermal_length / np.sqrt(1 - (rate * time_step / 2) ** 2)
        assert displacement == pytest.approx(shadow, rel=1e-12)


def test_the_velocity_width_of_euler_is_off_by_the_stated_error():
    for damping, time_step in ((1.0, 0.05), (1.0, 0.2), (4.0, 0.2)):
        chain = Chain(size=1, damping=damping)
        ratio = (
            stationary_widths("euler", time_step, damping=damping)[1] / chain.free_velocity_width
        )
        assert time_step_error(chain, time_step, 1.0, stepper="euler") == pytest.approx(ratio - 1)


def test_without_spring_or_damping_the_noise_is_exact_or_as_stated():
    chain = Chain(stiffness=0, damping=2, amplitude=3)
    for stepper, factor in (("splitting", 1.0), ("euler", 1 / (1 - 2 * 0.3 / (2 * chain.mass)))):
        step = make_step(chain, 0.3, stepper)
        variance = step.noise**2 / (1 - step.decay**2)
        assert variance == pytest.approx(factor * chain.free_velocity_width**2, rel=1e-12)
    weak, none = (make_step(Chain(damping=damping), 0.1, "splitting") for damping in (1e-9, 0))
    assert none.noise == pytest.approx(weak.noise)
    assert none.decay == 1


# -- the stated error covers what was measured, and is not absurdly larger --------------------

# By how many % W_v of 100 rods changes from kicks of r_0 to r, in units of W_v, and the standard
# error (studies/time_step_law.py).
MEASURED = [  # restitution, r, r_0, change, error
    (0.2, 0.167, 0.056, -0.40, 0.03),
    (0.5, 0.176, 0.059, -0.13, 0.03),
    (0.5, 0.307, 0.178, -0.29, 0.03),
    (0.9, 0.308, 0.178, +0.07, 0.06),
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


def test_the_stated_error_covers_the_measured_change():
    for e, r, shorter, change, error in MEASURED:
        assert abs(change) - 3 * error < stated(e, r)
        if r < SHORT:
            assert stated(e, r) - stated(e, shorter) < 2 * abs(change) + 3 * error


@pytest.mark.parametrize(("r", "error"), [(1.038, 7.3), (1.162, 13.7)])
def test_the_stated_error_of_a_long_step_is_that_of_the_true_width(r, error):
    """20 rods at 10 and 14 default steps, against another program at a tenth of a step (+- 0.2)."""
    assert error < stated(0.5, r) < 1.3 * error


@pytest.mark.parametrize("method", ["event-driven", "contact-dynamics"])
def test_a_single_rod_has_no_error_of_collisions(method):
    chains = [Chain(size=1, restitution=e, gap=gap) for e, gap in ((0, 0), (0.5, 2), (1.2, 0))]
    for stepper in ("splitting", "euler"):
        how = {"stepper": stepper, "method": method}
        errors = {time_step_error(chain, 0.1, 0.3, **how) for chain in chains}
        assert len(errors) == 1
        assert (errors == {0.0}) == (stepper == "splitting")


def test_where_no_error_is_stated():
    """At restitution one there is none, and of other methods nobody measured it."""
    assert stated(1.0, 5.0) == 0
    assert stated(1 - 1e-9, 0.3) < 0.05
    assert stated(0.5, 1.3) == math.inf  # no true width belongs to this one
    assert math.isnan(time_step_error(Chain(size=30, restitution=0.8), 0.1, 0.3, method="my own"))
