# ---
# jupyter:
#   jupytext:
#     cell_metadata_filter: tags,-all
#     formats: ipynb,py:percent
#     text_representation:
#       extension: .py
#       format_name: percent
#       format_version: '1.3'
#       jupytext_version: 1.19.6
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # The fluid in time
#
# **Question.** A hundred hard rods on springs are squeezed together and released. Does the chain
# overshoot its length at rest, and swing? Does a theory that is right *at rest* also predict how the
# chain comes to rest?
#
# We follow one release four times: as rods, as an isothermal fluid with the equations of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460), as a fluid that has a
# temperature, and exactly. Then we push the rods in the middle: do rods carry sound?
#
# The unit of length is the rod radius $R$, and that of mass is $M$ (a rod has $m =
# \frac{4\pi}{3}M$). The unit of time is $t_0 = \sqrt{M/k}$. The restitution is 1,
# and there is no gap between the anchors.
#
# *Level: fourth year. You need: lessons 4 and 5; partial differential equations. Time: 90 minutes.
# To predict before you see the results, type `make lessons` in the folder of the project, and open
# the copy of this lesson in `build/lessons/`, which has neither outputs nor solutions.*

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.stats import norm
from solutions import lesson_07 as solutions
from teaching import GREEN, PINK, RED, SKY, agree, check, panels, safe

# %% [markdown]
# **What you may change.** The friction `damping`, from 0.5 to 2 (with more of it nothing swings), and
# seeds. Then run all cells again. The numbers in the text are for `damping = 1`.

# %%
damping = 1

# %% tags=["hide-input"]
if not safe(
    0.5 <= damping <= 2,
    f"This lesson is for damping from 0.5 to 2, not {damping}: with less the fluids ring on after "
    "the end of the runs, and with more nothing swings. The lesson goes on with damping = 1.",
):
    damping = 1

# %%
import crazybilliards as cb

chain = cb.Chain(size=100, amplitude=30, damping=damping)
s, W, R = chain.thermal_length, chain.free_velocity_width, chain.radius
omega, friction = np.sqrt(chain.stiffness / chain.mass), chain.damping / chain.mass
print(f"thermal length s = {s:.1f} R, velocity width W = {W:.2f} R/t_0, s/W = {s / W:.2f} t_0")
print(f"one free rod: frequency {omega:.3f} /T, friction gamma/m = {friction:.3f} /T")

# %% [markdown]
# The squeeze acts on the reduced coordinate $y = x - 2R\,(i-\frac{L+1}{2})$. In $y$ the rods are
# points, and all anchors lie at $y = 0$. The squeeze multiplies every $y$ by 0.3 and leaves the
# velocities as they are in the steady state. `compare_relaxation` squeezes 1000 chains, follows
# them, and solves the theories.

# %%
SQUEEZE = 0.3
CHAINS = 1000
settings = {"duration": 16, "every": 0.4, "replicas": CHAINS, "seed": 2, "progress": False}
tree = cb.compare_relaxation(chain, "compressed", SQUEEZE, **settings)
rods, isothermal, warm, exact = (
    tree[name].to_dataset() for name in ("particles", "isothermal", "evolving", "exact")
)
time = rods.time.values

# %% tags=["hide-input"]
ax = panels(width=7, height=3)
for moment, name in ((0, "squeezed, t = 0"), (-1, f"t = {time[-1]:.0f} $t_0$")):
    seen = cb.smooth(rods.isel(time=moment))
    style = {"color": ("0.55", "k")[moment], "linestyle": ("-", "--")[moment]}
    ax.plot(seen.x, seen.density, label=name, **style)
ax.axhline(chain.close_packed_density, color="0.6", linewidth=1)
ax.text(-195, chain.close_packed_density + 0.005, "close packing", color="0.4")
ax.set(xlim=(-200, 200), ylim=(0, 0.56), xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(loc="lower center")
plt.show()

# %% [markdown]
# ## 1. The equations
#
# The paper gives a continuity equation and a velocity equation, with the pressure of hard rods per
# mass and the springs at the mean displacement $\langle\Delta x\rangle$:
#
# $$\rho_t + (\rho V)_x = 0,\qquad
# V_t + VV_x = -\frac1\rho\left(\frac{\rho W^2}{1-2R\rho}\right)_{\!x}
# - \frac km\langle\Delta x\rangle - \frac\gamma m V .$$
#
# **The springs.** Let $N(x,t)$ be the number of rods to the left of $x$. The rods there have the mean
# displacement $\langle\Delta x\rangle = x - 2R\,(N - L/2)$. The flow carries these labels with it,
# $N_t + V N_x = 0$.
#
# **The isothermal fluid** has a constant $W^2$. The paper uses this constant in the steady state, and
# solves nothing in time.
#
# **The fluid with a temperature** has an equation for $W^2$ as well. It is derived here, and it is
# not in the paper:
#
# $$(W^2)_t + V(W^2)_x = -\frac{2W^2\,V_x}{1-2R\rho}
# - \frac{2\gamma}{m}\left(W^2 - \frac{A^2}{2m\gamma}\right).$$
#
# The first term is the adiabatic law of a gas with one degree of freedom. The second term is the
# exchange of heat with friction and noise. `hydrodynamics` solves both fluids.
#
# ## 2. Space and time
#
# **Predict.** The friction is less than critical ($\gamma < 2\sqrt{km}$), so one free rod swings.
# Which of the three overshoot and become longer than at rest: the `"rods"`, the `"isothermal"` fluid,
# the fluid with a `"temperature"`, or `"all"`?

# %%
my_word = ...  # your code here: one of the four words

hint = "Which of them becomes colder while it expands, and is then pushed less?"
check(my_word, solutions.OVERSHOOTS, hint=hint)

# %% [markdown]
# **Run.**

# %% tags=["hide-input"]
fig, axes = plt.subplots(1, 3, figsize=(10, 3.6), sharey=True)
shown = {
    f"rods ({CHAINS} chains)": rods,
    "isothermal fluid": isothermal,
    "fluid with temperature": warm,
}
for ax, (name, result) in zip(axes, shown.items(), strict=True):
    picture = cb.smooth(result)
    image = ax.pcolormesh(
        picture.x, time, picture.density, cmap="cividis", vmin=0, vmax=0.5, rasterized=True
    )
    ax.set(title=name, xlabel="position x [R]", xlim=(-200, 200))
axes[0].set_ylabel("time $t$ [$t_0$]")
fig.colorbar(image, ax=axes, label=r"density $\rho$ [1/R]")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# The isothermal fluid overshoots: near $t = 4\,t_0$ its chain is longer, and less dense in the middle,
# than at the end. Neither the rods nor the fluid with a temperature overshoot.
#
# </details>
#
# ## 3. The width of the cloud, and its heat
#
# In $y$ the stationary chain is a Gaussian cloud of width $s$. Such a cloud *breathes*: its width
# $\sigma(t)$ changes, and its form does not (lesson 4). The flow is $V = (\sigma'/\sigma)\,y$. The
# velocity equation of section 1 then becomes
#
# $$\sigma'' = \frac{W^2}{\sigma} - \frac km\sigma - \frac\gamma m\sigma'.$$
#
# **Your turn.** Insert the flow into the equation for $W^2$. A length $dx$ is $dy=(1-2R\rho)\,dx$ in
# $y$, and $W^2$ is the same everywhere. Write $(W^2)'$; `heat` is $W^2$, `W` is the width at rest
# $W_0$, and `friction` is $\gamma/m$.


# %%
def my_heat_rate(sigma, sigma_rate, heat):
    return ...  # your code here


def expected_heat_rate(sigma, sigma_rate, heat):
    return solutions.heat_rate(sigma, sigma_rate, heat, W**2, friction)


clouds = [(s, 0.0, 2 * W**2), (s, W, W**2), (0.5 * s, -W, 0.3 * W**2)]
hint = "V_x / (1 - 2 R rho) is V_y, which is sigma_rate / sigma."
check(my_heat_rate, expected_heat_rate, at=clouds, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_heat_rate(sigma, sigma_rate, heat):
#     return -2 * heat * sigma_rate / sigma - 2 * friction * (heat - W**2)
# ```
#
# </details>


# %%
def breathe(chain, times, squeeze, heated=True):
    """Return sigma/s, sigma'/W_0 and W^2/W_0^2 after a release at rest."""
    s, W, loss = chain.thermal_length, chain.free_velocity_width, chain.damping / chain.mass

    def rates(t, state):
        sigma, rate, heat = state
        warming = solutions.heat_rate(sigma, rate, heat, W**2, loss) if heated else 0.0
        return rate, heat / sigma - (W / s) ** 2 * sigma - loss * rate, warming

    start, accuracy = (squeeze * s, 0.0, W**2), {"rtol": 1e-9, "atol": 1e-9}
    sigma, rate, heat = solve_ivp(rates, (0, times[-1]), start, t_eval=times, **accuracy).y
    return sigma / s, rate / W, heat / W**2


# %% [markdown]
# **Predict.** The cloud expands at first. Is the push $W^2/\sigma$ then stronger or weaker than in the
# isothermal fluid?
#
# **Run.**

# %%
cold_width, cold_rate, _ = breathe(chain, time, SQUEEZE, heated=False)
width, rate, heat = breathe(chain, time, SQUEEZE)
print(f"isothermal: widest {cold_width.max():.3f} s at t = {time[cold_width.argmax()]:.1f} t_0")
print(f"with temperature: widest {width.max():.4f} s, lowest heat {heat.min():.3f} W_0^2")

# %% tags=["hide-input"]
# The rods: y is the displacement, because all anchors coincide in y.
points = CHAINS * chain.size  # independent, so errors of variances are simple
rods_y2 = (rods.displacement_width**2 + rods.mean_displacement**2).mean("particle").values
rods_v2 = (rods.velocity_width**2).mean("particle").values  # the width is sqrt(<v^2>)
rods_width = np.sqrt(rods_y2) / s
kinetic = rods_v2 / W**2

left, other = panels(2)
left.plot(time, cold_width, "--", color=PINK, label="isothermal fluid")
left.plot(time, width, color=GREEN, linewidth=2.5, label="fluid with temperature")
left.plot(time, rods_width, "o", color="k", markersize=4, fillstyle="none", label="rods")
left.set(xlabel="time $t$ [$t_0$]", ylabel=r"width of the cloud $\sigma/s$", ylim=(0, 1.7))
other.plot(time, 1 + cold_rate**2, "--", color=PINK, label="isothermal fluid: motion + heat")
other.plot(
    time, heat + rate**2, color=GREEN, linewidth=2.5, label="with temperature: motion + heat"
)
other.plot(time, heat, ":", color=SKY, linewidth=2, label="with temperature: heat $W^2$ alone")
other.plot(time, kinetic, "o", color="k", markersize=4, fillstyle="none", label="rods")
other.set(xlabel="time $t$ [$t_0$]", ylabel=r"$\langle v^2\rangle / W_0^2$", ylim=(0, 2.9))
for ax in (left, other):
    ax.legend(loc="upper right")
plt.show()
energy = heat + rate**2
width_error = width / np.sqrt(2 * points)
agree("widths of the rods and of the fluid with temperature", rods_width, width, width_error)
agree("their kinetic energies", kinetic, energy, energy * np.sqrt(2 / points))

# %% tags=["remove-cell"]
off = [
    np.abs(result.cloud_width / s - mine).max().item()
    for result, mine in ((isothermal, cold_width), (warm, width), (exact, width))
]
assert cold_width.max() > 1.5
assert width.max() < 1.001
assert heat.min() < 0.5
assert max(off) < 1e-3  # hydrodynamics, and the exact solution of the package

# %% [markdown]
# <details><summary>Explain</summary>
#
# An expanding gas does work on the springs and on its own motion, and takes the energy from its heat.
# The first term is negative: the rods *cool*, to less than half of $W_0^2$, and the push becomes
# weaker. The noise returns heat, but only at the rate $2\gamma/m$. The isothermal fluid is kept at
# $W_0^2$ by assumption, and the push carries it to 1.56 $s$.
#
# At rest $W^2 = W_0^2$ is right. **A closure that is right in the steady state can be wrong on the way
# to it.**
#
# </details>
#
# **You can stop here.** You have reduced a partial differential equation to two ordinary ones, and
# found why a fluid needs a temperature to come to rest as the rods do.
#
# ## 4. Where are the rods?
#
# The fluid with a temperature has the exact cloud of points. It has a density, and no rods. The usual
# reading is that rod $i$ is where $N = i-\frac12$ rods lie to its left.
#
# **Predict.** Sketch the density of the rods in the middle of the squeezed chain. Is it as smooth as
# that of the fluid? Is the outermost rod where the fluid has it?
#
# The points are independent draws from the Gaussian cloud. Which of $L$ draws is rod 1?
#
# **Your turn.** `points` has one chain in each row: $L$ independent points, in no order. Return the
# mean places of rods 1 to $L$ in $y$, averaged over the rows.


# %%
def my_mean_places(points):
    return ...  # your code here


trials = [(np.random.default_rng(seed).normal(size=(50, 7)),) for seed in (1, 2)]
hint = "np.sort(..., axis=1) puts the points of each chain in order. Then average over axis 0."
check(my_mean_places, solutions.mean_places, at=trials, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_mean_places(points):
#     return np.sort(points, axis=1).mean(axis=0)
# ```
#
# </details>
#
# **Run.** We draw points from the cloud at the start and at the end. `rod_by_rod` computes the same
# without random numbers, for a theory at all times.

# %%
by_rod = cb.rod_by_rod(warm)
cloud = np.random.default_rng(3).normal(size=(20_000, chain.size))
first_of_all = solutions.mean_places(cloud)[0]
print("mean displacement of rod 1 at the end:")
for name, each in {"fluid": warm, "rod by rod": by_rod}.items():
    print(f"{name}: {each.mean_displacement.values[-1, 0] / s:.3f} s")
print(f"sorted points: {first_of_all * width[-1]:.3f} s")
theory, error = by_rod.mean_displacement, rods.mean_displacement_error
agree("mean displacements of the rods and rod by rod", rods.mean_displacement, theory, error)

# %% tags=["hide-input"]
ax = panels(width=8, height=3.4)
reach, edges = 9, np.linspace(-9, 9, 73)
counts = np.histogram(chain.physical(np.sort(SQUEEZE * s * cloud, axis=1)), edges)[0]
ax.stairs(
    counts / len(cloud) / np.diff(edges), edges, color="0.75", fill=True, label="sorted points"
)
for each, colour, style, name in (
    (warm, GREEN, "--", "fluid with temperature"),
    (by_rod, RED, "-", "the same, rod by rod"),
):
    middle = each.isel(time=0).sel(x=slice(-reach, reach))
    ax.plot(middle.x, middle.density, style, color=colour, linewidth=2, label=name)
seen = rods.isel(time=0).sel(x=slice(-reach, reach)).coarsen(x=4, boundary="trim").mean()
ax.plot(seen.x, seen.density, "ko", fillstyle="none", markersize=4, label="rods")
ax.set(xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]", ylim=(0.3, 0.65))
ax.set_title("the middle of the squeezed chain, t = 0")
ax.legend(ncols=2, loc="upper center")
plt.show()

# %% tags=["remove-cell"]
assert abs(by_rod.mean_displacement - exact.mean_displacement).max() < 1e-4 * s
assert abs(warm.mean_displacement - exact.mean_displacement).max() > 0.05 * s

# %% [markdown]
# <details><summary>Explain</summary>
#
# Rods are the points *in order*, and their density has a peak for each rod. The mean of the first of a
# hundred draws is not the place where half a point lies to its left: the fluid is wrong by 0.07 $s$
# there. Elastic rods only exchange their names, so their points remain independent while they move, and
# the order statistics of lessons 4 and 5 hold at all times.
#
# </details>
#
# The film shows all descriptions:

# %% tags=["hide-input"]
film = cb.film(tree, seconds=6, progress=False)
film

# %% [markdown]
# ## 5. Sound
#
# Take a small disturbance of a fluid at rest, $\rho = \rho_0+\rho_1$, and keep the terms of first order.
# Over short distances springs and friction can be neglected. With the pressure per mass $p$,
#
# $$\rho_{1,t} = -\rho_0 V_x,\qquad V_t = -\frac{1}{\rho_0}\,\frac{dp}{d\rho}\,\rho_{1,x}
# \quad\Rightarrow\quad V_{tt} = \frac{dp}{d\rho}\,V_{xx},\qquad c^2 = \frac{dp}{d\rho}.$$
#
# **Your turn.** In the isothermal fluid $p = \rho W^2/(1-2R\rho)$ with a constant $W^2$. Write its
# speed of sound $c$ as a function of the density. `W` and `R` are known.


# %%
def my_sound_speed(density):
    return ...  # your code here


def expected_speed(density):
    return solutions.sound_speed(density, W, R)


densities = [(0.0,), (0.1,), (0.4,)]
hint = "Differentiate p with the quotient rule, and take the square root."
check(my_sound_speed, expected_speed, at=densities, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_sound_speed(density):
#     return W / (1 - 2 * R * density)
# ```
#
# </details>
#
# The fluid with a temperature has no time to exchange heat while a short pulse passes. Its $W^2$
# follows the adiabatic law, $W^2\propto\rho_y^2$, where $\rho_y = \rho/(1-2R\rho)$ is the density in
# $y$. SymPy differentiates both pressures:

# %%
rho, rho0, a, W2 = sp.symbols("rho rho_0 a W2", positive=True)  # a = 2R
reduced = rho / (1 - a * rho)
heated = W2 * (reduced / reduced.subs(rho, rho0)) ** 2
squares = {}
for name, variance in (("isothermal", W2), ("adiabatic", heated)):
    squares[name] = sp.factor(sp.diff(rho * variance / (1 - a * rho), rho).subs(rho, rho0))
    print(f"{name}: c^2 =", squares[name])

# %% tags=["remove-cell"]
assert sp.simplify(squares["isothermal"] - W2 / (1 - a * rho0) ** 2) == 0
assert sp.simplify(squares["adiabatic"] - 3 * W2 / (1 - a * rho0) ** 2) == 0
numbers = {W2: W**2, a: 2 * chain.radius, rho0: 0.4}
assert np.isclose(float(squares["isothermal"].subs(numbers)), expected_speed(0.4) ** 2)

# %% [markdown]
# Without exchange of heat sound is $\sqrt3$ times as fast as at a constant temperature. In $y$ the
# isothermal sound has the speed $W$ *everywhere*. In $x$ it is faster, because a collision carries it
# over the length of a rod at once.
#
# Start from the steady state and give the rods in the middle a push that is narrow against $s$.
#
# **Predict.** The pulse splits into two that run to both sides. Does a pulse become faster or slower
# as it moves outwards?
#
# **Run.** The broken lines solve $dx/dt = \pm c(x)$ with the density at rest. `frame="eulerian"` leaves
# out the heat flux, which `docs/physics/in_time.md` adds.

# %%
fluids = {"isothermal fluid": None, "fluid with temperature": "evolving"}
WIDTH, PUSH, END = 0.08 * s, 0.02 * W, 0.8 * s / W
rest = cb.displaced(chain, 0.0)
rest_y = rest.x - 2 * chain.radius * (rest.label - chain.size / 2)
near = np.abs(rest_y) < 6 * WIDTH
bump = np.where(near, np.exp(-((rest_y / WIDTH) ** 2) / 2), 0.0)
start = rest.assign(flow_velocity=("x", PUSH * bump))
settings = {"every": END / 40, "cells": 4000, "frame": "eulerian", "progress": False}
pulses = {
    name: cb.hydrodynamics(chain, start, END, velocity_variance=variance, **settings)
    for name, variance in fluids.items()
}


# %% tags=["hide-input"]
def sound_path(times, factor):
    """Where a signal from x = 0 is, that runs with factor c(x)."""
    x, density = rest.x.values, rest.density.values

    def speed(t, place):
        return factor * expected_speed(np.interp(place, x, density))

    return solve_ivp(speed, (0, times[-1]), [0.0], t_eval=times, rtol=1e-8).y[0]


def crest(x, values, low, high):
    """Place of the largest value between low and high, by a parabola through its neighbours."""
    i = np.flatnonzero((x > low) & (x < high))
    i = i[values[i].argmax()]
    around = slice(i - 3, i + 4)
    curve = np.polyfit(x[around] - x[i], values[around], 2)
    return x[i] - curve[1] / (2 * curve[0])


fig, axes = plt.subplots(1, 2, figsize=(10, 3.6), sharey=True)
measured = {}
for ax, (name, flow), factor in zip(axes, pulses.items(), (1, np.sqrt(3)), strict=True):
    t, x = flow.time.values, flow.x.values
    path = sound_path(t, factor)
    crests = [crest(x, v, -1, 150) for v in flow.flow_velocity.values]
    measured[name] = crests[-1] / path[-1]
    image = ax.pcolormesh(
        x, t, flow.flow_velocity / PUSH, cmap="cividis", vmin=0, vmax=0.6, rasterized=True
    )
    for side in (-1, 1):
        ax.plot(side * path, t, "--", color="white", linewidth=1.2)
    ax.set(title=name, xlabel="position x [R]", xlim=(-130, 130))
    print(f"{name}: crest at {crests[-1]:.1f} R, path with {factor:.3f} c: {path[-1]:.1f} R")
axes[0].set_ylabel("time $t$ [$t_0$]")
fig.colorbar(image, ax=axes, label="flow velocity V / push")
plt.show()
middle = expected_speed(rest.density.sel(x=0, method="nearest").item())
print(f"in the middle: W = {W:.1f} R/t_0, c = {middle:.1f} R/t_0")

# %% tags=["remove-cell"]
assert all(abs(ratio - 1) < 0.03 for ratio in measured.values())

# %% [markdown]
# <details><summary>Explain</summary>
#
# Both fluids carry sound with their own $c(x)$. The pulse becomes slower as it moves outwards,
# because the density falls.
#
# </details>
#
# ## 6. Do rods carry sound?
#
# The fluid with a temperature was *exact* for the breathing cloud.
#
# **Predict.** Is it right for sound too?
#
# The rods can be solved exactly. In $y$ elastic rods that exchange their names pass through one
# another, so a pushed rod carries its push at its own velocity. Each point is a damped oscillator with
# noise (lesson 1, section 4). It is Gaussian at time $t$, and an integral over all starts gives the
# mean velocity at $y$ (the folded cell).


# %% tags=["hide-input"]
def mean_velocity(y, t, push, spread):
    """Exact mean velocity of the points at y, at time t after a push."""
    y0 = np.linspace(-6 * s, 6 * s, 6001)
    weight = norm.pdf(y0, scale=s)
    propagator = expm(np.array([[0, 1], [-(omega**2), -friction]]) * t)
    known = propagator @ np.diag([s**2, 0]) @ propagator.T
    covariance = np.diag([s**2, W**2]) - known
    place, speed = propagator @ np.array([y0, push * np.exp(-((y0 / spread) ** 2) / 2)])
    distance = y[:, np.newaxis] - place
    here = weight * norm.pdf(distance, scale=np.sqrt(covariance[0, 0]))
    velocity = speed + covariance[1, 0] / covariance[0, 0] * distance
    return (here * velocity).sum(1) / here.sum(1)


# %% [markdown]
# **Run.** We simulate 10 000 chains from exact equilibrium states, with a push in the middle.

# %%
push, spread, moment, copies = 0.3 * W, 0.1 * s, 0.5 * s / W, 10_000
states = cb.equilibrium_states(chain, copies, seed=2)
state_y = chain.reduced(states.position.values)
pushed_velocity = states.velocity + push * np.exp(-((state_y / spread) ** 2) / 2)
start = states.assign(velocity=pushed_velocity)
settings = {"replicas": copies, "average": "ensemble", "seed": 3, "progress": False}
watch = {"observe": ("snapshots",), "duration": moment, "every": moment}
last = cb.simulate(chain, start=start, **watch, **settings).isel(time=-1)

# %% tags=["hide-input"]
edges = np.linspace(-2, 2, 41) * s
centres = (edges[1:] + edges[:-1]) / 2
cell = np.digitize(chain.reduced(last.position.values).ravel(), edges)
velocities = last.velocity.values.ravel()
members = [velocities[cell == j] for j in range(1, edges.size)]
binned = np.array([each.mean() for each in members])
errors = np.array([each.std() / np.sqrt(each.size) for each in members])
fine = np.linspace(-2, 2, 401) * s
truth = mean_velocity(fine, moment, push, spread)

ax = panels(width=8, height=3.8)
strong = rest.assign(
    flow_velocity=("x", push * np.where(near, np.exp(-((rest_y / spread) ** 2) / 2), 0.0))
)
settings = {"every": moment, "cells": 4000, "frame": "eulerian", "progress": False}
for (name, variance), style, colour in zip(
    fluids.items(), ("--", "-."), (PINK, GREEN), strict=True
):
    flow = cb.hydrodynamics(chain, strong, moment, velocity_variance=variance, **settings)
    flow = flow.isel(time=-1)
    flow_y = flow.x - 2 * chain.radius * (flow.label - chain.size / 2)
    ax.plot(flow_y / s, flow.flow_velocity / W, style, color=colour, label=name)
ax.plot(fine / s, truth / W, color=RED, linewidth=2.5, label="exact")
look = {"fmt": "o", "color": "k", "fillstyle": "none", "markersize": 4}
ax.errorbar(centres / s, binned / W, errors / W, label="rods, 10 000 chains", **look)
ax.set(xlim=(-2, 2), xlabel="reduced position y / s", ylabel="mean velocity / W")
ax.set(title=f"t = {moment:.2f} $t_0$ = 0.5 s/W after a push in the middle", ylim=(-0.025, 0.19))
ax.legend(ncols=2, loc="upper center")
plt.show()

hump = crest(fine, truth, 0, 1.5 * s)
agree("rods and the exact curve", binned, mean_velocity(centres, moment, push, spread), errors)
print(f"the exact curve is highest at {hump / (W * moment):.2f} W t; sound: 1 or {np.sqrt(3):.2f}")
# %% [markdown]
# <details><summary>Explain</summary>
#
# No. Both fluids are wrong here. The push spreads into two low humps that become broader and broader,
# because rods of all velocities carry it.
#
# A fluid assumes that collisions make the velocities forget where they came from. Elastic collisions
# of equal rods only exchange names, so they forget nothing. The fluid with a temperature was exact for
# the breathing cloud for another reason: a Gaussian remains a Gaussian. Lesson 8 looks for a gas that
# is a fluid.
#
# </details>
#
# ## Exercises
#
# **1.** With which friction would the isothermal fluid be good enough? Compare the two widths
# for $\gamma = 1, 2, 5, 10$.
#
# <details><summary>Solution</summary>
#
# ```python
# long = np.linspace(0, 60, 1201)
# for damping in (1, 2, 5, 10):
#     slow = chain.replace(damping=damping)
#     cold, heated = (breathe(slow, long, SQUEEZE, heated=h)[0] for h in (False, True))
#     print(damping, np.abs(cold - heated).max())
# ```
#
# The differences are 0.56, 0.33, 0.11 and 0.04 $s$. Friction exchanges heat at the rate $2\gamma/m$
# *and* slows the motion down. At $\gamma = 10$ the noise keeps the temperature nearly constant.
#
# </details>
