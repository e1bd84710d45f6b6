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
# # When is a gas a fluid?
#
# **Question.** Hard rods without springs fly between two walls. Let them out of the left half of
# their box. Does the gas slosh to and fro? Does it have sound, and how fast is it? What must the
# particles of a gas do so that it is a fluid?
#
# The equations of the fluid are those of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460). In lesson 7 they were wrong
# for a push in a chain of rods. Here we find out which gas they describe.
#
# All collisions are elastic. Lengths are in rod radii $R$. The mean mass and the temperature are 1,
# so $W = \sqrt{T/\langle m\rangle} = 1$ as well. The rods leave the *free length* $l = X - 2RL$ of
# the box. In the reduced coordinate $y$ they are points in this room (lesson 6, section 2).
#
# *Level: fourth year. You need: lesson 4 (section 1) and lesson 7 (section 1), linear differential
# equations. Time: 90 minutes. To predict before you see the results, type `make lessons` in the
# folder of the project, and open the copy of this lesson in `build/lessons/`, which has neither
# outputs nor solutions.*

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
import pde
from scipy.linalg import expm
from solutions import lesson_08 as solutions
from teaching import BLUE, GREEN, PINK, RED, agree, check, panels, safe

# %% [markdown]
# **What you may change.** The number of rods `size` from 32 to 256, the ratio of the two masses from
# 1.5 to 5, and seeds. Then run all cells again.

# %%
size, ratio = 128, 3

# %% tags=["hide-input"]
if not safe(
    32 <= size <= 256 and 1.5 <= ratio <= 5,
    f"This lesson is for 32 to 256 rods and ratios from 1.5 to 5, not {size} and {ratio}: fewer "
    "rods, or nearly equal masses, have no clear sound, and more take long. The lesson goes on "
    "with 128 rods and the ratio 3.",
):
    size, ratio = 128, 3

# %%
import crazybilliards as cb

L, room = size, size  # rods, and the free length l [R]
kappa = np.pi / room  # of the longest wave


def gas(ratio, friction=0.001):
    """Return rods between walls: T = 1, mean mass 1, friction Gamma/(kappa W)."""
    damping = friction * kappa
    kinds = {"mass": 2 / (1 + ratio), "mass_ratio": ratio, "stiffness": 0, "box": room + 2 * L}
    return cb.Chain(size=L, damping=damping, amplitude=np.sqrt(2 * damping), **kinds)


# %%
def follow(chain, start, duration, noise=False, outputs=24):
    """Return y and v over time, replica and rod."""
    if not noise:
        chain = chain.replace(damping=0, amplitude=0)
    times = {"duration": duration, "every": duration / outputs, "time_step": duration / outputs}
    settings = {"replicas": start.sizes["replica"], "average": "ensemble", "progress": False}
    run = cb.simulate(chain, start=start, observe="snapshots", seed=2, **times, **settings)
    run = run.transpose("time", "replica", "particle")
    return chain.reduced(run.position.values), run.velocity.values


# %% [markdown]
# ## 1. Rods of one mass
#
# At the start all rods are in the left half of the free length, with Maxwell's velocities. There is
# no noise and no friction.
#
# **Predict.** Will the gas `"slosh"`, so that for some time more than half of the rods are on the
# right? Or will it only `"spread"`?

# %%
my_word = ...  # your code here: "slosh" or "spread"

hint = "Rods of one mass exchange their velocities. How do the points move, if names do not count?"
check(my_word, solutions.RELEASED, hint=hint)

# %% [markdown]
# Equal rods that collide exchange their velocities. In $y$ one can as well say that points fly
# through one another. Each point then flies alone, and the walls are mirrors: a point that would be
# beyond a wall is where its mirror image is.
#
# **Your turn.** A point would be at $y$ if there were no walls. Where is it between the walls at
# `low` and `high`? It may have met many mirrors.


# %%
def my_mirrored(y, low, high):
    return ...  # your code here


flights = [(0.3, -1.0, 1.0), (1.4, -1.0, 1.0), (-1.5, -1.0, 1.0), (8.2, -1.0, 1.0)]
hint = "np.mod(y - low, 2 * room) is the way from low, there and back. np.minimum turns it round."
check(my_mirrored, solutions.mirrored, at=flights, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_mirrored(y, low, high):
#     room = high - low
#     way = np.mod(y - low, 2 * room)
#     return low + np.minimum(way, 2 * room - way)
# ```
#
# </details>
#
# **Run.** The same start twice: rods with all their collisions, and points between mirrors.

# %%
# A ratio that is not quite 1 makes the package compute every collision.
rng, equal, runs = np.random.default_rng(1), gas(1 + 1e-9), 500
y0 = np.sort(rng.uniform(-room / 2, 0, (runs, L)), axis=1)
v0 = rng.normal(size=y0.shape)
start = cb.given_start(equal, equal.physical(y0), v0, replicas=runs)
y, v = follow(equal, start, 2 * room)

# %%
t = np.linspace(0, 2 * room, 25)
flown = solutions.mirrored(y0 + t[:, None, None] * v0, -room / 2, room / 2)
rods_beyond, points_beyond = (np.mean(each > 0, axis=(1, 2)) for each in (y, flown))
apart = abs(y - np.sort(flown, axis=2)).max()
print(f"rods and sorted points are at most {apart:.0e} R apart")

# %% [markdown]
# The mirrors turn waves $\cos\kappa_q(y+\frac l2)$ with $\kappa_q = \pi q/l$ into themselves. In the
# time $t$ a point flies a Gaussian distance of the width $Wt$, which multiplies a wave by
# $e^{-(\kappa_qWt)^2/2}$. The sum over the waves of the start is the exact share on the right,
#
# $$f(t) = \frac12 - \sum_{q=1,3,\dots}\Big(\frac{2}{\pi q}\Big)^2 e^{-(\kappa_qWt)^2/2}.$$

# %%
q = np.arange(1, 2001, 2)
decay = np.exp(-((q * kappa * t[:, None]) ** 2) / 2)
law = 0.5 - ((2 / (np.pi * q)) ** 2 * decay).sum(axis=1)
scatter = np.sqrt(law * (1 - law) / (runs * L))[1:]  # the points are independent
agree("share beyond the middle", rods_beyond[1:], law[1:], scatter)

# %% tags=["hide-input"]
look = {"color": "k", "fillstyle": "none"}
ax = panels(width=6, height=3)
ax.plot(t / room, law, color=RED, label="exact")
ax.plot(t / room, points_beyond, "x", color=BLUE, label="points between mirrors")
ax.plot(t / room, rods_beyond, "o", label="rods of one mass", **look)
ax.axhline(0.5, color="0.6", linewidth=0.8)
ax.set(xlabel="time t [l/W]", ylabel="share beyond the middle", ylim=(0, 0.7))
ax.legend(loc="lower right")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# The gas does not slosh. Fast points come back from the right wall while slow ones still arrive, and
# $f$ rises to a half.
#
# </details>
#
# ## 2. What a fluid would do
#
# Take a small wave in a fluid at rest. Its density is $1 + r\cos\kappa(y+\frac l2)$, its velocity
# $u\sin\kappa(y+\frac l2)$ and its temperature $1 + \theta\cos\kappa(y+\frac l2)$, each in units of
# its value at rest, $u$ in units of $W$. Measure time in $1/\kappa W$. With $V=0$ at the walls the
# equations of lesson 7, section 1, become
#
# $$\dot r = -u,\qquad \dot u = r + \theta - \Gamma u,\qquad \dot\theta = -2u - 2\Gamma_T\theta .$$
#
# Here $\Gamma$ is the rate of friction. The noise exchanges heat at the rate $2\Gamma_T$.
#
# **Your turn.** Write the matrix of these equations for the vector $(r, u, \theta)$.


# %%
def my_matrix(friction, heat):  # Gamma and Gamma_T
    return ...  # your code here


hint = "Row by row: what multiplies r, u and theta in each of the three equations?"
check(my_matrix, solutions.wave_matrix, at=[(0.0, 0.0), (0.2, 0.3)], hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_matrix(friction, heat):
#     return np.array([[0, -1, 0], [1, -friction, 1], [0, -2, -2 * heat]])
# ```
#
# </details>
#
# The isothermal fluid has $\theta = 0$, which leaves the first two rows and columns. The frequencies
# are the imaginary parts of the eigenvalues, and the speed of sound is $\omega/\kappa$:

# %%
M = solutions.wave_matrix(0, 0)
for name, part in {"isothermal fluid": M[:2, :2], "fluid with a temperature": M}.items():
    print(f"{name}: speed of sound {np.linalg.eigvals(part).imag.max():.4f} W")

# %% [markdown]
# **Your turn.** A temperature that stays constant needs an exchange of heat that is faster than the
# wave, $2\Gamma_T\gg1$. Rods of one mass have $\Gamma_T=\Gamma$. Up to which $\Gamma$, in units of
# $\kappa W$, does the isothermal wave swing at all? Is there a $\Gamma$ that suits both?

# %%
my_largest = ...  # your code here: the largest friction with which the wave swings

hint = "Eliminate r: u'' + Gamma u' + u = 0 is a damped oscillator. When is it critically damped?"
check(my_largest, solutions.LARGEST_FRICTION, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# $\omega^2 = 1-\Gamma^2/4$ vanishes at $\Gamma=2$, and at $\Gamma\gg\frac12$ the wave decays before
# it has swung. The friction that would fix the temperature destroys the wave. So rods of one mass
# have no isothermal sound.
#
# </details>
#
# Now watch the longest wave in the rods. Its momentum is $p = \sum_i m_iv_i\sin\kappa(y_i+\frac
# l2)$. A gas at rest has small random waves, and $C(t) = \langle p(t)\,p(0)\rangle/\langle
# p(0)^2\rangle$ says how they go on. In a fluid $C(t)$ is the $u(t)$ of a wave that starts with
# $u=1$ and $r=\theta=0$.


# %%
def momentum(ratio, friction=0.0, runs=1500):
    """Return p of the longest wave, over time and replica, for one period of sound at sqrt(3) W."""
    chain = gas(ratio, friction or 0.001)
    start = cb.equilibrium_states(chain, runs, seed=1)
    y, v = follow(chain, start, 2 * room / np.sqrt(3), noise=friction > 0)
    return (chain.rod_masses * v * np.sin(kappa * (y + room / 2))).sum(axis=2)


def correlation(p):
    """Return C(t) and its standard error."""
    C = (p * p[0]).mean(axis=1) / (p[0] ** 2).mean()
    rest = (p - C[:, None] * p[0]) * p[0]
    return C, rest.std(axis=1) / np.sqrt(p.shape[1]) / (p[0] ** 2).mean()


def fluids(friction, heat, times):
    """Return u(t) of the isothermal fluid and of the fluid with a temperature."""
    M = solutions.wave_matrix(friction, heat)
    return [np.array([expm(part * t)[1, 1] for t in times]) for part in (M[:2, :2], M)]


# %% [markdown]
# **Predict.** For rods of one mass without friction the density of the wave decays as $e^{-t^2/2}$
# (section 1, $t$ in units of $1/\kappa W$). What follows for $C(t)$, if $\dot r=-u$?
#
# **Run.**

# %%
tau = np.linspace(0, 2 * np.pi / np.sqrt(3), 25)  # kappa W t
C_one, error_one = correlation(momentum(1))
exact = (1 - tau**2) * np.exp(-(tau**2) / 2)
agree("C(t), rods of one mass", C_one[1:], exact[1:], error_one[1:])
for name, u in zip(("isothermal", "with a temperature"), fluids(0, 0, tau), strict=True):
    print(f"rods and fluid, {name}: {np.sqrt(np.mean((C_one - u) ** 2)):.2f} apart (rms)")

# %% [markdown]
# <details><summary>Explain</summary>
#
# Two derivatives follow, one for each $u$: $C = -\frac{d^2}{dt^2}e^{-t^2/2} = (1-t^2)\,e^{-t^2/2}$.
# The wave swings back once, to $-0.45$, and is gone. Both fluids would swing for ever. The picture is
# in section 5.
#
# </details>
#
# **You can stop here.** You know that equal elastic rods only exchange velocities, so that their gas
# is exactly solvable and no fluid, and which sound a fluid would have.
#
# ## 3. Two masses
#
# Now make every second rod heavier.
#
# **Your turn.** Write both velocities after an elastic collision of the masses $m_1$ and $m_2$.


# %%
def my_collision(v1, v2, m1, m2):
    return ...  # your code here: the new v1 and the new v2


hits = [(1.0, 0.0, 1.0, 1.0), (1.0, -1.0, 1.0, 3.0), (0.5, 0.2, 2.0, 1.0)]
hint = "Seen from the centre of mass, both velocities change their signs."
check(my_collision, solutions.collision, at=hits, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_collision(v1, v2, m1, m2):
#     centre = (m1 * v1 + m2 * v2) / (m1 + m2)
#     return 2 * centre - v1, 2 * centre - v2
# ```
#
# </details>
#
# **Predict.** All rods start with the same energy and random directions, $v_i = \pm\sqrt{T/m_i}$.
# After a hundred collisions of each rod, what is $\langle v^4\rangle/\langle v^2\rangle^2$ for rods
# of one mass? (It is 3 for Maxwell's law.) And for the light rods of two masses?

# %%
my_kurtosis = ...  # your code here: for rods of one mass

hint = "Equal rods exchange their velocities. Which speeds are there at the end?"
check(my_kurtosis, solutions.KURTOSIS_OF_ONE_MASS, hint=hint)

# %% [markdown]
# **Run.**

# %%
late = {}
for each in (1, ratio):
    chain = gas(each)
    states = cb.equilibrium_states(chain, 200, seed=3)
    signs = 2 * (states.velocity > 0) - 1
    states = states.assign(velocity=signs / np.sqrt(chain.rod_masses))
    _, v = follow(chain, states, 100, outputs=1)
    late[each] = v[-1][:, ::2].ravel() / np.sqrt(1 / chain.mass)
    kurtosis = np.mean(late[each] ** 4) / np.mean(late[each] ** 2) ** 2
    print(f"mass ratio {each}: <v^4>/<v^2>^2 = {kurtosis:.2f}")

# %% tags=["hide-input"]
ax = panels(width=8, height=2.8)
edges, middle = np.linspace(-4.1, 4.1, 42), np.linspace(-4, 4, 401)
for (each, values), colour in zip(late.items(), (RED, GREEN), strict=True):
    name = "one mass" if each == 1 else f"light rods, masses 1 : {each}"
    ax.hist(values, edges, density=True, histtype="step", color=colour, label=name, linewidth=1.5)
ax.plot(middle, np.exp(-(middle**2) / 2) / np.sqrt(2 * np.pi), "k--", label="Maxwell")
ax.set(xlabel=r"velocity $v/\sqrt{T/m}$", ylabel="probability density", ylim=(0, 2.7))
ax.legend(loc="upper left")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# Equal rods keep their two speeds for ever. Unequal ones come to Maxwell's law. Each small piece of
# their gas forgets all but its density, mean velocity and temperature. The equations of a fluid
# assume this *local equilibrium*.
#
# </details>
#
# ## 4. Sound
#
# **Predict.** Will $C(t)$ of two masses follow one of the fluids? Which one, without noise and
# friction?
#
# **Your turn.** Suppose that $C(t)$ has its first minimum at the time $t$. Which speed of sound does
# this give? The longest wave has the wavelength $2l$.


# %%
def my_speed(time, room):  # room is l
    return ...  # your code here


hint = "At its first minimum a wave has swung for half a period."
check(my_speed, solutions.speed, at=[(10.0, 20.0), (4.0, 20.0)], hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# In half a period sound runs half a wavelength, which is $l$.
#
# ```python
# def my_speed(time, room):
#     return room / time
# ```
#
# </details>
#
# **Run.** The error comes from 200 random choices of the replicas.

# %%
p_two = momentum(ratio, runs=3000)
C_two, error_two = correlation(p_two)


def found_speed(p):
    near = slice(8, 17)
    curve = np.polyfit(tau[near], correlation(p)[0][near], 3)
    turning = np.roots(np.polyder(curve))
    lowest = turning[np.argmin(abs(turning - np.pi / np.sqrt(3)))].real
    return solutions.speed(lowest / kappa, room)


rng = np.random.default_rng(5)
choices = rng.integers(0, p_two.shape[1], (200, p_two.shape[1]))
speed, speed_error = found_speed(p_two), np.std([found_speed(p_two[:, each]) for each in choices])
print(f"speed of sound in rods of two masses: {speed:.3f} ± {speed_error:.3f} W")
agree("speed of sound and that of the fluid with a temperature", speed, np.sqrt(3), speed_error)

# %% [markdown]
# <details><summary>Explain</summary>
#
# The sound of two masses has the speed $\sqrt3\,W$, that of the fluid with a temperature. Without
# noise nothing takes the heat away that compression makes.
#
# </details>
#
# ## 5. The equations of the paper, beside rods
#
# Give the rods noise and friction, $\Gamma = 0.2\,\kappa W$. The fluid loses momentum at the rate
# $\gamma/\langle m\rangle$. It exchanges heat at twice the rate $\gamma\langle1/m\rangle$, which is
# larger, because light rods feel the noise more.
#
# We solve the equations of lesson 7 with py-pde. A wall is a mirror for a fluid, too: the box is half
# of a ring of the length $2X$, and the other half is its mirror image.

# %%
friction, X = 0.2, room + 2 * L
heat = friction * (1 + ratio) ** 2 / (4 * ratio)  # <m> <1/m> is the last factor
ring = pde.CartesianGrid([[0, 2 * X]], 64, periodic=True)
x = ring.axes_coords[0]
shape = np.sin(np.pi * x / X)
equations = {
    "rho": "-d_dx(rho * V)",
    "V": "-V * d_dx(V) - d_dx(rho * W2 / (1 - 2 * rho)) / rho - friction * V",
    "W2": "-V * d_dx(W2) - 2 * W2 * d_dx(V) / (1 - 2 * rho) - 2 * heat * (W2 - 1)",
}


# %%
def solved(equations, **constants):
    """Return u(t) of a small wave, from the nonlinear equations."""
    values = {"rho": L / X + 0 * x, "V": 0.01 * shape, "W2": 1 + 0 * x}
    start = pde.FieldCollection([pde.ScalarField(ring, values[f], label=f) for f in equations])
    constants |= {"friction": friction * kappa, "heat": heat * kappa}
    fluid, storage = pde.PDE(equations, consts=constants), pde.MemoryStorage()
    every = tau[1] / kappa
    settings = {"dt": every / 6, "solver": "runge-kutta", "backend": "numpy"}
    fluid.solve(start, t_range=24 * every, tracker=[storage.tracker(every)], **settings)
    u = np.array([fields[1].data @ shape for fields in storage])
    return u / u[0]


isothermal = {name: equations[name] for name in ("rho", "V")}
by_pde = [solved(isothermal, W2=1.0), solved(equations)]

# %% [markdown]
# **Predict.** Which fluid do the rods of two masses follow now?
#
# **Run.**

# %%
C_noisy, error_noisy = correlation(momentum(ratio, friction))
for name, u, line in zip(
    ("isothermal", "with a temperature"), by_pde, fluids(friction, heat, tau), strict=True
):
    off = np.sqrt(np.mean((C_noisy - u) ** 2))
    print(f"fluid, {name}: {off:.2f} from the rods (rms),", end=" ")
    print(f"py-pde {abs(u - line).max():.3f} from the matrix of section 2")

# %% tags=["hide-input"]
figure, axes = plt.subplots(1, 3, figsize=(11, 4), sharey=True)
fine = np.linspace(0, tau[-1], 200)
shown = {
    "one mass, no friction": (C_one, error_one, 0, 0),
    f"masses 1 : {ratio}, no friction": (C_two, error_two, 0, 0),
    rf"masses 1 : {ratio}, $\Gamma = {friction}\,\kappa W$": (C_noisy, error_noisy, friction, heat),
}
for ax, (title, (C, error, *rates)) in zip(axes, shown.items(), strict=True):
    cold, warm = fluids(*rates, fine)
    ax.plot(fine, cold, "--", color=PINK, label="isothermal fluid")
    ax.plot(fine, warm, color=GREEN, label="fluid with a temperature")
    ax.errorbar(tau, C, error, fmt="o", markersize=4, label="rods", **look)
    ax.set(title=title, xlabel=r"time t [$1/\kappa W$]")
law = (1 - fine**2) * np.exp(-(fine**2) / 2)
axes[0].plot(fine, law, ":", color=RED, linewidth=2.5, label="exact")
for u, colour in zip(by_pde, (PINK, GREEN), strict=True):
    axes[2].plot(tau[::2], u[::2], "x", color=colour, label="py-pde" if colour == GREEN else None)
axes[0].set_ylabel(r"$\langle p(t)\,p(0)\rangle/\langle p(0)^2\rangle$")
lines = [axes[0].get_legend_handles_labels(), axes[2].get_legend_handles_labels()]
known = dict(zip(lines[0][1] + lines[1][1], lines[0][0] + lines[1][0], strict=True))
figure.legend(known.values(), known.keys(), loc="outside upper center", ncols=len(known))
plt.show()

# %% tags=["remove-cell"]
assert np.sqrt(np.mean((C_two - fluids(0, 0, tau)[1]) ** 2)) < 0.25
assert np.sqrt(np.mean((C_two - fluids(0, 0, tau)[0]) ** 2)) > 0.6
assert np.sqrt(np.mean((C_noisy - by_pde[1]) ** 2)) < 0.12
assert np.sqrt(np.mean((C_noisy - by_pde[0]) ** 2)) > 0.4
for by_grid, line in zip(by_pde, fluids(friction, heat, tau), strict=True):
    assert abs(by_grid - line).max() < 0.01
assert apart < 1e-4

# %% [markdown]
# <details><summary>Explain</summary>
#
# Rods of one mass follow their exact law and neither fluid. Rods of two masses follow the fluid with
# a temperature, with noise and without. The isothermal fluid of the paper is wrong here, because the
# noise is too slow to take the heat away.
#
# The undamped wave of rods becomes lower with each swing. Viscosity and heat conduction would explain
# this, which the fluid does not have. With more rods the difference is smaller.
#
# So a gas is a fluid if its collisions *mix* the velocities faster than the wave changes. In one
# dimension equal masses do not mix, however often they collide.
#
# </details>
#
# ## Exercises
#
# **1. Does it slosh?** Repeat section 1 with two masses: `cb.compare_relaxation(gas(ratio),
# "gathered", 0.5, ...)` lets the rods and both fluids out of the left half. Draw the centre of the
# gas over time for each.
#
# <details><summary>Solution</summary>
#
# ```python
# times = {"duration": 2 * room, "every": room / 16, "progress": False}
# tree = cb.compare_relaxation(gas(ratio), "gathered", 0.5, replicas=200, **times)
# for name in ("isothermal", "evolving"):
#     plt.plot(tree[name].time / room, tree[name].centre / room, label=name)
# rods = tree["particles"]
# plt.plot(rods.time / room, rods.mean_displacement.mean("particle") / room, "o", label="rods")
# plt.legend()
# ```
#
# It sloshes: the centre passes the middle and returns. That of the fluid with a temperature goes
# further.
#
# </details>
#
# **2. Much friction.** The density wave of equal rods with noise decays as $e^{-M/2}$, with
# $M = \frac{2}{\Gamma^2}(\Gamma t-1+e^{-\Gamma t})$ in the units of section 2. Compare it with both
# fluids (row and column 0 of the matrix, $\Gamma_T=\Gamma$) for $\Gamma = 0.2$, 1 and 4.
#
# <details><summary>Solution</summary>
#
# ```python
# times = np.linspace(0, 60, 2001)
# for G in (0.2, 1, 4):
#     law = np.exp(-(G * times - 1 + np.exp(-G * times)) / G**2)
#     M = my_matrix(G, G)
#     for part in (M[:2, :2], M):
#         print(G, max(abs(expm(part * t)[0, 0] - f) for t, f in zip(times, law)))
# ```
#
# The isothermal fluid is wrong by 0.75, 0.25 and 0.02, that with a temperature by 0.55, 0.07 and
# 0.001. Much friction leaves diffusion only.
#
# </details>
