r"""Wrong values, as in ``wrong_calls.py``: a call and what its message says."""

VALUES = """
cb.simulate(chain, duration=5, every=1.0) | duration must be at least...average='ensemble'
cb.Chain(size=0) | size must be an integer...got 0
cb.Chain(size=-3) | size must be an integer...got -3
cb.Chain(size=2.0) | size must be an integer...got 2.0
cb.Chain(size=2.5) | size must be an integer
cb.Chain(size=True) | size must be an integer...got True
cb.Chain(size="ten") | size must be an integer...got 'ten'
cb.Chain(size=10**10) | size must be an integer...got 10000000000
cb.Chain(size=np.array([3])) | size must be an integer
cb.Chain(restitution=-0.1) | restitution must be 0 or more, got -0.1
cb.Chain(restitution=np.nan) | restitution must be finite, got nan
cb.Chain(amplitude=np.inf) | amplitude must be finite, got inf
cb.Chain(amplitude=1e-80) | amplitude must be between 1e-60 and 1e60 in magnitude, or 0, got 1e-80
cb.Chain(amplitude=10**400) | between 1e-60 and 1e60
cb.Chain(damping=-1) | damping must be 0 or more, got -1
cb.Chain(stiffness=None) | stiffness must be a number, got None
cb.Chain(stiffness=1j) | stiffness must be a number, got 1j
cb.Chain(mass=0) | mass must be positive, got 0
cb.Chain(mass=-1) | mass must be positive, got -1
cb.Chain(mass=1e70) | mass must be between 1e-60 and 1e60 in magnitude, got 1e+70
cb.Chain(radius=0) | radius must be positive, got 0
cb.Chain(gap=-1e-9) | gap must be 0 or more, got -1e-09
cb.Chain(gap="1") | gap must be a number, got '1'
cb.Chain(gap=True) | gap must be a number, got True
cb.Chain(gap=np.array([1.0])) | gap must be a number, got array([1.])
cb.Chain(gap=np.array(-1.0)) | gap must be 0 or more
cb.Chain(spring="lineer") | spring must be one of...got 'lineer'; did you mean 'linear'?
cb.Chain(spring=3) | spring must be...got 3
cb.Chain(spring=["linear"]) | spring must be...got ['linear']
chain.replace(gap=-1) | gap must be 0 or more
checks.check_choice("name", "bleu", ("blue", "red")) | one of ('blue', 'red'), got 'bleu'...'blue'?
checks.check_choice("name", "xyz", ("blue", "red")) | one of ('blue', 'red'), got 'xyz'
cb.simulate(chain, seed=np.random.RandomState(0)) | seed must be an integer...a Generator
cb.simulate(chain, seed=[1, 2]) | a Generator of numpy...got [1, 2]
cb.equilibrium_states(chain, 3, seed="a") | a Generator of numpy...got 'a'
cb.simulate(chain, seed=10**5000) | seed must be...up to 4096 bits...got a number of 16610 bits
cb.Chain(amplitude=10**5000) | amplitude must be between...got a number of 16610 bits
cb.simulate(chain, rng=1) | seed takes what rng took
cb.simulate(chain, observe=Unknown()) | observe: 'unknown' gives 'my_variable', which has no
cb.compare_relaxation(chain, "dropped") | release must be one of
cb.compare_relaxation(chain, by=-1) | by must be
cb.compare_relaxation(chain, duration=-1) | duration must be
cb.compare_relaxation(chain, every=1e3) | every must be at most
cb.compare_relaxation(chain, replicas=1) | replicas must be
cb.compare_relaxation(chain.replace(restitution=0.5)) | elastic chains
cb.hydrodynamics(chain, exact, 1, frame="labels") | did you mean 'label'?
"""

SIMULATIONS = """
cb.simulate(chain, duration=0) | duration must be
cb.simulate(chain, duration=np.nan) | duration must be
cb.simulate(chain, duration=1) | duration must be at least
cb.simulate(chain, duration=1e30) | too small
cb.simulate(chain, duration=5.0, warmup=0.0, every=1e-9) | every = 1e-09 is too small
cb.simulate(chain, duration=1e-3, every=1e-6) | warm-up and duration would take 1e+08 steps
cb.simulate(chain, warmup=-1) | warmup must be
cb.simulate(chain, time_step=0) | time_step must be
cb.simulate(chain, time_step=5, method="contact-dynamics") | time_step must be below
cb.simulate(cb.Chain(stiffness=0, damping=0), observe="widths") | give time_step
cb.simulate(chain, stepper="leapfrog") | stepper must be one of
cb.simulate(chain, method="magic") | method must be one of
cb.simulate(chain, method="event_driven") | did you mean 'event-driven'?
cb.simulate(chain, merging=-1) | merging must be
cb.simulate(chain, seed=-1) | seed must be
cb.simulate(chain, seed=1.5) | seed must be
cb.simulate(chain, replicas=0) | replicas must be
cb.simulate(chain, threads=0) | threads must be
cb.simulate(chain, observe=("widths", "colour")) | observe takes any of
cb.simulate(chain, observe="width") | did you mean 'widths'?
cb.simulate(chain, observe=()) | observe must name
cb.simulate(chain, observe=None) | observe takes
cb.simulate(chain, observe=True) | observe takes
cb.simulate(chain, observe=[["widths"]]) | observe takes
cb.simulate(chain, observe=[3]) | observe takes
cb.simulate(chain, observe="collisions", method="contact-dynamics") | needs single collisions
cb.simulate(chain, observe="impacts", method="contact-dynamics") | single collisions, which only
cb.simulate(chain, observe="impacts", average="ensemble") | 'impacts' is averaged over time only
cb.simulate(cb.Chain(size=1), observe="impacts") | 'impacts' needs a chain of at least 2 rods
cb.simulate(cb.Chain(size=1), observe="covariances") | 'covariances' needs...at least 2 rods
cb.simulate(cb.Chain(damping=0), observe="velocities") | 'velocities' needs
cb.Covariances(separations=0) | separations must be
cb.Velocities(bins=0) | bins must be an integer
cb.simulate(chain, particles="12") | particles must be a list
cb.simulate(chain, particles=True) | particles must be a list
cb.simulate(chain, particles=()) | particles must
cb.simulate(chain, particles=(0,)) | particles must
cb.simulate(chain, particles=(6,)) | particles must ascend
cb.simulate(chain, particles=(3, 2)) | particles must ascend
cb.simulate(chain, particles=(1.5,)) | particles must
cb.simulate(chain, average="both") | average must be one of
cb.simulate(chain, average="ensemble", observe="velocities") | not over an ensemble
cb.simulate(chain, average="ensemble", duration=3, every=5) | every must be at most the duration
cb.simulate(chain, average="ensemble", duration=3, every=0) | every must be
cb.simulate(chain, average="ensemble", duration=3, observe="snapshots", every=1e-30) | too small
cb.simulate(chain, average="ensemble", duration=5.0, every=1e-9) | every = 1e-09 is too small
cb.simulate(chain, average="ensemble", duration=1e-9, warmup=1e2) | every = 1e-11 is too small
cb.simulate(chain, average="ensemble", duration=1e8, every=1e-3, observe="snapshots") | GiB
cb.simulate_limit(chain, accuracy=0) | accuracy must be
cb.simulate_limit(chain, accuracy=0.5) | accuracy must lie between 1e-4 and 0.1
cb.simulate_limit(chain, replicas=0) | replicas must be
cb.simulate_limit(chain, warmup=-1.0) | warmup must be
cb.simulate_limit(chain, observe="density") | observe must name 'widths'
cb.simulate_limit(chain, observe=("widths", "snapshots")) | 'snapshots' has no limit
cb.simulate_limit(chain, observe=("widths", "collisions")) | 'collisions' has no limit
cb.simulate_limit(chain, observe=("widths", "avalanches")) | 'avalanches' has no limit
cb.simulate_limit(chain, observe=("widths", "triggered-collisions")) | has no limit
cb.simulate_limit(chain, observe=("widths", "impacts")) | single collisions, unrecorded
cb.simulate_limit(chain, particles=[99]) | particles must ascend
cb.simulate_limit(cb.Chain(amplitude=0)) | needs damping and amplitude
cb.simulate_limit(cb.Chain(damping=0)) | needs damping and amplitude
cb.simulate_limit(cb.Chain(size=3_000_000), observe=("widths", "velocities")) | GiB
cb.simulate(cb.Chain(size=10**9), replicas=10**9) | would take...GiB of memory
cb.simulate(chain, replicas=10**12) | would take...GiB of memory
cb.simulate(cb.Chain(size=10**7), observe="avalanches") | would take...GiB of memory
cb.simulate(cb.Chain(size=10**7), observe="velocities") | would take...GiB of memory
cb.given_start(chain, 0.0, replicas=10**12) | would take...GiB of memory
cb.equilibrium_states(chain, 10**12) | would take...GiB of memory
"""

CASES = """
Case("simulation", chain, {}) | job must be one of
Case("simulat", chain, {}) | did you mean 'simulate'?
Case("simulate", chain, {"length": 3}) | simulate takes any of
Case("simulate", chain, {"duration": -1}) | duration must be
Case("simulate", chain, {"duration": {"a": 1}}) | plain value
Case("simulate", chain, {"observe": ["heat"]}) | observe takes any of
Case("simulate_limit", chain, {"accuracy": 2}) | accuracy must lie between
Case("simulate_limit", chain, {"duration": 100}) | simulate_limit takes any of
Case("phase_space", chain, {"duration": 1}) | phase_space takes any of
Case("phase_space", chain, {"cells": 10**6}) | cells
"""

# Descriptions of sweeps, as texts in quotes.
SWEEPS = r"""
"[grid" | not a TOML file
b"\xff\xfe" |
b"\x00" |
"grid = 3" | must be a table
"[grids]\nsize = [1]" | got 'grids'; did you mean 'grid'?
"[simulates]" | did you mean 'simulate'?
"[simulate]\n[phase_space]" | one job a sweep
"[grid]\nsize = 3" | size must be a list
"[grid]\nsize = []" | size must be a list
"[grid]\nsize = [1979-05-27]" | size
"[grid]\ngap = [3, 3.0]" | twice
"[grid]\nsize = ['3']" | size must be an integer
"[grid]\nsize = [3, -1]" | size must be an integer
"[grid]\nsize = [true]" | size must be an integer
"[grid]\ndamping = [1.0, 2.0]\n[chain]\ndamping = 2.0" | given twice
"[grid]\namplitude = [nan]" | amplitude must be
f"[grid]\namplitude = [{10**400}]" | amplitude must be
"[grid]\nlength = [1, 2]" | [grid] takes...'gap'...'duration'...got 'length'
"[grid]\nrestituton = [1]" | 'size'...got 'restituton'; did you mean 'restitution'
"[grid]\nobserve = [5]" | observe
"[grid]\nparticles = [5]" | particles
f"[grid]\nseed = {[*range(2000)]}\ngap = {[*range(2000)]}" | 4000000 cases
f"[grid]\nseed = {[*range(999)]}\ngap = {[*range(999)]}\nsize = {[*range(1, 999)]}" | cases
"[chain]\nsize = 'x'" | size must be
"[chain]\nname = 1" | Chain takes any of...'size'...got 'name'
"[chain]\nrestituton = 1" | got 'restituton'; did you mean 'restitution'
"[simulate]\ndurations = 1" | takes any of...did you mean 'duration'
"[simulate]\nduration = 'long'" | duration must be
"[simulate]\nobserve = 3" | observe takes
"[simulate]\nstart = 1" | got 'start'
"[simulate]\nthreads = 1" | got 'threads'
"[simulate]\ncheckpoint = 'state'" | got 'checkpoint'
"[simulate]\naverage = ['time']" | average must be
"[phase_space]\ncell = 3" | [phase_space] takes any of...did you mean 'cells'?
"[phase_space]\ncells = 'x'" | cells must be
"[phase_space]\ntolerance = -1" | tolerance must be
"[grid]\nrestitution = [0.5]\n[equilibrium]" | restitution must be 1
"[grid]\nrestitution = [0.5]\n[force_balance]" | restitution must be 1
"[grid]\nsize = " + "[" * 5000 | not a TOML file
"[grid]\ne = [0.5, 0.9]" | [grid] takes any of ... got 'e'; restitution is e of the paper
f"[grid]\n'{GAMMA}' = [0.5]" | damping is ... of the paper
"[chain]\ngamma = 1" | Chain takes any of ... damping is gamma of the paper
"[simulate]\ndt = 1" | [simulate] takes any of ... time_step is dt of the paper
"[simulate]\nL = 1" | takes any of ... size is L of the paper, an argument of Chain
"""

VALUE_TABLES = (VALUES, SIMULATIONS, CASES)
