"""The command ``theory``: every theory by its name."""

import functools
from dataclasses import replace

import pytest

from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.model import Chain, load


@pytest.fixture
def solved(monkeypatch):
    """Take down what a command gives to theories, and gets: (chain, result)."""
    calls = []

    def watched(function):
        @functools.wraps(function)
        def solve(chain):
            calls.append((chain, function(chain)))
            return calls[-1][1]

        return solve

    for name, theory in THEORIES.items():
        monkeypatch.setitem(THEORIES, name, replace(theory, solve=watched(theory.solve)))
    return calls


@pytest.mark.parametrize("name", THEORIES)
def test_every_theory_by_its_name(name, run, solved, tmp_path):
    done = run("theory", name, "--size", 4, "--amplitude", 5, "--output", tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    [(chain, result)] = solved
    assert chain == Chain(size=4, amplitude=5)
    assert load(tmp_path / "theory.nc").identical(result)
    written = {"density.png", "profile.png", "theory.nc"}
    assert {path.name for path in tmp_path.iterdir()} == written
    assert THEORIES[name].title.capitalize() in " ".join(done.stdout.split())
    assert f"{result.velocity_width[0]:.4g}" in done.stdout


@pytest.mark.parametrize(
    ("chain", "title", "walls"),
    [
        ("--size 4 --restitution 0.5", "Gas, L = 4, e = 0.5", False),
        ("--size 4 --box 20 --stiffness 0", "Exact equilibrium, L = 4, e = 1", True),
    ],
)
def test_without_a_name_it_is_the_theory_of_the_chain_and_says_so(run, chain, title, walls):
    """In a box the error of the force on the walls is stated as well."""
    done = run("theory", *chain.split())
    assert done.returncode == 0
    assert done.stdout.startswith(title)
    assert ("force on" in done.stdout) == walls
