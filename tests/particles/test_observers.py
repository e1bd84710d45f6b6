"""What is measured, against what is known exactly at e = 1."""

import json
import pydoc
from typing import ClassVar

import numpy as np
import pytest
import xarray as xr
from described_runs import a_run, observers_of, some_snapshots
from scipy.stats import kurtosis, norm, skew

import crazybilliards as cb
from crazybilliards.model import Chain, load, save
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.particles import simulate
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.observers import OBSERVERS, Velocities
from crazybilliards.particles.observers.base import Averaged, Snapshots
from crazybilliards.particles.observers.energy import Energy
from crazybilliards.particles.running.replica import restore

HOW = {"duration": 200, "progress": False}


def test_every_observer_is_a_public_name():
    for name, observer in OBSERVERS.items():
        assert getattr(cb.observers, observer.__name__) is observer
        assert name in pydoc.render_doc(cb.simulate, renderer=pydoc.plaintext)
    assert sorted(kind.__name__ for kind in OBSERVERS.values()) == cb.observers.__all__


@pytest.mark.compiled
@pytest.mark.parametrize(("spring", "exponent"), [("linear", 2), ("quadratic", 3)])
def test_energies_in_equilibrium_are_those_of_independent_rods(spring, exponent):
    """T/2 and T/n a rod for U ~ |d|^n, because d U' is T on average; no gap, e = 1."""
    chain = Chain(size=10, spring=spring)
    start = cb.equilibrium_states(chain, 300, seed=2)
    how = {"average": "ensemble", "duration": 3, "every": 1.0, "progress": False}
    run = simulate(chain, start=start, replicas=300, observe="energy", **how)
    shares = {"kinetic": 1 / 2, "spring": 1 / exponent, "total": 1 / 2 + 1 / exponent}
    for name, share in shares.items():
        found, error = run[f"{name}_energy"], run[f"{name}_energy_error"]
        expected = share * chain.size * chain.temperature
        assert (abs(found - expected) < 5 * error).all(), name
        assert (error < 0.05 * expected).all(), name


def test_the_shape_of_a_distribution_is_that_of_the_velocities_not_of_their_bins():
    """In these bins an exact Gaussian has an excess kurtosis of 0.0028."""
    run = a_run(Chain(size=2), observe="velocities")
    observer = run.observers[0].prepared(run, 1)
    n = 64_000  # the middles of equally likely intervals: a Gaussian to 1e-4
    gauss = run.chain.free_velocity_width * norm.ppf((np.arange(n) + 0.5) / n)
    v = np.random.default_rng(1).permutation(np.stack([gauss, np.exp(gauss)], axis=1))
    for block, part in enumerate(np.array_split(v, run.blocks)):
        empty = np.zeros((len(part), 0), dtype=np.int64)
        observer.observe(Snapshots(block, 0, 0, np.zeros_like(part), part, empty))
    counts = np.full(run.blocks, n // run.blocks)
    report = observer.report(counts)
    np.testing.assert_allclose(report["velocity_skewness"][1], skew(v), atol=1e-9)
    np.testing.assert_allclose(report["velocity_kurtosis"][1], kurtosis(v), rtol=1e-9, atol=1e-9)
    assert abs(report["velocity_kurtosis"][1][0]) < 1e-3
    expected = np.sqrt(24 / n)  # of a Gaussian
    assert report["velocity_kurtosis_error"][1][0] == pytest.approx(expected, rel=0.5)
    bins, width = observer.coordinates()["velocity_bin"], run.chain.free_velocity_width
    middle = np.abs(bins) < 2 * width
    density = report["velocity_density"][1][0, middle] / norm.pdf(bins[middle], scale=width)
    assert np.abs(density - 1).mean() < 0.02
    observer.sums[:] = 0
    rest = np.zeros((1, 2))
    observer.observe(Snapshots(0, 0, 0, rest, rest, np.zeros((1, 0), dtype=np.int64)))
    of_rods_at_rest = observer.report(np.eye(1, run.blocks, dtype=np.int64)[0])
    assert np.isnan(of_rods_at_rest["velocity_kurtosis"][1]).all()


def test_the_energy_of_a_run_of_a_billion_snapshots_takes_no_memory_for_their_times():
    run = a_run(Chain(), duration=6.4e9, time_step=0.1, warmup=0, observe="energy")
    assert run.snapshots == 64 * 10**8
    [energy] = (observer.prepared(run, 1) for observer in run.observers)
    energy.together = 64 * 10**5  # after many additions in pairs
    energy.counts[:] = energy.together
    assert energy.coordinates()["time"][[0, -1]] == pytest.approx([3.2e6, 6.4e9 - 3.2e6], rel=1e-6)


BUILT_IN = [pytest.param(observer, id=name) for name, observer in OBSERVERS.items()]


@pytest.mark.parametrize("observer", BUILT_IN)
def test_an_observer_gives_what_it_declares(observer):
    chain = Chain(size=4, box=10 * observer.meets_walls)
    result = simulate(chain, duration=300, observe=observer(), progress=False)
    variables = {str(name).removesuffix("_error") for name in result.data_vars}
    assert variables == set(observer.gives)
    common = {"particle", "normalized_particle", "mean_position", "contact", "normalized_contact"}
    assert {str(name) for name in result.coords} - common == set(observer.along)
    assert set(observer.gives) <= VOCABULARY.keys()


def test_an_observer_is_taken_as_an_object_with_parameters():
    observe = ["widths", Velocities(bins=801)]
    run = simulate(Chain(size=2), observe=observe, **HOW)
    assert run.sizes["velocity_bin"] == 801
    assert json.loads(run.attrs["provenance"])["observe"] == ["widths", "velocities(bins=801)"]


def test_two_observers_that_would_give_one_name_are_refused():
    with pytest.raises(ValueError, match="holds 'velocities' twice"):
        a_run(Chain(), observe=[Velocities(bins=11), Velocities()])

    class OwnTimes(Energy):
        gives = ("rods",)
        shares_time = False

    for observe in (["energy", OwnTimes()], [OwnTimes(), "snapshots"]):
        with pytest.raises(ValueError, match="would both give 'time'"):
            a_run(Chain(), observe=observe)
        # The times of an ensemble are common to all.
        a_run(Chain(), observe=observe, average="ensemble")


@pytest.mark.compiled
@pytest.mark.parametrize("changed", [{}, {"box": 10, "mass_ratio": 3}])
def test_snapshots_are_recorded_beside_all_other_observers(changed, tmp_path):
    how = {"duration": 650, "every": 0.5, "replicas": 2, "seed": 4, "progress": False}
    chain = Chain(size=4, restitution=0.9, **changed)
    names = [name for name in observers_of(chain) if name != "snapshots"]
    run = simulate(chain, observe=[*names, "snapshots"], **how)
    alone = simulate(chain, observe=names, **how)
    for name, values in alone.data_vars.items():
        if "time" not in values.dims:
            xr.testing.assert_identical(run[name], values)
    assert run.sizes["time"] > 1000 >= alone.sizes["time"]
    stretched = chain.potential(run.position - chain.anchors).sum(axis=-1).mean(axis=0)
    np.testing.assert_allclose(run.spring_energy, stretched, rtol=1e-9)
    energy = (run.velocity**2 @ xr.DataArray(chain.rod_masses / 2, dims="particle")).mean("replica")
    np.testing.assert_allclose(run.kinetic_energy, energy.transpose("time"), rtol=1e-12)
    save(run, tmp_path / "run.nc")
    xr.testing.assert_identical(load(tmp_path / "run.nc"), run)


def test_energies_beside_snapshots_that_not_all_replicas_reached_are_unknown():
    """Of an interrupted run; snapshots that some replica reached are kept."""
    run = a_run(Chain(size=2), observe=["energy", "snapshots"], replicas=2)
    pairs = [[each.prepared(run, 1) for each in run.observers] for _ in range(2)]
    v = np.ones((3, 2))
    for number, pair in enumerate(pairs):
        for each in pair:
            part = v[: 3 - number]
            empty = np.zeros((len(part), 0), dtype=np.int64)
            each.observe(Snapshots(0, 0, 0, 0 * part, part, empty))
    reports, times = {}, []
    for first, second in zip(*pairs, strict=True):
        first.join([second])
        reports |= first.report(np.array([3, 2]))
        times.append(first.coordinates()["time"])
    assert reports["velocity"][1].shape == (2, 3, 2)
    np.testing.assert_array_equal(*times)
    mass = run.chain.mass
    np.testing.assert_allclose(reports["kinetic_energy"][1], [mass, mass, np.nan])
    unstretched = mass + run.chain.potential(run.chain.reduced_anchors).sum()
    np.testing.assert_allclose(reports["total_energy"][1], [unstretched, unstretched, np.nan])


@pytest.mark.filterwarnings("ignore:collision_rate is infinite")
@pytest.mark.parametrize(("size", "e"), [(1, 0.5), (2, 0.0), (2, 1.0), (3, 0.5)])
def test_observers_of_rods_at_rest_and_of_a_few_rods(size, e):
    """Nothing moves without noise, what has no value is NaN, and sums are those of the rods."""
    still = Chain(size=size, restitution=e, amplitude=0, gap=0.3)
    some = {*observers_of(still)}
    how = {"duration": 200, "progress": False, "time_step": 0.1}
    with pytest.warns(UserWarning, match="nothing will move"):
        rest = simulate(still, observe=sorted(some - {"velocities"}), **how)
    for name in ("velocity_width", "autocorrelation_time", "kinetic_energy", "collision_rate"):
        assert (rest[name] == 0).all()
    if size > 1:
        assert (rest.contact_force == 0).all()
        assert rest.contact_temperature.isnull().all()
    run = simulate(Chain(size=size, restitution=e), observe=sorted(some), merging=0, **how)
    np.testing.assert_allclose(run.mode_velocity_variance.sum(), (run.velocity_width**2).sum())
    energy = run.kinetic_energy.mean() / (Chain().mass / 2)
    np.testing.assert_allclose(energy, (run.velocity_width**2).sum())
    assert run.collision_rate[-1] == 0
    spacing = run.x[1] - run.x[0]
    assert float(run.density.sum() * spacing + run.outside) == pytest.approx(size)
    if size > 1 and e > 0:
        temperature, factor = run.contact_temperature, 2 / np.sqrt(np.pi) * (1 - e)
        loss = factor * run.contact_force * np.sqrt(temperature)
        np.testing.assert_allclose(run.contact_loss, loss, atol=1e-12)


@pytest.mark.parametrize("average", ["time", "ensemble"])
@pytest.mark.parametrize("observer", BUILT_IN)
def test_a_checkpoint_keeps_everything_that_observing_changes(observer, average):
    """Save and restore, then observe the same: every attribute agrees. None can be forgotten."""
    if average == "ensemble" and not observer.ensemble:
        return
    chain = Chain(size=5, box=12 * observer.meets_walls)
    run = a_run(chain, duration=100, observe=observer(), average=average, replicas=2)
    generator = np.random.default_rng(1)
    [original] = (each.prepared(run, 2) for each in run.observers)
    untouched = {name: np.array(value) for name, value in original.state().items()}
    original.observe(some_snapshots(run, generator, 0))
    tally = original.tally(make_tally(5, contacts=True))
    for array in (
        tally.contacts,
        *tally.pushes,
        *tally.triggered,
        tally.impacts,
        tally.struck,
        tally.speeds.counts,
    ):
        array += 1  # as the collision kernels do
    state = {name: np.array(value) for name, value in original.state().items()}
    assert any(not np.array_equal(state[name], untouched[name]) for name in state)
    [resumed] = (each.prepared(run, 2) for each in run.observers)
    for name, value in state.items():
        restore(resumed, name, value)
    snapshots = some_snapshots(run, generator, 3)
    for each in (original, resumed):
        each.observe(snapshots)
    assert vars(original).keys() == vars(resumed).keys()
    for name, value in vars(original).items():
        assert np.array_equal(value, vars(resumed)[name], equal_nan=isinstance(value, np.ndarray))


# -- observers of another package: their names, their mistakes, and what they cannot spoil ---------


class Fast(Averaged):
    name = "fast"
    gives = ("share_fast",)
    vocabulary: ClassVar = {
        "share_fast": ("share of the time in which |v| > W", "1"),
        "velocity_width": ("something else", "1"),
    }

    def observe(self, snapshots):
        fast = np.abs(snapshots.v) > Chain().free_velocity_width
        self.sums[snapshots.block] += fast.sum(axis=0)

    def report(self, counts):
        return self.averages({"share_fast": lambda share: share}, counts, "particle")


def test_an_observer_brings_the_meanings_of_its_own_names(tmp_path):
    before = dict(VOCABULARY)
    run = simulate(Chain(size=2), observe=[Fast(), "widths"], **HOW)
    save(run, tmp_path / "run.nc")
    xr.testing.assert_identical(load(tmp_path / "run.nc"), run)
    assert run.share_fast.attrs == {"long_name": Fast.vocabulary["share_fast"][0], "units": "1"}
    assert run.share_fast_error.attrs["long_name"].startswith("standard error of share of the time")
    assert run.velocity_width.attrs["long_name"] == VOCABULARY["velocity_width"][0]
    assert dict(VOCABULARY) == before


@pytest.mark.parametrize(("name", "error"), [("surprise", KeyError), ("velocity_width", TypeError)])
def test_a_variable_without_a_meaning_or_of_another_observer_is_an_error(name, error):
    class Surprising(Fast):
        def report(self, counts):
            return super().report(counts) | {name: ((), 7.0)}

    for observe in ([Surprising(), "widths"], ["widths", Surprising()]):
        with pytest.raises(error, match=name):
            simulate(Chain(size=2), observe=observe, **HOW)


def test_an_observer_cannot_change_what_the_others_see():
    class Careless(Fast):
        single_collisions = True

        def observe(self, snapshots):
            for array in (snapshots.y, snapshots.v, snapshots.collisions):
                with pytest.raises(ValueError, match="read-only"):
                    array[...] = 0

    simulate(Chain(size=2), observe=[Careless(), "widths"], **HOW)


def test_what_a_checkpoint_cannot_hold_is_an_error_before_any_work(tmp_path):
    """Otherwise a resumed run would go on without it."""

    class Holding(Fast):
        def prepare(self, run, copies):
            super().prepare(run, copies)
            self.places = {}

        def observe(self, snapshots):
            pytest.fail("it works")

    with pytest.raises(ValueError, match=r"holds arrays and numbers, .*places is none"):
        simulate(Chain(size=2), observe=Holding(), checkpoint=tmp_path / "state", **HOW)
