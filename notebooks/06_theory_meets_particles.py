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
# # Theory meets particles
#
# **Question.** A hundred hard rods lie on a line, and each one touches its neighbours. A damped
# spring ties each rod to its own anchor, and noise shakes it. The rods collide elastically. Can a
# theory of *gases* predict where the rods are?
#
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) answer with a force
# balance: the pressure of a gas of hard rods balances the springs. This lesson repeats their
# calculation. It compares the result with a force balance that needs no fit, and with the exact
# solution. At the end you know which of the three is right, where, and why.
#
# *Level: third year. You need: lesson 4, sections 1 to 5; the pressure of a gas. Time: 60 minutes.
# To predict before you see the results, type `make lessons` in the folder of the project, and open
# the copy of this lesson without outputs in `build/lessons/`.*

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from teaching import BLUE, GREEN, ORANGE, PINK, agree, check, panels, right

# %%
import crazybilliards as cb

watch = {"duration": 40, "every": 0.1, "observe": "snapshots", "particles": range(46, 56)}
seen = cb.simulate(cb.Chain(size=100, amplitude=10), **watch, seed=1, progress=False)
time, middle = seen.time.values - seen.time.values[0], seen.position.values[0].T

# %% tags=["hide-input"]
ax = panels(height=3)
for number, x in enumerate(middle):
    ax.fill_between(time, x - 1, x + 1, color=(ORANGE, GREEN)[number % 2], linewidth=0)
ax.set(xlabel="time t [T]", ylabel="x [R]", xlim=(0, time[-1]), title="ten rods in the middle")
plt.show()

# %% [markdown]
# Each band is a rod, 2 R high. Where two bands touch, the rods collide and swap their velocities.
# A theory of gases does not follow any of them. It knows a density and a pressure.
#
# ## The paper's calculation in one cell
#
# [Lesson 0](00_the_analytics_section_in_sixty_lines.ipynb) repeats the paper's section with scipy.
# Its force balance stands here with the numbers $B$ and $C$ of the fit that section 3 makes to a
# simulation. That section also explains the equation. The function `force_balance` of the package does the same with a
# solution in closed form, and section 3 compares the two.

# %%
L, R, k, m = 100, 1.0, 1.0, 4 * np.pi / 3
W2, B, C = 10**2 / (2 * m), 9.96, 1 / 123.52  # A = 10, gamma = 1
half = np.linspace(0, 0.9999 / C, 2000)


def log_slope(x, log_free):  # of the number of rods per free length, rho/(1 - 2 R rho)
    return -k / (m * W2) * B * np.arctanh(C * x) / (1 + 2 * R * np.exp(log_free))


def integrate(start):
    free = np.exp(solve_ivp(log_slope, (0, half[-1]), [start], t_eval=half, rtol=1e-8).y[0])
    return free / (1 + 2 * R * free)


start = brentq(lambda start: 2 * np.trapezoid(integrate(start), half) - L, -5, 10)
in_one_cell = integrate(start)
print(f"density in the middle: {in_one_cell[0]:.4f} per R")

# %% [markdown]
# ## 1. The chain
#
# Between collisions rod $i$ obeys $m\ddot x = -\gamma\dot x - k(x - x^0_i) + A\,\xi(t)$. The unit
# of length is the rod radius $R$. Without collisions each rod would be a Brownian oscillator. Its
# velocity would be Gaussian with the width $W = A/\sqrt{2m\gamma}$, and its displacement Gaussian
# with the width $s = W\sqrt{m/k}$.

# %%
chain = cb.Chain(size=100, amplitude=10)
W, s = chain.free_velocity_width, chain.thermal_length
k, m, R = chain.stiffness, chain.mass, chain.radius
print(f"velocity width W = {W:.3f} R/T, thermal length s = {s:.2f} R")

# %% [markdown]
# **Predict.** The rods are 200 R long in all, and $s = 7$ R. How far, in units of $s$, do the
# collisions push the outermost rods away from their anchors? Do collisions change the width of the
# velocities?
#
# **Run.**

# %%
run = cb.simulate(chain, duration=100_000, replicas=2, seed=1, progress=False)
outermost = run.mean_displacement.values[-1] / s
print(f"mean displacement of the outermost rod: {outermost:.3f} s")
agree("velocity widths and W", run.velocity_width, W, run.velocity_width_error)

# %% tags=["remove-cell"]
assert 2.4 < outermost < 2.6

# %% tags=["hide-input"]
left, right_panel = panels(2)
cb.overlay({"simulation": run}, "mean_displacement", ax=left)
cb.overlay({"simulation": run}, "velocity_width", ax=right_panel)
left.axhline(s, color="0.6", label="s")
right_panel.axhline(W, color=ORANGE, label="W, free rods")
right_panel.set_ylim(0.98 * W, 1.02 * W)
left.legend()
right_panel.legend()
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# Collisions push the outermost rods out by $2.5\,s$. They do not change the velocities. For
# $e = 1$ the steady state is a state of thermal equilibrium, and in equilibrium the velocities are
# independent of the positions.
# </details>
#
# ## 2. The density
#
# The paper bins the density by the *fraction of each bin that rods cover*. Then it takes a running
# average over the length of a rod. Both steps are convolutions with a box of length $2R$, and
# `smooth` does both. Two densities can be compared only after the same smoothing.

# %%
ax = cb.overlay({"simulation": cb.smooth(run)}, ax=panels(width=6))
ax.axhline(chain.close_packed_density, color="0.6", linewidth=1)
ax.text(0, 0.505, "close packing", ha="center", color="0.4")
ax.set_ylim(0, 0.55)
plt.show()

# %% [markdown]
# ## 3. The gas-kinetic force balance
#
# Hard rods with the velocity variance $W^2$ and the density $\rho$ have the pressure
# $m\rho W^2/(1-2R\rho)$. In the steady state the gradient of the pressure balances the springs. The
# spring of a rod pulls with $-k\langle\Delta x\rangle$ on average, so
#
# $$\rho' = -\frac{k}{mW^2}\,\langle\Delta x\rangle(x)\;\rho\,(1-2R\rho)^2 .$$
#
# **Task.** Write the right side of this equation as a function.


# %% tags=["remove-cell"]
def slope_solution(density, displacement):
    return -k / (m * W**2) * displacement * density * (1 - 2 * R * density) ** 2


places = [(0.4, 5.0), (0.1, -12.0)]
assert right(slope_solution, slope_solution, at=places)
assert not right(lambda *given: -slope_solution(*given), slope_solution, at=places)


# %%
def slope(density, displacement):
    return ...  # your code here


hint = "the springs pull inwards: with a displacement above 0 the density falls with x"
check(slope, slope_solution, at=places, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def slope(density, displacement):
#     return -k / (m * W**2) * displacement * density * (1 - 2 * R * density) ** 2
# ```
# </details>
#
# The equation needs one more thing: the mean displacement $\langle\Delta x\rangle(x)$ of the rods
# found at $x$. We compare two ways to get it.
#
# **The paper's way.** Measure the displacement in the simulation, fit $B\,\mathrm{arctanh}(Cx)$ to
# it, and integrate the equation.

# %%
fit = cb.fit_arctanh(run)
print(f"B = {fit.scale / s:.2f} s, 1/C = {1 / fit.steepness:.1f} R, misfit {fit.misfit:.3f} R")
paper = cb.force_balance(chain, displacement=fit)
inside = half < 123  # the density falls to 0 within one cell of the grid of force_balance, at 123.5
apart = np.abs(np.interp(half, paper.x, paper.density) - in_one_cell)[inside].max()
print(f"force_balance and the first cell: {2 * R * apart:.1e} of close packing apart")

# %% tags=["remove-cell"]
assert abs(fit.scale / s - 1.41) < 0.03
assert 2 * R * apart < 1e-3

# %% [markdown]
# **A way without any fit.** The $N$-th rod from the left belongs to the $N$-th anchor. At $x$ the
# number of rods to the left is $N(x) = \int_{-\infty}^x\rho$. Therefore
# $\langle\Delta x\rangle = x - (2R+g)(N - L/2)$, where $g$ is the gap between anchors, here 0. The
# equation now contains only $\rho$, and `force_balance` solves it as a boundary-value problem.
#
# **The exact solution.** [Lesson 4](04_the_elastic_chain_is_exactly_solvable.ipynb), sections 1 and 3,
# derives it. Subtract the rods' own length from their positions. In this reduced coordinate the
# rods are the **order statistics** of 100 independent Gaussian numbers.

# %%
labels = cb.force_balance(chain)
exact = cb.equilibrium(chain)
print(f"error of the numerical solution: {exact.attrs['residual']:.1e}")

# %% tags=["remove-cell"]
# The solution by labels obeys the equation of the task.
given = labels.density.values, labels.displacement.values
assert abs(np.gradient(given[0], labels.x.values) - slope_solution(*given)).max() < 1e-5

# %% [markdown]
# ## 4. All of it in one picture
#
# **Predict.** Which of the three theories is closest to the simulation? Where along the chain is
# the largest error of the other two?
#
# **Run.**

# %%
results = {
    "simulation": cb.smooth(run),
    "exact": cb.smooth(exact),
    "force balance, without any fit": cb.smooth(labels),
    "force balance, arctanh fit": cb.smooth(paper),
}
for name in list(results)[1:]:
    d = cb.deviation(results["simulation"], results[name])
    print(f"{name:30s} largest difference {100 * d.maximum:.1f} % of close packing")

# %% tags=["hide-input"]
fig, (above, below) = plt.subplots(
    2, 1, figsize=(7, 5), sharex=True, height_ratios=(3, 1.4), layout="constrained"
)
cb.overlay(results, ax=above)
above.legend()
reference = cb.smooth(exact).density
differences = {}
for name, result in results.items():
    difference = ((result.density - reference) * 2).assign_attrs(reference.attrs)
    differences[name] = result.assign(density=difference)
    if "density_error" in result:
        differences[name]["density_error"] = result.density_error * 2
cb.overlay(differences, ax=below)
above.set_xlabel("")
below.set_xlim(-150, 150)
below.set_ylabel(r"minus exact, $\times 2R$")
plt.show()

# %% tags=["remove-cell"]
exact_off = cb.deviation(results["simulation"], results["exact"])
labels_off = cb.deviation(results["simulation"], results["force balance, without any fit"])
paper_off = cb.deviation(results["simulation"], results["force balance, arctanh fit"])
assert exact_off.maximum < 0.01
assert exact_off.maximum_in_errors < 5
assert labels_off.maximum < paper_off.maximum < 0.04

# %% [markdown]
# <details><summary>Explain</summary>
#
# The exact solution agrees with the simulation everywhere within five standard errors. The two
# force balances are wrong by about 3 % of close packing, and only near the ends of the chain, where
# the density falls to zero within a few rods. Sections 5 and 6 find the two reasons.
# </details>
#
# ## 5. From points to rods
#
# A force balance has two steps. The first is the density of *points*. Take the rods' length out,
# $y = x - 2R\,(N - L/2)$. In $y$ the density is $\rho_y = \rho/(1-2R\rho)$, and the equation of the
# task says $\mathrm{d}\ln\rho_y/\mathrm{d}y = -\frac{k}{mW^2}\langle\Delta x\rangle$ ([lesson
# 5](05_from_the_kinetic_equation_to_the_force_balance.ipynb), section 5).
#
# The second step reads the rods off the points. *A fluid* has all of its matter with the label $N$
# at one place, $x = y + 2R\,(N - L/2)$. Its density is therefore $\rho = \rho_y/(1+2R\rho_y)$, and
# rod $i$ is what lies between $N = i-1$ and $N = i$. *A rod* is the $i$-th of $L$ points.
# [Lesson 4](04_the_elastic_chain_is_exactly_solvable.ipynb), section 4, derives its distribution
# for a Gaussian. Other independent points have $\rho_y/L$ in its place:
#
# $$p_i(y) = \frac{\rho_y(y)}{L}\;\mathrm{Beta}_{i,\,L+1-i}\Big(\frac{N(y)}{L}\Big),\qquad
# \rho(x) = \sum_i p_i\Big(x - 2R\,\big(i - \tfrac{L+1}2\big)\Big).$$
#
# The function `rod_by_rod` takes the points of a theory, and computes this sum.
#
# **Predict.** At $A = 1$ the rods hardly move, $s = 0.7$ R. Is the error of the force balance
# without any fit larger or smaller than at $A = 10$? Which part of it comes from the first step?
#
# **Run.**


# %%
def error(theory, chain):  # largest error of the density, in % of close packing
    return 100 * cb.deviation(cb.smooth(cb.equilibrium(chain)), cb.smooth(theory)).maximum


for amplitude in (30, 10, 3, 1):
    case = chain.replace(amplitude=amplitude)
    fluid = cb.force_balance(case)
    by_rod = cb.rod_by_rod(fluid)
    print(f"A = {amplitude}: fluid {error(fluid, case):.1f} %,", end=" ")
    print(f"rod by rod {error(by_rod, case):.3f} %")
print(f"width of the outermost rod at A = 1: {by_rod.displacement_width[-1].item():.2f} R")

# %% tags=["hide-input"]
read = {"exact": cb.equilibrium(case), "fluid": fluid, "rod by rod": by_rod}
looks = ({"color": ORANGE, "linewidth": 3.5}, {"color": BLUE}, {"color": "k", "linestyle": ":"})
raw, smoothed = panels(2, height=3.4)
for (name, result), look in zip(read.items(), looks, strict=True):
    raw.plot(result.x, result.density, label=name, **look)
    smoothed.plot(result.x, cb.smooth(result).density, label=name, **look)
raw.set(title="the right end at A = 1", ylabel=r"density $\rho$ [1/R]")
smoothed.set(title="the same, smoothed")
for ax in (raw, smoothed):
    ax.set(xlabel="position x [R]", xlim=(88, 106))
    ax.legend()
plt.show()

# %% tags=["remove-cell"]
assert 0.13 < error(fluid, case) / 100 < 0.14
assert error(by_rod, case) < 1e-3
of_run = cb.deviation(cb.smooth(run), cb.smooth(cb.rod_by_rod(labels)))
assert of_run.maximum_in_errors < 5
assert abs(by_rod.mean_displacement - read["exact"].mean_displacement).max() < 1e-5

# %% [markdown]
# <details><summary>Explain</summary>
#
# The first step makes no error at any amplitude. Without a gap $\langle\Delta x\rangle = y$, so
# $\rho_y$ is $L$ times a Gaussian of the width $s$. These are the independent points of lesson 4.
# **For $e = 1$ without a gap, the force balance (equation 19 of the paper) is exact for the points.
# What is approximate is to read the rods off a fluid, by $1/(1-2R\rho)$.**
#
# The fluid spreads every rod over more than its length 2 R. At $A = 1$ the outermost rod is found
# within about 0.3 R of its mean position, so the error is largest there. Further inside, the error
# of a rod and those of its neighbours cancel.
# </details>
#
# ## 6. What does the fit cost?
#
# [Lesson 4](04_the_elastic_chain_is_exactly_solvable.ipynb), section 5, explains why an arctanh
# fits the mean displacements at all. The root mean square misfit of section 3 is 0.02 R.
#
# **Predict.** Read the rods off the force balance with the fit, too. Which error is left? Which
# error is left if the *exact* mean displacements replace the fit?
#
# **Run.**

# %%
closures = {"arctanh fit": paper, "exact mean displacements": cb.force_balance(chain, exact)}
for name, theory in closures.items():
    print(f"{name}: fluid {error(theory, chain):.1f} %,", end=" ")
    print(f"rod by rod {error(cb.rod_by_rod(theory), chain):.1f} %")
place, width = exact.mean_position[-1].item(), exact.displacement_width[-1].item()
print(f"outermost rod: mean position {place:.1f} R, width {width:.1f} R")

# %% tags=["hide-input"]
end = labels.sel(x=slice(100, 128))
before = end.x.values[end.x.values < 1 / fit.steepness]
ax = panels(width=6, height=3)
ax.plot(end.x, end.displacement, color=BLUE, label="points: $y$")
ax.plot(before, fit(before), "--", color=PINK, label="arctanh fit")
ax.plot(exact.mean_position[-7:], exact.mean_displacement[-7:], "ko", label="rods, exact")
ax.axvline(1 / fit.steepness, color="0.6", linewidth=1)
ax.text(1 / fit.steepness + 0.3, 11, "x = 1/C", color="0.4")
ax.set(xlim=(99, 128), ylim=(10, 32), xlabel="position x [R]", ylabel="displacement [R]")
ax.legend()
plt.show()

# %% tags=["remove-cell"]
of_fit, of_exact = (error(cb.rod_by_rod(theory), chain) for theory in closures.values())
assert 2 < of_fit < 2.8
assert 0.2 < of_exact < 0.5

# %% [markdown]
# <details><summary>Explain</summary>
#
# With the fit, 2.4 % are left. The fit is good at the mean positions of the rods, but it ends at
# $1/C = 123.5$ R, and its force balance has no points beyond. The outermost rod, with the width
# 3.0 R around 116.7 R, is sometimes found there. With the exact mean displacements 0.3 % are left,
# because the mean displacement of a rod is not quite the $y$ of the points at its mean position.
# </details>
#
# ## Exercises
#
# **1.** Put gaps between the anchors, `gap=0.2`. Does the arctanh still fit the displacement?
#
# <details><summary>Solution</summary>
#
# No. Inside the chain the rods now have room, so their mean displacement is zero on a plateau. An
# arctanh has no plateau. At $A = 10$ the misfit grows from 0.02 R to 0.4 R, and the density of the
# paper's force balance is wrong by 13 %. The force balance without any fit contains the gap. Its
# error as a fluid stays at 2.4 %. (`rod_by_rod` takes the distributions of rods with a gap from the
# exact solution.)
# </details>
#
# **2.** The force balance without any fit works for every spring. Compare it with `equilibrium` for
# `spring="quadratic"`. You need no simulation.
#
# <details><summary>Solution</summary>
#
# ```python
# soft = cb.Chain(amplitude=10, spring="quadratic")
# labels = cb.force_balance(soft)
# error(labels, soft), error(cb.rod_by_rod(labels), soft)
# ```
#
# The fluid is wrong by 10 %. Rod by rod nothing is left, because the points are independent on any
# spring.
# </details>
