"""Numbers that pages tell in words are those of the tables that scripts write."""

from math import ceil
from pathlib import Path

import pandas as pd
import pytest

ROOT = Path(__file__).parents[1]


def words(name):
    """Return the text of a page on one line."""
    return " ".join((ROOT / name).read_text(encoding="utf-8").split())


def table(name):
    """Return a table of the documentation; cells that repeat the one above them are filled."""
    found = pd.read_csv(ROOT / "docs/tables" / f"{name}.csv")
    first = found.columns[0]
    return found.assign(**{first: found[first].ffill()})


def held_out():
    found = table("correlations_held_out")
    apart = (found.L == 230) & (found.e == 0.3)
    longest = (found.L > 300) & (found.e == 0)
    centre, border, single = (found[f"W_v {of}, %"].abs() for of in ("centre", "border", "largest"))
    small = found.L <= 300
    return {
        "docs/correlations.md": [
            f"The error of $W_v$ is at most {centre[~apart].max()} % in all of them",
            f"where it is {centre[apart].item()} %",
            f"`phase_space` is up to {-found['W_v centre without, %'].min():.0f} % too small",
            f"too small by up to {border[small & ~apart].max()} % in chains of at most 300 rods",
            f"({border[apart].item()} %), and by {border[longest].item()} % with 420 rods",
            f"For $e \\ge 0.8$ it is right to {border[found.e >= 0.8].max()} %",
            f"is {single[small & (found.e > 0.5)].max()} % for $e > 0.5$, "
            f"{single[small & (found.e < 0.5)].max()} % below, and {single[longest].item()} % with",
        ],
        "paper.md": [
            f"within {centre[~apart].max()} % in fifteen of them and {centre[apart].item()} % off",
            f"up to {-found['W_v centre without, %'].min():.0f} % off",
        ],
    }


def displacement_widths():
    found = table("displacement_widths")
    before, now = found["before, %"], found["now, %"].abs()
    worst = now == now.max()
    [size], [error] = found.L[worst], found["its error, %"][worst]
    strong = (found.e >= 0.3) & (found.Gamma >= 0.4)
    assert len(found) == 24
    assert (now[strong] > 4).sum() == 1
    return {
        "docs/correlations.md": [
            f"{len(found)} chains of {found.L.min()} to {found.L.max()} rods",
            f"any rod is {now.min()} to {now.max()} %, where it was {before.min()} to "
            f"{before.max()} % with $h$. It is at most {now[~worst].max()} %, but for the first of "
            f"{size} rods, where the simulation has an error of {error} %",
        ],
        "docs/tables.md": [
            f"Reached except for {size} rods at $e = 0.642$, with {now.max()} ± {error}"
        ],
    }


def without_k():
    found = table("correlations_with_k")
    found = found[(found.e == 0)]
    before = found["W_v largest, %"].str.split().str[0].astype(float)
    border = -found["W_v rod 1, %"].str.split().str[0].astype(float)
    largest = before.where(before > border, border)
    derived = found.group == "derived with"
    return {
        "docs/correlations.md": [
            f"was up to {ceil(largest[derived].max())} % too small in chains of 10 to 300 rods, "
            f"and up to {ceil(largest[found.L == 1000].item())} % with 1000"
        ]
    }


def correlation_lengths():
    found = table("correlation_lengths").set_index(["e", "L"])
    simulated, stated = (
        found["xi, simulation"].str.split(" ± ", expand=True).astype(float).to_numpy().T
    )
    short = 100 * (1 - found["xi, theory"] / simulated)
    errors = (found["xi, theory"] - simulated).abs() / stated
    near = errors[errors.index.get_level_values("e") >= 0.9]
    assert near.drop((0.9, 1000)).max() < 2
    excess = found["h_c/T centre, theory"] - found["h_c/T centre, simulation"].str.split().str[
        0
    ].astype(float)
    return {
        "docs/correlations.md": [
            f"length is {short[0.9, 1000]:.0f} % too short (four errors)",
            f"{short[0.75, 300]:.0f} % for 300 rods at $e = 0.75$, and {short[0, 300]:.0f} % for "
            f"300 rods and {short[0, 1000]:.0f} % for 1000 at $e = 0$",
            f"it is {excess[0].min():.2f} to {excess[0].max():.2f} too large",
        ]
    }


def first_order():
    found = table("first_order").set_index(["field", "calculation"])

    def off(field):
        ratio = found.loc[(field, "theory with the right source")] / found.loc[(field, "exact")]
        return 100 * (ratio - 1).abs()[1:]

    moves = [off(field) for field in ("displacement", "velocity")]
    heat = off("temperature")
    row = found.loc[("displacement", "theory")] / found.loc[("displacement", "exact")]
    return {
        "docs/correlations.md": [
            f"the part of the displacements is {row['j = 1']:.1f} times too large",
            f"right to {ceil(max(each.iloc[:2].max() for each in moves))} %, and those of the "
            f"wave 3 to {ceil(max(each.iloc[2] for each in moves))} %",
            f"remain {heat.min():.0f} to {ceil(heat.max())} % off",
        ]
    }


def verdicts():
    reproduced, not_so, cannot, undecided = (
        int(part.split()[0])
        for part in words("docs/paper/claims.md")
        .split("* Statements of the paper: ")[1]
        .split(" | ")[0]
        .split(", ")
    )
    total = reproduced + not_so + cannot + undecided
    return {"paper.md": [f"Of {total} statements {reproduced} are reproduced, {not_so} are not"]}


@pytest.mark.parametrize(
    "tell", [held_out, displacement_widths, without_k, correlation_lengths, first_order, verdicts]
)
def test_pages_tell_the_numbers_of_their_tables(tell):
    missing = [
        (page, number)
        for page, numbers in tell().items()
        for number in numbers
        if number not in words(page)
    ]
    assert missing == []
