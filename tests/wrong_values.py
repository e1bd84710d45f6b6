r"""Wrong values, as in ``wrong_calls.py``: a call and what its message says."""

VALUES = """
cb.simulate(chain, duration=5, every=1.0) | duration must be at least...average='ensemble'
cb.Chain(size=2.5) | size must be an integer
cb.Chain(amplitude=1e-80) | amplitude must be between 1e-60 and 1e60 in magnitude, or 0, got 1e-80
cb.Chain(mass=0) | mass must be positive, got 0
cb.Chain(size=6, box=12) | box must be above 12, the length of all rods, or 0...got 12
cb.Chain(size=6, box=20, radius=2) | box must be above 24
chain.replace(box=-1) | box must be 0 or more, got -1
cb.Chain(wall_restitution=0.5) | without walls it must be 1; box=... gives a chain two walls
cb.Chain(box=300, wall_restitution=-1) | wall_restitution must be 0 or more, got -1
cb.Chain(mass_ratio=0) | mass_ratio must be positive, got 0
cb.Chain(spring="lineer") | spring must be one of...got 'lineer'; did you mean 'linear'?
checks.check_choice("name", "bleu", ("blue", "red")) | one of ('blue', 'red'), got 'bleu'...'blue'?
cb.simulate(chain, seed=[1, 2]) | a Generator of numpy...got [1, 2]
cb.equilibrium_states(chain, 3, seed="a") | a Generator of numpy...got 'a'
cb.simulate(chain, seed=10**5000) | seed must be...up to 4096 bits...got a number of 16610 bits
cb.Chain(amplitude=10**5000) | amplitude must be between...got a number of 16610 bits
cb.compare_relaxation(chain, "dropped") | release must be one of
cb.compare_relaxation(chain, by=-1) | by must be
cb.compare_relaxation(chain, duration=-1) | duration must be
cb.compare_relaxation(chain, every=1e3) | every must be at most
cb.compare_relaxation(chain, replicas=1) | replicas must be
cb.compare_relaxation(chain.replace(restitution=0.5)) | elastic collisions only
cb.compare_relaxation(chain, "wave") | a gas of points needs a box=..., and gap=0 or stiffness=0
cb.compare_relaxation(chain, "confined") | confined needs a box, and by <= 1
cb.hydrodynamics(chain, exact, 1, frame="labels") | did you mean 'label'?
"""

SIMULATIONS = """
cb.simulate(chain, duration=0) | duration must be
cb.simulate(chain, duration=1e30) | too small
cb.simulate(chain, duration=1e-3, every=1e-6) | warm-up and duration would take 1e+08 steps
cb.simulate(chain, warmup=-1) | warmup must be
cb.simulate(chain, time_step=0) | time_step must be
cb.simulate(chain, time_step=5, method="contact-dynamics") | time_step must be below
cb.simulate(cb.Chain(stiffness=0, damping=0), observe="widths") | give time_step
cb.simulate(chain, stepper="leapfrog") | stepper must be one of
cb.simulate(chain, method="magic") | method must be one of
cb.simulate(chain, merging=-1) | merging must be
cb.simulate(chain, seed=1.5) | seed must be
cb.simulate(chain, replicas=0) | replicas must be
cb.simulate(chain, threads=0) | threads must be
cb.simulate(chain, observe=("widths", "colour")) | observe takes any of
cb.simulate(chain, observe="width") | did you mean 'widths'?
cb.simulate(chain, observe=()) | observe must name
cb.simulate(chain, observe="collisions", method="contact-dynamics") | needs single collisions
cb.simulate(chain, observe="impacts", method="contact-dynamics") | single collisions, which only
cb.simulate(chain, observe="impacts", average="ensemble") | 'impacts' is averaged over time only
cb.simulate(cb.Chain(size=1), observe="impacts") | 'impacts' needs a chain of at least 2 rods
cb.simulate(cb.Chain(size=1), observe="covariances") | 'covariances' needs...at least 2 rods
cb.simulate(cb.Chain(damping=0), observe="velocities") | 'velocities' needs
cb.Covariances(separations=0) | separations must be
cb.Velocities(bins=0) | bins must be an integer
cb.Impacts(bins=0) | bins must be an integer
cb.simulate(chain, observe="walls") | 'walls' needs a chain between walls, Chain(box=...)
cb.simulate(walled, observe="walls", method="contact-dynamics") | 'walls' needs single collisions
cb.simulate(walled, observe="walls", average="ensemble") | 'walls' is averaged over time only
cb.simulate(walled, observe="avalanches") | 'avalanches'...does not know the chain's box
cb.simulate(sorts, observe="triggered-collisions") | does not know the chain's mass_ratio
cb.simulate(chain, particles="12") | particles must be a list
cb.simulate(chain, particles=(6,)) | particles must ascend
cb.simulate(chain, particles=(3, 2)) | particles must ascend
cb.simulate(chain, average="both") | average must be one of
cb.simulate(chain, average="ensemble", observe="velocities") | not over an ensemble
cb.simulate(chain, average="ensemble", duration=3, every=5) | every must be at most the duration
cb.simulate(chain, average="ensemble", duration=3, observe="snapshots", every=1e-30) | too small
cb.simulate(chain, average="ensemble", duration=5.0, every=1e-9) | every = 1e-09 is too small
cb.simulate(chain, average="ensemble", duration=1e8, every=1e-3, observe="snapshots") | GiB
cb.simulate(cb.Chain(size=10**9), replicas=10**9) | would take...GiB of memory
cb.simulate(chain, replicas=10**12) | would take...GiB of memory
cb.simulate(cb.Chain(size=10**7), observe="velocities") | would take...GiB of memory
cb.given_start(chain, 0.0, replicas=10**12) | would take...GiB of memory
cb.equilibrium_states(chain, 10**12) | would take...GiB of memory
"""

# The walls of ``walled`` are 12 apart, and every second of the 5 rods of ``sorts`` is heavier.
WALLS = """
cb.given_start(walled, chain.anchors + 2) | between the walls: their centres lie within 5 of
cb.simulate(walled, start=cb.given_start(chain, chain.anchors - 2)) | between the walls
cb.equilibrium(walled.replace(wall_restitution=0.5)) | elastic walls only
cb.phase_space(walled) | does not know the chain's box: it must be 0...got 12
cb.critical_size(sorts.replace(restitution=1.1)) | does not know the chain's mass_ratio
cb.breathing_cloud(walled, 1, stretch=0.5) | does not know the chain's box
cb.displaced(walled, 1) | does not know the chain's box
cb.compare_relaxation(walled) | release='compressed' does not know the chain's box
cb.compare_relaxation(sorts, "displaced") | does not know the chain's mass_ratio
cb.compare_relaxation(walled.replace(wall_restitution=0.5), "wave") | elastic walls only
cb.compare_relaxation(walled, "wave", 2) | height must be from -1 to 1, got 2
cb.compare_relaxation(walled, "gathered", 2) | share must be at most 1, got 2
cb.compare_relaxation(walled, "confined", 2) | confined needs a box, and by <= 1, got by=2
cb.fit_arctanh(walls) | fit_arctanh does not know the chain's box
cb.fit_border_power_law(walls) | fit_border_power_law does not know the chain's box
"""

CASES = """
Case("simulation", chain, {}) | job must be one of
Case("simulate", chain, {"length": 3}) | simulate takes any of
Case("simulate", chain, {"duration": -1}) | duration must be
Case("simulate", chain, {"duration": {"a": 1}}) | plain value
cb.Sweep({"restitution": [0.3, 0.1 + 0.2]}) | grid: restitution holds 0.3 twice
cb.Sweep({"restitution": np.eye(2)}) | grid: restitution must be a list of values, got array([[1.
cb.Sweep({"restitution": {"a": 1}}) | grid: restitution must be a list of values, got {'a': 1}
cb.Sweep({"spring": "linear"}) | grid: spring must be a list of values, got 'linear'
cb.Sweep([1, 2]) | grid must be a dict, as {'size': ...}, got [1, 2]
cb.Sweep({}, chain=chain) | chain must be a dict, as {'size': ...}, got Chain(
cb.Sweep({"e": [1]}) | restitution is e of the paper
cb.process_pool(0) | processes must be an integer >= 1, got 0
cb.run_cases(cb.Sweep({}), "a", None) | executor must be one, as in with process...got None
cb.run_cases({"size": [3]}, "a", Executor()) | cases must be a Sweep or a list of Case, got {'size'
cb.run_cases(3, "a", Executor()) | cases must be a Sweep or a list of Case, got 3
cb.run_cases([], 3, Executor()) | folder must be a text or a Path, got 3
cb.sweep | did you mean 'Sweep'?
"""

# Descriptions of sweeps, as texts in quotes.
SWEEPS = r"""
"[grid" | not a TOML file
b"\xff\xfe" |
b"\x00" |
"grid = 3" | must be a table
"[grids]\nsize = [1]" | got 'grids'; did you mean 'grid'?
"[simulate]\n[phase_space]" | one job a sweep
"[grid]\nsize = 3" | size must be a list
"[grid]\ngap = [3, 3.0]" | twice
"[grid]\nbox = [0, 20]" | box must be above 200, the length of all rods
"[grid]\nmass_ratio = [1, 3]\n[phase_space]" | does not know the chain's mass_ratio
"[grid]\nsize = [3, -1]" | size must be an integer
"[grid]\ndamping = [1.0, 2.0]\n[chain]\ndamping = 2.0" | given twice
"[grid]\namplitude = [nan]" | amplitude must be
f"[grid]\namplitude = [{10**400}]" | amplitude must be
"[grid]\nlength = [1, 2]" | [grid] takes...'gap'...'duration'...got 'length'
f"[grid]\nseed = {[*range(2000)]}\ngap = {[*range(2000)]}" | 4000000 cases
f"[grid]\nseed = {[*range(999)]}\ngap = {[*range(999)]}\nsize = {[*range(1, 999)]}" | cases
"[chain]\nname = 1" | Chain takes any of...'size'...got 'name'
"[simulate]\ndurations = 1" | takes any of...did you mean 'duration'
"[simulate]\nstart = 1" | got 'start'
"[simulate]\naverage = ['time']" | average must be
"[phase_space]\ncell = 3" | [phase_space] takes any of...did you mean 'cells'?
"[grid]\nrestitution = [0.5]\n[equilibrium]" | restitution must be 1
"[grid]\nsize = " + "[" * 5000 | not a TOML file
f"[grid]\n'{GAMMA}' = [0.5]" | damping is ... of the paper
"[simulate]\ndt = 1" | [simulate] takes any of ... time_step is dt of the paper
"""

VALUE_TABLES = (VALUES, SIMULATIONS, WALLS, CASES)
