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
# # The elastic chain is exactly solvable
#
# **Question.** Twenty hard rods on springs are shaken by noise and collide elastically. Each of them
# pushes all the others about. Can one know where each rod is, on average and at every moment,
# *without simulating a single collision*?
#
# It is possible, and this lesson shows how. The chain is that of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) at restitution 1. The
# paper found in its simulations that all rods then have the same velocity distribution. The exact
# solution is not in the paper. It is derived here.
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = 4\pi/3\,M$), and times in
# $T = \sqrt{M/k}$, where $k$ is the stiffness of the springs.
#
# *Level: third year. You need: lesson 1 (sections 1 to 3), lesson 3 (sections 1 and 2), the Gibbs
# distribution. Time: 120 minutes (sections 1 to 4: 60 minutes). To predict before you see the
# results, type `make lessons` in the folder of the project, and open the copy of this lesson
# without outputs in `build/lessons/`.*

# %% tags=["hide-input"]
import ipywidgets
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import trapezoid
from scipy.linalg import expm
from scipy.special import comb, ndtr, ndtri
from scipy.stats import beta, norm
from teaching import BLUE, GREEN, ORANGE, PINK, agree, check, panels, right

# %%
import crazybilliards as cb

# %% [markdown]
# Between collisions rod $i$ obeys
#
# $$m\ddot x_i = -\gamma\dot x_i - k(x_i - x^0_i) + A\,\xi_i(t),$$
#
# with independent white noises $\xi_i$ of unit strength. In our units $\gamma = A = 1$. Take $L$ such
# oscillators that do not interact and share one rest position. Euler's scheme of [lesson
# 1](01_one_noisy_oscillator.ipynb) moves them.


# %%
def independent_oscillators(chain, steps, dt, seed):
    rng = np.random.default_rng(seed)
    y, v = np.zeros((2, chain.size))
    path = np.empty((steps, chain.size))
    for n in range(steps):
        kick = chain.amplitude * rng.standard_normal(chain.size) / np.sqrt(dt)
        v = v + dt / chain.mass * (kick - chain.damping * v - chain.stiffness * y)
        y = y + dt * v
        path[n] = y
    return path


chain = cb.Chain(size=20)  # restitution 1, no gap between the anchors, linear springs
s, W = chain.thermal_length, chain.free_velocity_width
path = independent_oscillators(chain, steps=2400, dt=0.05, seed=4)[1200:]

# %% [markdown]
# **Predict.** The left panel below shows these points, which pass through one another. The right
# panel shows `np.sort(path, axis=1)`: number $i$ is at every moment the $i$-th point from the left.
# How do the two panels differ?
#
# **Run.**

# %% tags=["hide-input"]
time = 0.05 * np.arange(len(path))
marked = {0: BLUE, 9: ORANGE, 19: GREEN}
axes = panels(2, height=3.8, sharey=True)
for ax, lines, title in (
    (axes[0], path, "20 points that pass through one another"),
    (axes[1], np.sort(path, axis=1), "the same points, sorted at every moment"),
):
    ax.plot(time, lines, color="0.8", linewidth=0.7)
    for i, colour in marked.items():
        ax.plot(time, lines[:, i], color=colour, linewidth=1.6, label=f"number {i + 1}")
    ax.set(xlabel="time t [T]", title=title, ylim=(-3.2, 2.5))
    ax.legend(loc="lower center", ncols=3)
axes[0].set_ylabel("position y [R]")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# Both panels show **the same curves**. Only the names differ. On the right the coloured points never
# cross: they bounce. The picture is exact, because two equal masses that collide elastically *swap
# velocities*. Two points that pass through one another and then swap names do the same.
#
# </details>
#
# ## 1. Rods become points
#
# Rods have the length $2R$. [Lesson 3](03_collisions_and_restitution.ipynb), section 2, takes it out:
#
# $$y_i = x_i - 2R\Big(i - \frac{L+1}{2}\Big) .$$
#
# Rods that touch have $y_{i+1} = y_i$, so the rods become points with $y_1 \le y_2 \le \dots \le
# y_L$. The anchors are a distance $2R + g$ apart, where $g$ is the gap. In $y$ they are $g$ apart.
# **Without a gap all anchors are at $y = 0$**, and the sorted points of the picture are our chain.
#
# ## 2. The velocities
#
# A free rod has a Gaussian velocity of width $W = A/\sqrt{2m\gamma}$ and the temperature
# $mW^2$. Consider the distribution
#
# $$p(y, v) \propto \exp\Big[-\frac1{mW^2}\sum_i\Big(\frac m2 v_i^2 + U(y_i - y^0_i)\Big)\Big]
# \qquad\text{on}\quad y_1 \le \dots \le y_L .$$
#
# An elastic collision exchanges two velocities and conserves the energy, so it leaves $p$ unchanged.
# Springs, damping and noise leave it unchanged as well, because they do so for every single rod. It
# is therefore the stationary state, for any spring energy $U$ and any gap. It is called the Gibbs
# measure of *ordered* points. It is a product of a part with positions and a part with velocities.
#
# **Predict.** Take three chains: one without a gap, one with a gap, and one with a gap and springs
# that pull like $k\,d^2$ instead of $k\,d$. In which of them does the velocity width $W_v(i) =
# \sqrt{\langle v_i^2\rangle}$ of a rod near the border differ from that in the centre?
#
# **Run.**

# %%
kinds = {
    "no gap": cb.Chain(size=30),
    "gap 0.3 R": cb.Chain(size=30, gap=0.3),
    "gap 0.3 R, quadratic springs": cb.Chain(size=30, gap=0.3, spring="quadratic"),
}
runs = {}
for name, each in kinds.items():
    runs[name] = cb.simulate(each, duration=30_000, observe="widths", seed=5, progress=False)

# %% tags=["hide-input"]
ax = panels(width=7, height=3.2)
for number, (name, run) in enumerate(runs.items()):
    agree(f"{name}: W_v and W", run.velocity_width, W, run.velocity_width_error)
    ax.errorbar(
        run.particle + 0.2 * (number - 1),
        run.velocity_width / W,
        run.velocity_width_error / W,
        fmt="osD"[number],
        markersize=4,
        color=(BLUE, ORANGE, GREEN)[number],
        label=name,
    )
ax.axhline(1, color="0.4", linewidth=1)
ax.set(xlabel="particle i", ylabel="velocity width $W_v/W$", ylim=(0.97, 1.045))
ax.legend(loc="upper right", ncols=3, fontsize=9)
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# In none of them. The velocity part of the Gibbs measure does not contain the other rods: $W_v(i) =
# W$ holds *exactly*, for every rod, at any gap and for any spring. Collisions change only where the
# rods are.
#
# </details>
#
# ## 3. Sorting random numbers
#
# Without a gap the positions are $L$ *independent* Gaussian numbers of width
#
# $$s = W\sqrt{m/k} = \frac{A}{\sqrt{2\gamma k}}$$
#
# (the thermal length), put in order. Statisticians call the $i$-th smallest of $L$ draws the $i$-th
# **order statistic**.
#
# **Your turn.** This is the whole theory of the chain. Write it down: from Gaussian numbers of
# variance 1, shape (draws, 20), compute the positions $x$ of the 20 rods. `s` is the thermal length,
# `chain.radius` is $R$, and `chain.rank` is $i - \frac{L+1}{2}$.


# %% tags=["remove-cell"]
def rods_from(numbers):
    return np.sort(s * numbers, axis=1) + 2 * chain.radius * chain.rank


some = np.random.default_rng(0).standard_normal((3, chain.size))
assert right(rods_from, lambda numbers: chain.physical(np.sort(s * numbers)), at=[(some,)])
assert not right(lambda numbers: chain.physical(s * numbers), rods_from, at=[(some,)])


# %%
def my_rods(numbers):
    return ...  # your code here


check(my_rods, rods_from, at=[(some,)], hint="Scale by s, sort along axis 1, add 2 R rank.")

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_rods(numbers):
#     return np.sort(s * numbers, axis=1) + 2 * chain.radius * chain.rank
# ```
#
# </details>
#
# **Predict.** Draw 50 000 such chains. Nothing in them knows of forces, collisions or time. Which of
# these will agree with a simulation: the mean displacements, their widths, the density of the rods?
#
# **Run.** `equilibrium` computes the Gibbs measure by integrals along the chain, without any random
# number.

# %%
draws = 50_000
x = rods_from(np.random.default_rng(1).standard_normal((draws, chain.size)))
y = chain.reduced(x)
run = cb.simulate(chain, duration=100_000, seed=2, progress=False)
exact = cb.equilibrium(chain)

# %% tags=["hide-input"]
mean, width = y.mean(axis=0), y.std(axis=0)
mean_error = width / np.sqrt(draws)
# The error of a measured width follows from the scatter of (y - mean)^2.
width_error = ((y - mean) ** 2).std(axis=0) / (2 * width * np.sqrt(draws))
sorting = {"mean_displacement": (mean, mean_error), "displacement_width": (width, width_error)}
axes = panels(2, height=3.4)
for ax, (name, (value, error)) in zip(axes, sorting.items(), strict=True):
    ax.plot(exact.particle, exact[name] / s, color=ORANGE, linewidth=2.5, label="equilibrium")
    ax.plot(run.particle, run[name] / s, "o", color="k", mfc="none", ms=8, label="simulation")
    ax.plot(run.particle, value / s, "x", color=BLUE, ms=5, label="sorted random numbers")
    ax.set(xlabel="particle i", xticks=(1, 5, 10, 15, 20))
    agree(f"{name}: simulation and equilibrium", run[name], exact[name], run[f"{name}_error"])
    agree(f"{name}: sorting and equilibrium", value, exact[name], error)
axes[0].set_ylabel(r"mean displacement $\langle\Delta x\rangle/s$")
axes[1].set_ylabel("displacement width $W_x/s$")
axes[0].legend()
plt.show()

# %% [markdown]
# In the density the rods show as a row of peaks (the right half of the chain):

# %% tags=["hide-input"]
edges = exact.x.values[::2]
count = np.histogram(x, edges)[0]
# At most one centre of a rod fits into a bin, so a bin is a coin that was tossed `draws` times.
chance = np.diff(exact.label.values[::2])  # label N(x): the mean number of rods to the left of x
likely = chance > 100 / draws
coin = np.sqrt(draws * (chance * (1 - chance))[likely])
agree(f"sorting, {likely.sum()} bins", count[likely], draws * chance[likely], coin)
pulls = cb.deviation(cb.smooth(run), cb.smooth(exact)).maximum_in_errors
agree("simulation, smoothed", pulls, 0, 1)
ax = panels(width=9, height=3.4)
heights = count / draws / np.diff(edges)
ax.stairs(heights, edges, color=BLUE, fill=True, alpha=0.4, label="sorted random numbers")
ax.plot(exact.x, exact.density, color=ORANGE, linewidth=2, label="equilibrium")
ax.plot(run.x[::2], run.density[::2], "o", color="k", mfc="none", ms=4, label="simulation")
ax.set(xlim=(0, 24), ylim=(0, 2.5), xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(ncols=3, loc="upper center")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# All three agree, everywhere. The elastic chain without a gap *is* a sorted list of independent
# Gaussian numbers.
#
# </details>
#
# ## 4. One rod
#
# The distribution of one order statistic is known in closed form. Let $\Phi$ be the distribution
# function of the unit Gaussian and $u = \Phi(y/s)$. Before they are sorted, the $L$ numbers $u$ are
# independent, and each is uniform in $(0, 1)$.
#
# **Your turn.** Which probability density does the $i$-th smallest of $L$ such numbers have at $u$?
# One number lies at $u$, $i - 1$ of the others lie below it, and $L - i$ above it. Each of the
# others lies below $u$ with the probability $u$. Multiply by the number of ways to choose which
# number is which. `comb(n, k)` is the number of ways to choose $k$ of $n$ things.


# %% tags=["remove-cell"]
def ordered_density(u, i, L):
    return L * comb(L - 1, i - 1) * u ** (i - 1) * (1 - u) ** (L - i)


ranks = [(0.3, 1, 1), (0.3, 2, 5), (0.6, 10, 20), (0.9, 20, 20)]
assert right(ordered_density, lambda u, i, L: beta(i, L + 1 - i).pdf(u), at=ranks)
assert not right(lambda u, i, L: ordered_density(u, i, L) / L, ordered_density, at=ranks)


# %%
def my_ordered_density(u, i, L):
    return ...  # your code here


check(
    my_ordered_density,
    ordered_density,
    at=ranks,
    hint="Any of the L numbers may be the one at u. Then choose i - 1 of the other L - 1 numbers. "
    "A single number, i = L = 1, has the density 1.",
)

# %% [markdown]
# <details><summary>Solution</summary>
#
# Each of the $L$ numbers may be the one at $u$. Of the other $L - 1$ numbers, $i - 1$ lie below it.
# There are $\binom{L-1}{i-1}$ ways to choose these, and each way has the probability
# $u^{i-1}(1-u)^{L-i}$.
#
# ```python
# def my_ordered_density(u, i, L):
#     ways = L * comb(L - 1, i - 1)
#     return ways * u ** (i - 1) * (1 - u) ** (L - i)
# ```
#
# </details>
#
# This density is a Beta distribution with the parameters $i$ and $L + 1 - i$. For the rod it says
#
# $$p_i(y) = \frac1s\,\varphi(y/s)\;\mathrm{Beta}_{i,\,L+1-i}\big(\Phi(y/s)\big),
# \qquad \varphi = \Phi' .$$
#
# **Predict.** Is the distribution of the rod in the centre wider or narrower than that of a free
# rod? Is that of the outermost rod symmetric?
#
# **Run.** Histograms: the sorted numbers. Lines: the formula.


# %%
def one_rod(i, chain, y):
    """Density of the reduced position of rod i of an elastic chain without a gap [1/R]."""
    s, L = chain.thermal_length, chain.size
    return norm.pdf(y / s) / s * beta(i, L + 1 - i).pdf(ndtr(y / s))


# %% tags=["hide-input"]
fine = np.linspace(-8 * s, 8 * s, 8001)
ax = panels(width=7, height=3.2)
for i, colour in ((1, BLUE), (3, PINK), (10, ORANGE), (20, GREEN)):
    ax.hist(y[:, i - 1] / s, 80, density=True, color=colour, alpha=0.35)
    ax.plot(fine / s, s * one_rod(i, chain, fine), color=colour, label=f"rod {i}")
ax.plot(fine / s, norm.pdf(fine / s), "k:", label="a free rod")
ax.set(xlabel="displacement $y/s$", ylabel=r"probability density $s\,p_i$", xlim=(-4, 4))
ax.legend()
plt.show()
closed_mean = [trapezoid(fine * one_rod(i, chain, fine), fine) for i in exact.particle.values]
whole = sum(
    np.interp(exact.x - x0, fine, one_rod(i, chain, fine), left=0, right=0)
    for i, x0 in zip(exact.particle.values, chain.anchors, strict=True)
)
print("Formula and equilibrium differ")
print(f"in the mean displacements by {abs(closed_mean - exact.mean_displacement).max() / s:.1e} s")
print(f"in the densities by {abs(whole - exact.density).max() * 2:.1e} of close packing")
assert abs(closed_mean - exact.mean_displacement).max() < 1e-5 * s
assert abs(whole - exact.density).max() * 2 < 1e-3

# %% [markdown]
# <details><summary>Explain</summary>
#
# The distribution of a rod in the centre is narrower, because its neighbours hold it in a small part
# of the room that a free rod takes. The outermost rod is pushed outward. Its distribution is skewed,
# because it has neighbours on one side only.
#
# </details>
#
# ## 5. Where the arctanh of the paper comes from
#
# The paper measures the mean displacement and fits it by $B\,\mathrm{arctanh}(Cx)$. The exact mean
# displacement is the expected order statistic. Blom found a good approximation to it,
#
# $$\langle\Delta x_i\rangle \approx s\,\Phi^{-1}(q_i),\qquad q_i = \frac{i-3/8}{L+1/4}.$$
#
# This is the value of $y$ below which the fraction $q_i$ of the Gaussian lies. Compare it with the
# arctanh, which is a logarithm: $\mathrm{arctanh}(z) = \frac12\ln\frac{1+z}{1-z}$. With $z = 2q - 1$
# it is $\frac12\ln\frac{q}{1-q}$, the inverse distribution function of the *logistic* distribution.
# The fit therefore treats the rods as sorted **logistic** numbers. In a dense chain, where $x
# \approx 2R(i - \frac{L+1}2)$, $Cx$ takes the place of $2q-1$.
#
# **Predict.** The two distributions look alike in the middle, but the logistic one has longer tails.
# Will the arctanh fit equally well at all driving amplitudes $A$? (In units of $s$ the exact
# solution does not depend on $A$ at all.)
#
# **Run.** The fit is made to the exact displacements, so no simulation is needed.

# %%
fits = {}
for amplitude in (1, 10, 100):
    theory = cb.equilibrium(cb.Chain(size=100, amplitude=amplitude))
    fit, unit = cb.fit_arctanh(theory), s * amplitude  # the thermal length of this chain
    off = (fit(theory.mean_position.values) - theory.mean_displacement.values) / unit
    print(f"A = {amplitude}: the arctanh is wrong by at most {abs(off).max():.4f} s")
    fits[amplitude] = off
i = theory.particle.values
blom = ndtri((i - 3 / 8) / (100 + 1 / 4)) - theory.mean_displacement.values / unit
print(f"Blom's formula is wrong by at most {abs(blom).max():.4f} s")

# %% tags=["hide-input"]
ax = panels(width=7)
for (amplitude, off), colour, style in zip(
    fits.items(), (BLUE, GREEN, PINK), ("--", "-.", ":"), strict=True
):
    ax.plot(i, off, style, color=colour, label=f"arctanh, A = {amplitude}")
ax.plot(i, blom, color=ORANGE, linewidth=1.5, label="Blom, any A")
ax.set(xlabel="particle i", ylabel="difference from exact, in s", ylim=(-0.1, 0.06))
ax.legend(ncols=2, loc="lower center", fontsize=9)
plt.show()

# %% tags=["remove-cell"]
assert np.isclose(unit, cb.Chain(amplitude=100).thermal_length)
assert abs(blom).max() < 0.01
worst = {amplitude: abs(off).max() for amplitude, off in fits.items()}
assert worst[10] < 0.02 < 0.04 < min(worst[1], worst[100])

# %% [markdown]
# <details><summary>Explain</summary>
#
# Blom's formula has no free parameter and is right to a hundredth of $s$, in the same way at all
# $A$. The arctanh has two free parameters. It is as good at $A = 10$, and four to five times worse at
# 100 and 1, with opposite signs at the ends. At large $A$ the mean position $x$ is not proportional
# to the label any more, because it contains $\langle\Delta x\rangle$ itself, and this straightens
# the curve. At an amplitude in between this compensates the difference of the two distributions. The
# arctanh therefore describes the curve well, but it is not its law: nothing in the chain produces a
# logistic distribution.
#
# </details>
#
# ## 6. With gaps: a plasma in one dimension
#
# With a gap the anchors $y^0_i = g\,r_i$, $r_i = i - \frac{L+1}{2}$, differ, and the points are no
# longer independent. But the spring energy can be multiplied out:
#
# $$\sum_i\frac k2(y_i - g r_i)^2 = \frac k2\sum_i y_i^2 - kg\sum_i r_i y_i + \text{const},
# \qquad \sum_i r_i y_i = \frac12\sum_{i<j}(y_j - y_i).$$
#
# The last sum runs over all pairs: $y_k$ is added $k - 1$ times and subtracted $L - k$ times. The
# points are in order, so $y_j - y_i = |y_j - y_i|$, and the energy is
#
# $$\frac k2\sum_i y_i^2 - \frac{kg}{2}\sum_{i<j}|y_i - y_j| + \text{const}.$$
#
# Charged planes repel each other with a constant force, which has the energy $-|y_i - y_j|$. So
# *rods with gaps behave like charged planes in a trap*. This is the one-dimensional one-component
# plasma, which Baxter solved exactly in 1963. The energy no longer depends on the names of the rods.
# (This is derived here, for linear springs.)

# %%
r, gap = chain.rank, 0.7
state = np.sort(np.random.default_rng(0).normal(size=chain.size))
pairs = abs(state[:, None] - state[None, :]).sum() / 2
springs = ((state - gap * r) ** 2).sum() / 2
plasma = (state**2).sum() / 2 - gap / 2 * pairs + gap**2 * (r**2).sum() / 2
print(f"energy of one state: {springs:.10f} as springs, {plasma:.10f} as a plasma")

# %% tags=["remove-cell"]
assert np.isclose(springs, plasma, rtol=1e-12)

# %% [markdown]
# `equilibrium(chain)` takes any gap. Given $y_{i+1}$, the points to its left do not depend on those
# to its right, so all integrals over the chain can be done one rod after another.
# `equilibrium_states(chain, replicas, seed)` uses the same integrals backwards. It draws
# *independent* states, positions and velocities, from the exact distribution, as sorting does
# without a gap.
#
# **Predict.** Without a gap every rod but the middle one is pushed outward. How does
# $\langle\Delta x\rangle$ change in the middle of the chain, and at its ends, when the rods get room?
#
# **Run.** Simulation, theory and exact samples at three gaps.

# %%
results = {}
for g in (0.0, 0.1, 0.5):
    loose = cb.Chain(size=50, gap=g)
    run = cb.simulate(loose, duration=20_000, observe="widths", seed=8, progress=False)
    states = cb.equilibrium_states(loose, 20_000, seed=7)
    results[g] = cb.equilibrium(loose), run, states.position.values - loose.anchors

# %% tags=["hide-input"]
ax = panels(width=8, height=3.8)
for (g, (theory, run, d)), colour in zip(results.items(), (BLUE, ORANGE, GREEN), strict=True):
    mean = theory.mean_displacement
    agree(f"g = {g}: simulation", run.mean_displacement, mean, run.mean_displacement_error)
    agree(f"g = {g}: exact samples", d.mean(axis=0), mean, d.std(axis=0) / np.sqrt(len(d)))
    ax.plot(theory.particle, mean / s, color=colour, label=f"g = {g} R")
    ax.plot(run.particle, run.mean_displacement / s, "o", color=colour, ms=6, mfc="none")
    ax.plot(run.particle, d.mean(axis=0) / s, "x", color="k", ms=3.5)
ax.plot([], [], "o", color="0.4", mfc="none", label="simulation")
ax.plot([], [], "x", color="k", ms=3.5, label="exact samples")
ax.set(xlabel="particle i", ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
ax.legend()
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# With a gap the inner rods sit at their anchors, because a rod is pushed as often from the left as
# from the right. Only a layer at either end is still pushed outward. In the language of plasmas the
# trap is a background charge, and the plasma is neutral inside. The layer is its surface.
#
# </details>
#
# Move the slider (in a running notebook):


# %% tags=["hide-input"]
def displacements(gap):
    """Draw <dx>(i) for a gap, exactly."""
    theory = cb.equilibrium(cb.Chain(size=50, gap=gap))
    ax = panels(width=7, height=3)
    ax.plot(theory.particle, theory.mean_displacement / s, "o-", color=BLUE, ms=3)
    ax.axhline(0, color="0.6", linewidth=1)
    ax.set(xlabel="particle i", ylabel=r"$\langle\Delta x\rangle/s$", ylim=(-2.4, 2.4))
    ax.set_title(f"50 rods, gap {gap:.2f} R = {gap / s:.2f} s")
    plt.show()


slider = ipywidgets.FloatSlider(value=0.1, min=0, max=1, step=0.02, continuous_update=False)
_ = ipywidgets.interact(displacements, gap=slider)

# %% [markdown]
# ## 7. In time
#
# Without a gap the argument of the first picture holds at every moment, not only in the stationary
# state: *the relabelled points are independent oscillators*. Release the chain from a compressed
# state. The cloud of points then follows the equations of **one** oscillator. [Lesson
# 1](01_one_noisy_oscillator.ipynb), section 1, derives the equations of its three second moments
# $\langle y^2\rangle$, $\langle yv\rangle$ and $\langle v^2\rangle$. They are linear, so a matrix
# exponential solves them.


# %%
def moments(chain, times, start):
    """<y^2>, <yv>, <v^2> of one damped, shaken oscillator at the given times."""
    pull, damping = chain.stiffness / chain.mass, chain.damping / chain.mass
    matrix = np.array([[0, 2, 0], [-pull, -damping, 1], [0, -2 * pull, -2 * damping]])
    steady = np.array([chain.thermal_length**2, 0, chain.free_velocity_width**2])
    return np.array([steady + expm(t * matrix) @ (start - steady) for t in times])


# %% [markdown]
# **Predict.** Take the stationary state, squeeze all room between the rods to 0.3 of its size, leave
# the velocities unchanged, and let go. Will the cloud overshoot its final width? Will it get colder
# on the way?
#
# **Run.** We simulate an ensemble of 1000 chains of 50 rods, each from its own exact equilibrium
# state, and average over the ensemble at equal times.

# %%
fifty, replicas, squeeze = cb.Chain(size=50), 1000, 0.3
states = cb.equilibrium_states(fifty, replicas, seed=11)
squeezed = fifty.physical(squeeze * fifty.reduced(states.position.values))
start = cb.given_start(fifty, squeezed, states.velocity.values, replicas=replicas)
settings = {"duration": 30, "every": 0.5, "observe": "widths", "seed": 12, "progress": False}
run = cb.simulate(fifty, start=start, replicas=replicas, average="ensemble", **settings)
times = run.time.values
exact_y2, _, exact_v2 = moments(fifty, times, np.array([(squeeze * s) ** 2, 0, W**2])).T
print(f"largest width {np.sqrt(exact_y2.max()) / s:.4f} s, smallest <v^2> ", end="")
print(f"{exact_v2.min() / W**2:.3f} W^2")

# %% tags=["hide-input"]
measured = run.mean_displacement**2 + run.displacement_width**2  # <y_i^2>
sigma = np.sqrt(measured.mean("particle")).values
heat = (run.velocity_width**2).mean("particle").values
cloud = cb.breathing_cloud(fifty, 30, every=0.5, stretch=squeeze)
left, middle, other = panels(3, width=11, height=3.5)
left.plot(times, np.sqrt(exact_y2) / s, color=ORANGE, linewidth=2.2, label="exact")
left.plot(times[::2], sigma[::2] / s, "o", color="k", mfc="none", ms=4, label="1000 chains")
left.set(xlabel="time t [T]", ylabel=r"width of the cloud $\sigma/s$")
left.legend()
middle.plot(times, exact_v2 / W**2, color=ORANGE, linewidth=2.2)
middle.plot(times[::2], heat[::2] / W**2, "o", color="k", mfc="none", ms=4)
middle.set(xlabel="time t [T]", ylabel=r"$\langle v^2\rangle/W^2$")
for i, colour in ((50, GREEN), (45, PINK), (35, BLUE)):
    at = run.sel(particle=i).mean_displacement
    other.plot(times, cloud.mean_displacement.sel(particle=i) / s, color=colour, label=f"rod {i}")
    other.plot(times[::2], at[::2] / s, "o", color=colour, mfc="none", ms=4)
other.set(xlabel="time t [T]", ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
other.legend(loc="center right", bbox_to_anchor=(1, 0.7))
plt.show()
points = replicas * fifty.size  # independent Gaussian points
agree("cloud width", sigma / np.sqrt(exact_y2), 1, 1 / np.sqrt(2 * points))
agree("<v^2>", heat / exact_v2, 1, np.sqrt(2 / points))
error = run.displacement_width / np.sqrt(replicas)
agree("mean displacement of every rod", run.mean_displacement, cloud.mean_displacement, error)

# %% tags=["remove-cell"]
assert abs(cloud.cloud_width.values - np.sqrt(exact_y2)).max() < 1e-6 * s
assert np.sqrt(exact_y2.max()) < 1.001 * s
assert abs(exact_v2.min() / W**2 - 0.54) < 0.01
isothermal = cb.breathing_cloud(fifty, 30, every=0.5, stretch=squeeze, evolving=False)
assert isothermal.cloud_width.values.max() > 1.5 * s

# %% [markdown]
# <details><summary>Explain</summary>
#
# The cloud returns to its width and overshoots it by less than 0.1 %. In the stationary state the
# springs hold a cloud of width $s$ against the velocities. In the squeezed cloud they are too weak,
# so it expands. As it expands the springs take energy out of the velocities, and it cools to about
# half of $W^2$. The noise replaces this energy only at the rate $2\gamma/m$. At no time is any rod
# further from the exact solution than chance allows.
#
# </details>
#
# `breathing_cloud` solves the same motion in the variables of a fluid: the width $\sigma$ of the
# cloud and its temperature. The cloud stays Gaussian, so rod $i$ is at $\sigma(t)$ times the $i$-th
# expected order statistic. [Lesson 7](07_the_fluid_in_time.ipynb), section 3, looks at this motion
# as a fluid, and shows what goes wrong if the temperature is held constant.
#
# With a gap, or for $e \ne 1$, the points cannot be relabelled, and this solution in time does not
# hold. For these cases the package has theories that are good, but not exact: `hydrodynamics` and
# `phase_space`.
#
# ## Exercises
#
# **1.** Take two rods with a gap. Their distance $z = y_2 - y_1$ is a Gaussian number with mean $g$
# and variance $2s^2$, cut off at 0. Derive $\langle\Delta x_2\rangle$, and compare with
# `cb.equilibrium(cb.Chain(size=2, gap=0.5))`.
#
# <details><summary>Solution</summary>
#
# The centre of mass is not displaced, so
# $\langle\Delta x_2\rangle = \frac12(\langle z\rangle - g)$. The mean of a Gaussian that is cut off
# gives
#
# $$\langle\Delta x_2\rangle = \frac{s}{\sqrt2}\,\frac{\varphi(a)}{\Phi(a)},\qquad
# a = \frac{g}{\sqrt2\,s} .$$
#
# ```python
# a = 0.5 / (np.sqrt(2) * s)
# print(s / np.sqrt(2) * norm.pdf(a) / ndtr(a))
# print(float(cb.equilibrium(cb.Chain(size=2, gap=0.5)).mean_displacement[1]))
# ```
#
# Both give 0.254580 R.
#
# </details>
#
# **2.** How does the width $W_x$ of a rod in the centre depend on $L$, without a gap? Use
# `equilibrium` for $L$ = 11, 101 and 1001 and compare with
# $W_x \approx \sqrt{\pi/2}\;s/\sqrt L$, the known result for the median of many Gaussian draws.
#
# <details><summary>Solution</summary>
#
# ```python
# for L in (11, 101, 1001):
#     width = float(cb.equilibrium(cb.Chain(size=L)).displacement_width[L // 2])
#     print(L, width / (np.sqrt(np.pi / 2) * s / np.sqrt(L)))
# ```
#
# The ratios are 0.980, 0.998 and 0.9998: the width falls like $L^{-1/2}$. Its neighbours alone hold
# a rod in the centre of a long chain.
#
# </details>
#
# **3.** Take quadratic springs, $F = k\,d\,|d|$, and no gap. Which random numbers must be sorted
# now? Try it for 20 rods and compare the outermost rod with `equilibrium`.
#
# <details><summary>Solution</summary>
#
# Sort independent draws from $w(y) \propto \exp(-k|y|^3/3T)$, as $U = k|d|^3/3$. In scipy this is
# the generalised normal distribution:
#
# ```python
# from scipy.stats import gennorm
#
# soft = cb.Chain(size=20, spring="quadratic")
# scale = (3 * soft.temperature / soft.stiffness) ** (1 / 3)
# draws = gennorm(3, scale=scale).rvs((50_000, 20), random_state=1)
# last = np.sort(draws, axis=1)[:, -1]
# print(last.mean(), "+-", last.std() / np.sqrt(50_000))
# print(float(cb.equilibrium(soft).mean_displacement[-1]))
# ```
#
# The sorted numbers give 1.2403 $\pm$ 0.0012 R, `equilibrium` 1.2397 R.
#
# </details>
#
# **4.** Does sorting still work for $e = 0.9$? Compare the outermost rod of a simulation with the
# order statistic.
#
# <details><summary>Solution</summary>
#
# ```python
# lossy = cb.simulate(cb.Chain(size=20, restitution=0.9), duration=20_000, seed=1, progress=False)
# print(float(lossy.mean_displacement[-1] / s), float(exact.mean_displacement[-1] / s))
# ```
#
# It does not: the simulation gives $1.283 \pm 0.006\;s$, the order statistic $1.867\;s$. Inelastic
# rods do not only swap their velocities. They cool each other, and a colder chain is shorter.
#
# </details>
