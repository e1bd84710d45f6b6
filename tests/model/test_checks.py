"""Messages about wrong names: what is accepted, and which name is near."""

from pathlib import Path

import pytest

from crazybilliards.comparison.sweeps import Case, read_sweep
from crazybilliards.kinetic import equilibrium, hydrodynamics
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_choice
from crazybilliards.model.vocabulary import require
from crazybilliards.particles import simulate

CHAIN = Chain(size=5)


def swept(folder: Path, text: str):
    path = folder / "grid.toml"
    path.write_text(text)
    return read_sweep(path)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda _: check_choice("name", "bleu", ("blue", "red")), r"one of \('blue', 'red'\), got"),
        (lambda _: check_choice("name", "bleu", ("blue", "red")), "'bleu'; did you mean 'blue'?"),
        (lambda _: Chain(spring="lineer"), "did you mean 'linear'?"),
        (lambda _: CHAIN.replace(restituton=1), "did you mean 'restitution'?"),
        (lambda _: simulate(CHAIN, observe="width"), "did you mean 'widths'?"),
        (lambda _: simulate(CHAIN, method="event_driven"), "did you mean 'event-driven'?"),
        (lambda _: hydrodynamics(CHAIN, equilibrium(CHAIN), 1, frame="labels"), "mean 'label'?"),
        (lambda _: require(equilibrium(CHAIN), ("desity",)), "has no 'desity'; .*mean 'density'?"),
        (lambda _: Case("simulat", CHAIN, {}), "did you mean 'simulate'?"),
        (lambda _: Case("simulate", CHAIN, {"durations": 1}), "did you mean 'duration'?"),
        (lambda folder: swept(folder, "[grids]"), "any of .*'chain'.*did you mean 'grid'?"),
        (lambda folder: swept(folder, "[simulates]"), "did you mean 'simulate'?"),
        (lambda folder: swept(folder, "[grid]\nsizes = [3]"), r"\[grid\] .*did you mean 'size'?"),
        (lambda folder: swept(folder, "[chain]\nsizes = 3"), "Chain takes.*did you mean 'size'?"),
        (
            lambda folder: swept(folder, "[phase_space]\ncell = 3"),
            r"\[phase_space\] takes any of .*did you mean 'cells'?",
        ),
    ],
)
def test_the_message_names_what_is_accepted_and_the_nearest(wrong, message, tmp_path):
    with pytest.raises(ValueError, match=message.replace("?", r"\?")):
        wrong(tmp_path)


def test_what_is_near_nothing_gets_no_guess():
    with pytest.raises(ValueError, match=r"got 'xyz'$"):
        check_choice("name", "xyz", ("blue", "red"))
    with pytest.raises(ValueError, match=r"got 3$"):
        check_choice("name", 3, ("blue", "red"))
