"""Answers to the tasks of lesson 5, From the kinetic equation to the force balance."""

from scipy.stats import beta


def shorter_by(chain, radius):
    """Return by how much an elastic chain without gap becomes shorter if its radius changes."""
    return (chain.size - 1) * 2 * (chain.radius - radius)


def pressure(density):
    """Return the pressure over m W^2 of rods of the radius 1."""
    return density / (1 - 2 * density)


def momentum_handed_over(v, w, e):
    """Return the momentum over m that a rod of velocity v hands to one of velocity w < v."""
    return (1 + e) / 2 * (v - w)


def contact_factor(packing):
    """Return chi, by which contacts are more frequent than among points, at the packing 2R rho."""
    return 1 / (1 - packing)


def slope(density, displacement, chain):
    """Return d rho/dx of the force balance, equation (19) of the paper."""
    pull = displacement / chain.thermal_length**2  # k/(m W^2) times the displacement
    return -pull * density * (1 - 2 * chain.radius * density) ** 2


def rod(i, density, share, size):
    """Return the probability density of the i-th of independent points, of the given density.

    ``density`` is that of all points, and ``share`` the part of them that lies below the place.
    """
    return density / size * beta(i, size + 1 - i).pdf(share)
