"""Claims get the verdict that their numbers deserve, by one rule for all kinds of claims."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from crazybilliards.reproduction.claims.verdicts import (
    EYE,
    POSITIVE,
    Claim,
    Estimate,
    around,
    furthest_in_plot,
    in_plot,
    worst,
)

DOCS = Path(__file__).parents[2] / "docs"
REPRODUCED = {True: "reproduced", False: "not reproduced", None: "undecided"}


# Three errors have to fit in, or to lie outside.
NU, SMALL, SEEN = around(-0.46, 0.01), around(0.0, 0.1), around(0.0, EYE)


@pytest.mark.parametrize(
    ("within", "value", "error", "holds"),
    [
        (NU, -0.46, 0.003, True),
        (NU, -0.471, 0.002, None),  # three errors reach the paper's number from outside
        (NU, -0.465, 0.002, None),  # three errors reach out
        (NU, -0.475, 0.001, False),
        (NU, -0.46, 0.2, None),
        (NU, np.nan, 0.01, None),
        (NU, -0.46, np.nan, None),
        (around(-2.2, 0.1), -2.456, 0.061, None),  # figure 6: once reproduced, for its error
        (POSITIVE, 0.5, 0.1, True),
        (POSITIVE, -0.5, 0.1, False),
        (POSITIVE, 0.02, 0.02, None),
        (SMALL, 0.5, 0.1, False),
        (SMALL, 0.02, 0.02, True),
        (SMALL, 0.1, 0.02, None),
        (SEEN, 0.01, 0.003, True),  # however significant: below 2 % of the plot it is not seen
        (SEEN, 0.018, 0.003, None),
        (SEEN, 0.03, 0.003, False),
    ],
)
def test_numbers(within, value, error, holds):
    number = {"number": Estimate(value, error), "within": within, "reason": "why"}
    claim = Claim("nu", **number, source="fig.2")
    assert claim.verdict == REPRODUCED[holds]
    assert ("why" in claim.details) is (holds is not True)
    # A choice of ours that was not varied excuses nothing.
    chosen = Claim("nu", **number, source="fig.2", ours="the size")
    assert chosen.verdict == REPRODUCED[holds]


def every_kind(value, error):
    """Return a claim of each kind about one number; it has to be within 1 of 0, or positive."""
    measured = Estimate(value, error)
    share = Estimate(value * EYE, error * EYE)
    return [
        Claim("it", "is", source="fig.2", number=measured, within=around(0.0, 1.0)),
        Claim("it", source="fig.2", **worst("is", [measured], 1.0)),
        Claim("it", source="fig.2", **in_plot("is", share, 1.0)),
        Claim("it", "is", source="fig.2", number=measured, within=POSITIVE),
    ]


@given(value=st.floats(-5, 5), error=st.floats(0, 2), more=st.floats(1, 10))
def test_all_kinds_of_limits_have_one_rule_and_large_errors_help_no_claim(value, error, more):
    """A verdict with large errors is that with small ones, or undecided."""
    precise, poor = (
        [claim.verdict for claim in every_kind(value, each)] for each in (error, error * more)
    )
    inside, outside = abs(value) + 3 * error < 1, abs(value) - 3 * error > 1
    assert {*precise[:2]} == {REPRODUCED[True if inside else False if outside else None]}
    assert all(each in (sure, "undecided") for sure, each in zip(precise, poor, strict=True))


def test_a_choice_decides_only_where_it_was_varied_and_changed_the_verdict():
    """The number of figure 6 at one time step, and at others."""

    def verdict(value, *others, **about):
        elsewhere = {f"choice {k}": Estimate(*each) for k, each in enumerate(others)}
        number = {"number": Estimate(*value), "within": around(-2.2, 0.1)}
        return Claim("exponent", **number, elsewhere=elsewhere, **about).verdict

    flat, right, steep, poor = (-1.6, 0.01), (-2.2, 0.01), (-3.0, 0.1), (-2.3, 0.2)
    said = {"source": "fig:trigger", "ours": "the time step"}
    for those in ((flat,), (flat, steep), (flat, poor)):
        assert verdict(*those, **said) == "not reproduced"
    assert verdict(right, poor, **said) == "reproduced"
    assert verdict(poor, right, **said) == "undecided"
    for those in ((flat, right), (right, flat), (flat, poor, right), (poor, right, steep)):
        assert verdict(*those, **said) == "cannot be decided"


def test_the_number_is_told_with_its_limits_and_with_that_at_other_choices():
    number = {"number": Estimate(-1.6, 0.01), "within": around(-2.2, 0.05), "source": "fig:trigger"}
    elsewhere = {"dt = 0.02": Estimate(-2.21, 0.01), "dt = 0.01": Estimate(-2.3, 0.1)}
    claim = Claim("exponent", **number, elsewhere=elsewhere)
    told = "dt = 0.02: -2.210 ± 0.010, reproduced; dt = 0.01: -2.30 ± 0.10"  # which decides nothing
    assert claim.details["at other choices"] == told
    assert "at other choices" not in Claim("it", **number).details
    measured = Estimate(0.1, 0.02)

    def told(within):
        details = Claim("it", "change", source="fig.2", number=measured, within=within).details
        return details["found here"], details.get("its number")

    assert told(around(0.3, 0.01)) == ("change 0.100 ± 0.020", "0.3")
    assert told(around(0.0, 0.5)) == ("change 0.100 ± 0.020 (limit 0.5)", None)
    assert told(POSITIVE) == ("change 0.100 ± 0.020", None)
    assert in_plot("rods", measured, 3.0)["within"] == around(0.0, 0.02)
    assert worst("both", [measured], 0.5)["number"] == pytest.approx(measured)


@pytest.mark.parametrize(
    ("deviations", "errors", "verdict", "decides"),
    [
        ([0.9, 0.8, 0.1], [0.02, 0.1, 0.2], "undecided", 1),  # a smaller one may be seen
        ([0.9, 0.8, 0.1], [0.02, 0.05, 0.2], "reproduced", 0),
        ([4.0, 3.0, 0.1], [2.0, 0.1, 0.2], "not reproduced", 1),  # the largest may be chance
    ],
)
def test_the_deviation_that_decides_need_not_be_the_largest(deviations, errors, verdict, decides):
    """Limits are 1, in units of what an eye sees."""
    found = furthest_in_plot(EYE * np.array(deviations), EYE * np.array(errors))
    assert found.value == EYE * deviations[decides]
    assert Claim("it fits", **in_plot("rods", found, 5.0), source="fig.2").verdict == verdict


def test_what_is_said_of_a_plot_and_on_the_page_of_claims_is_what_was_measured():
    """A steep line an eye does not tell from the symbols, though it is far off beside them."""
    share = Estimate(0.00874, 0.00014)
    assert in_plot("rho(x)", share, 1372.8)["words"] == (
        "rho(x): the symbol that decides is 0.874 ± 0.014 % of the plotted range away from the "
        "nearest point of the line (visible: 2 %); the largest vertical distance is 1372.8 "
        "standard errors"
    )
    assert "standard errors" not in in_plot("p(v)", share)["words"]
    told = (DOCS / "paper/claims.md").read_text(encoding="utf-8")
    words = r"\S+: the symbol that decides is .*? away from the nearest point of the line \(vis"
    assert len(re.findall(words, told)) == 9


def test_sameness_is_confirmed_only_if_a_difference_would_have_been_seen():
    """Chance takes the largest of many beyond three enlarged errors as often as one beyond 3."""
    for number in (1, 4, 1000):
        _, error = worst("both", [Estimate(0.0, 1.0)] * number, 1.0)["number"]
        each = norm.cdf(3 * error) - norm.cdf(-3 * error)
        assert 1 - each**number == pytest.approx(2 * norm.sf(3), rel=2e-3)
    near, poor, off = Estimate(0.01, 0.002), Estimate(0.01, 0.05), Estimate(-0.3, 0.01)

    def verdict(*differences):
        return Claim("equal", source="fig.2", **worst("both", differences, 0.1)).verdict

    assert verdict(near, near) == "reproduced"
    assert verdict(near, poor) == "undecided"  # once it held: its difference is no standard error
    assert verdict(near, poor, off) == "not reproduced"
    assert verdict(near, Estimate(np.nan, 0.1)) == "undecided"
    assert verdict(off, Estimate(np.nan, 0.1)) == "not reproduced"
    words = "both: -0.300 ± 0.010, the worst of 3 (limit 0.1); largest difference 30.0 standard"
    assert worst("both", [near, off, poor], 0.1)["words"] == f"{words} errors"


def test_estimates_are_written_to_the_second_digit_of_the_error():
    assert str(Estimate(-0.46123, 0.00234)) == "-0.4612 ± 0.0023"
    assert str(Estimate(37.512, 1.234)) == "37.5 ± 1.2"
    assert str(Estimate(5.0, 0.0)) == "5.0000 ± 0.0000"
    assert str(Estimate(np.nan, 0.1)) == "not determined"
    difference = Estimate(3.0, 0.3).minus(Estimate(1.0, 0.4))
    assert difference == pytest.approx((2.0, 0.5))
