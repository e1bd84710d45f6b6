"""The lessons judge answers without giving them away, and tell disagreements in words."""

import re

import numpy as np
import pytest
from teaching import agree, check, choose, right, safe


def broken(x):
    raise ValueError("no root")


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        (abs, "Right."),
        (lambda x: -abs(x), "Right."),
        (lambda x: x, "Not yet: for (-1) you have -1, which is too small. Hint: sign"),
        (lambda x: float("nan"), "which is undefined"),
        (lambda x: ..., "Your turn"),
        (lambda x: (..., ...), "Your turn"),
        (lambda x: None, "returns nothing: write return"),
        (broken, "no root"),
    ],
)
def test_an_answer_is_checked(answer, verdict, capsys):
    check(answer, abs, at=[(-1.0,), (2.0,)], hint="sign", also=[lambda x: -abs(x)])
    assert verdict in capsys.readouterr().out


@pytest.mark.parametrize(
    ("answer", "expected", "verdict"),
    [
        (..., 2.0, "Your turn"),
        ([0.599], [0.6], "Right."),
        ([1, 2], 1, "shape (2,)"),
        ([1, 4], [1, 2], "you have [1, 4], number 2 of these is too large"),
    ],
)
def test_numbers_are_checked(answer, expected, verdict, capsys):
    assert right(0.5009, 0.5, tolerance=2e-3)
    assert not right(0.5011, 0.5, tolerance=2e-3)
    check(answer, expected, hint="half", tolerance=2e-3)
    assert verdict in capsys.readouterr().out


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        (..., "Your turn"),
        ("...", "Your turn"),
        (2, "Right."),
        ("2", "Right."),
        ("Middle ", "Right."),
        (1, "Not yet: you chose left. Hint: twice"),
        *((each, "one of these numbers: 1 left, 2 middle.") for each in (3, "centre", [2], None)),
    ],
)
def test_a_word_is_chosen_among_options(answer, verdict, capsys):
    choose(answer, "left", "middle", right="middle", hint="twice")
    assert verdict in capsys.readouterr().out


WRONG = [-1.0, 0.0, 1e9, float("nan"), float("inf"), [1.0, 2.0], [[3.0]], "word", range]


@pytest.mark.parametrize("answer", WRONG, ids=repr)
@pytest.mark.parametrize("expected", [0.7317, [0.7317, 0.7317]], ids=repr)
def test_no_wrong_answer_is_told_the_right_one(answer, expected, capsys):
    check(answer, expected, hint="none")
    check(lambda x: answer, lambda x: expected, at=[(5.0,)], hint="none")
    printed = capsys.readouterr().out
    assert printed.count("\n") == 2
    assert not re.search(r"Right|[.]73", printed)


@pytest.fixture
def strict(monkeypatch):
    """Return a function that makes lessons strict, which they are not before."""
    monkeypatch.delenv("CRAZYBILLIARDS_LESSONS", raising=False)
    return lambda: monkeypatch.setenv("CRAZYBILLIARDS_LESSONS", "strict")


@pytest.mark.parametrize(
    ("measured", "expected", "error", "verdict"),
    [
        (1.021, 1, 0.01, "1.021 W measured, 1 W expected, 2.1 standard errors apart: they agree."),
        ([1, 2, 2.9], [1, 2, 0], 1, "of 3 values the farthest is 2.9 W measured"),
        (4, 1, 1, "3.0 standard errors apart: look again, chance alone does this in 0.27 % of all"),
        ([0, 4.9], 0, 1, "4.9 standard errors apart: look again"),
        (np.array([0.0, 1.0]), [0, 1], 0, "0.0 standard errors apart: they agree."),
    ],
)
def test_agreement_is_told_in_words(measured, expected, error, verdict, capsys, strict):
    strict()
    agree("x", measured, expected, error, unit="W")
    assert verdict in capsys.readouterr().out


@pytest.mark.parametrize(
    ("measured", "error", "distance"),
    [(6.0, 1, "6.0"), (1e24, 1, "more than 1000"), (1.0, 0, "more than"), (float("nan"), 1, "nan")],
)
def test_disagreement_stops_strict_lessons_only(measured, error, distance, capsys, strict):
    agree("far", [measured, 0], 0, error)
    assert re.search(rf"{distance}.* apart: they do not agree\.", capsys.readouterr().out)
    assert safe(True, "Take damping below 4.")
    assert not safe(False, "Take damping below 4.")
    assert capsys.readouterr().out == "Take damping below 4.\n"
    strict()
    with pytest.raises(AssertionError, match="far: of 2 values"):
        agree("far", [measured, 0], 0, error)
