"""What theories refuse, as ``wrong_calls.py`` says it of other calls."""

STATIONARY = """
equilibrium(Chain(size=10**6)) | would take ... GiB
equilibrium_states(Chain(), 0) | replicas must be
steady_state(thirty.replace(box=70.0, wall_restitution=0.0)) | walls that do not absorb
steady_state(Chain(size=10**6)) | size must be at most 100000, got 1000000
steady_state(Chain(size=160, restitution=1.05, damping=4.0)) | could be found: collisions give more
steady_state(Chain(size=95, restitution=1.2, damping=12.5)) | too heavy for the grid
steady_state(thirty.replace(restitution=1.3)) | no steady state
steady_state(thirty.replace(restitution=1e60)) | a restitution of at most 1e+06, got 1e+60
critical_size(Chain(restitution=1.0)) | every size has a steady state
critical_size(Chain(restitution=1.05, spring="quadratic")) | quadratic
critical_size(Chain(restitution=1.05, damping=0)) | damping=0
critical_size(Chain(restitution=1.05, damping=50)) | sqrt(k m) = ... is too strong...up to 10
"""

FORCE_BALANCE = """
force_balance(Chain(restitution=0.5)) | restitution must be 1, got 0.5; give velocity_variance
force_balance(Chain(), velocity_variance=-1) | velocity_variance must be
force_balance(Chain(), ([0, 1], [1])) | equally long
force_balance(Chain(), ([1, 0], [1, 2])) | ascending
force_balance(Chain(), ([0, 1], [1, np.nan])) | finite
force_balance(Chain(), lambda x: -x) | does not hold the rods together
force_balance(Chain(), lambda x: np.arctanh(x)) | not finite at x =
force_balance(Chain(), lambda x: 0.3 * x, lambda x: 1.0) | cannot be given together
force_balance(chain, lambda x: "one") | displacement: the callable must return a number for each x
force_balance(chain, None, lambda x: "one") | velocity_variance: the callable must return a number
force_balance(chain, None, lambda x: -1.0) | finite and positive
force_balance(chain, None, "abc") | velocity_variance takes
force_balance(chain.replace(spring="quadratic"), None, lambda x: 1.0) | linear springs
force_balance(boxed.replace(wall_restitution=0.5)) | elastic walls only
force_balance(boxed.replace(stiffness=0), lambda x: x) | without springs it has no effect
"""

# A duration in the place of the start is the usual mistake.
IN_TIME = """
flow(100.0) | start must be a result with density over x...displaced(...compressed(...force_balance
flow(duration=0) | duration must be
flow(every=100) | every must be at most
flow(every=1e-9) | outputs
flow(frame="polar") | frame must be one of
flow(displacement="magic") | displacement takes a table
flow(displacement=([0, 1], [1, 2])) | needs frame='eulerian'
flow(velocity_variance="cold") | velocity_variance must be None, 'evolving', a number
flow(velocity_variance=lambda x: 1.0) | needs frame='eulerian'
flow(velocity_variance=lambda x: -1.0, frame="eulerian") | finite and positive
flow(cells=2) | cells must be
flow(cells=10**8) | at most 100000
flow(frame="eulerian", cells=10**5, duration=1e4) | use frame='label'
flow(chain=chain.replace(restitution=0.5)) | restitution must be 1
flow(moved.assign(density=2 * moved.density)) | overlap
flow(moved.drop_vars("label").assign(density=0.5 * moved.density)) | add up to the chain's 5
flow(moved.assign(density=-moved.density)) | not negative
flow(moved.assign(flow_velocity=moved.flow_velocity * np.nan)) | flow_velocity
flow(moved.assign(velocity_variance=-moved.velocity_variance)) | positive
flow(moved.drop_vars("x")) | no coordinate 'x'
flow(moved.astype(str)) | must be numbers
flow(displaced(dense, 1.0), dense, 1.0, every=1e-6) | would take ... GiB of memory
flow(displaced(wide, 0.5), wide, frame="eulerian", cells=100) | wide, 0.5 at most ...give cells=613
flow(displaced(dense, 0.5), dense, frame="eulerian") | wide, 0.5 at most ...use frame='label'
flow(compressed(twenty, 5e-4), twenty, duration=1) | too steep
flow(inward, twenty, duration=0.01, every=0.001) | collapses to less than
flow(displaced(twenty, 1.0), twenty, frame="eulerian", cells=60) | give cells=
flow(displaced(chain, 200.0), frame="eulerian") | up to ... times the free velocity...frame='label'
flow(moved.assign(flow_velocity=moved.flow_velocity + 100), frame="eulerian") | times the free vel
flow(displaced(chain, 30.0), frame="eulerian", **hot) | too fast
flow(at_rest(boxed.replace(box=0, amplitude=50)), boxed) | between the walls must add up to
flow(at_rest(boxed).isel(x=[0, -1]).assign(label=("x", [0.0, 5.0])), boxed) | x needs nodes
flow(at_rest(boxed.replace(box=1010)), boxed.replace(box=1010)) | too far out; use frame='eulerian'
flow(at_rest(boxed.replace(box=20)), boxed, **hot) | a rod at a wall at the start; use frame='euler
flow(chain=boxed.replace(mass_ratio=3, restitution=0.9), **hot) | two masses in inelastic collisions
flow(chain=boxed.replace(wall_restitution=0.9), **hot) | wall_restitution must be 1
flow(chain=lossy, frame="eulerian", **hot) | restitution must be 1, got 0.9; velocity_variance='evol
flow(at_rest(lossy.replace(restitution=1)), lossy, **hot) | beyond t = 4...: the fluid collapses to
breathing_cloud(Chain(gap=1), 1) | breathing cloud holds without gap only
breathing_cloud(chain, 1.0, stretch=0.0) | stretch must be
breathing_cloud(chain, 1.0, shift=np.inf) | shift must be
breathing_cloud(chain, 1.0, start_velocity_variance=-1.0) | start_velocity_variance must be
"""

RODS = """
rod_by_rod(rest.drop_vars("x")) | no coordinate 'x'
rod_by_rod(cb.smooth(rest)) | smoothed already
rod_by_rod(rest.drop_vars("label")) | no 'label'
rod_by_rod(rest.drop_vars("density")) | no 'density'
rod_by_rod(rest.isel(x=slice(0, rest.sizes["x"] // 2))) | needs the whole grid
rod_by_rod(rest.isel(x=[*range(0, 100, 2), *range(100, rest.sizes["x"])])) | must be even
rod_by_rod(rest.isel(x=slice(None, None, -1))) | needs the whole grid
rod_by_rod(rest.isel(particle=slice(3))) | 3 particles, the chain 5
rod_by_rod(rest.expand_dims("case")) | over x or
rod_by_rod(rest.assign(label=rest.label * np.nan)) | needs the whole grid
rod_by_rod(rest.assign_attrs(provenance=at_rest(twenty).attrs["provenance"])) | rods
rod_by_rod(rest.assign_attrs(source="simulation")) | takes a theory
rod_by_rod(rest.drop_attrs()) | names no chain
rod_by_rod(rest.density) | a DataArray
"""

REFUSED = [
    line.split(" | ")
    for table in (STATIONARY, FORCE_BALANCE, IN_TIME, RODS)
    for line in table.strip().splitlines()
]
