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
# temperature, and exactly. Then we push the rods in the middle: how fast does sound travel along
# the chain, and do rods carry it?
#
# The unit of length is the rod radius $R$, and that of mass is $M$ (a rod has $m =
# \frac{4\pi}{3}M$). The unit of time is $\sqrt{M/k}$, written $T$ on the axes. The restitution is
# 1, and there is no gap between the anchors.
#
# *Level: fourth year. You need: lesson 4, section 7, and lesson 5; partial differential equations.
# Time: 100 minutes. To predict before you see the results, type `make lessons` in the folder of the
# project, and open the copy of this lesson without outputs in `build/lessons/`.*

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
import pde
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.stats import norm
from teaching import BLUE, GREEN, ORANGE, PINK, agree, check, panels, right

# %%
import crazybilliards as cb

chain = cb.Chain(size=100, amplitude=30)
s, W = chain.thermal_length, chain.free_velocity_width
omega, friction = np.sqrt(chain.stiffness / chain.mass), chain.damping / chain.mass
print(f"thermal length s = {s:.1f} R, velocity width W = {W:.2f} R/T, s/W = {s / W:.2f} T")
print(f"one free rod: frequency {omega:.3f} /T, friction gamma/m = {friction:.3f} /T")

# %% [markdown]
# ## The equations in three strings
#
# [*The analytics section in sixty lines*](paper_the_analytics_section_in_sixty_lines.ipynb), section 6, gives the equations of the
# paper to py-pde as text. These are its cells. Section 1 explains the equations. The function
# `hydrodynamics` of the package solves the same equations without the small viscosity, which is the
# last term of the second string. It also chooses its time steps, and it solves stronger compressions
# (*The analytics section in sixty lines*, section 7).

# %%
R, L = chain.radius, chain.size
k, m, gamma = chain.stiffness, chain.mass, chain.damping
equations = {
    "rho": "-d_dx(rho * V)",
    "V": "-V * d_dx(V) - W2 / rho * d_dx(rho / (1 - 2 * R * rho))"
    "- k / m * (x - 2 * R * (N - L / 2)) - gamma / m * V + 4 * d2_dx2(V)",
    "N": "-V * d_dx(N)",
}
constants = {"W2": W**2, "R": R, "L": L, "k": k, "m": m, "gamma": gamma}
fluid = pde.PDE(equations, consts=constants, bc={"curvature": 0})

# %%
grid = pde.CartesianGrid([[-L * R - 5 * s, L * R + 5 * s]], 400)
X, width = grid.axes_coords[0], 0.6 * s  # the chain is squeezed to 0.6 of its width at rest
y = np.linspace(-30 * s, 30 * s, 100_001)
y = np.interp(X, y + 2 * R * L * (norm.cdf(y, scale=width) - 0.5), y)
free = L * norm.pdf(y, scale=width)
fields = {"rho": free / (1 + 2 * R * free), "V": 0 * X, "N": L * norm.cdf(y, scale=width)}
start = pde.FieldCollection([pde.ScalarField(grid, fields[f], label=f) for f in fields])
solver = {"dt": 0.02, "solver": "runge-kutta", "backend": "numpy", "tracker": None}
end = fluid.solve(start, t_range=8.0, **solver)
flow = cb.hydrodynamics(chain, cb.compressed(chain, 0.6), 8.0, every=8.0, progress=False)
apart = np.abs(np.interp(X, flow.x, flow.density[-1]) - end["rho"].data).max()
print(f"hydrodynamics and three strings: {2 * R * apart:.1e} of close packing apart")

# %% tags=["remove-cell"]
assert 2 * R * apart < 1e-2

# %% [markdown]
# ## The release
#
# The squeeze acts on the reduced coordinate $y = x - 2R\,(i-\frac{L+1}{2})$. In $y$ the rods are
# points, and all anchors lie at $y = 0$. The squeeze multiplies every $y$ by 0.3 and leaves the
# velocities as they are in the steady state. `compare_relaxation` squeezes 200 chains and follows
# them, and it solves the theories.

# %%
SQUEEZE = 0.3
tree = cb.compare_relaxation(
    chain, "compressed", SQUEEZE, duration=16, every=0.4, replicas=200, seed=1, progress=False
)
rods, isothermal, warm, exact = (
    tree[name].to_dataset() for name in ("particles", "isothermal", "evolving", "exact")
)
time = rods.time.values

# %% tags=["hide-input"]
ax = panels(width=7, height=3)
for moment, name in ((0, "squeezed, t = 0"), (-1, f"t = {time[-1]:.0f} T")):
    seen = cb.smooth(rods.isel(time=moment))
    style = {"color": (BLUE, ORANGE)[moment], "linestyle": ("-", "--")[moment]}
    ax.plot(seen.x, seen.density, label=name, **style)
ax.axhline(chain.close_packed_density, color="0.6", linewidth=1)
ax.text(-195, chain.close_packed_density + 0.005, "close packing", color="0.4")
ax.set(xlim=(-200, 200), ylim=(0, 0.56), xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(loc="lower center")
plt.show()

# %% [markdown]
# ## 1. The equations
#
# The paper gives a continuity equation and a velocity equation. They contain the pressure of hard
# rods (per mass) and the springs at the mean displacement $\langle\Delta x\rangle$:
#
# $$\rho_t + (\rho V)_x = 0,\qquad
# V_t + VV_x = -\frac1\rho\left(\frac{\rho W^2}{1-2R\rho}\right)_{\!x}
# - \frac km\langle\Delta x\rangle - \frac\gamma m V .$$
#
# **The springs.** The springs that pull at $x$ are those of the rods that are there. Let
# $N(x,t) = \int_{-\infty}^x\rho$ be the number of rods to the left of $x$. Then
# $\langle\Delta x\rangle = x - 2R\,(N - L/2)$. The flow carries these labels with it,
# $N_t + V N_x = 0$. Nothing is taken from a simulation.
#
# **The isothermal fluid** has a constant $W^2$. The paper writes $W_v(r,t)$ without an equation for
# it, uses a constant in the steady state, and solves nothing in time.
#
# **The fluid with a temperature** has an equation for $W^2$ as well. It is derived here, and it is
# not in the paper:
#
# $$(W^2)_t + V(W^2)_x = -\frac{2W^2\,V_x}{1-2R\rho}
# - \frac{2\gamma}{m}\left(W^2 - \frac{A^2}{2m\gamma}\right).$$
#
# The first term is the adiabatic law of a gas with one degree of freedom: if the gas is compressed
# to half its free length, its temperature rises to four times the value. The second term is the
# exchange of heat with friction and noise. `hydrodynamics` solves both fluids with the library
# py-pde.
#
# ## 2. Space and time
#
# **Predict.** The friction is less than critical ($\gamma < 2\sqrt{km}$), so one free rod swings.
# Will the squeezed chain swing too? Will the two fluids?
#
# **Run.**

# %% tags=["hide-input"]
fig, axes = plt.subplots(1, 3, figsize=(10, 3.6), sharey=True)
shown = {"rods (200 chains)": rods, "isothermal fluid": isothermal, "fluid with temperature": warm}
for ax, (name, result) in zip(axes, shown.items(), strict=True):
    picture = cb.smooth(result)
    image = ax.pcolormesh(
        picture.x, time, picture.density, cmap="cividis", vmin=0, vmax=0.5, rasterized=True
    )
    ax.set(title=name, xlabel="position x [R]", xlim=(-200, 200))
axes[0].set_ylabel("time t [T]")
fig.colorbar(image, ax=axes, label=r"density $\rho$ [1/R]")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# The isothermal fluid overshoots: near $t = 4\,T$ its chain is longer, and less dense in the middle,
# than it is at the end. The rods do not overshoot. The fluid with a temperature does not overshoot
# either. Section 3 gives the reason.
# </details>
#
# ## 3. The width of the cloud, and its heat
#
# In $y$ the stationary chain is a Gaussian cloud of width $s$. Such a cloud *breathes*: its width
# $\sigma(t)$ changes, and its form does not. [Lesson
# 4](04_the_elastic_chain_is_exactly_solvable.ipynb), section 7, shows this for elastic rods and
# solves it exactly. Here we describe the same motion by the equations of the fluid. The flow is
# $V = (\sigma'/\sigma)\,y$, and the equations of section 1 reduce to two ordinary differential
# equations:
#
# $$\sigma'' = \frac{W^2}{\sigma} - \frac km\sigma - \frac\gamma m\sigma',\qquad
# (W^2)' = -2W^2\,\frac{\sigma'}{\sigma} - \frac{2\gamma}{m}\left(W^2-W_0^2\right),$$
#
# where $W_0$ is the velocity width at rest. In the isothermal fluid $W^2 = W_0^2$ replaces the
# second equation.


# %%
def breathe(chain, times, squeeze, heated=True):
    """Return sigma/s, sigma'/W_0 and W^2/W_0^2 after a release at rest."""
    s, W, loss = chain.thermal_length, chain.free_velocity_width, chain.damping / chain.mass

    def rates(t, state):
        sigma, rate, heat = state
        warming = -2 * heat * rate / sigma - 2 * loss * (heat - W**2) if heated else 0.0
        return rate, heat / sigma - (W / s) ** 2 * sigma - loss * rate, warming

    start, accuracy = (squeeze * s, 0.0, W**2), {"rtol": 1e-9, "atol": 1e-9}
    sigma, rate, heat = solve_ivp(rates, (0, times[-1]), start, t_eval=times, **accuracy).y
    return sigma / s, rate / W, heat / W**2


# %% [markdown]
# **Predict.** The cloud expands at first. Which sign has each of the two terms of the heat equation?
# Is the push $W^2/\sigma$ then stronger or weaker than in the isothermal fluid?
#
# **Run.**

# %%
cold_width, cold_rate, _ = breathe(chain, time, SQUEEZE, heated=False)
width, rate, heat = breathe(chain, time, SQUEEZE)
print(f"isothermal: widest {cold_width.max():.3f} s at t = {time[cold_width.argmax()]:.1f} T")
print(f"with temperature: widest {width.max():.4f} s, lowest heat {heat.min():.3f} W_0^2")

# %% tags=["hide-input"]
# The rods: y is the displacement, because all anchors coincide in y.
points = 200 * chain.size  # independent, so errors of variances are simple
rods_y2 = (rods.displacement_width**2 + rods.mean_displacement**2).mean("particle").values
rods_v2 = (rods.velocity_width**2).mean("particle").values  # the width is sqrt(<v^2>)
rods_width = np.sqrt(rods_y2) / s
kinetic = rods_v2 / W**2

left, other = panels(2)
left.plot(time, cold_width, "--", color=BLUE, label="isothermal fluid")
left.plot(time, width, color=ORANGE, linewidth=2.5, label="fluid with temperature")
left.plot(time, rods_width, "o", color="k", markersize=4, fillstyle="none", label="rods")
left.set(xlabel="time t [T]", ylabel=r"width of the cloud $\sigma/s$", ylim=(0, 1.7))
other.plot(time, 1 + cold_rate**2, "--", color=BLUE, label="isothermal fluid: motion + heat")
other.plot(
    time, heat + rate**2, color=ORANGE, linewidth=2.5, label="with temperature: motion + heat"
)
other.plot(time, heat, ":", color=GREEN, label="with temperature: heat $W^2$ alone")
other.plot(time, kinetic, "o", color="k", markersize=4, fillstyle="none", label="rods")
other.set(xlabel="time t [T]", ylabel=r"$\langle v^2\rangle / W_0^2$", ylim=(0, 2.9))
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
# An expanding gas does work on the springs and on its own motion. It takes this energy from its
# heat. So the first term is negative: the rods *cool*, to less than half of $W_0^2$, and the push
# becomes weaker. The second term is then positive: the noise returns heat, but only at the rate
# $2\gamma/m$, which is no faster than the chain moves. The isothermal fluid is kept at $W_0^2$ by
# assumption. The model adds heat while it expands, and the push carries it to 1.56 $s$.
#
# At rest the assumption is right, because $W^2 = W_0^2$ holds in the steady state for $e = 1$. **A
# closure that is right in the steady state can be wrong on the way to it.**
# </details>
#
# The cloud tells where the *points* are. A fluid has rod $i$ at the place where $N = i-\frac12$.
# `rod_by_rod` reads the rods off the points ([lesson 5](05_from_the_kinetic_equation_to_the_force_balance.ipynb), section 5).
#
# **Predict.** The fluid with a temperature has the exact cloud. Does it have the exact mean
# displacements of the rods, too? Does `rod_by_rod` hold while the chain moves?
#
# **Run.**

# %%
by_rod = cb.rod_by_rod(warm)
for name, theory in {"fluid": warm, "rod by rod": by_rod}.items():
    off = abs(theory.mean_displacement - exact.mean_displacement).max().item()
    print(f"mean displacements, {name}: at most {off / s:.4f} s from the exact ones")
for name in ("mean_displacement", "displacement_width"):
    agree(f"{name} of the rods and rod by rod", rods[name], by_rod[name], rods[f"{name}_error"])

# %% tags=["remove-cell"]
assert off < 1e-4 * s
assert abs(warm.mean_displacement - exact.mean_displacement).max() > 0.05 * s

# %% [markdown]
# <details><summary>Explain</summary>
#
# The fluid's mean displacements are wrong by up to 0.07 $s$. Rod by rod they are right at all times,
# and so are the widths, which a fluid does not have. Points that exchange their names in elastic
# collisions remain independent while they move. This is all that `rod_by_rod` assumes.
# </details>
#
# ## 4. The animation

# %% tags=["hide-input"]
film = cb.film(tree, seconds=6, progress=False)
film

# %% tags=["remove-cell"]
assert len(film.html) < 1e6

# %% [markdown]
# ## 5. A motion without compression
#
# **Predict.** Push the whole chain aside by 2 $s$ instead of squeezing it, and release it. Will the
# two fluids differ now?
#
# **Run.**

# %%
fluids = {"isothermal fluid": None, "fluid with temperature": "evolving"}
pushed = cb.displaced(chain, 2 * s)
swings = {
    name: cb.hydrodynamics(chain, pushed, 16, every=0.4, velocity_variance=variance, progress=False)
    for name, variance in fluids.items()
}

# %% tags=["hide-input"]
ringing = np.sqrt(omega**2 - friction**2 / 4)
oscillator = np.exp(-friction * time / 2) * (
    np.cos(ringing * time) + friction / (2 * ringing) * np.sin(ringing * time)
)
ax = cb.overlay(swings, "centre", ax=panels(width=6, height=2.8))
ax.plot(time[::2], 2 * s * oscillator[::2], "o", color="k", fillstyle="none", label="one free rod")
ax.set_ylabel("centre of the chain [R]")
ax.legend()
plt.show()
largest = max(np.abs(flow.centre - 2 * s * oscillator).max().item() / s for flow in swings.values())
print(f"largest difference from one free rod: {largest:.1e} s")

# %% tags=["remove-cell"]
assert largest < 1e-3

# %% [markdown]
# <details><summary>Explain</summary>
#
# The two fluids agree. The chain swings as a whole, like one free rod. Nothing is compressed, so
# nothing is heated, and collisions do not change the total momentum.
# </details>
#
# ## 6. Sound
#
# Take a small disturbance of a fluid at rest with the density $\rho_0$, so that
# $\rho = \rho_0+\rho_1$, and $\rho_1$ and $V$ are small. Keep the terms of first order. Over short
# distances springs and friction can be neglected. With the pressure per mass $p$,
#
# $$\rho_{1,t} = -\rho_0 V_x,\qquad V_t = -\frac{1}{\rho_0}\,\frac{dp}{d\rho}\,\rho_{1,x}
# \quad\Rightarrow\quad V_{tt} = \frac{dp}{d\rho}\,V_{xx},\qquad c^2 = \frac{dp}{d\rho}.$$
#
# **Task.** In the isothermal fluid $p = \rho W^2/(1-2R\rho)$ with a constant $W^2$. Write its speed
# of sound $c$ as a function of the density.


# %% tags=["remove-cell"]
def sound_speed_solution(density):
    return W / (1 - 2 * chain.radius * density)


densities = [(0.0,), (0.1,), (0.4,)]
assert right(sound_speed_solution, sound_speed_solution, at=densities)
assert not right(lambda density: W, sound_speed_solution, at=densities)


# %%
def sound_speed(density):
    return ...  # your code here


hint = "differentiate p with the quotient rule, and take the square root"
check(sound_speed, sound_speed_solution, at=densities, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def sound_speed(density):
#     return W / (1 - 2 * chain.radius * density)
# ```
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
assert np.isclose(float(squares["isothermal"].subs(numbers)), sound_speed_solution(0.4) ** 2)

# %% [markdown]
# Without exchange of heat sound is $\sqrt3$ times as fast as at a constant temperature. (Newton took
# air to be isothermal and found too low a speed of sound. Laplace added the heat.) In the reduced
# coordinate a length $dx$ is $dy = (1-2R\rho)\,dx$, so in $y$ the isothermal sound has the speed $W$
# *everywhere*. In $x$ sound is faster because a collision carries it over the length of a rod at
# once.
#
# Start from the steady state and give the rods in the middle a push that is narrow against $s$.
#
# **Predict.** The pulse splits into two that run to both sides. Does a pulse become faster or slower
# as it moves outwards?
#
# **Run.** The broken lines solve $dx/dt = \pm c(x)$ with the density at rest.

# %%
WIDTH, PUSH, END = 0.08 * s, 0.02 * W, 0.8 * s / W
rest = cb.displaced(chain, 0.0)
rest_y = rest.x - 2 * chain.radius * (rest.label - chain.size / 2)
near = np.abs(rest_y) < 6 * WIDTH
bump = np.where(near, np.exp(-((rest_y / WIDTH) ** 2) / 2), 0.0)
start = rest.assign(flow_velocity=("x", PUSH * bump))
settings = {"every": END / 40, "cells": 1000, "progress": False}
pulses = {
    name: cb.hydrodynamics(chain, start, END, velocity_variance=variance, **settings)
    for name, variance in fluids.items()
}


# %% tags=["hide-input"]
def sound_path(times, factor):
    """Where a signal from x = 0 is, that runs with factor c(x)."""
    x, density = rest.x.values, rest.density.values

    def speed(t, place):
        return factor * sound_speed_solution(np.interp(place, x, density))

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
axes[0].set_ylabel("time t [T]")
fig.colorbar(image, ax=axes, label="flow velocity V / push")
plt.show()
middle = sound_speed_solution(rest.density.sel(x=0, method="nearest").item())
print(f"in the middle: W = {W:.1f} R/T, c = {middle:.1f} R/T")

# %% tags=["remove-cell"]
assert all(abs(ratio - 1) < 0.03 for ratio in measured.values())

# %% [markdown]
# <details><summary>Explain</summary>
#
# Both fluids carry sound with their own $c(x)$. The pulse becomes slower as it moves outwards,
# because the density falls. In the dense middle the isothermal sound is nearly five times as fast
# as the rods themselves.
# </details>
#
# ## 7. Do rods carry sound?
#
# The fluid with a temperature was *exact* for the breathing cloud.
#
# **Predict.** Is it right for sound too?
#
# The rods can be solved exactly. In $y$ elastic rods that exchange their names pass through one
# another. So a pushed rod carries its push at its own velocity: fast rods carry it far, and slow
# rods carry it a short way. Each point is a damped oscillator with noise. A point that starts at
# $y_0$ with the mean push $u(y_0)$ is Gaussian at time $t$,
#
# $$(y, v)\sim\mathcal N\!\big(M\,(y_0, u(y_0)),\; \Sigma - M\,\mathrm{diag}(s^2,\,0)\,M^\top\big),
# \qquad M = e^{Bt},\quad B = \begin{pmatrix}0&1\\-k/m&-\gamma/m\end{pmatrix},$$
#
# with $\Sigma = \mathrm{diag}(s^2, W^2)$ at rest. The integral over the Gaussian of $y_0$ gives the
# mean velocity at $y$.


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
settings = {"every": moment, "cells": 1000, "progress": False}
for (name, variance), style, colour in zip(fluids.items(), ("--", "-."), (BLUE, PINK), strict=True):
    flow = cb.hydrodynamics(chain, strong, moment, velocity_variance=variance, **settings)
    flow = flow.isel(time=-1)
    flow_y = flow.x - 2 * chain.radius * (flow.label - chain.size / 2)
    ax.plot(flow_y / s, flow.flow_velocity / W, style, color=colour, label=name)
ax.plot(fine / s, truth / W, color=ORANGE, linewidth=2.5, label="exact")
look = {"fmt": "o", "color": "k", "fillstyle": "none", "markersize": 4}
ax.errorbar(centres / s, binned / W, errors / W, label="rods, 10 000 chains", **look)
ax.set(xlim=(-2, 2), xlabel="reduced position y / s", ylabel="mean velocity / W")
ax.set(title=f"t = {moment:.2f} T = 0.5 s/W after a push in the middle", ylim=(-0.025, 0.19))
ax.legend(ncols=2, loc="upper center")
plt.show()

hump = crest(fine, truth, 0, 1.5 * s)
early = 0.1 * moment
soon = mean_velocity(0.1 * fine, early, 0.03 * push, 0.1 * spread)
hump_soon = crest(0.1 * fine, soon, 0, 0.15 * s)
agree("rods and the exact curve", binned, mean_velocity(centres, moment, push, spread), errors)
print(f"the exact curve is highest at {hump / (W * moment):.2f} W t; sound: 1 or {np.sqrt(3):.2f}")
print(f"ten times earlier, push narrower and weaker: at {hump_soon / (W * early):.2f} W t")

# %% tags=["remove-cell"]
assert abs(hump_soon / (W * early) - np.sqrt(2)) < 0.05

# %% [markdown]
# <details><summary>Explain</summary>
#
# No. Both fluids are wrong here, because the rods carry no sound. The push spreads
# into two low humps that become broader and broader, because rods of all velocities carry it. (The
# push is a strong one, so that one can see it above the noise. The fluids' pulses therefore
# steepen, and drift to the right while they separate.)
#
# Shortly after a narrow and weak push the mean velocity is proportional to $w^2 e^{-w^2/2W^2}$ with
# $w = y/t$. Its maximum is at $w = \sqrt2\,W$, between the two speeds of sound. At the time of the
# picture the maxima are further out, because fewer other rods share the push there.
#
# A fluid assumes that collisions make the velocities forget where they came from. This is called
# *local equilibrium*. Elastic collisions of equal rods in one dimension only exchange names, so
# they forget nothing. The fluid with a temperature was exact for the breathing cloud for another
# reason: a Gaussian remains a Gaussian. Noise and friction make rods forget within $m/\gamma =
# 4.2\,T$, but by then the springs have destroyed the push.
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
# </details>
#
# **2.** `hydrodynamics` computes with labels instead of positions. Check it with its other,
# independent solver, `frame="eulerian"`, which solves the two equations of section 1 on a grid of
# positions.
#
# <details><summary>Solution</summary>
#
# ```python
# other = cb.hydrodynamics(chain, cb.compressed(chain, SQUEEZE), 16, every=0.4, frame="eulerian",
#                       velocity_variance="evolving", progress=False)
# np.abs(other.cloud_width / s - width).max().item()
# ```
#
# The result is 0.002: the two agree to 0.2 % of $s$ with the default 285 cells.
# </details>
#
# **3.** A wave of frequency $\omega$ exchanges heat at the rate $2\gamma/m$ while it passes. Derive
# $c^2(\omega)$ between Newton's and Laplace's limits, without springs. Which limit applies in
# section 6?
#
# <details><summary>Solution</summary>
#
# Let $\theta = \delta W^2/W^2$. In $y$, $\theta_t = -2V_y - \frac{2\gamma}{m}\theta$, and the
# continuity equation says $-V_y = \partial_t\,\delta\rho_y/\rho_y$. For a time dependence
# $e^{-i\omega t}$ this gives
# $\theta = \frac{-2i\omega}{-i\omega+2\gamma/m}\,\frac{\delta\rho_y}{\rho_y}$. With
# $p = \rho_y W^2$,
#
# $$c^2(\omega) = W^2\left(1 + \frac{2}{1 + 2i\gamma/(m\omega)}\right).$$
#
# Slow waves have $c = W$, fast ones $\sqrt3\,W$. Our pulse has $\omega\approx W/(0.08\,s) = 6.1/T$
# against $2\gamma/m = 0.48/T$, so it is nearly adiabatic.
# </details>
#
# **4.** In section 3 the squeezed rods had the velocities of the steady state. Squeeze a chain
# without exchange of heat instead: which $W^2$ does it have, and what happens at the release?
#
# <details><summary>Solution</summary>
#
# The adiabatic law gives $W^2\propto 1/\sigma^2$, which is $1/0.3^2 = 11$ times $W_0^2$. Change the
# start in `breathe` to `(squeeze * s, 0.0, (W / squeeze) ** 2)`. The cloud then expands to 2.47 $s$
# at $t = 2.9\,T$, and cools to 0.37 $W_0^2$ on the way.
# </details>
