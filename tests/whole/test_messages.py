"""What a wrong call says: one line that names what came, what is wanted and the nearest name."""

import inspect
import pickle
import re
from copy import copy
from functools import partial

import numpy as np
import pytest
import xarray as xr
from refused_theories import REFUSED
from wrong_calls import GAMMA, WRONG_CALLS, WRONG_SWEEPS

import crazybilliards as cb
from crazybilliards.comparison.sweeps import read_sweep
from crazybilliards.model.vocabulary import VOCABULARY, described, unit_of
from crazybilliards.particles.running.replica import Replica
from crazybilliards.reproduction import fits


class Quantity:
    """Numbers with a unit, by the name that a library has for it."""

    def __init__(self, values, name):
        self.values = np.asarray(values, dtype=float)
        setattr(self, name, "km")

    def __array__(self, dtype=None, copy=None):
        return self.values

    def __float__(self):
        return float(self.values)

    def __len__(self):
        return len(self.values)

    def __getitem__(self, which):
        return self.values[which]

    def item(self):
        return self.values.item()

    shape = property(lambda self: self.values.shape)


@pytest.fixture(scope="module")
def names():
    """Return what the calls name."""
    chain = cb.Chain(size=5)
    raw = {"duration": 10, "average": "ensemble", "observe": "snapshots", "progress": False}
    exact, moved = cb.equilibrium(chain), cb.displaced(chain, 1.0)
    twenty = cb.Chain(size=20)
    crystal, narrow = cb.equilibrium(twenty), cb.compressed(twenty, 0.02)
    speed = -30 * twenty.free_velocity_width * np.sign(narrow.x)

    def flow(start=moved, chain=chain, duration=10, **settings):
        cb.hydrodynamics(chain, start, duration, progress=False, **settings)

    theories = {name: getattr(cb.kinetic, name) for name in cb.kinetic.__all__}
    return theories | {
        "cb": cb,
        "Chain": cb.Chain,
        "np": np,
        "xr": xr,
        "km": partial(Quantity, name="unit"),
        "pint": partial(Quantity, name="units"),
        "moved": moved,
        "lags": cb.observers.TimeCorrelations,
        "in_metres": moved.assign(density=moved.density.assign_attrs(units="1/m")),
        "fits": fits,
        "GAMMA": GAMMA,
        "chain": chain,
        "six": cb.Chain(size=6),
        "walled": chain.replace(box=12),
        "sorts": chain.replace(mass_ratio=3),
        "exact": exact,
        "walls": cb.equilibrium(chain.replace(box=12)),
        "crystal": crystal,
        "at_rest": cb.force_balance,
        "rest": cb.force_balance(chain),
        "hot": {"velocity_variance": "evolving"},
        "boxed": cb.Chain(size=5, amplitude=5, box=30),
        "lossy": cb.Chain(size=300, restitution=0.9),
        "twenty": twenty,
        "thirty": cb.Chain(size=30, restitution=0.9),
        "wide": cb.Chain(size=100),
        "dense": cb.Chain(size=20_000),
        "inward": narrow.assign(flow_velocity=speed),
        "flow": flow,
        "run": cb.simulate(chain, duration=100, progress=False),
        "second": cb.simulate(chain, duration=100, progress=False, seed=1),
        "run_in_a_box": cb.simulate(chain.replace(box=12), duration=100, progress=False),
        "snapshots": cb.simulate(chain, **raw),
        "start": cb.given_start(chain, chain.anchors),
        "foreign": xr.Dataset({"density": ("x", np.full(9, 0.1))}, {"x": np.arange(9.0)}),
    }


@pytest.mark.filterwarnings("ignore:.*Without a steady state")
@pytest.mark.parametrize(
    ("call", "said"),
    [
        pytest.param(
            *line, marks=pytest.mark.compiled if re.search("twenty|lossy", line[0]) else ()
        )
        for line in WRONG_CALLS + REFUSED
    ],
)
def test_a_wrong_call_says_in_one_line_what_is_wanted_before_any_work(
    call, said, names, monkeypatch
):
    monkeypatch.setattr(Replica, "work", lambda *_: pytest.fail("it works"))
    with pytest.raises((ValueError, TypeError)) as caught:
        eval(call, dict(names))
    require_said(said, str(caught.value))


@pytest.mark.parametrize(("text", "said"), WRONG_SWEEPS)
def test_a_wrong_sweep_says_in_one_line_what_is_wanted(text, said, tmp_path):
    path = tmp_path / "grid.toml"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"\w") as caught:
        read_sweep(path).cases()
    require_said(said, str(caught.value))


def require_said(said, message):
    assert len(message) < 500
    assert "\n" not in message
    assert re.search(".*".join(map(re.escape, said.split("..."))), message), message


OF_A_CHAIN = [
    name
    for name in cb.__all__
    if inspect.isfunction(getattr(cb, name))
    and "chain" in inspect.signature(getattr(cb, name)).parameters
]


@pytest.mark.parametrize("name", OF_A_CHAIN)
def test_a_result_in_the_place_of_a_chain_is_refused_with_a_hint(name, names):
    function, others = getattr(cb, name), {}
    for argument in inspect.signature(function).parameters.values():
        if argument.default is argument.empty and argument.name != "chain":
            others[argument.name] = {"gap": [1.0]} if argument.name == "over" else 1.0
    if name == "hydrodynamics":
        others |= {"start": names["exact"], "duration": 1.0}
    with pytest.raises(
        TypeError, match=r"chain must be a Chain, got a Dataset: .*chain_of\(result"
    ):
        function(names["exact"], **others)


def test_a_chain_and_its_functions_stay_what_they_were():
    assert list(inspect.signature(cb.Chain).parameters) == list(cb.Chain().parameters())
    for public in (cb.Chain, cb.simulate):
        assert pickle.loads(pickle.dumps(public)) is public
        assert public.__doc__
    assert pickle.loads(pickle.dumps(cb.Chain(size=3))) == copy(cb.Chain(size=3))


@pytest.mark.parametrize("number", [np.array(0.5), np.float32(0.5), xr.DataArray([0.5, 1])[0]])
def test_an_array_without_dimensions_is_a_number(number, names):
    chain = names["chain"].replace(gap=number)
    assert type(chain.gap) is float
    assert chain == names["chain"].replace(gap=0.5)
    assert cb.Chain(size=np.array(5)) == names["chain"]
    assert cb.force_balance(chain, velocity_variance=number).equals(
        cb.force_balance(chain, velocity_variance=0.5)
    )


@pytest.mark.parametrize("stiffness", [0, 1])
def test_what_cannot_move_is_warned_of_at_the_line_of_the_user(stiffness):
    chain = cb.Chain(size=2, amplitude=0, stiffness=stiffness)
    settings = {"duration": 10, "average": "ensemble", "observe": "energy", "progress": False}
    for start in (None, cb.given_start(chain, chain.anchors)):
        with pytest.warns(UserWarning, match="amplitude=0 and a start at rest") as caught:
            cb.simulate(chain, start=start, **settings)
        assert [warning.filename for warning in caught] == [__file__]
    cb.simulate(chain, start=cb.given_start(chain, chain.anchors, 1.0), **settings)


def test_units_of_results_are_ones_own(names):
    chain, last = names["chain"], names["snapshots"].isel(time=-1)
    for position in (last.position, last.position.assign_attrs(units="R"), last.position.values):
        again = cb.given_start(chain, position, last.velocity)
        np.testing.assert_array_equal(again.position, last.position)
    table = names["exact"].mean_position.values, names["exact"].velocity_width ** 2
    cb.force_balance(chain, velocity_variance=table)


def test_units_are_not_those_of_a_unit_library(names):
    for _, unit in VOCABULARY.values():
        written = described("", unit)["units"]
        for word in written.replace("^", " ").replace("/", " ").split():
            assert word.strip("()").isdecimal() or word in ("R_0", "M_0", "t_0")
    width = names["exact"].velocity_width
    assert width.attrs["units"] == "R_0/t_0"
    assert unit_of(width) == unit_of(width.assign_attrs(units="R_0/T_0")) == "R/t_0"
    ax = cb.overlay({"exact": names["exact"]}, "velocity_width")
    assert ax.get_ylabel().endswith("[$R/t_0$]")
