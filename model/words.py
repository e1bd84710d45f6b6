"""Other words for the names of the package: what a message says that was meant by a wrong name.

Names that are spelled alike often mean something else, such as ``time`` and ``time_step``. A word
that stands here is therefore never compared by its letters.
"""

# The symbols of the paper, and the names of their parameters of Chain and simulate.
SYMBOLS = {
    "L": "size",
    "R": "radius",
    "m": "mass",
    "k": "stiffness",
    "gamma": "damping",
    "A": "amplitude",
    "e": "restitution",
    "g": "gap",
    "dt": "time_step",
    "\N{GREEK SMALL LETTER GAMMA}": "damping",
}

# A name, and other words for it. A word may stand for several names: the first that fits is meant.
_WORDS = """
size: N n rods n_rods num_rods number_of_rods n_particles num_particles number_of_particles
restitution: coefficient_of_restitution restitution_coefficient cor
amplitude: noise noise_amplitude noise_strength
damping: friction
stiffness: spring_constant spring_stiffness
box: box_length box_size
wall_restitution: e_w restitution_wall
mass_ratio: mass_ratios
duration: time T t t_max tmax t_end tend t_final total_time runtime steps n_steps num_steps nsteps
accuracy: duration tolerance
warmup: burn_in burnin equilibration equilibration_time thermalization transient
seed: random_state random_seed
observe: observable observables observers measure measurements quantities
start: initial initial_state init initial_condition x0
every: stride interval sample_every save_every sampling output_every
replicas: runs samples n_runs n_replicas num_replicas realizations ensemble_size
threads: n_threads num_threads n_jobs workers n_workers cores
progress: verbose quiet
stepper: integrator scheme
results: labels
path: file filename output
paper: save output file filename savefig path
quantity: variable observable
position: positions x
temperature: T
free_velocity_width: W
anchors: positions position x0 x
replace: copy update evolve set
parameters: to_dict asdict params
velocity_width: W_v Wv
displacement_width: W_x Wx
velocity_variance: W2 W^2
density: rho
mean_displacement: dx <dx>
kinetic_energy: E energy
snapshots: positions position trajectory trajectories states
time-correlations: vacf msd autocorrelation
label: lagrangian labels
simulate: run sim simulation
overlay: plot draw
film: movie animation
velocity: velocities
"""
WORDS: dict[str, list[str]] = {}
for _line in _WORDS.strip().splitlines():
    _name, _others = _line.split(": ")
    for _word in _others.split():
        WORDS.setdefault(_word, []).append(_name)

# Arguments that are often given to another function than this one.
_OF_A_CHAIN = ("spring", "box", "wall_restitution", "mass_ratio")
OWNERS = dict.fromkeys((*SYMBOLS.values(), *_OF_A_CHAIN), "Chain")
_SIMULATE = """time_step duration warmup method stepper merging observe particles replicas average
every threads checkpoint"""
OWNERS |= dict.fromkeys(_SIMULATE.split(), "simulate") | {"accuracy": "simulate_limit"}

# Arguments that there are not, with the reason or with what replaces them.
_ENDS = "a chain is no ring: its ends are free, or in a box, the distance between two walls"
_HEAT = "walls have no temperature: they take the share 1 - wall_restitution^2 of the energy"
NOTES = dict.fromkeys(("periodic", "pbc", "ring", "boundary"), _ENDS) | {
    **dict.fromkeys(("walls", "wall"), "box is the distance between two walls"),
    **dict.fromkeys(("wall_temperature", "heat", "thermal_walls"), _HEAT),
    "temperature": "amplitude^2/(2 damping) is the temperature",
    "masses": "mass_ratio is the mass of every second rod over that of the others, mass",
    "radii": "all rods have one radius",
    "diameter": "a rod is two radius long",
    "fps": "a film has 25 pictures a second, and seconds is its length",
}
