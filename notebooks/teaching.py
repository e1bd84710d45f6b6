"""What the lessons share: colours, panels, a comparison in standard errors, a check of answers.

The lessons import this file from their own folder.
"""

import matplotlib.pyplot as plt
import numpy as np

from crazybilliards.reproduction.claims.repetition import error_of_mean

BLUE, ORANGE, GREEN, PINK, RED, SKY = COLOURS = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#CC79A7",
    "#D55E00",
    "#56B4E9",
)
plt.rcParams.update({"figure.constrained_layout.use": True, "figure.dpi": 80})


def panels(number=1, width=10, height=3.6, **settings):
    """Return the axes of a row of panels; a single panel comes without a list around it."""
    _, axes = plt.subplots(1, number, figsize=(width, height), **settings)
    return axes


def mean_and_error(values):
    """Return the mean over independent runs, along the first axis, and its standard error.

    With few runs the error is enlarged so that 68 % of all means lie within one.
    """
    values = np.asarray(values)
    return values.mean(axis=0), error_of_mean(values)


def agree(what, measured, expected, error):
    """Print the largest difference in standard errors, and insist that it is below five."""
    pulls = abs(np.asarray(measured) - np.asarray(expected)) / np.asarray(error)
    print(f"{what}: at most {pulls.max():.1f} standard errors apart")
    assert pulls.max() < 5


def right(answer, expected, *, at=(), tolerance=1e-6):
    """Return whether an answer equals the expected one within a relative tolerance.

    Functions are compared by their values for each of the tuples of arguments in ``at``.
    """
    pairs = [(answer(*each), expected(*each)) for each in at] or [(answer, expected)]
    for given, wanted in pairs:
        given, wanted = np.asarray(given, dtype=float), np.asarray(wanted, dtype=float)
        scale = abs(wanted).max() if wanted.size else 1.0
        if given.shape != wanted.shape or not (abs(given - wanted) <= tolerance * scale).all():
            return False
    return True


def check(answer, expected, *, at=(), hint, tolerance=1e-6):
    """Say whether an answer is missing, right, or wrong; a wrong one is given a hint.

    A missing answer is ``...``, or a function that returns this or None.
    """
    try:
        given = answer(*at[0]) if at else answer
        if given is ... or given is None:
            print("Your turn: replace the dots, and run the cell again.")
        elif right(answer, expected, at=at, tolerance=tolerance):
            print("Right.")
        else:
            print(f"Not yet. Hint: {hint}")
    except Exception as error:  # whatever the student's code does, the lesson goes on
        print(f"Your code stops with {type(error).__name__}: {error}. Hint: {hint}")
