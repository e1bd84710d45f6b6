"""Whatever the arguments, a function of the package returns a sound result or says what is wrong.

Hypothesis draws chains and arguments from a list of nasty values (zero, negative, NaN, infinite,
1e300, 1e-300, strings, None, truth values, numpy scalars, lists, huge whole numbers) and from
ordinary ones. Every call must end in one of three ways:

* a result: finite, ordered where rods are ordered, with the right number of rods;
* one ValueError or TypeError of one line, or a DivergedError of a chain that grows without bound;
* for a run that would take long: the return after a Ctrl-C, which is sent after two seconds.

Any other exception, any warning but those named here, a NaN, a call that outlives Ctrl-C, or one
that asks for more address space than the limit set here fails the test.
"""

import math
import re

import numpy as np
import pytest
import xarray as xr
from exploration import explored, interrupted_when_long, outcome, require_sound
from hypothesis import given
from hypothesis import strategies as st
from typer.main import get_command

from crazybilliards import kinetic
from crazybilliards.apps.commands.line import app, main
from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate
from crazybilliards.particles.observers import OBSERVERS
from crazybilliards.particles.stepping import compile_kernels

resource = pytest.importorskip("resource")  # not on Windows

ROOM = 24 * 2**30  # bytes of address space; more is asked for by mistake only

STRANGE = st.sampled_from(
    [
        *(True, None, "", "1", "NaN", "x", b"1", (), [], [1.0], [None], [[1]], {}, 1j, 10**400),
        *(np.float64(2.0), np.float32(1e-3), np.int64(-4), np.bool_(True), np.array([1.0, 2.0])),
        *(np.zeros((3, 3)), np.array(3), range(3), "x" * 1000, [0] * 1000),
    ]
)
EXTREME = st.sampled_from(
    [
        *(0, -1, 1, 2, 0.0, -0.0, -1.5, math.nan, math.inf, -math.inf, 1e300, 1e-300, 5e-324),
        *(1e60, 1e-60, 1e30, 1e-30, 1e15, 1e-15, 1e9, 1e-9, 1e6, 1e-6, 1e3, 1e-3, 1e17),
        *(10**3, 10**5, 10**7, 10**9, 10**18, 10**30),
    ]
)
SIZES = st.integers(1, 12)
ORDINARY = st.floats(0.01, 10).map(lambda value: float(f"{value:.3g}"))


@st.composite
def arguments(draw, **each):
    """Draw some of the keyword arguments: up to two of them nasty, the others ordinary."""
    chosen = draw(st.fixed_dictionaries({}, optional=each))
    for _ in range(draw(st.sampled_from([0, 1, 1, 2]))):
        chosen[draw(st.sampled_from(sorted(each)))] = draw(EXTREME | EXTREME | STRANGE)
    return chosen


def chains(restitution):
    return arguments(
        size=SIZES,
        restitution=restitution,
        gap=st.just(0.0) | ORDINARY,
        **dict.fromkeys(("amplitude", "damping", "stiffness", "radius", "mass"), ORDINARY),
        spring=st.sampled_from(["linear", "quadratic"]),
    ).map(lambda parameters: {"size": 6, **parameters})


ELASTIC = st.just(1.0)
NEAR_ONE = st.just(1.0) | st.floats(0.9, 1.05).map(lambda e: round(e, 3))
ANY = st.just(1.0) | st.floats(0, 1.1).map(lambda e: round(e, 3))


@pytest.fixture(autouse=True)
def limits():
    """Bound the address space for the test."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (ROOM, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_AS, before)


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """Compile the kernels beforehand, so that a Ctrl-C meets a computation."""
    compile_kernels()
    chain = Chain(size=2)
    for frame in ("label", "eulerian"):
        options = {"frame": frame, "velocity_variance": "evolving", "progress": False}
        kinetic.hydrodynamics(chain, kinetic.displaced(chain, 1.0), 0.1, **options)


@explored(1000)
@given(arguments(**dict.fromkeys(Chain().parameters(), ORDINARY)))
def test_a_chain_is_sound_or_refused(parameters):
    chain = outcome(Chain, **parameters)
    if chain is None:
        return
    assert Chain(**chain.parameters()) == chain
    assert not math.isnan(chain.temperature + chain.thermal_length + chain.free_velocity_width)


TABLE = st.sampled_from(
    [
        *(([-9.0, 0.0, 9.0], values) for values in ([1.0, 2.0, 1.0], [-1.0, 0.0, 1.0])),
        *(([-9.0, 0.0, 9.0], values) for values in ([1e200, -1e200, 1.0], [0.0, 0.0, 0.0])),
        *(([0.0, 0.0], [1.0, 2.0]), ([-1.0, math.nan], [1.0, 2.0]), ([-1.0, 1.0], ["a", "b"])),
        *(([1.0], [2.0]), np.tanh, np.arctan),
        *(lambda x: None, lambda x: np.full_like(x, np.nan), lambda x: 1.0),
    ]
)


def starts(chain):
    """Return the usual starts of a chain and some that are not sound."""
    good = outcome(kinetic.displaced, chain, chain.thermal_length)
    if good is None:
        return []
    return [
        good,
        *(good * factor for factor in (0, -1, math.nan, 10)),
        *(good.isel(x=slice(None, None, step)) for step in (2, -1)),
        *(good.rename(x="z"), good.drop_vars("x"), good.isel(x=0), good.isel(x=[])),
        good.drop_vars("label"),
        good.assign(flow_velocity=good.flow_velocity + 1e100),
        good.assign_attrs(provenance="{"),
        good.assign_coords(x=good.x * math.nan),
        *(xr.Dataset(), None, "start", 3, {}),
    ]


# By function: examples, what it always gets, and what of it is drawn.
EXPLORED = {
    simulate: (
        300,
        {"duration": 200.0, "progress": False},
        arguments(
            duration=st.floats(50, 300),
            warmup=st.floats(0, 30),
            time_step=st.floats(0.001, 1),
            method=st.sampled_from(["event-driven", "contact-dynamics"]),
            stepper=st.sampled_from(["splitting", "euler"]),
            merging=st.floats(0, 1),
            seed=st.integers(0, 10),
            observe=st.sets(st.sampled_from(sorted(OBSERVERS)), min_size=1, max_size=2).map(list),
            particles=st.lists(SIZES, min_size=1, max_size=3, unique=True).map(sorted),
            replicas=st.integers(1, 3),
            average=st.sampled_from(["time", "ensemble"]),
            every=st.floats(0.01, 10),
            threads=st.integers(1, 2),
            checkpoint_interval=st.floats(0, 10),
        ),
    ),
    kinetic.equilibrium: (300, {}, st.just({})),
    kinetic.equilibrium_states: (
        300,
        {"replicas": 2},
        arguments(replicas=st.integers(1, 5), seed=st.integers(0, 9)),
    ),
    kinetic.force_balance: (
        300,
        {},
        arguments(displacement=TABLE, velocity_variance=ORDINARY | TABLE),
    ),
    kinetic.breathing_cloud: (
        300,
        {"duration": 1.0},
        arguments(
            **dict.fromkeys(("duration", "every", "stretch", "shift"), ORDINARY),
            start_velocity_variance=ORDINARY,
            evolving=st.booleans(),
        ),
    ),
    kinetic.hydrodynamics: (
        150,
        {"duration": 1.0, "progress": False},
        arguments(
            duration=st.floats(0.1, 5),
            frame=st.sampled_from(["label", "eulerian"]),
            displacement=st.none() | TABLE,
            velocity_variance=st.sampled_from([None, "evolving"]) | ORDINARY | TABLE,
            every=st.floats(0.1, 2),
            cells=st.integers(8, 200),
        ),
    ),
    kinetic.steady_state: (300, {}, arguments(correlations=st.booleans())),
    kinetic.critical_size: (30, {}, st.just({})),
    kinetic.displaced: (100, {"shift": 1.0}, arguments(shift=ORDINARY)),
    kinetic.compressed: (100, {"factor": 1.0}, arguments(factor=ORDINARY)),
    given_start: (
        100,
        {"position": 1.0},
        arguments(position=ORDINARY, velocity=ORDINARY, replicas=st.integers(1, 3)),
    ),
}
RESTITUTIONS = {simulate: ANY, kinetic.steady_state: ANY, kinetic.hydrodynamics: NEAR_ONE}
RESTITUTIONS |= {kinetic.critical_size: st.floats(1, 1.1)}


@pytest.mark.filterwarnings("ignore:amplitude=0 and a start at rest")
@pytest.mark.filterwarnings("ignore:.*spectra are NaN")
@pytest.mark.filterwarnings("ignore:the share of the rods on the left")
@pytest.mark.filterwarnings("ignore:.*the chain diverged")
@pytest.mark.parametrize("function", EXPLORED, ids=lambda function: function.__name__)
def test_a_result_is_sound_or_refused(function):
    examples, always, drawn = EXPLORED[function]

    @explored(examples)
    @given(chains(RESTITUTIONS.get(function, ELASTIC)), drawn, st.integers(0, 60))
    def require(parameters, options, number):
        if function is kinetic.breathing_cloud:
            parameters = parameters | {"gap": 0.0, "spring": "linear"}
        chain = outcome(Chain, **parameters)
        given_to = {**always, **options}
        if chain is not None and function is kinetic.hydrodynamics:
            some = starts(chain)
            chain = chain if some else None
            given_to["start"] = some[number if number < len(some) else 0] if some else None
        if chain is not None:
            require_sound(outcome(function, chain, **given_to))

    require()


NASTY = [
    *("x", "nan", "inf", "-inf", "0", "-1", "1.5", "1e300", "-1e300", "1e-300", "1e60", "1e-60"),
    *("1000000000", "true", "None", "", "1,2", ",", "1,,2", "nan,1", "\x00", "é\n"),
    *("9" * 30, "9" * 5000),
]
SMALL = {
    "compare": ["--size", "4", "--duration", "300", "--amplitude", "1", "--threads", "1"],
    "simulate": ["--size", "4", "--duration", "50", "--threads", "1"],
    "relax": ["--size", "4", "--duration", "1", "--replicas", "2", "--threads", "1"],
    "theory": ["--size", "4", "--restitution", "1"],
}
# Not tried: paths, and what only switches something on.
LEFT_OUT = {"output", "checkpoint", "help"}
OPTIONS = [
    (command, option.opts[0])
    for command in SMALL
    for option in get_command(app).commands[command].params
    if option.opts[0].startswith("--") and option.name not in LEFT_OUT
]


def ended(arguments, monkeypatch):
    """Run a command; return its exit status."""
    monkeypatch.setattr("sys.argv", ["crazybilliards", *arguments])
    try:
        with interrupted_when_long(), pytest.raises(SystemExit) as caught:
            main()
    except KeyboardInterrupt:  # between two commands
        return 130
    return caught.value.code


def require_clear(status, printed):
    """Check how a command ended and what it said."""
    assert "Traceback" not in printed.err
    assert not re.search(r"\bnan\b", printed.out, re.IGNORECASE)
    if status == 2:
        lines = [line for line in printed.err.splitlines() if line.strip()]
        assert len(lines) == 1, lines
        assert lines[0].startswith("crazybilliards: error: ")
        assert len(lines[0]) < 600
    else:
        assert status in (0, None, 1, 130), (status, printed.err)


@pytest.mark.filterwarnings("ignore:amplitude=0 and a start at rest")
@pytest.mark.filterwarnings("ignore:.* has no (arctanh fit|theory)")
@pytest.mark.filterwarnings("ignore:stiffness=0. nothing ties the rods")
@pytest.mark.filterwarnings("ignore:the share of the rods on the left")
@pytest.mark.filterwarnings("ignore:.* a chain diverged")
@pytest.mark.parametrize(("command", "option"), OPTIONS)
def test_an_option_is_taken_or_refused_in_one_line(command, option, monkeypatch, capsys):
    for value in NASTY:
        arguments = [command, *SMALL[command], option, value]
        require_clear(ended(arguments, monkeypatch), capsys.readouterr())
