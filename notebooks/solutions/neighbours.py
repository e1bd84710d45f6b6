"""Answers to the tasks of Neighbours remember."""

SUM_OVER_ALL_RODS = 1  # of the covariances, in units of W^2: collisions keep the total momentum


def change_of_product(v, u, e):
    """Return by how much the product of the velocities of two rods changes in a collision."""
    return (1 - e**2) / 4 * (v - u) ** 2


def speed_squared(theta):
    """Return the mean of w^2 over collisions, if v - u is Gaussian of the variance 2 theta."""
    return 4 * theta
