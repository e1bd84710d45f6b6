"""What the lessons share: colours, panels, comparisons in words, checked answers.

The lessons import this file from their own folder.
"""

import os

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import norm

from crazybilliards.reproduction.claims.study import error_of_mean

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


def safe(condition, sentence):
    """Return whether a changed parameter suits the lesson; if it does not, print the sentence.

    The sentence says which values suit the lesson, why, and how it goes on.
    """
    if not condition:
        print(sentence)
        _insist(False, sentence)
    return bool(condition)


def agree(what, measured, expected, error, unit=""):
    """Say in words whether measured values agree with expected ones.

    They do up to three standard errors, and from five on they do not. In between one looks again,
    and is told how often chance takes one of so many values so far. Of arrays the two values that
    are the farthest apart are told. A disagreement does not stop a lesson, unless the environment
    variable CRAZYBILLIARDS_LESSONS is "strict".
    """
    all_three = (np.asarray(each, dtype=float) for each in (measured, expected, error))
    measured, expected, error = np.broadcast_arrays(*all_three)
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.where(measured == expected, 0.0, abs(measured - expected) / error)
    worst = np.argmax(np.where(np.isnan(apart), np.inf, apart))
    pull = apart.flat[worst]
    of_all = f"of {apart.size} values the farthest is " if apart.size > 1 else ""
    far = "more than 1000" if pull > 1000 else f"{pull:.1f}"
    verdict = "they agree" if pull < 3 else "they do not agree"
    if 3 <= pull < 5:
        chance = 1 - (1 - 2 * norm.sf(pull)) ** apart.size
        verdict = f"look again, chance alone does this in {100 * chance:.2g} % of all cases"
    told = (
        f"{what}: {of_all}{measured.flat[worst]:.4g}{unit and ' ' + unit} measured, "
        f"{expected.flat[worst]:.4g}{unit and ' ' + unit} expected, "
        f"{far} standard errors apart: {verdict}."
    )
    print(told)
    _insist(pull < 5, told)


def _insist(condition, sentence):
    """Stop a lesson that its authors execute, and never a student's."""
    if os.environ.get("CRAZYBILLIARDS_LESSONS") == "strict":
        assert condition, sentence


def choose(answer, *options, right, hint):
    """Say whether one of the options, or its number, is missing, right, or wrong.

    Whatever else is given, the options are told. A missing answer is ``...``, also in quotes: they
    make a text of a word that the learner types in place of the dots.
    """
    known = {str(number): option for number, option in enumerate(options, start=1)}
    given = str(answer).strip().casefold()
    chosen = known.get(given, given)
    listed = ", ".join(f"{number} {option}" for number, option in known.items())
    if answer is ... or not given.strip("."):
        print(f"Your turn: replace the dots by a number, and run the cell again. {listed}.")
    elif chosen not in options:
        print(f"The answer is one of these numbers: {listed}.")
    elif chosen == right:
        print("Right.")
    else:
        print(f"Not yet: you chose {chosen}. Hint: {hint}")


def right(answer, expected, *, at=(), tolerance=1e-6):
    """Return whether an answer equals the expected one within a relative tolerance.

    Functions are compared by their values for each of the tuples of arguments in ``at``.
    """
    return _first_wrong(answer, expected, at, tolerance) is None


def check(answer, expected, *, at=(), hint, tolerance=1e-6, also=()):
    """Say whether an answer is missing, right, or wrong; a wrong one is given a hint.

    A missing answer is ``...``, or a function that returns this. An answer is a number, numbers, or
    a function of the arguments in ``at``. ``also`` are other right answers. What is said of a wrong
    answer contains the answer and its direction, and never the expected value.
    """
    try:
        given = answer(*at[0]) if at else answer
        if _is_missing(given):
            print("Your turn: replace the dots, and run the cell again.")
        elif given is None and at:
            print("Your function returns nothing: write return in front of the answer.")
        elif any(right(answer, each, at=at, tolerance=tolerance) for each in (expected, *also)):
            print("Right.")
        else:
            print(f"Not yet{_first_wrong(answer, expected, at, tolerance)}. Hint: {hint}")
    except Exception as error:  # whatever the student's code does, the lesson goes on
        print(f"Your code stops with {type(error).__name__}: {error}. Hint: {hint}")


def _is_missing(given):
    return given is ... or (isinstance(given, tuple | list) and any(each is ... for each in given))


def _first_wrong(answer, expected, at, tolerance):
    """Return in words the first answer that is wrong, or None if all are right."""
    for arguments in at or [None]:
        given, wanted = (
            each if arguments is None else each(*arguments) for each in (answer, expected)
        )
        given, wanted = (np.asarray(each, dtype=float) for each in (given, wanted))
        if given.shape != wanted.shape:
            return f": an answer of the shape {given.shape} must have the shape {wanted.shape}"
        scale = abs(wanted).max() if wanted.size else 1.0
        wrong = ~(abs(given - wanted) <= tolerance * scale)
        if wrong.any():
            where = "" if arguments is None else f"for ({', '.join(map(_shown, arguments))}) "
            return f": {where}you have {_shown(given)}, {_direction(given, wanted, wrong)}"
    return None


def _direction(given, wanted, wrong):
    """Return what is wrong with the first wrong number, without the right one."""
    first = np.flatnonzero(wrong)[0]
    which = f"number {first + 1} of these" if given.size > 1 else "which"
    if np.isnan(given.flat[first]):
        return f"{which} is undefined"
    return f"{which} is too {'large' if given.flat[first] > wanted.flat[first] else 'small'}"


def _shown(value):
    look = {"float_kind": "{:.4g}".format}
    return np.array2string(
        np.asarray(value, dtype=float), formatter=look, threshold=6, separator=", "
    )
