"""Answers to the tasks of The appendix of the paper, equation by equation."""

INTEGRAL_OVER_ALL_PAIRS = 0  # rods that move apart would hand over the opposite
ROD_OF_THE_DERIVATIVES = "w"  # eq16 moves the rod at r + 2R


def integral_of_15(rho, W):
    """Return the integral over v of the Gaussian of (15), as it is printed."""
    return W * rho
