"""The command ``theory``: every theory by its name."""

import functools
import json
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
    done = run("theory", name, "--size", 10, "--amplitude", 5, "--output", tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    [(chain, result)] = solved
    assert chain == Chain(size=10, amplitude=5)
    assert load(tmp_path / "theory.nc").identical(result)
    pictures = {"density.png", "profile.png"}
    pictures |= {"phase_space.png"} if "phase_space" in name else set()
    assert {path.name for path in tmp_path.iterdir()} == pictures | {"theory.nc"}
    assert THEORIES[name].title.capitalize() in " ".join(done.stdout.split())
    assert f"{result.velocity_width[0]:.4g}" in done.stdout
    assert name in run("theory", "--help").stdout


def test_without_a_name_it_is_the_best_theory_and_says_so(run, solved):
    done = run("theory", "--size", 12, "--restitution", 0.5)
    assert done.returncode == 0
    assert done.stdout.startswith("Kinetic equation with pair correlations, L = 12, e = 0.5")
    [(_, result)] = solved
    assert f"{result.velocity_width[0]:.4g}" in done.stdout


def test_the_list_tells_who_takes_the_chain(run, solved):
    done = run("theory", "--list", "--restitution", 0.5)
    text = " ".join(done.stdout.split())
    assert "correlated_phase_space" in text
    assert solved == []
    facts = json.loads(run("theory", "--list", "--restitution", 0.5, "--json").stdout)
    assert [row["theory"] for row in facts["theories"]] == list(THEORIES)
