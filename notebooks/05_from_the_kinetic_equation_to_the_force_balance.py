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
# # From the kinetic equation to the force balance
#
# **Question.** A gas of points with the velocity variance $W^2$ has the pressure $\rho W^2$ (per
# mass). The rods of our chain have a length. Which pressure do they have? And does its balance with
# the springs predict where the rods are? The paper of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) gives both.
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = \frac{4\pi}{3}M$), times in
# $t_0=\sqrt{M/k}$. Collisions are elastic, $e=1$, and the anchors of the springs have no gap.
#
# *90 minutes. `make lessons` writes copies without outputs and solutions.*
#
# **Two minutes on the page.** Draw on paper the density of
# <a href="../docs/chain.md#amplitude=3&size=30&speed=100">30 rods</a> that you expect, from the
# centre to the right end: is it a smooth hill, or does it show the rods?

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy import stats
from solutions import lesson_05 as solutions
from teaching import BLUE, GREEN, ORANGE, PINK, agree, check, mean_and_error, panels, safe

# %% [markdown]
# **What you may change.** The number of rods `size`, from 10 to 60, and the strength of the noise
# `amplitude`, from 1 to 10. Weaker noise makes layers that are too narrow for the pictures. The
# explanations quote the numbers of 30 rods at the amplitude 3.

# %%
size, amplitude = 30, 3

# %% tags=["hide-input"]
if not safe(
    10 <= size <= 60 and 1 <= amplitude <= 10,
    f"This lesson is for 10 to 60 rods and amplitudes from 1 to 10, not {size} and {amplitude}: "
    "its pictures cannot show others. The lesson goes on with 30 rods and the amplitude 3.",
):
    size, amplitude = 30, 3

# %%
import crazybilliards as cb

chain = cb.Chain(size=size, amplitude=amplitude)
W, s, d = chain.free_velocity_width, chain.thermal_length, 2 * chain.radius  # d: length of a rod
print(f"free velocity width W = {W:.2f} R/t_0, thermal length s = {s:.2f} R")

# %% [markdown]
# ## 1. What pushes the chain apart?
#
# **Predict.** Make the rods ten times shorter, and put the anchors closer together, so that rods at
# rest still touch. Will the rods collide more often, less often, or equally often? And how much
# shorter will the chain become, from the mean position of its first rod to that of its last?

# %%
my_shorter = ...  # your code here: a length in R

hint = "Do the two chains differ in the coordinate y of lesson 4, where rods are points?"
check(my_shorter, solutions.shorter_by(chain, 0.1), hint=hint, tolerance=0.02)

# %% [markdown]
# **Run.** Both simulations use the same random numbers.

# %%
lengths = {}
for radius in (1, 0.1):
    short = chain.replace(radius=radius)
    run = cb.simulate(short, duration=2000, observe=["widths", "collisions"], progress=False)
    lengths[radius] = run.mean_position.values[-1] - run.mean_position.values[0]
    print(f"radius {radius}: {run.collision_rate.sum().item():.3f} collisions per time,", end=" ")
    print(f"length {lengths[radius]:.2f} R, of which rods {(size - 1) * 2 * radius:.2f} R")

# %% tags=["remove-cell"]
assert np.isclose(lengths[1] - lengths[0.1], solutions.shorter_by(chain, 0.1))

# %% [markdown]
# <details><summary>Explain</summary>
#
# They collide equally often, and the chain becomes shorter by exactly what the rods have lost,
# $58.0 - 5.8 = 52.2$ R. Collisions of equal points swap velocities, which changes nothing in their
# gas. A rod, however, hands its momentum at once to a place that is $2R$ further on. The pressure
# $\rho W^2$ lacks this transport.
#
# </details>
#
# ## 2. The pressure of rods
#
# $N$ rods in a box of length $\ell$ have the partition function $Z\propto(\ell-2RN)^N/N!$, because
# each rod takes its length away from the room of the others. The pressure over $mW^2$ is
# $\partial_\ell\ln Z$.
#
# **Your turn.** Write it as a function of the density $\rho=N/\ell$.


# %%
def my_pressure(density):  # over m W**2; use d = 2 R
    return ...  # your code here


hint = "ln Z depends on l by N ln(l - d N). Divide numerator and denominator by l."
check(my_pressure, solutions.pressure, at=[(0.01,), (0.25,), (0.4,)], hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# $\partial_\ell\ln Z=\frac{N}{\ell-2RN}=\frac{\rho}{1-2R\rho}$ (Tonks, 1936).
#
# </details>
#
# ## 3. The force balance
#
# Assume that the density of the chain varies little over a rod length. Each place then has the
# pressure of a uniform gas. Its gradient holds the springs, which pull with the mean displacement
# $\langle\Delta x\rangle$ of the rods found at $x$:
#
# $$\frac{d}{dx}\,\frac{\rho W^2}{1-2R\rho} = -\frac km\,\rho\,\langle\Delta x\rangle .$$
#
# **Your turn.** For a constant $W$ solve this for $\rho'$. The result is equation (19) of the
# paper, `diff_gl`.

# %%
places = [(0.4, 5.0), (0.1, -12.0)]


def my_slope(density, displacement):  # use s, with s**2 = m W**2 / k, and d = 2 R
    return ...  # your code here


hint = "The derivative of rho/(1 - d rho) is rho'/(1 - d rho)**2. The springs pull inwards."
check(my_slope, lambda *place: solutions.slope(*place, chain), at=places, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# $$\rho' = -\frac{k}{mW^2}\,\langle\Delta x\rangle\,\rho\,(1-2R\rho)^2 .$$
#
# ```python
# def my_slope(density, displacement):
#     return -displacement / s**2 * density * (1 - d * density) ** 2
# ```
#
# </details>
#
# **The closure.** The equation still needs $\langle\Delta x\rangle(x)$. Let $N(x)$ be the number of
# rods to the left of $x$, so that the middle of rod $i$ has the label $N=i-\frac12$. Assume that
# all rods found at $x$ have the label $N(x)$. Their anchor is at $2R(N-\frac L2)$, so
#
# $$\langle\Delta x\rangle = x - 2R\,(N - \tfrac L2),\qquad N' = \rho,\qquad
# N(-\infty) = 0,\quad N(\infty) = L .$$
#
# `force_balance` solves these equations with these boundary conditions.
#
# ## 4. Theory meets particles
#
# **Predict.** You have seen the density of the rods. Sketch that of the theory over it. By how much
# will they differ?
#
# **Run.** Like the paper, `smooth` averages a density over a rod length.

# %%
fluid = cb.force_balance(chain)
watch = {"every": 1, "observe": ["density", "widths", "snapshots"], "progress": False}
run = cb.simulate(chain, duration=60_000, seed=1, **watch)
before = cb.deviation(cb.smooth(run), cb.smooth(fluid))
print(f"smoothed densities differ by up to {before.maximum:.1%} of close packing,", end=" ")
print(f"{before.maximum_in_errors:.0f} standard errors")
agree("velocity widths of all rods", run.velocity_width, W, run.velocity_width_error, unit="R/t_0")

# %% tags=["hide-input"]
ax = panels(width=8, height=3.4)
ax.plot(run.x, run.density, color="0.45", linewidth=1.2, label="simulation")
ax.plot(fluid.x, fluid.density, color=BLUE, linewidth=2, label="force balance")
ax.axhline(chain.close_packed_density, color="0.6", linewidth=1, linestyle="--")
end = chain.anchors[-1] + 5 * s
ax.text(end, chain.close_packed_density + 0.01, "close packing", color="0.4", ha="right")
ax.set(xlim=(0, end), ylim=(0, 1.15 * run.density.max()))
ax.set(xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend()
plt.show()

# %% tags=["remove-cell"]
given = fluid.density.values, fluid.displacement.values
assert abs(np.gradient(given[0], fluid.x.values) - solutions.slope(*given, chain)).max() < 1e-4
assert abs(before.maximum - 0.09) < 0.005

# %% [markdown]
# <details><summary>Explain</summary>
#
# The fluid is a smooth hill. The rods of the simulation stand in **layers**, one for each rod. Most
# layers rise above close packing. Even after smoothing the two differ by 9 %.
#
# </details>
#
# ## 5. From points to rods
#
# Which step of the theory has lost the layers? Take the rods' length out, as in lesson 4:
# $y = x - 2R(N-\frac L2)$, so $dy/dx = 1-2R\rho$. The density of the points is
# $\rho_y=\rho/(1-2R\rho)$, and the force balance becomes
#
# $$\frac{d\ln\rho_y}{dy} = -\frac{k}{mW^2}\,\langle\Delta x\rangle = -\frac{y}{s^2},\qquad
# \rho_y = L\,\frac{e^{-y^2/2s^2}}{\sqrt{2\pi}\,s},\qquad N = L\,\Phi(y/s).$$
#
# **Predict.** Take the positions $x_i$ of the simulation, and compute the points
# $y_i=x_i-2R(i-\frac{L+1}2)$. If their density has layers, too, the force balance is wrong. If it
# is this Gaussian, the fault lies in the step back, $\rho=\rho_y/(1+2R\rho_y)$. Which is it?
#
# **Run.**

# %%
edges = np.linspace(-3, 3, 41) * s
points = chain.reduced(run.position.values[0])  # one row for each time
blocks = [np.histogram(block, edges)[0] / len(block) for block in np.array_split(points, 50)]
measured, error = mean_and_error(blocks)  # points in each bin
expected = size * np.diff(stats.norm.cdf(edges / s))
agree("points in 40 bins", measured, expected, error)

# %% tags=["hide-input"]
ax = panels(width=6, height=3)
width = edges[1] - edges[0]
ax.stairs(measured / width, edges, fill=True, color="0.75", label="points of the simulation")
y = np.linspace(-3, 3, 200) * s
ax.plot(y, size * stats.norm.pdf(y, scale=s), color=BLUE, linewidth=2, label="force balance")
ax.set(xlabel="reduced position y [R]", ylabel=r"density of points $\rho_y$ [1/R]")
ax.set_ylim(0, 1.35 * size * stats.norm.pdf(0, scale=s))
ax.legend(loc="upper right")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# The points have no layers. Their density is that of the force balance, within the statistical
# error. The fault is in the step back.
#
# </details>
#
# A fluid has all matter with the label $N$ at the one place $x=y+2R(N-\frac L2)$, and rod $i$ is
# what lies between $N=i-1$ and $N=i$. But a rod is not spread over this stretch. **Rod $i$ is the
# $i$-th of $L$ points**, shifted by a whole number of rod lengths.
#
# **Your turn.** Write the probability density $p_i(y)$ of the $i$-th of $L$ independent points. The
# theory gives `density`, which is $\rho_y(y)$, and `share`, which is $N(y)/L$. Lesson 4, section 4,
# did this for a Gaussian; `stats.beta(i, size + 1 - i).pdf` is its Beta distribution.

# %%
some = [(1, 2.0, 0.01), (5, 4.0, 0.2), (size, 3.0, 0.95)]


def my_rod(i, density, share):
    return ...  # your code here


hint = "In lesson 4 one point has the density phi(y/s)/s. Here it has density / size."
check(my_rod, lambda *place: solutions.rod(*place, size), at=some, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_rod(i, density, share):
#     return density / size * stats.beta(i, size + 1 - i).pdf(share)
# ```
#
# </details>
#
# The density of all rods is then $\rho(x)=\sum_ip_i\big(x-2R(i-\frac{L+1}2)\big)$.
#
# **Predict.** Nothing but the smooth $\rho_y$ and $N$ of the force balance enters this sum. Can it
# have layers?
#
# **Run.** `rod_by_rod` computes the same sum for any theory.

# %%
x, N = fluid.x.values, fluid.label.values
y, rho_y = x - d * (N - size / 2), fluid.density.values / (1 - d * fluid.density.values)
summed = np.zeros(x.size)
for i, shift in enumerate(d * chain.rank, start=1):
    summed += np.interp(x - shift, y, solutions.rod(i, rho_y, N / size, size))
rods = cb.rod_by_rod(fluid)
print(f"sum and rod_by_rod differ by {abs(summed - rods.density).max().item():.4f} per R")
after = cb.deviation(cb.smooth(run), cb.smooth(rods))
for name, off in (("fluid", before), ("rods", after)):
    print(f"{name:5} - simulation: up to {off.maximum:.1%} of close packing,", end=" ")
    print(f"{off.maximum_in_errors:.1f} standard errors")

# %% tags=["hide-input"]
ax = panels(width=8, height=3.4)
ax.plot(run.x, run.density, color="0.7", linewidth=4, label="simulation")
ax.plot(fluid.x, fluid.density, color=BLUE, linewidth=1.5, label="force balance")
ax.plot(rods.x, rods.density, color=ORANGE, linewidth=1.5, label="force balance, rod by rod")
ax.set(xlim=(0, end), ylim=(0, 1.25 * run.density.max()))
ax.set(xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(ncols=3, loc="upper center")
plt.show()

# %% tags=["remove-cell"]
assert abs(summed - rods.density).max() < 2e-3
assert after.maximum < 0.01
assert after.maximum_in_errors < 5

# %% [markdown]
# <details><summary>Explain</summary>
#
# The layers appear. Read as a fluid, the points were wrong by 9 %. Read as rods, the same points
# agree with the simulation within its errors. **For $e=1$ without a gap equation (19) is exact for
# the points. What is approximate is to read rods off a fluid, by $1/(1-2R\rho)$.** Section 3
# assumed a density that varies little over a rod length. Points need no such assumption, because
# they have no length.
#
# </details>
#
# **Back on the page.** A fluid is right where the layers are gone. Guess the amplitude from which on
# the density of <a href="../docs/chain.md#amplitude=3&size=30&speed=100">30 rods</a> looks like the
# hill of the fluid, also at its ends, and look.
#
# **You can stop here.** You have derived the force balance of rods, found that it is exact for
# points, and recovered the measured layers from its smooth density.
#
# ## 6. What the fit of the paper costs
#
# The paper closes equation (19) in another way. It measures the mean displacement of each rod, fits
# $B\,\mathrm{arctanh}(Cx)$ to it at the mean positions, and inserts the fit for
# $\langle\Delta x\rangle(x)$. The boundary condition that is left is the number of rods.
#
# **Predict.** Will its points, read as rods, agree with the simulation as well?
#
# **Run.** We take 100 rods at the amplitude 10, as the paper does.

# %%
hundred = cb.Chain(size=100, amplitude=10)
long = cb.simulate(hundred, duration=60_000, replicas=2, seed=1, progress=False)
fit = cb.comparison.fit_arctanh(long)
closures = {"labels": cb.force_balance(hundred), "fit": cb.force_balance(hundred, fit)}
for name, theory in closures.items():
    for reading, each in (("fluid", theory), ("rods", cb.rod_by_rod(theory))):
        off = cb.deviation(cb.smooth(long), cb.smooth(each)).maximum
        print(f"closed by the {name:6}, read as {reading:5}: {off:.1%} of close packing")
print(f"root mean square misfit of the arctanh: {fit.misfit:.2f} R; it ends at 1/C =", end=" ")
print(f"{1 / fit.steepness:.1f} R")

# %% tags=["hide-input"]
exact, end_of_fit = cb.equilibrium(hundred), 1 / fit.steepness
labels = closures["labels"].sel(x=slice(100, 128))
inside = labels.x.values[labels.x.values < end_of_fit]
ax = panels(width=7, height=3.2)
ax.plot(labels.x, labels.displacement, color=BLUE, label="labels: y of the points")
ax.plot(inside, fit(inside), "--", color=PINK, label="arctanh fit")
place, off = exact.mean_position[-7:], exact.mean_displacement[-7:]
spread = exact.displacement_width[-7:]
ax.errorbar(place, off, xerr=spread, fmt="o", color=GREEN, label="rods, and their widths")
ax.axvline(end_of_fit, color="0.6", linewidth=1)
ax.text(end_of_fit + 0.3, 11, "1/C", color="0.4")
ax.set(xlim=(99, 128), ylim=(10, 32), xlabel="position x [R]", ylabel="displacement [R]")
ax.legend(loc="upper left")
plt.show()

# %% tags=["remove-cell"]
errors = [
    cb.deviation(cb.smooth(exact), cb.smooth(each)).maximum
    for theory in closures.values()
    for each in (theory, cb.rod_by_rod(theory))
]
assert 0.02 < errors[3] < 0.028
assert errors[1] < 1e-3 < 0.02 < errors[0] < errors[2] < 0.04

# %% [markdown]
# <details><summary>Explain</summary>
#
# No, 2.4 % remain. The arctanh fits the mean displacements to 0.02 R. But it ends at
# $1/C = 123.5$ R, and its force balance has no points beyond. The last rod, whose distribution is
# 3.0 R wide around 116.7 R, is sometimes found there.
#
# </details>
#
# ## 7. The momentum that collisions hand over
#
# How do collisions carry this pressure?
#
# **Your turn.** The left rod has the velocity $v$, the right rod $w<v$. How much momentum, divided
# by $m$, does the left rod hand over at the restitution $e$?

# %%
pairs = [(1.0, 0.0, 1.0), (2.0, -1.0, 0.0), (1.0, 0.5, 0.5)]


def my_momentum(v, w, e):
    return ...  # your code here


hint = "It is v before minus v after the collision. At e = 0 both rods leave with the mean of v, w."
check(my_momentum, solutions.momentum_handed_over, at=pairs, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# The velocity $v$ changes to $\frac{v+w}2-\frac e2(v-w)$, so the rod hands over
# $\frac{1+e}2(v-w)$.
#
# </details>
#
# Let $\tilde\rho_2(r, v;\,r+2R, w)$ be the density of pairs in contact. Pairs with $v>w$ collide at
# the rate $(v-w)\,\tilde\rho_2$. The momentum (over $m$) that rods at $r$ hand to their right
# neighbours, per time and length, is therefore
#
# $$\Pi(r) = \frac{1+e}{2}\iint_{v>w} (v-w)^2\,\tilde\rho_2(r, v;\,r+2R, w)\;dv\,dw . \tag{1}$$
#
# Rods at $r$ gain $\Pi(r-2R)$ from their left neighbours and lose $\Pi(r)$ to their right ones.
# This difference and the pressure of points hold the springs:
#
# $$(\rho W^2)' = \Pi(r-2R) - \Pi(r) - \frac km\,\rho\,\langle\Delta x\rangle .$$
#
# This is the first moment of the kinetic equation ([the appendix of the
# paper](../docs/paper/appendix.md)), and it is exact. In
# equilibrium the velocities of a pair are independent and Gaussian, so $v-w$ has the variance
# $2W^2$. Half of all pairs approach. At $e=1$ therefore $\Pi = W^2\rho_2$, where
# $\rho_2(r, r+2R)$ is the density of contacts.
#
# ## 8. How often rods are in contact
#
# Rods are in contact more often than independent points would be,
# $\rho_2(x, x+2R) = \chi\,\rho(x)\,\rho(x+2R)$. In a uniform gas the rods carry the pressure $\rho$
# (over $mW^2$), and contacts hand momentum over the distance $2R$, which adds
# $2R\rho_2=2R\chi\rho^2$. The sum is the pressure of section 2.
#
# **Your turn.** Write $\chi$ as a function of the packing $2R\rho$.


# %%
def my_chi(packing):
    return ...  # your code here


hint = "Subtract rho from the pressure of section 2. Few contacts, packing 0: chi = 1."
check(my_chi, solutions.contact_factor, at=[(0.0,), (0.5,), (0.9,)], hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# $\frac{\rho}{1-2R\rho}-\rho=\frac{2R\rho^2}{1-2R\rho}$, so $\chi=\frac1{1-2R\rho}$.
#
# </details>
#
# The paper keeps this $\chi$ where the density varies, and takes a derivative for the difference:
#
# $$\Pi(r-2R) - \Pi(r) \approx -\frac{d}{dr}\big(2R\,\Pi\big),\qquad
# \rho W^2 + 2R\,\Pi = \rho W^2 + W^2\,\frac{2R\rho^2}{1-2R\rho} = \frac{\rho W^2}{1-2R\rho}.$$
#
# ## Exercise
#
# **Restitution below 1.** Equation (1) has the factor $\frac{1+e}2$. Should the pressure of the
# collisions have it, too? Derive the virial theorem in $y$, and compare its two sides in a
# simulation at $e=0.5$.
#
# <details><summary>Solution</summary>
#
# In $y$ rods collide at a point and conserve momentum, so collisions drop out of
# $\frac{d}{dy}(\rho_y\langle v^2\rangle) = -\frac{k}{m}\,y\,\rho_y$. Multiply by $y$ and integrate:
#
# $$k\sum_i\langle y_i^2\rangle = m\sum_i\langle v_i^2\rangle .$$
#
# ```python
# cold = cb.Chain(size=30, restitution=0.5)
# run = cb.simulate(cold, duration=20_000, seed=1, observe="widths", progress=False)
# y2 = (run.displacement_width**2 + run.mean_displacement**2).sum()
# print(float(cold.stiffness * y2 / (cold.mass * (run.velocity_width**2).sum())))
# ```
#
# The ratio is 0.995, which is 1 within the error of the time step, and not $\frac{1+e}2=0.75$. The
# factor in (1) is right, but rods that have met stay near each other and meet again. More contacts
# compensate the factor.
#
# </details>
