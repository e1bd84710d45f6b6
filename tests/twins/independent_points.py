r"""The mean field of the gas as a simulation of particles: independent points.

Many points move in the well of a spring with damping and noise. In the time dt each meets another
point of its cell of y, chosen at random, with the probability L f(y) |v - u| dt, f being the share
of the points per length. Then its own velocity becomes

    v* = v - lambda (v - u),      lambda = (1 - e)/2,

and that of the other stays (K. Nanbu, J. Phys. Soc. Jpn. 49, 2042, 1980). A point meets L - 1
others, and its motion about their common centre of mass has the share 1 - 1/L of the noise. L
others and the whole noise are the same. Nothing is known here of labels, moments or closures.
Groups of L points, drawn at random and in order, are the rods. In the units of the free rod.
"""

import numpy as np

STEP, CELL = 0.01, 0.05


def rods_of_independent_points(size, restitution, damping, number, duration, warmup, seed):
    """Return mean place and velocity variance of rods, and its standard error; shape (3, size)."""
    rng = np.random.default_rng(seed)
    number -= number % size
    y, v = rng.normal(size=(2, number))
    kept, samples = np.exp(-damping * STEP / 2), []
    noise, every = np.sqrt(1 - kept**2), round(1 / damping / STEP)
    for step in range(1, round((warmup + duration) / STEP) + 1):
        y += STEP / 2 * v
        v -= STEP / 2 * y
        v = kept * v + noise * rng.normal(size=number)
        v = _collided(y, v, size, restitution, rng)
        v = kept * v + noise * rng.normal(size=number)
        v -= STEP / 2 * y
        y += STEP / 2 * v
        if step * STEP > warmup and step % every == 0:
            samples.append(_of_rods(y, v, size, rng))
    places, squares = np.swapaxes(samples, 0, 1)
    return places.mean(0), squares.mean(0), squares.std(0) / np.sqrt(len(samples) - 1)


def _collided(y, v, size, restitution, rng):
    cell = np.floor(y / CELL).astype(int)
    cell -= cell.min()
    order, count = np.argsort(cell.astype(np.int16), kind="stable"), np.bincount(cell)
    first = np.cumsum(count) - count
    others = order[first[cell] + (rng.random(y.size) * count[cell]).astype(int)]
    w = v - v[others]
    rate = size * count[cell] / (y.size * CELL) * np.abs(w)
    meets = rng.random(y.size) < rate * STEP
    return v - np.where(meets, (1 - restitution) / 2 * w, 0.0)


def _of_rods(y, v, size, rng):
    """Return mean place and mean square of the velocity of points in order, mirror images too."""
    groups = rng.permutation(y.size).reshape(-1, size)
    groups = np.take_along_axis(groups, np.argsort(y[groups], axis=1), axis=1)
    place, square = y[groups].mean(0), (v[groups] ** 2).mean(0)
    return (place - place[::-1]) / 2, (square + square[::-1]) / 2
