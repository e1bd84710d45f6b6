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
    done = run("theory", name, "--size", 10, "--amplitude", 5, "--output", tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    [(chain, result)] = solved
    assert chain == Chain(size=10, amplitude=5)
    assert load(tmp_path / "theory.nc").identical(result)
    written = {"density.png", "profile.png", "theory.nc"}
    assert {path.name for path in tmp_path.iterdir()} == written
    assert THEORIES[name].title.capitalize() in " ".join(done.stdout.split())
    assert f"{result.velocity_width[0]:.4g}" in done.stdout
    assert name in run("theory", "--help").stdout


@pytest.mark.parametrize(("e", "title"), [(0.5, "Gas"), (1, "Exact equilibrium")])
def test_without_a_name_it_is_the_theory_of_the_chain_and_says_so(run, solved, e, title):
    done = run("theory", "--size", 12, "--restitution", e)
    assert done.returncode == 0
    assert done.stdout.startswith(f"{title}, L = 12, e = {e}")
    [(_, result)] = solved
    assert f"{result.velocity_width[0]:.4g}" in done.stdout


def test_in_a_box_the_error_of_the_force_on_walls_is_stated(run):
    assert "force on" in run("theory", "--size", 5, "--box", 20, "--stiffness", 0).stdout
    assert "force on" not in run("theory", "--size", 5).stdout
