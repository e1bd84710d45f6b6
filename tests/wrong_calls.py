r"""Wrong calls, each with what its message says; ``...`` stands for anything between.

One line for each kind of message. ``tests/whole/test_messages.py`` says what the names stand for,
and makes the calls.
"""

GAMMA = "\N{GREEK SMALL LETTER GAMMA}"

NAMES = """
cb.Chain(e=0.8) | Chain has no argument 'e'; restitution is e of the paper
cb.Chain(**{GAMMA: 2}) | damping is ... of the paper
cb.Chain(restituton=0.9) | Chain has no argument 'restituton'; did you mean 'restitution'?
cb.Chain(nonsense=3) | 'nonsense'; it takes size, restitution, amplitude
cb.simulate(chain, rng=1) | simulate has no argument 'rng'; it takes chain, duration
cb.simulate(chain, dt=0.1) | simulate has no argument 'dt'; time_step is dt of the paper
chain.replace(e=0.9) | restitution is e of the paper
cb.compare(chain, {"e": [0.9]}) | restitution is e of the paper
cb.Sweep({"e": [1]}) | restitution is e of the paper
cb.simulate(chain, observe="width") | did you mean 'widths'?
cb.Chain(spring="lineer") | spring must be one of...got 'lineer'; did you mean 'linear'?
cb.comparison.fit_arctanh(foreign) | the result has no 'mean_displacement'
"""

VALUES = """
cb.Chain(size=2.5) | size must be an integer
cb.Chain(restitution=np.ma.masked) | restitution must be a number, got masked
cb.Chain(amplitude=1e-80) | amplitude must be between 1e-60 and 1e60 in magnitude, or 0, got 1e-80
cb.Chain(mass=0) | mass must be positive, got 0
cb.Chain(size=6, box=12) | box must be above 12, the length of all rods, or 0...got 12
cb.Chain(wall_restitution=0.5) | without walls it must be 1; box=... gives a chain two walls
cb.save(run, 3) | path must be a text or a Path, got 3
cb.save(run, "a.csv") | must end in .nc, got 'a.csv'
cb.load(".") | a folder, not a file; load_sweep reads
cb.given_start(chain, "a") | position must be numbers, got 'a'
cb.given_start(chain, chain.anchors, np.datetime64("2020-01-01")) | velocity must be numbers
cb.given_start(chain, chain.anchors, np.ma.masked_less(range(5), 2)) | velocity must be numbers
cb.simulate(chain, seed=[1, 2]) | a Generator of numpy...got [1, 2]
cb.chain_of(foreign) | names no chain
cb.force_balance(run, velocity_variance=3) | chain must be a Chain, got a Dataset
cb.chain_of(chain) | not a crazybilliards result: Chain(size=5
cb.save(3, "a.nc") | not a crazybilliards result: 3
cb.film([run]) | not a crazybilliards result: [<xarray.Dataset
cb.smooth(exact.density) | not a crazybilliards result
cb.comparison.coverage_density(None) | not a crazybilliards result: None
cb.run_cases([chain], "a") | a Sweep or a list of cases, and hold Chain(size=5
cb.deviation(foreign, foreign) | not a crazybilliards result
cb.comparison.fit_arctanh(-exact) | not displaced outward
cb.comparison.fit_arctanh(exact.isel(particle=slice(2))) | fit_arctanh: the result has 2 particles
cb.comparison.fit_arctanh(exact.isel(particle=slice(None, None, -1))) | must ascend from 1 to 5
cb.comparison.fit_border_power_law(exact.isel(particle=[0, 1])) | give all particles
cb.comparison.fit_border_power_law(cb.equilibrium(cb.Chain(size=4))) | at least 5
cb.comparison.fit_border_power_law(exact.assign(velocity_width=exact.particle - 1)) | positive
cb.comparison.fit_border_power_law(crystal.where(crystal.particle != 3)) | positive widths
cb.comparison.fit_border_power_law(crystal) | no power law fits
cb.comparison.coverage_density(cb.smooth(exact)) | the density is smoothed already
cb.smooth(run.sel(x=slice(-1, 1))) | of the chain's 5 rods: smooth needs the whole grid
"""

RUNS = """
cb.simulate(chain, duration=5, every=1.0) | duration must be at least...average='ensemble'
cb.simulate(chain, duration=1e30) | 1e+30 t_0, would take...steps
cb.simulate(chain, duration=1e-3, every=1e-6) | warm-up and duration would take 1e+08 steps
cb.simulate(chain, average="ensemble", duration=3, every=5) | every must be at most the duration
cb.simulate(chain, time_step=5, method="contact-dynamics") | time_step must be below
cb.simulate(cb.Chain(stiffness=0, damping=0), observe="widths") | give time_step
cb.simulate(chain, observe=[3]) | observe must be one of...got 3
cb.simulate(chain, observe=()) | observe takes a list of names or observers, got ()
cb.simulate(chain, observe="collisions", method="contact-dynamics") | needs single collisions
cb.simulate(chain, observe="impacts", average="ensemble") | 'impacts' is averaged over time only
cb.simulate(cb.Chain(size=1), observe="impacts") | 'impacts' needs a chain of at least 2 rods
cb.simulate(chain, start=3) | start must be a result with position and velocity...got 3
cb.simulate(chain, start=start.assign(V=3.0)) | start of simulate does not read 'V', it reads
cb.simulate(chain, observe=lags(1), every=5, duration=400) | longest lag 1, and snapshots are 5
cb.simulate(chain, observe=lags(1), duration=3, average="ensemble") | neither longest nor lags
cb.simulate(chain, observe="walls") | 'walls' needs a chain between walls, Chain(box=...)
cb.simulate(chain, observe=cb.observers.Density(reach=1e12)) | reach=1e+12 is too large for a grid
cb.simulate(chain, particles=3) | particles must be a list of numbers, got 3
cb.simulate(chain, particles=(3, 2)) | particles must ascend
cb.simulate(chain, replicas=10**12) | would take...GiB of memory, ...GiB are available
cb.simulate(cb.Chain(amplitude=1e20), observe="density") | would take...GiB of memory
cb.equilibrium(cb.Chain(size=10, amplitude=1e-9, gap=1.0)) | lost in the rounding of positions
cb.simulate(chain, start=snapshots) | start is over time; choose one time...isel(time=-1)
cb.simulate(chain, start=start.isel(replica=0)) | start: position must be over replica and particle
cb.simulate(chain.replace(radius=2), start=start) | start must hold rods in order
cb.simulate(six, start=start) | start has 5 rods, the chain 6
cb.simulate(chain, start=start, replicas=3) | start is for replicas=1, got replicas=3
cb.simulate(chain, start=start * np.nan) | finite
cb.given_start(chain, six.anchors) | position must fit...5 rods
cb.given_start(chain, [-4, -2, 0, 1.5, 4]) | do not overlap: rods 3 and 4 of...overlap by 0.5 R
cb.given_start(walled, chain.anchors + 2) | between the walls: their centres lie within 5 of...rod 5
"""

COMBINED = """
cb.combine([run, run_in_a_box]) | of one chain, got ...box=0.0...and ...box=12.0
cb.combine([run, run]) | other seeds, got 0 twice
cb.combine([run, second.isel(particle=[1, 2])]) | runs must have the same particle
cb.combine([run, second.drop_vars("density")]) | no 'density'
cb.combine([exact, run]) | takes results of simulate
cb.combine([cb.smooth(run), cb.smooth(second)]) | before their densities are smoothed
cb.combine([run, 3]) | not a crazybilliards result: 3
cb.combine(run) | runs must be a list of results, ... got a Dataset
cb.combine([]) | runs must be a list
"""

# What does not know walls or two masses refuses them. In a box ``walled`` 12 long, and every second
# of the 5 rods of ``sorts`` is heavier.
UNKNOWN = """
cb.simulate(walled, observe="avalanches") | 'avalanches'...does not know the chain's box
cb.simulate(sorts, observe="triggered-collisions") | does not know the chain's mass_ratio
cb.steady_state(sorts) | does not know the chain's mass_ratio: it must be 1...got 3
cb.critical_size(sorts.replace(restitution=1.1)) | does not know the chain's mass_ratio
cb.breathing_cloud(walled, 1, stretch=0.5) | does not know the chain's box
cb.displaced(walled, 1) | does not know the chain's box
cb.compare_relaxation(sorts, "displaced") | does not know the chain's mass_ratio
cb.comparison.fit_arctanh(walls) | fit_arctanh does not know the chain's box
cb.comparison.fit_border_power_law(walls) | fit_border_power_law does not know the chain's box
"""

# numpy would drop the unit of another library without a word: ``km`` is like those of astropy,
# ``pint`` like those of pint and unyt.
UNITS = """
cb.given_start(chain, km(chain.anchors)) | position must be plain numbers
cb.given_start(chain, [pint(each) for each in chain.anchors]) | position must be plain numbers
cb.given_start(chain, np.array([km(1.0)] * 5, dtype=object)) | position must be plain numbers
cb.given_start(chain, xr.DataArray(chain.anchors, attrs={"units": "km"})) | position must be plain
cb.Chain(radius=km(3.0)) | radius must be plain numbers
cb.Chain(size=pint(3)) | size must be plain numbers
chain.reduced(pint(chain.anchors)) | x must be plain numbers
chain.force(km(chain.anchors)) | displacement must be plain numbers
cb.force_balance(chain, displacement=(pint(chain.anchors), chain.anchors)) | must be plain numbers
cb.force_balance(chain, displacement=lambda x: km(x)) | displacement must be plain numbers
cb.force_balance(chain, velocity_variance=pint(3.0)) | velocity_variance must be plain numbers
cb.hydrodynamics(chain, in_metres, 1.0) | start: density must be plain numbers
fits.fit_exponential([0.1, 0.5, 0.9], [1.0, 2.0, 4.0], [0.1] * 3)(km([0.1, 0.2])) | x must be plain
"""

THEORIES = """
cb.equilibrium_states(chain.replace(restitution=0.8), 4) | chain.replace(restitution=1)
cb.equilibrium(walled.replace(wall_restitution=0.5)) | elastic walls only
cb.hydrodynamics(cb.Chain(size=20), crystal, 60) | spikes of a crystal...force_balance
cb.hydrodynamics(six, cb.displaced(chain, 1), 1) | must add up to the chain's 6 rods, got 5
cb.hydrodynamics(chain, moved.assign(velocity=3.0), 1) | does not read 'velocity'...'flow_velocity'
cb.hydrodynamics(chain, moved.assign(temperature=3.0), 1) | does not read 'temperature', it reads
cb.force_balance(chain, None, exact.velocity_width) | a DataArray must hold its values over x alone
cb.hydrodynamics(six, start, 1) | the result has no 'density'
cb.force_balance(six, displacement=exact) | the result has 5 particles, the chain 6
flow(moved.assign(density=moved.density.roll(x=30))) | its label and...are 1.21
cb.hydrodynamics(chain, foreign, 1) | start: the density must add up to the chain's 5 rods
cb.compare_relaxation(chain, every=1e3) | every must be at most
cb.compare_relaxation(chain, "wave") | a gas of points needs a box=..., and gap=0 or stiffness=0
cb.compare_relaxation(walled, "wave", 2) | height must be from -1 to 1, got 2
cb.compare_relaxation(walled, "gathered", 2) | share must be at most 1, got 2
cb.compare_relaxation(walled.replace(restitution=0.9), "gathered", 0.5) | elastic collisions only
cb.compare_relaxation(walled, "confined", 2) | confined needs a box, and by <= 1, got by=2
cb.compare(chain, {"amplitude": [1, 0]}) | no steady state
cb.compare(chain, {"restitution": [0.9, 0.9 + 1e-8]}) | must differ in their first six digits
cb.compare(chain, 3) | over must be one parameter of the chain and its values...got 3
cb.compare(chain, {"restitution": "0.5"}) | over: restitution must be a list of values, got '0.5'
fits.fit_growth([1, 2, 3], [1, 2]) | time, energy must have
fits.fit_growth([1, 2, np.nan], [1, 2, 3]) | time must be finite, got [1, 2, nan]
fits.fit_growth([1, 1, 1], [1, 2, 3]) | identical
fits.fit_growth([0, 1, 2], [1, -1, 1]) | at least 3 energies
fits.fit_singularity([0, 1], [1, 2]) | at least 5 energies
fits.fit_singularity([1] * 5, [1, 2, 3, 4, 5]) | finite
fits.fit_scaling([2, 2], [1, 3], [1, 1]) | no power law fits
fits.fit_exponential([0, 0.5, 1], [1, 2, 3], [0, 1, 1]) | positive errors
fits.tail_length([1], [1], 0.5) | must ascend
fits.tail_length([1, 3, 2], [1, 1, 1], 0.5) | must ascend
fits.fit_avalanches([4, 2, 1], smallest=10**400) | at least two of the sizes 1000
fits.fit_avalanches([5, 3], smallest=0) | smallest
fits.fit_avalanches([5, 3], smallest=2, largest=1) | largest
fits.fit_avalanches([5, 3, 1], smallest=7) | at least two of the sizes 7 to 3
fits.fit_avalanches([1, 2, 1, 0], smallest=3) | at least two of the sizes 3 to 4
fits.fit_avalanches([5, -3, 2]) | none below 0
"""

PICTURES = """
cb.deviation(exact, exact, "velocity_width") | floor must be a number
cb.deviation(run, run) | not smoothed: take cb.smooth of both, or raw=True
cb.overlay({"a": run.expand_dims(size=[1, 2])}) | density is over (size, x)
cb.overlay({"run": run}, style={"rum": {}}) | style: ...got 'rum'; did you mean 'run'?
cb.overlay(run) | overlay takes results by their labels...got a Dataset
cb.overlay({}) | overlay takes results by their labels...got {}
cb.overlay({"exact": exact, "mine": ([0, 1], [1, 2, 3])}) | mine: overlay takes...two columns
cb.overlay({"exact": exact, "mine": foreign.rename(x="r")}) | same axes, got exact: x; mine: r
cb.overlay({"mine": in_metres.drop_attrs(deep=False)}) | mine: density...not carry a unit
cb.overlay({"mine": ([0, 1], [np.nan, np.nan])}) | mine: density has no number
cb.overlay({"mine": foreign * 1j}) | mine: density must be numbers
cb.film(exact) | run has no snapshots in time, which simulate(chain, observe='snapshots') records
cb.film(snapshots.isel(particle=0)) | no snapshots in time
cb.film(snapshots.drop_vars("velocity")) | no snapshots in time
cb.film(snapshots * np.nan) | no snapshot in which all velocities are known
cb.film(chain, duration=-1) | duration must be positive
cb.film(chain, "rods.avi") | path must end in .mp4, .gif or .html, got rods.avi
cb.film(snapshots, duration=5) | duration is that of a chain to simulate
"""

WRONG_CALLS = [
    line.split(" | ")
    for table in (NAMES, VALUES, RUNS, COMBINED, UNKNOWN, UNITS, THEORIES, PICTURES)
    for line in table.strip().splitlines()
]

# Descriptions of sweeps, and what the message says that refuses each.
SWEEPS = r"""
[grid | not a TOML file
[simulate]\n[steady_state] | one job a sweep
[grid]\nsize = 3 | size must be a list
[grid]\ngap = [3, 3.0] | twice
[grid]\ngap = [0, 1]\n[chain]\ngap = 2 | gap is given twice
[grid]\nbox = [0, 20] | box must be above 200, the length of all rods
[grid]\nmass_ratio = [1, 3]\n[steady_state] | does not know the chain's mass_ratio
[grid]\nrestitution = [0.5]\n[equilibrium] | restitution must be 1
[steady_state]\ncorrelation = false | no argument 'correlation'; did you mean 'correlations'?
"""
WRONG_SWEEPS = [line.replace("\\n", "\n").split(" | ") for line in SWEEPS.strip().splitlines()]
