"""What a wrong call says: one line that names what came, what is wanted and the nearest name."""

import inspect
import pickle
import re
from concurrent.futures import Executor
from copy import copy
from importlib import import_module
from types import UnionType

import numpy as np
import pytest
import xarray as xr
from wrong_calls import GAMMA, WRONG_CALLS, WRONG_SWEEPS

import crazybilliards as cb
from crazybilliards.apps.commands.line import main
from crazybilliards.comparison.sweeps import Case, read_sweep
from crazybilliards.model import checks, public_names, words
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.particles.observers import OBSERVERS
from crazybilliards.particles.running.replica import Replica
from crazybilliards.reproduction import fits


@pytest.fixture(scope="module")
def names():
    """Return what the calls name."""
    chain, six = cb.Chain(size=5), cb.Chain(size=6)
    exact = cb.equilibrium(chain)
    raw = {"duration": 10, "average": "ensemble", "observe": "snapshots", "progress": False}
    return {
        "cb": cb,
        "np": np,
        "GAMMA": GAMMA,
        "chain": chain,
        "walled": chain.replace(box=12),
        "sorts": chain.replace(mass_ratio=3),
        "walls": cb.equilibrium(chain.replace(box=12)),
        "six": six,
        "exact": exact,
        "crystal": cb.equilibrium(cb.Chain(size=20)),
        "run": cb.simulate(chain, duration=100, progress=False),
        "snapshots": cb.simulate(chain, **raw),
        "some": cb.simulate(chain, particles=[2, 3], **raw),
        "start": cb.given_start(chain, chain.anchors),
        "tree": xr.DataTree.from_dict({"a": exact}),
        "foreign": xr.Dataset({"density": ("x", np.full(9, 0.1))}, {"x": np.arange(9.0)}),
        "Case": Case,
        "Executor": Executor,
        "checks": checks,
        "xr": xr,
        "fits": fits,
    }


@pytest.mark.filterwarnings("ignore:.*Without a steady state")
@pytest.mark.parametrize(("call", "said"), WRONG_CALLS)
def test_a_wrong_call_says_in_one_line_what_is_wanted_before_any_work(
    call, said, names, monkeypatch
):
    monkeypatch.setattr(Replica, "work", lambda *_: pytest.fail("it works"))
    with pytest.raises((ValueError, TypeError, AttributeError)) as caught:
        eval(call, dict(names))
    require_said(said, str(caught.value))


def signature(call):
    return inspect.signature(call).parameters


def classes(kind):
    return kind.__args__ if isinstance(kind, UnionType) else (kind,)


WANTED = {
    cb.Chain: "a Chain: Chain",
    xr.Dataset: "a result, an",
    xr.DataTree: "an xarray.DataTree, which",
}
CALLS = [name for name in cb.__all__ if hasattr(getattr(cb, name), "__wrapped__")]
CALLS += ["Chain", "Sweep", *(each.__name__ for each in OBSERVERS.values() if signature(each))]


def test_every_public_function_checks_its_calls():
    functions = {name for name in cb.__all__ if not inspect.isclass(getattr(cb, name))}
    assert functions == {name for name in CALLS if not inspect.isclass(getattr(cb, name))}


@pytest.mark.parametrize("name", CALLS)
def test_every_public_call_is_checked(name, names):
    """Names and number of arguments, those that are missing, and objects of another type."""
    call = getattr(cb, name)
    function = call.__init__ if inspect.isclass(call) else call
    space = inspect.unwrap(function).__globals__
    arguments = signature(call)
    kinds = {each.name: eval(str(each.annotation), space) for each in arguments.values()}
    right = {cb.Chain: "chain", xr.Dataset: "exact", xr.DataTree: "tree"}
    placed = [
        next((names[right[each]] for each in right if each in classes(kinds[one.name])), 3)
        for one in arguments.values()
        if one.kind != one.KEYWORD_ONLY
    ]
    by_name = ", ".join(each.name for each in arguments.values() if each.kind == each.KEYWORD_ONLY)
    takes = f"; it takes .*{f'by name {by_name}' if by_name else ''}$"
    with pytest.raises(TypeError, match=f"^{name}: too many positional arguments{takes}"):
        call(*placed, 3)
    last = next(reversed(arguments), "")
    meant = f"; did you mean '{last}'" if last else "; it takes no arguments"
    with pytest.raises(TypeError, match=f"^{name} has no argument '{last}x'{meant}"):
        call(**{f"{last}x": 1})
    needed = [each.name for each in arguments.values() if each.default is each.empty]
    if needed:
        with pytest.raises(TypeError, match=f"^{name}: missing a .*argument: '{needed[0]}'{takes}"):
            call()
    for argument, kind in kinds.items():
        if set(classes(kind)) <= set(WANTED):
            for wrong in (None, {}, "a.nc", np.zeros(3), cb.Widths):
                said = ".*, or ".join(WANTED[each] for each in classes(kind))
                with pytest.raises(ValueError, match=f"^{argument} must be {said}.*; got "):
                    call(**{argument: wrong})


def test_a_name_that_is_gone_says_what_replaces_it(monkeypatch):
    monkeypatch.setitem(public_names._GONE, "two_clumps", "displaced(chain, 0) does it")
    for room in (cb, cb.kinetic):
        with pytest.raises(AttributeError, match="two_clumps' any more: displaced"):
            room.two_clumps  # noqa: B018


@pytest.mark.parametrize(("text", "said"), WRONG_SWEEPS)
def test_a_wrong_sweep_says_in_one_line_what_is_wanted(text, said, tmp_path):
    text, path = eval(text, {"GAMMA": GAMMA}), tmp_path / "grid.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ValueError, match=r"\w") as caught:
        read_sweep(path).cases()
    require_said(said.strip(), str(caught.value))


def require_said(said, message):
    assert len(message) < 500
    assert "\n" not in message
    assert re.search(".*".join(map(re.escape, said.split("..."))), message), message


@pytest.mark.parametrize("number", [np.array(0.5), np.float32(0.5), xr.DataArray([0.5, 1])[0]])
def test_an_array_without_dimensions_is_a_number(number, names):
    chain = names["chain"].replace(gap=number)
    assert type(chain.gap) is float
    assert chain == names["chain"].replace(gap=0.5)
    assert cb.Chain(size=np.array(5)) == names["chain"]
    for start in (cb.displaced(chain, number), cb.compressed(chain, number)):
        run = cb.hydrodynamics(chain, start, number, every=number, progress=False)
        assert run.time.values.tolist() == [0.0, 0.5]
    assert cb.force_balance(chain, velocity_variance=number).equals(
        cb.force_balance(chain, velocity_variance=0.5)
    )


@pytest.mark.parametrize("stiffness", [0, 1])
def test_what_cannot_move_is_warned_of(stiffness):
    chain = cb.Chain(size=2, amplitude=0, stiffness=stiffness)
    still = [None, cb.given_start(chain, chain.anchors)]
    settings = {"duration": 10, "average": "ensemble", "observe": "energy", "progress": False}
    for start in still:
        with pytest.warns(UserWarning, match="amplitude=0 and a start at rest") as caught:
            cb.simulate(chain, start=start, **settings)
        assert [warning.filename for warning in caught] == [__file__]
    cb.simulate(chain, start=cb.given_start(chain, chain.anchors, 1.0), **settings)


def test_the_checks_of_calls_leave_everything_else_as_it_was():
    from crazybilliards.particles.simulation import simulate

    for room in cb._ROOMS:
        for name in import_module(f"crazybilliards.{room}").__all__:
            public = getattr(cb, name)
            assert pickle.loads(pickle.dumps(public)) is public
            assert public.__doc__
    assert cb.simulate is simulate
    assert list(inspect.signature(cb.Chain).parameters) == list(cb.Chain().parameters())
    assert inspect.signature(cb.Widths) == inspect.Signature()
    # An error within the function is not one of the call.
    with pytest.raises(TypeError, match="unsupported operand"):
        cb.force_balance(cb.Chain(size=3), displacement=lambda x: x + None)


def test_every_other_word_is_one_for_a_name_that_there_is(names):
    arguments = {name for each in CALLS for name in inspect.signature(getattr(cb, each)).parameters}
    there = {*arguments, *dir(names["chain"]), *cb.__all__, *VOCABULARY, *OBSERVERS, "label"}
    assert {name for meant in words.WORDS.values() for name in meant} <= there
    for argument, owner in words.OWNERS.items():
        assert argument in inspect.signature(getattr(cb, owner)).parameters
    assert not {*words.NOTES} & {*words.WORDS}


def test_an_error_within_a_property_stays_as_it_is():
    class Own(cb.Chain):
        @property
        def broken(self):
            return self.nonsense

    with pytest.raises(AttributeError, match="'Own' object has no attribute 'nonsense'"):
        Own().broken  # noqa: B018
    assert pickle.loads(pickle.dumps(cb.Chain(size=3))) == copy(cb.Chain(size=3))


def test_every_symbol_of_the_paper_says_which_parameter_it_is():
    for symbol, parameter in checks.SYMBOLS.items():
        if parameter != "time_step":
            said = f"{parameter} is {symbol} of the paper"
            for call in (cb.Chain, cb.simulate, cb.phase_space, cb.compare_relaxation):
                of_chain = "" if call is cb.Chain else ", an argument of Chain"
                with pytest.raises(TypeError, match=said + of_chain):
                    call(**{symbol: 2})


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ("--e=0.9", "--restitution is e of the paper"),
        ("-e", "--restitution is e of the paper"),
        ("--gamma=2", "--damping is gamma of the paper"),
        ("--dt=0.1", "--time-step is dt of the paper"),
        ("--walls=12", "box is the distance between two walls"),
        ("--wall-temperature=2", "walls have no temperature"),
        ("--restituton=1", "Possible options: --duration, --restitution"),
    ],
)
def test_an_option_that_is_a_symbol(option, said, capsys, monkeypatch):
    monkeypatch.setattr("sys.argv", ["crazybilliards", "simulate", option])
    with pytest.raises(SystemExit):
        main()
    line = capsys.readouterr().err
    assert said in line
    assert line.count("\n") == 1


def test_a_warning_names_the_line_of_the_user():
    with pytest.warns(UserWarning, match="relaxation time|not measured") as caught:
        cb.compare(cb.Chain(size=3), {"restitution": [0.9]}, duration=20, progress=False)
    assert {each.filename for each in caught} == {__file__}
