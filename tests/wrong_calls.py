"""Wrong calls, each with what its message says; ``...`` stands for anything between.

``tests/test_messages.py`` says what the names stand for, and makes the calls.
"""

from wrong_values import SWEEPS, VALUE_TABLES

GAMMA = "\N{GREEK SMALL LETTER GAMMA}"

SYMBOLS = """
cb.Chain(**{GAMMA: 2}) | damping is ... of the paper
cb.Chain(dt=2) | time_step is dt of the paper, an argument of simulate
chain.replace(e=0.9) | restitution is e of the paper
cb.simulate(chain, dt=0.1) | 'dt'; time_step is dt of the paper
cb.simulate(chain, restitution=0.9) | restitution is an argument of Chain
"""

NAMES = """
cb.Chain(restituton=0.9) | Chain has no argument 'restituton'; did you mean 'restitution'?
cb.Chain(nonsense=3) | 'nonsense'; it takes by name size, restitution, amplitude
cb.simulate(chain, chain=chain) | simulate: multiple values for argument 'chain'
cb.Density(-3) | reach must be positive, got -3
cb.simulate(chain, observe=cb.Density(reach=1e12)) | reach=1e+12 is too large for a grid
cb.compare_elastic | any more: compare(chain, {'amplitude': [1, 3, 10, 30]})
cb.animate | any more: film(tree) films what compare_relaxation returns
cb.fit_growth | ; from crazybilliards.reproduction.fits import fit_growth
cb.equilibrium(chain, gap=1) | gap is an argument of Chain
cb.Chain(e=0.8, L=30, sise=3) | arguments 'e' (restitution is e ..., 'L' (size is ..., 'sise' (did
cb.Chain(e=0.8, foo=1) | arguments 'e' (restitution is e ..., 'foo'; it takes by name size, rest
chain.replace(e=0.8, g=1) | got 'e' (restitution is e of the paper), 'g' (gap is g of the paper)
"""

# Words for which the nearest name is the wrong one, or is far away.
WORDS = """
cb.Chain(N=30) | 'N'; did you mean 'size'?
cb.Chain(coefficient_of_restitution=0.8) | did you mean 'restitution'?
cb.Chain(temperature=1) | amplitude^2/(2 damping) is the temperature
cb.Chain(T=1) | 'T'; it takes by name size
cb.Chain(masses=[1, 2]) | mass_ratio is the mass of every second rod
cb.Chain(walls=True) | box is the distance between two walls
cb.Chain(ring=True) | a chain is no ring: its ends are free, or in a box
cb.Chain(wall_temperature=2) | walls have no temperature
cb.simulate(chain, heat=1) | walls have no temperature
cb.simulate(chain, box=12) | box is an argument of Chain
cb.Chain(e_w=0.5) | did you mean 'wall_restitution'?
cb.Chain(duration=3) | duration is an argument of simulate
cb.Chain(t_max=3) | 't_max'; it takes by name size
cb.simulate(chain, time=3) | did you mean 'duration'?
cb.simulate(chain, steps=3) | did you mean 'duration'?
cb.simulate(chain, T=3) | did you mean 'duration'?
cb.simulate(chain, n=3) | size is an argument of Chain
cb.hydrodynamics(chain, exact, 1, frame="lagrangian") | did you mean 'label'?
cb.TimeCorrelations(every=3) | every is an argument of simulate
cb.overlay({"a": run}, "W_v") | did you mean 'velocity_width'?
cb.simulate(chain, observe="positions") | 'snapshots' gives 'position'
cb.simulate(chain, observe="trajectory") | did you mean 'snapshots'?
cb.simulate(chain, observe="velocity_autocorrelation") | 'time-correlations' gives 'velocity_auto
cb.simulate(chain, observe="all") | 'widths') or a list of them, got 'all'
cb.run | did you mean 'simulate'?
cb.plot | did you mean 'overlay'?
cb.Observer | from crazybilliards.particles.observers.base import Observer
"""

ATTRIBUTES = """
chain.e | 'Chain' object has no attribute 'e'; restitution is e of the paper
chain.dt | time_step is dt of the paper, an argument of simulate
chain.N | did you mean 'size'?
chain.W | did you mean 'free_velocity_width'?
chain.positions | did you mean 'anchors'?
chain.restituton | did you mean 'restitution'?
chain.simulate(100) | crazybilliards.simulate(chain, ...) is a function
chain.run(100) | crazybilliards.simulate(chain, ...) is a function
chain.theories() | crazybilliards.theories(chain, ...) is a function
chain.copy(size=3) | did you mean 'replace'?
"""

# The right name, with the wrong kind of thing.
KINDS = """
cb.simulate(chain, observe=cb.Density) | got <class ...Density() makes one
cb.simulate(chain, observe=[cb.Density]) | Density() makes one
cb.load(".") | a folder, not a file; load_sweep reads
cb.load_sweep("no/folder") | there is no such folder; load_sweep takes the folder
cb.load_sweep(cb.__file__) | a file, not a folder; load_sweep takes the folder
cb.overlay({"a": run.expand_dims(size=[1, 2])}) | density is over (size, x); overlay draws what is over one
cb.deviation(exact, exact, "velocity_width") | floor must be a number...densities only
cb.film(snapshots, duration=5) | duration is that of a chain to simulate
cb.equilibrium_states(chain.replace(restitution=0.8), 4) | chain.replace(restitution=1)
"""

TYPES = """
cb.best_theory(cb.Chain(), "W_v") | quantity must be one of ...got 'W_v'
cb.chain_of(tree) | must be a result...tree['name'].to_dataset()...got a DataTree
cb.chain_of(foreign) | not a crazybilliards result
cb.deviation(foreign, foreign) | not a crazybilliards result
cb.deviation(exact, exact, floor="a") | floor must be a number, got 'a'
cb.deviation(run, exact, "velocity_width") | deviation compares densities only; for widths divide
cb.deviation(exact, exact, [1]) | floor must be a number, got [1]
cb.deviation(run, run) | not smoothed: take cb.smooth of both, or raw=True
cb.smooth(run.sel(x=slice(-1, 1))) | of the chain's 5 rods: smooth needs the whole grid
cb.fit_arctanh(foreign) | the result has no 'mean_displacement'
cb.fit_arctanh(exact.isel(particle=slice(2))) | fit_arctanh: the result has 2 particles, the chain 5
cb.fit_arctanh(exact.isel(particle=slice(None, None, -1))) | must ascend from 1 to 5
cb.fit_border_power_law(run.isel(particle=[0, 2, 1, 3, 4])) | must ascend from 1 to 5
cb.force_balance(chain, displacement=exact.sortby("particle", ascending=False)) | must ascend from
cb.rod_by_rod(cb.force_balance(chain).isel(particle=slice(None, None, -1))) | must ascend from
cb.fit_border_power_law(foreign) | the result has no 'velocity_width'
cb.overlay([run]) | overlay takes results by their labels...got a list
cb.overlay(run) | overlay takes results by their labels...got a Dataset
cb.overlay({"a": 3}) | a: not a crazybilliards result: 3
cb.overlay({"a": run}, "widths") | has no 'widths'
cb.overlay({"a": exact}, "mean_displacement", along="x") | along must be one of...'mean_position'
cb.overlay({"run": run}, style={"rum": {}}) | style: ...got 'rum'; did you mean 'run'?
cb.save(run, 3) | path must be a text or a Path, got 3
cb.save(run, "a.csv") | must end in .nc, got 'a.csv'
cb.load(3) | path must be a text or a Path, got 3
cb.simulate(chain, start=3) | start must be a result with position and velocity...got 3
cb.simulate(chain, start=exact) | start must be a result with position and velocity...given_start
cb.simulate(chain, observe=[cb.Density]) | observe takes names and observers, got <class
cb.simulate(chain, observe=np.array(2.0)) | observe takes a list of names or observers, got array(2.
cb.simulate(chain, particles=np.array(2.0)) | particles must be a list of numbers, got array(2.
cb.simulate(chain, particles=3) | particles must be a list of numbers, got 3
cb.relax_phase_space(chain, xr.Dataset(), 1) | no 'density'
cb.hydrodynamics(chain, foreign, 1) | start: the density must add up to the chain's 5 rods
cb.force_balance(chain, displacement=3) | displacement takes a table (x, values)...got 3
cb.film(exact) | run has no snapshots in time, which simulate(chain, observe='snapshots') records
cb.film(chain, "rods.avi") | path must end in .mp4, .gif or .html, got rods.avi
cb.compare(chain, 3) | over must be one parameter of the chain and its values...got 3
cb.compare(chain, {"restitution": "0.5"}) | over: restitution must be a list, got '0.5'
cb.compare(chain, {"amplitude": np.array(3.0)}) | over: amplitude must be a list, got array(3.
cb.compare(chain, {"amplitude": [1], "gap": [0]}) | over must be one parameter
cb.compare(chain, {"e": [0.9]}) | restitution is e of the paper
fits.fit_scaling("a", [1], [1]) | x must be numbers, got 'a'
fits.fit_scaling([1, 2, 3], [1, 2], [1, 1]) | x, y, error must have one dimension and the same
fits.fit_exponential([1, 2, 3], [1, 2], [1, 1]) | restitution, y, error must have
fits.fit_growth([1, 2, 3], [1, 2]) | time, energy must have
fits.fit_singularity([1, 2, 3], {}) | energy must be numbers, got {}
fits.fit_growth([1, 2, np.nan], [1, 2, 3]) | time must be finite, got [1, 2, nan]
cb.fit_border_power_law(run, weighted="no") | weighted must be True or False; got 'no'
cb.simulate(chain, progress=np.zeros(3)) | progress must be True or False, or a text; got array
fits.fit_avalanches([4, 2, 1], smallest=10**400) | no avalanches of sizes 1000
cb.Chain(restitution=np.ma.masked) | restitution must be a number, got masked
fits.fit_avalanches(3) | count must have one dimension
fits.tail_length([1, 2], [1], 3) | velocity, density must have
fits.tail_length([1, 2, 3], [1, 1, 1], "a") | beyond must be a number, got 'a'
"""

STARTS = """
cb.simulate(chain, start=cb.given_start(six, six.anchors)) | start has 6 rods, the chain 5
cb.simulate(six, start=start) | start has 5 rods, the chain 6
cb.simulate(chain, start=snapshots) | start is over time; choose one time...isel(time=-1)
cb.simulate(chain, start=start, replicas=3) | start is for replicas=1, got replicas=3
cb.simulate(chain, start=start.isel(replica=0)) | start: position must be over replica and particle
cb.simulate(chain, start=some.isel(time=-1)) | start has 2 rods, the chain 5
cb.given_start(chain, six.anchors) | position must fit...5 rods
cb.given_start(chain, [0, 1, 2, 3, 4]) | do not overlap
cb.given_start(chain, [0, 3, np.nan, 6, 9]) | finite
cb.given_start(chain, chain.anchors, [1, 2]) | velocity must fit
cb.simulate(chain, start=start.drop_vars("velocity")) | position and velocity
cb.simulate(chain, start=start.assign(position=-start.position)) | in order
cb.simulate(chain, start=start * np.nan) | finite
cb.given_start(chain, chain.anchors, "1") | velocity must be numbers, got '1'
cb.given_start(chain, chain.anchors, np.datetime64("2020-01-01")) | velocity must be numbers
cb.given_start(chain, chain.anchors, np.ma.masked_less(range(5), 2)) | velocity must be numbers
cb.given_start(chain, "a") | position must be numbers, got 'a'
cb.relax_phase_space(cb.Chain(size=20), crystal, 60) | spikes of a crystal...force_balance
"""

WRONG_CALLS = [
    line.split(" | ")
    for table in (SYMBOLS, NAMES, WORDS, ATTRIBUTES, KINDS, TYPES, STARTS, *VALUE_TABLES)
    for line in table.strip().splitlines()
]

# A description of a sweep, and what the message says that refuses it.
WRONG_SWEEPS = [line.split(" |") for line in SWEEPS.strip().splitlines()]
