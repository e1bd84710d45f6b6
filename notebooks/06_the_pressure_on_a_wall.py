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
# # The pressure on a wall
#
# **Question.** Take the springs away and put the rods between two walls. They are now a gas. How
# hard does it press on a wall? How long is a rod, if the pressure is all that you can measure? And
# is the gas near a wall the same as far from it?
#
# Lengths are in rod radii $R$, so a rod is $2R$ long. The box has the length $X$ from wall to wall.
# All collisions are elastic, also those with the walls. In one dimension the pressure $P$ is a
# force: the mean force on a wall.
#
# *90 minutes. `make lessons` writes copies without outputs and solutions.*
#
# **Two minutes on the page.** Let the page measure the force of
# <a href="../docs/chain.md#spring=none&size=20&box=80&second=pressure&speed=100">20 rods in 80
# R</a>. Guess the force in a box of 60 R, and then set $X = 60$.

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from solutions import lesson_06 as solutions
from teaching import GREEN, PINK, RED, agree, check, choose, panels, safe

# %% [markdown]
# **What you may change.** The number of rods `size`, from 10 to 100 (with more the runs are
# too short), and seeds. After a change run all cells below it again.

# %%
size = 50

# %% tags=["hide-input"]
if not safe(
    10 <= size <= 100,
    f"This lesson is for 10 to 100 rods, not {size}: with fewer the law of section 3 is hard to "
    "see, and with more the runs are too short. The lesson goes on with size = 50.",
):
    size = 50

# %%
import crazybilliards as cb

gas = cb.Chain(size=size, stiffness=0, damping=0.1, amplitude=1, box=2.5 * size)
L, T, R, X = gas.size, gas.temperature, gas.radius, gas.box
print(f"{L} rods fill {2 * R * L / X:.0%} of the box")

# %% [markdown]
# The noise $A$ and the damping $\gamma$ act on all rods and keep their temperature at $T = mW^2 =
# A^2/2\gamma$ (lesson 1).
#
# ## 1. Points
#
# Begin with points instead of rods, and with only one of them. It flies to and fro between two walls
# that are `room` apart, with the speed $v$. Each time it hits the right wall it turns round.
#
# **Your turn.** Which momentum does a hit give to the right wall? How often does it hit that wall?
# Write the mean force on this wall.


# %%
def my_force(v, room, mass):
    return ...  # your code here


points = [(1.0, 10.0, 1.0), (2.0, 10.0, 1.0), (1.0, 4.0, 3.0)]
hint = "It gives 2 m v at each hit, and flies to the other wall and back in between."
check(my_force, solutions.force_of_a_point, at=points, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# The momentum changes from $mv$ to $-mv$, so the wall gets $2mv$. The time from hit to hit is
# $2\,\mathrm{room}/v$. The mean force is the quotient.
#
# ```python
# def my_force(v, room, mass):
#     return mass * v**2 / room
# ```
#
# </details>
#
# Now $L$ points share the room $l$. When two of them collide they exchange their velocities, so one
# can as well say that they fly through one another and exchange their names. The wall does not ask
# for names. It feels $L$ points that do not notice each other, and their forces add up:
#
# $$P = \frac{L\,m\langle v^2\rangle}{l} = \frac{L\,T}{l}.$$
#
# This is the law of an ideal gas.
#
# **Predict.** Make all points twice as heavy and leave $A$ and $\gamma$ as they are. Is the pressure
# then higher, lower or equal?

# %%
my_choice = "..."  # your code here: 1 higher, 2 lower or 3 equal

hint = "Which width W has a heavier point (lesson 1)?"
choose(my_choice, "higher", "lower", "equal", right=solutions.TWICE_THE_MASS, hint=hint)

# %% [markdown]
# **Run.** The observer `walls` adds up the momentum that each wall gets, and divides it by the time.
# We take very short rods as points.


# %%
def measured_pressure(chain, duration=150_000, seed=1):
    """Return the mean force on the two walls, and its standard error."""
    settings = {"duration": duration, "seed": seed, "progress": False}
    run = cb.simulate(chain, observe="walls", **settings)
    return run.wall_force.values.mean(), np.hypot(*run.wall_force_error.values) / 2


points = gas.replace(radius=1e-6)
for factor in (1, 2):
    heavier = points.replace(mass=factor * gas.mass)
    P, error = measured_pressure(heavier)
    agree(f"{factor} times the mass, P / (L T / X)", P * X / (L * T), 1, error * X / (L * T))

# %% [markdown]
# <details><summary>Explain</summary>
#
# The pressure stays the same. Heavier points are slower: each hit gives more momentum, and the hits
# are rarer. The force contains only $m\langle v^2\rangle = T$.
#
# </details>
#
# ## 2. Rods
#
# Rods of the length $2R$ take up $2RL$ of the box.
#
# **Predict.** The rods fill half of the box. Is the pressure that of the points in the same box,
# larger by a half, or twice as large?
#
# To find the law, take the rods' own length out, as in lesson 3, section 2:
#
# $$y_i = x_i - 2R\Big(i-\frac{L+1}2\Big).$$
#
# Rods touch when their $y$ are equal. So in $y$ the rods are points. The first rod touches the left
# wall when $x_1 = -\frac X2 + R$, the last one touches the right wall when $x_L = \frac X2 - R$.
#
# **Your turn.** Where do these two rods have their $y$ at the walls? How much room do the points
# have? Write the pressure of the rods as a function of the length $X$ of the box (`box`). The
# numbers `L`, `T` and `R` are known.


# %%
def my_pressure(box):
    return ...  # your code here


some_boxes = [(3.0 * L,), (2.2 * L,), (10.0 * L,)]
hint = "Insert i = 1 and i = L into y. The difference of the two is the room l of section 1."
check(my_pressure, lambda box: solutions.pressure(box, L, T, R), at=some_boxes, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# The points fly between $-\frac X2+RL$ and $\frac X2-RL$. Their room is the *free length*
# $l = X-2RL$, and section 1 gives $P = LT/(X-2RL)$.
#
# ```python
# def my_pressure(box):
#     return L * T / (box - 2 * R * L)
# ```
#
# </details>
#
# **Run.** Six boxes, from nearly full to three quarters empty:

# %%
boxes = 2 * R * L * np.array([1.1, 1.25, 1.6, 2, 3, 4])
P, P_error = np.array([measured_pressure(gas.replace(box=box)) for box in boxes]).T
law = solutions.pressure(boxes, L, T, R)
for box, ratio, points_law in zip(boxes, P / law, L * T / boxes, strict=True):
    share = 2 * R * L / box
    print(f"rods fill {share:.0%}: P is {ratio:.4f} of the law of rods", end=", ")
    print(f"{ratio * solutions.pressure(box, L, T, R) / points_law:.2f} of that of points")
agree("P over the law of rods", P / law, 1, P_error / law)

# %% [markdown]
# <details><summary>Explain</summary>
#
# In a half full box the pressure is twice that of points, because the free length is half of $X$. The
# mean density is $\rho = L/X$. Divide numerator and denominator of the law by $X$:
#
# $$P = \frac{LT}{X-2RL} = \frac{\rho T}{1-2R\rho} = \frac{\rho mW^2}{1-2R\rho}.$$
#
# This is the pressure of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460). Lesson 5 needed a density
# that changes little over the length of a rod. In a box their formula is exact, as Tonks found in
# 1936.
#
# </details>
#
# ## 3. The length of a rod
#
# Suppose that you cannot see the rods. You know how many there are, you can move a wall, and you can
# measure the force on it. (Van der Waals found the size of molecules from pressures in 1873.)
#
# **Predict.** Draw $1/P$ against $X$. Which curve is it? Where does it meet the axis $1/P = 0$?
# **Back on the page** you can test your drawing with
# <a href="../docs/chain.md#challenge=pressure">three boxes</a>.
#
# **Your turn.** Write a function that finds the length of one rod from measured boxes and pressures.
# It must not use $R$ or $T$. `np.polyfit(x, y, 1)` returns the slope and the constant of the best
# straight line.


# %%
def my_length(boxes, pressures):
    return ...  # your code here


trials = [(boxes, solutions.pressure(boxes, L, 3.0, radius)) for radius in (0.2, 1.0)]
hint = "1/P = (X - 2RL)/(LT) is a straight line. It vanishes where the rods fill the box."
check(my_length, lambda box, P: solutions.rod_length(box, P, L), at=trials, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_length(boxes, pressures):
#     slope, constant = np.polyfit(boxes, 1 / np.array(pressures), 1)
#     return -constant / slope / L
# ```
#
# </details>
#
# **Run.** The error comes from 1000 repetitions with pressures that scatter as the measured ones do.

# %%
rng = np.random.default_rng(5)
repeated = rng.normal(P, P_error, (1000, P.size))
lengths = [solutions.rod_length(boxes, each, L) for each in repeated]
found, length_error = solutions.rod_length(boxes, P, L), np.std(lengths)
print(f"length of a rod from the pressures: {found:.4f} ± {length_error:.4f} R")
agree("length of a rod", found, 2 * R, length_error, unit="R")

# %% tags=["hide-input"]
slope, constant = np.polyfit(boxes, 1 / P, 1)
line = np.array([0.85, 4.15]) * 2 * R * L
ax = panels(width=7, height=3.2)
ax.plot(line, (slope * line + constant) * T / (2 * R), color=RED, label="best straight line")
ax.plot(line, line / (2 * R * L), "--", color="0.5", label="points: $X/LT$")
look = {"fmt": "o", "color": "k", "fillstyle": "none"}
ax.errorbar(boxes, T / P / (2 * R), T / P**2 * P_error / (2 * R), label="rods", zorder=3, **look)
ax.axhline(0, color="k", linewidth=0.8)
ax.plot(found * L, 0, "v", color=GREEN, markersize=9, label="here the rods fill the box")
ax.set(xlabel="length of the box X [R]", ylabel="$1/P$  [$2R/T$]")
ax.legend(loc="upper left")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# The slope is $1/LT$, so the line gives the temperature as well. The line of points is parallel and
# goes through the origin. Where $1/P$ vanishes, the box is as long as all rods together.
#
# </details>
#
# **You can stop here.** You have derived the pressure of hard rods, measured it up to nearly close
# packing, and found the length of a rod from it. The rest of the lesson looks at the places of the
# rods near a wall.
#
# ## 4. At the wall
#
# Only the first rod touches the left wall. Let $\rho_1$ be its density where it touches, at
# $x = -\frac X2+R$. In a time unit it hits the wall with velocities around $-v$
# $\rho_1 f(v)\,v\,dv$ times, and each hit gives $2mv$. The sum over $v>0$ is the *contact theorem*,
# $P = \rho_1m\langle v^2\rangle = \rho_1T$.
#
# **Your turn.** The force balance of the fluid (lesson 5) says that the density is $L/X$ everywhere,
# because no spring pulls. How many times larger is $\rho_1$? Enter it with `L`, `R` and `X`.

# %%
my_ratio = ...  # your code here: rho_1 divided by L/X

hint = "Insert the pressure of section 2 into the contact theorem."
check(my_ratio, solutions.density_at_the_wall(X, L, R), hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# $\rho_1 = P/T = L/(X-2RL)$, and divided by $L/X$ this is `X / (X - 2 * R * L)`, here 5.
#
# </details>
#
# So the fluid, whose pressure is right, has a fifth of the right density at the wall. Where are the
# rods? In $y$ they are $L$ independent points, each with the same probability everywhere in the free
# length. Rod 1 is the leftmost point, rod 2 the next, and so on.
#
# **Your turn.** `uniform` holds $L$ independent numbers between 0 and 1. Make of them the positions
# $x_i$ of all rods, from left to right. This is an exact simulation without time.


# %%
def my_places(uniform):
    return ...  # your code here: X, L and R are known, and np.arange(1, L + 1) has all i


draws = [(np.random.default_rng(seed).random(L),) for seed in (1, 2)]
hint = "np.sort puts them in order. Make them y between -l/2 and l/2, and put the lengths back."
check(my_places, lambda uniform: solutions.places(uniform, X, R), at=draws, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_places(uniform):
#     i = np.arange(1, L + 1)
#     y = (X - 2 * R * L) * (np.sort(uniform) - 0.5)
#     return y + 2 * R * (i - (L + 1) / 2)
# ```
#
# </details>
#
# **Predict.** Sketch the density of all rods near the left wall. How far from the wall does it show
# single rods?
#
# **Run.** We draw 20 000 such states, and simulate the gas with all its collisions. `force_balance`
# is the fluid, and `equilibrium` is the exact density.

# %%
rng = np.random.default_rng(6)
drawn = np.array([solutions.places(rng.random(L), X, R) for _ in range(20_000)])
settings = {"duration": 100_000, "seed": 2, "progress": False}
run = cb.simulate(gas, observe=["density", "widths"], **settings)
fluid, exact = cb.force_balance(gas), cb.equilibrium(gas)

# %%
first = np.arange(1, 6)
mean = -X / 2 + R + (X - 2 * R * L) * first / (L + 1) + 2 * R * (first - 1)
scatter = drawn.std(axis=0)[:5] / np.sqrt(len(drawn))
agree("mean places of rods 1 to 5, drawn", drawn[:, :5].mean(axis=0), mean, scatter, unit="R")
simulated = run.mean_position.values[:5], mean, run.mean_displacement_error.values[:5]
agree("mean places of rods 1 to 5, simulated", *simulated, unit="R")

# %% [markdown]
# The last picture shows the pressure and the density near the left wall, each for the rods, the force
# balance and the exact law.

# %% tags=["hide-input"]
share, filling = 2 * R * L / boxes, np.linspace(0.05, 0.93, 200)
left, at_wall = panels(2, height=4)
left.semilogy(filling, filling / (1 - filling), color=RED, label=r"exact, $LT/(X-2RL)$")
left.semilogy(filling, filling, "--", color="0.5", label="points, $LT/X$")
of_fluid = [cb.force_balance(gas.replace(box=box)).wall_force.values.mean() for box in boxes]
square = {"marker": "s", "linestyle": "none", "fillstyle": "none", "markersize": 10}
left.plot(share, 2 * R * np.array(of_fluid) / T, color=PINK, label="force balance", **square)
left.errorbar(share, 2 * R * P / T, 2 * R * P_error / T, label="rods", **look)
left.set(xlabel=r"filling $2RL/X$", ylabel="pressure $P$ [$T/2R$]")
distance, step = 18 * R, R / 4
edges = -X / 2 + np.arange(0, distance + step, step)
counts = np.histogram(drawn.ravel(), edges)[0] / len(drawn) / step
at_wall.stairs(2 * R * counts, edges + X / 2, color="0.6", fill=True, label="sorted numbers")
near = exact.sel(x=slice(-X / 2 + distance))
at_wall.plot(near.x + X / 2, 2 * R * near.density, color=RED, label="exact equilibrium")
low = np.arange(0, distance, step)
seen = [run.density.sel(x=slice(a, a + step)).mean().item() for a in low - X / 2]
at_wall.plot(low + step / 2, 2 * R * np.array(seen), "ko", fillstyle="none", label="rods")
inside = fluid.x < -X / 2 + distance
level = 2 * R * fluid.density[inside]
at_wall.plot(fluid.x[inside] + X / 2, level, "--", color=PINK, linewidth=2, label="force balance")
at_wall.set(xlabel="distance from the wall [R]", ylabel=r"density $\rho$ [$1/2R$]", xlim=(0, 18))
for ax in (left, at_wall):
    ax.legend()
plt.show()

# %% tags=["remove-cell"]
by_rod, by_recursion = (cb.smooth(each).density for each in (cb.rod_by_rod(fluid), exact))
assert abs(by_rod - by_recursion).max() < 5e-4 * gas.close_packed_density
assert np.allclose(of_fluid, law, rtol=1e-6)
assert np.allclose(exact.wall_force, solutions.pressure(X, L, T, R), rtol=1e-5)

# %% [markdown]
# <details><summary>Explain</summary>
#
# No centre comes nearer to the wall than $R$. The rods line up behind this place in *layers*, about
# $2R + l/L$ apart. There are $i$ random gaps before rod $i$, so its place is uncertain by about
# $\sqrt i\,l/L$. The layers disappear where this is more than the length of a rod.
#
# The fluid has no layers. Yet its pressure is exact: the pressure is the same everywhere in the gas,
# and far from the wall the fluid has the right density. `cb.rod_by_rod(fluid)` sorts the points of
# the fluid as you have done, and has all layers. `docs/physics/gas_in_a_box.md` says more.
#
# </details>
#
# ## Exercises
#
# **1. Two masses.** `gas.replace(mass_ratio=3)` makes every second rod three times as heavy. Rods of
# different masses do not exchange their velocities, so the argument of section 1 fails. Is the law
# still right?
#
# <details><summary>Solution</summary>
#
# ```python
# mixture = gas.replace(mass_ratio=3)
# P_two, error = measured_pressure(mixture)
# print(P_two / my_pressure(X), error / my_pressure(X))
# ```
#
# Yes. In equilibrium positions and velocities are independent (Gibbs), and only the velocities depend
# on the masses. So $\rho_1$ is the same, and the contact theorem gives the same pressure.
#
# </details>
#
# **2. Collisions that take energy.** Compare `gas.replace(restitution=0.9)` with the law. Which
# temperature must stand in it?
#
# <details><summary>Solution</summary>
#
# ```python
# cold = gas.replace(restitution=0.9)
# run = cb.simulate(cold, duration=50_000, observe=["walls", "widths"], seed=1, progress=False)
# heat = cold.mass * (run.velocity_width.values**2).mean()
# print(run.wall_force.values.mean() / my_pressure(X), heat / T)
# ```
#
# The pressure is 0.194 of the law, and the gas has cooled to 0.193 of $T$, in the mean over all rods.
# With this mean the law is exact.
#
# </details>
