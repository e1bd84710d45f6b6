"""The minmod limiter, whose slopes make no new extrema."""

from crazybilliards.model.kernels import kernel


@kernel
def minmod(a, b):  # type: ignore[no-untyped-def]
    """Return the smaller of two slopes of equal sign, 0 if their signs differ."""
    if a * b <= 0:
        return 0.0
    return a if abs(a) < abs(b) else b
