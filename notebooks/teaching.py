"""What the lessons share: colours, panels, films, a comparison in standard errors, checked answers.

The lessons import this file from their own folder.
"""

import matplotlib.pyplot as plt
import numpy as np

from crazybilliards.comparison import Player
from crazybilliards.comparison.encoding import encoded, kind_of_film
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


def played(figure, show, frames, a_second):
    """Return a film of a figure, in which ``show(frame)`` moves what moves."""

    def pictures():
        for frame in frames:
            show(frame)
            figure.canvas.draw()
            yield np.array(figure.canvas.buffer_rgba())

    kind = kind_of_film(".html")
    film = Player(encoded(pictures(), kind, a_second), kind)
    plt.close(figure)  # or the notebook would also show the last picture
    return film


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
    return _first_wrong(answer, expected, at, tolerance) is None


def check(answer, expected, *, at=(), hint, tolerance=1e-6, also=()):
    """Say whether an answer is missing, right, or wrong; a wrong one is given a hint.

    A missing answer is ``...``, or a function that returns this. ``also`` are other right answers.
    """
    try:
        given = answer(*at[0]) if at else answer
        if given is ...:
            print("Your turn: replace the dots, and run the cell again.")
        elif given is None and at:
            print("Your function returns nothing: write return in front of the answer.")
        elif any(right(answer, each, at=at, tolerance=tolerance) for each in (expected, *also)):
            print("Right.")
        else:
            print(f"Not yet{_first_wrong(answer, expected, at, tolerance)}. Hint: {hint}")
    except Exception as error:  # whatever the student's code does, the lesson goes on
        print(f"Your code stops with {type(error).__name__}: {error}. Hint: {hint}")


def _first_wrong(answer, expected, at, tolerance):
    """Return the first numbers that are wrong in words, or None if all are right."""
    for arguments in at or [None]:
        given, wanted = (
            np.asarray(each if arguments is None else each(*arguments), dtype=float)
            for each in (answer, expected)
        )
        if given.shape != wanted.shape:
            return f": an answer of the shape {given.shape} must have the shape {wanted.shape}"
        scale = abs(wanted).max() if wanted.size else 1.0
        if not (abs(given - wanted) <= tolerance * scale).all():
            if arguments is None:  # the wanted number would be the solution
                return f": you have {_shown(given)}"
            where = ", ".join(_shown(each) for each in arguments)
            return f": for ({where}) you have {_shown(given)}, and right is {_shown(wanted)}"
    return None


def _shown(value):
    look = {"float_kind": "{:.4g}".format}
    return np.array2string(
        np.asarray(value, dtype=float), formatter=look, threshold=6, separator=", "
    )
