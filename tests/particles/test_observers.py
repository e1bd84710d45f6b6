"""What is measured, against what is known exactly at e = 1."""

import json
import pydoc

import numpy as np
import pytest
import xarray as xr
from described_runs import a_run, observers_of
from scipy.integrate import quad
from scipy.stats import kurtosis, norm, skew

import crazybilliards as cb
from crazybilliards.model import Chain, load, save
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import OBSERVERS, Observer, Velocities
from crazybilliards.particles.observers.base import Snapshots
from crazybilliards.particles.observers.energy import Energy


def test_every_observer_is_a_public_name():
    for name, observer in OBSERVERS.items():
        assert getattr(cb.observers, observer.__name__) is observer
        assert name in pydoc.render_doc(cb.simulate, renderer=pydoc.plaintext)
    assert sorted(kind.__name__ for kind in OBSERVERS.values()) == cb.observers.__all__

    def leaves(kind):
        own = [each for each in kind.__subclasses__() if each.__module__.startswith("crazyb")]
        return {kind} if not own else set().union(*map(leaves, own))

    assert leaves(Observer) == set(OBSERVERS.values())


@pytest.mark.compiled
def test_energy_starts_at_the_start():
    """Without gap elastic rods have the energy of independent oscillators, here from rest."""
    chain = Chain(size=1000)
    run = simulate(chain, duration=100, warmup=0, observe="energy", progress=False)
    assert run.time[0] == pytest.approx(1.02, abs=0.05)
    half = chain.damping / (2 * chain.mass)
    swing = np.sqrt(chain.stiffness / chain.mass - half**2)

    def response(t):  # velocity a time t after a kick
        return np.exp(-half * t) * (np.cos(swing * t) - half / swing * np.sin(swing * t))

    heating = chain.amplitude**2 / (2 * chain.mass)  # A^2 t/(2 m) at first
    a_rod = heating * quad(lambda t: response(t) ** 2, 0, run.time[0].item())[0]
    spread = np.sqrt(2 / chain.size)
    assert run.kinetic_energy[0].item() == pytest.approx(chain.size * a_rod, rel=5 * spread)
    assert "kinetic_energy_error" not in run


@pytest.mark.compiled
@pytest.mark.parametrize(("spring", "exponent"), [("linear", 2), ("quadratic", 3)])
def test_energies_in_equilibrium_are_those_of_independent_rods(spring, exponent):
    """T/2 and T/n a rod for U ~ |d|^n, because d U' is T on average; no gap, e = 1."""
    chain = Chain(size=10, spring=spring)
    start = cb.equilibrium_states(chain, 500, seed=2)
    how = {"average": "ensemble", "duration": 5, "every": 1.0, "progress": False}
    run = simulate(chain, start=start, replicas=500, observe="energy", **how)
    shares = {"kinetic": 1 / 2, "spring": 1 / exponent, "total": 1 / 2 + 1 / exponent}
    for name, share in shares.items():
        found, error = run[f"{name}_energy"], run[f"{name}_energy_error"]
        expected = share * chain.size * chain.temperature
        assert (abs(found - expected) < 5 * error).all(), name
        assert (error < 0.05 * expected).all(), name


@pytest.mark.parametrize("gap", [0.0, 0.5])
def test_what_the_rods_lose_without_noise_the_springs_gain(gap):
    chain = Chain(size=3, gap=gap, damping=0, amplitude=0)
    start = cb.given_start(chain, chain.anchors + np.array([-1.0, 0.5, 1.5]))
    how = {"average": "ensemble", "duration": 10, "every": 0.5, "progress": False}
    run = simulate(chain, start=start, observe="energy", **how)
    np.testing.assert_allclose(run.total_energy, run.spring_energy[0], rtol=5e-3)
    assert run.spring_energy.min() < 0.7 * run.total_energy[0]


@pytest.mark.compiled
def test_elastic_collisions_are_the_zero_crossings_of_gaussian_processes():
    """Rice: each of the L(L-1)/2 pairs of relabelled points meets w0/pi times a time unit."""
    chain = Chain(size=20)
    run = simulate(chain, duration=5000, replicas=2, observe="collisions", progress=False)
    expected = 190 * np.sqrt(chain.stiffness / chain.mass) / np.pi
    total = run.collision_rate.sum().item()
    spread = np.sqrt((run.collision_rate_error**2).sum().item()) * 3  # contacts are correlated
    assert total == pytest.approx(expected, rel=0.02)
    assert abs(total - expected) < 5 * spread
    assert run.collision_rate[-1] == 0
    np.testing.assert_allclose(
        run.collision_rate[:-1], run.collision_rate[-2::-1], atol=8 * spread / 20
    )


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


def test_a_rod_with_one_velocity_has_no_shape():
    run = a_run(Chain(size=2), observe="velocities")
    observer = run.observers[0].prepared(run, 1)
    counts = np.zeros(run.blocks, dtype=np.int64)
    counts[:2] = 1
    for block in range(2):
        still = np.zeros((1, 2))
        observer.observe(Snapshots(block, 0, 0, still, still, np.zeros((1, 0), dtype=np.int64)))
    assert np.isnan(observer.report(counts)["velocity_kurtosis"][1]).all()


@pytest.mark.compiled
def test_velocities_are_gaussian_at_restitution_one():
    chain = Chain(size=5)
    run = simulate(chain, duration=50_000, replicas=2, observe="velocities", progress=False)
    density, v = run.velocity_density, run.velocity_bin.values
    assert run.velocity_outside == 0
    width = np.gradient(v)
    np.testing.assert_allclose((density * width).sum("velocity_bin"), 1, rtol=0.01)
    W = chain.free_velocity_width
    middle = np.abs(v) < 2 * W
    coarse = density.values.mean(axis=0)[middle]
    expected = norm.pdf(v[middle], scale=W)
    assert np.abs(coarse / expected - 1).mean() < 0.03


def test_the_autocorrelation_time_is_that_of_a_free_rod():
    """gamma/k for the displacement of one rod on a linear spring; 64 blocks tell it to 18 %."""
    chain = Chain(size=1, damping=2)
    run = simulate(chain, duration=30_000, observe="widths", progress=False)
    assert run.autocorrelation_time.item() == pytest.approx(2, rel=0.6)


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
    options = {"duration": 500, "progress": False}
    fine = simulate(Chain(size=2), observe=["widths", Velocities(bins=801)], **options)
    assert fine.sizes["velocity_bin"] == 801
    usual = simulate(Chain(size=2), observe=["widths", "velocities"], **options)
    assert usual.sizes["velocity_bin"] == 401
    np.testing.assert_array_equal(fine.velocity_width, usual.velocity_width)
    observe = json.loads(fine.attrs["provenance"])["observe"]
    assert observe == ["widths", "velocities(bins=801)"]


def test_two_observers_that_would_give_one_name_are_refused():
    with pytest.raises(ValueError, match="would both give 'velocity_bin'"):
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
    how = {"duration": 1300, "every": 1.0, "replicas": 2, "seed": 4, "progress": False}
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
    again = simulate(
        chain, start=load(tmp_path / "run.nc").isel(time=-1), **how | {"duration": 100}
    )
    assert again.attrs["status"] == "completed"


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


@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("size", [1, 2, 3])
def test_observers_of_rods_at_rest_and_of_a_few_rods(size, e):
    """Nothing moves without noise, what has no value is NaN, and sums are those of the rods."""
    still = Chain(size=size, restitution=e, amplitude=0, gap=0.3)
    some = {*observers_of(still)}
    how = {"duration": 400, "progress": False, "time_step": 0.1}
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
