"""The lessons judge answers without giving them away, and tell disagreements in words."""

import re

import numpy as np
import pytest
from teaching import agree, check, right, safe


def broken(x):
    raise ValueError("no root")


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (abs, "Right."),
        (lambda x: -abs(x), "Right."),
        (lambda x: x, "Not yet: for (-1) you have -1, which is too small. Hint: sign"),
        (lambda x: x + 3, "Not yet: for (-1) you have 2, which is too large. Hint: sign"),
        (lambda x: float("nan"), "which is undefined"),
        (lambda x: ..., "Your turn"),
        (lambda x: (..., ...), "Your turn"),
        (lambda x: None, "returns nothing: write return"),
        (broken, "no root"),
    ],
)
def test_an_answer_is_checked(answer, said, capsys):
    check(answer, abs, at=[(-1.0,), (2.0,)], hint="sign", also=[lambda x: -abs(x)])
    assert said in capsys.readouterr().out


def test_numbers_are_checked(capsys):
    check(..., 2.0, hint="half")
    check([1, 2], [1, 2], hint="half")
    check([1, 2], 1, hint="half")
    check([0.599], [0.6], hint="half", tolerance=2e-3)
    check([1, 4], [1, 2], hint="half")
    said = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in said] == ["Your", "Right.", "Not", "Right.", "Not"]
    assert "shape (2,)" in said[2]
    assert "you have [1, 4], number 2 of these is too large" in said[4]
    assert not right(float("nan"), 1.0)
    assert right(0.5004, 0.5, tolerance=1e-3)


def test_words_are_checked(capsys):
    for answer in ("Middle ", "left", ...):
        check(answer, "middle", hint="two neighbours")
    right_word, wrong, missing = capsys.readouterr().out.splitlines()
    assert right_word == "Right."
    assert wrong == "Not yet: you have 'left'. Hint: two neighbours"
    assert "Your turn" in missing


WRONG = [-1.0, 0.0, 1e9, float("nan"), float("inf"), [1.0, 2.0], [[3.0]], "word", range]


@pytest.mark.parametrize("answer", WRONG, ids=repr)
@pytest.mark.parametrize("expected", [0.7317, [0.7317, 0.7317], "harlequin"], ids=repr)
def test_no_wrong_answer_is_told_the_right_one(answer, expected, capsys):
    check(answer, expected, hint="none")
    check(lambda x: answer, lambda x: expected, at=[(5.0,)], hint="none")
    said = capsys.readouterr().out
    assert said.count("\n") == 2
    assert "Right" not in said
    assert not re.search(r"[.]73|harlequin", said)


def test_agreement_is_told_in_words(capsys, monkeypatch):
    monkeypatch.setenv("CRAZYBILLIARDS_LESSONS", "strict")
    agree("W_v of one rod", 1.021, 1, 0.01, unit="W")
    agree("x", [1, 2, 4.9], [1, 2, 0], 1)
    agree("exactly", np.array([0.0, 1.0]), [0, 1], 0)
    assert capsys.readouterr().out.splitlines() == [
        "W_v of one rod: 1.021 W measured, 1 W expected, 2.1 standard errors apart: they agree.",
        "x: of 3 values the farthest is 4.9 measured, 0 expected, "
        "4.9 standard errors apart: they agree.",
        "exactly: of 2 values the farthest is 0 measured, 0 expected, "
        "0.0 standard errors apart: they agree.",
    ]


@pytest.mark.parametrize(
    ("measured", "error", "apart"),
    [
        (6.0, 1, "6.0 standard errors apart: they do not agree."),
        (1e24, 1, "more than 1000 standard errors apart: they do not agree."),
        (1.0, 0, "more than 1000 standard errors apart: they do not agree."),
        (float("nan"), 1, "nan standard errors apart: they do not agree."),
    ],
)
def test_disagreement_stops_strict_lessons_only(measured, error, apart, capsys, monkeypatch):
    monkeypatch.delenv("CRAZYBILLIARDS_LESSONS", raising=False)
    agree("far", [measured, 0], 0, error)
    assert apart in capsys.readouterr().out
    monkeypatch.setenv("CRAZYBILLIARDS_LESSONS", "strict")
    with pytest.raises(AssertionError, match="far: of 2 values"):
        agree("far", [measured, 0], 0, error)


def test_an_unsafe_change_is_told_in_one_sentence(capsys, monkeypatch):
    monkeypatch.delenv("CRAZYBILLIARDS_LESSONS", raising=False)
    assert safe(True, "Take damping below 4.")
    assert capsys.readouterr().out == ""
    assert not safe(False, "Take damping below 4.")
    assert capsys.readouterr().out == "Take damping below 4.\n"
    monkeypatch.setenv("CRAZYBILLIARDS_LESSONS", "strict")
    with pytest.raises(AssertionError, match="damping below 4"):
        safe(False, "Take damping below 4.")
