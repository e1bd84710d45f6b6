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
# **Question.** Twenty hard rods on springs are shaken by noise and collide elastically. Each of
# them pushes all the others about. Can one know where each rod is, on average and at every moment,
# *without simulating a single collision*?
#
# The chain is that of [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) at
# restitution 1. The paper does not have the exact solution.
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = 4\pi/3\,M$), times in
# $t_0 = \sqrt{M/k}$. In these units $k = \gamma = A = 1$.
#
# *90 minutes. `make lessons` writes copies without outputs and solutions.*
#
# **Two minutes on the page.** <a href="../docs/chain.md#preset=elastic">Do elastic collisions leave
# a trace?</a> Draw the distribution of the velocities at $e = 1$ that you expect and, on paper, the
# density. Then set $e = 1$.

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy import special
from scipy.linalg import expm
from scipy.stats import beta, norm
from solutions import lesson_04 as solutions
from teaching import BLUE, GREEN, ORANGE, PINK, agree, check, panels, safe

# %% [markdown]
# **What you may change.** The number of rods `size`, from 5 to 40, and all seeds. More rods make
# pictures that nobody can read.

# %%
size = 20

# %% tags=["hide-input"]
if not safe(
    5 <= size <= 40,
    f"This lesson is for 5 to 40 rods, not {size}: its pictures cannot show others. "
    "The lesson goes on with 20.",
):
    size = 20

# %%
import crazybilliards as cb

chain = cb.Chain(size=size)  # restitution 1, no gap between the anchors, linear springs
s, W = chain.thermal_length, chain.free_velocity_width

# %% [markdown]
# Take $L$ oscillators as in [lesson 1](01_one_noisy_oscillator.ipynb),
# $m\ddot y = -\gamma\dot y - ky + A\,\xi(t)$, each with a noise of its own. They do not interact.


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


path = independent_oscillators(chain, steps=2400, dt=0.05, seed=4)[1200:]

# %% [markdown]
# **Predict.** The left panel shows these points, which pass through one another. The right one
# shows `np.sort(path, axis=1)`: number $i$ is always the $i$-th point from the left. How do they
# differ?
#
# **Run.**

# %% tags=["hide-input"]
time = 0.05 * np.arange(len(path))
marked = {0: GREEN, size // 2: PINK, size - 1: "0.1"}
axes = panels(2, height=3.8, sharey=True)
for ax, lines, title in (
    (axes[0], path, f"{size} points that pass through one another"),
    (axes[1], np.sort(path, axis=1), "the same points, sorted at every moment"),
):
    ax.plot(time, lines, color="0.8", linewidth=0.7)
    for i, colour in marked.items():
        ax.plot(time, lines[:, i], color=colour, linewidth=1.6, label=f"number {i + 1}")
    ax.set(xlabel="time $t$ [$t_0$]", title=title, ylim=(-3.2, 2.5))
    ax.legend(loc="lower center", ncols=3)
axes[0].set_ylabel("position y [R]")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# Both panels show **the same curves** under other names. On the right the points bounce. This is
# exact: two points that pass through one another and then swap names move as two equal masses that
# collide elastically and *swap velocities*.
#
# </details>
#
# ## 1. Rods become points
#
# [Lesson 3](03_collisions_and_restitution.ipynb), section 2, takes out the length $2R$ of the rods:
#
# $$y_i = x_i - 2R\Big(i - \frac{L+1}{2}\Big) .$$
#
# The rods become points with $y_1 \le y_2 \le \dots \le y_L$. In $y$ the anchors are a distance $g$
# apart, where $g$ is the gap between rods at rest. **Without a gap all anchors are at $y = 0$**,
# and the sorted points of the picture are our chain.
#
# ## 2. The velocities
#
# A free rod has a Gaussian velocity of width $W = A/\sqrt{2m\gamma}$ and the temperature $mW^2$.
# Consider the distribution
#
# $$p(y, v) \propto \exp\Big[-\frac1{mW^2}\sum_i\Big(\frac m2 v_i^2 + U(y_i - y^0_i)\Big)\Big]
# \qquad\text{on}\quad y_1 \le \dots \le y_L .$$
#
# An elastic collision exchanges two velocities, so it leaves $p$ unchanged. Springs, damping and
# noise do, too, because they act on each rod alone. This Gibbs measure of *ordered* points is
# therefore the stationary state, for any spring energy $U$ and any gap.
#
# **Predict.** Take three chains: one without a gap, one with a gap, and one with a gap and springs
# that pull like $k\,d^2$ instead of $k\,d$. Enter the velocity width of the *outermost* rod in
# each, in units of $W$.

# %%
my_widths = ...  # your code here: three numbers

hint = "Integrate p over all positions. What is left for one velocity?"
check(my_widths, solutions.WIDTHS_OF_OUTER_RODS, hint=hint, tolerance=0.01)

# %% [markdown]
# **Run.**

# %%
kinds = {
    "no gap": cb.Chain(size=30),
    "gap 0.3 R": cb.Chain(size=30, gap=0.3),
    "gap 0.3 R, quadratic springs": cb.Chain(size=30, gap=0.3, spring="quadratic"),
}
runs = {}
for name, each in kinds.items():
    runs[name] = cb.simulate(each, duration=15_000, observe="widths", seed=5, progress=False)

# %% tags=["hide-input"]
ax = panels(width=7, height=3.2)
for number, (name, run) in enumerate(runs.items()):
    agree(f"{name}, W_v", run.velocity_width, W, run.velocity_width_error, unit="R/t_0")
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
# It is 1 in all three. The Gibbs measure is a product of a part with positions and one with
# velocities, so $W_v = W$ holds *exactly*, for every rod. Collisions change only where the rods
# are.
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
# **Your turn.** Write down this theory of the chain: from Gaussian numbers of variance 1, one row
# of $L$ for each draw, compute the positions $x$ of the rods. `s` is the thermal length,
# `chain.radius` is $R$, and `chain.rank` is $i - \frac{L+1}{2}$.

# %%
some = np.random.default_rng(0).standard_normal((3, size))


def my_rods(numbers):
    return ...  # your code here


hint = "In which order must the points be? And where is rod i, if point i is at y?"
check(my_rods, lambda numbers: solutions.rods_from(numbers, chain), at=[(some,)], hint=hint)

# %% tags=["remove-cell"]
assert np.allclose(solutions.rods_from(some, chain), chain.physical(np.sort(s * some)))

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
# **Predict.** Draw 50 000 such chains. Nothing in them knows of forces, collisions or time. Which
# will agree with a simulation: mean displacements, their widths, the density of rods?
#
# **Run.** `equilibrium` computes the Gibbs measure by integrals, without any random number.

# %%
draws = 50_000
numbers = np.random.default_rng(1).standard_normal((draws, size))
x = solutions.rods_from(numbers, chain)
y = chain.reduced(x)
run = cb.simulate(chain, duration=60_000, seed=2, progress=False)
exact = cb.equilibrium(chain)

# %% tags=["hide-input"]
mean, width = y.mean(axis=0), y.std(axis=0)
mean_error = width / np.sqrt(draws)
width_error = ((y - mean) ** 2).std(axis=0) / (2 * width * np.sqrt(draws))
sorting = {"mean_displacement": (mean, mean_error), "displacement_width": (width, width_error)}
axes = panels(2, height=3.4)
for ax, (name, (value, error)) in zip(axes, sorting.items(), strict=True):
    ax.plot(exact.particle, exact[name] / s, color=ORANGE, linewidth=2.5, label="exact equilibrium")
    ax.plot(run.particle, run[name] / s, "o", color="k", mfc="none", ms=8, label="simulation")
    ax.plot(run.particle, value / s, "x", color=BLUE, ms=5, label="sorted random numbers")
    ax.set(xlabel="particle i")
    ax.locator_params(axis="x", integer=True)
    what = name.replace("_", " ")
    agree(f"{what}, simulation", run[name], exact[name], run[f"{name}_error"], unit="R")
    agree(f"{what}, sorting", value, exact[name], error, unit="R")
axes[0].set_ylabel(r"mean displacement $\langle\Delta x\rangle/s$")
axes[1].set_ylabel("displacement width $W_x/s$")
axes[0].legend()
plt.show()

# %% [markdown]
# In the density the rods show as a row of peaks (the right half of the chain):

# %% tags=["hide-input"]
edges = exact.x.values[::2]
count = np.histogram(x, edges)[0]
# At most one rod's centre fits into a bin, which is thus a coin, tossed `draws` times.
chance = np.diff(exact.label.values[::2])  # label N(x): the mean number of rods to the left of x
likely = chance > 100 / draws
coin = np.sqrt(draws * (chance * (1 - chance))[likely])
agree("rods in a bin, sorting", count[likely], draws * chance[likely], coin)
ax = panels(width=9, height=3.4)
heights = count / draws / np.diff(edges)
ax.stairs(heights, edges, color=BLUE, fill=True, alpha=0.4, label="sorted random numbers")
ax.plot(exact.x, exact.density, color=ORANGE, linewidth=2, label="exact equilibrium")
ax.plot(run.x[::2], run.density[::2], "o", color="k", mfc="none", ms=4, label="simulation")
ax.set(xlim=(0, chain.anchors[-1] + 7 * s), ylim=(0, 1.25 * exact.density.max()))
ax.set(xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(ncols=3, loc="upper center")
plt.show()

# %% tags=["remove-cell"]
assert cb.deviation(cb.smooth(run), cb.smooth(exact)).maximum_in_errors < 5

# %% [markdown]
# <details><summary>Explain</summary>
#
# All three agree. The elastic chain without a gap *is* a sorted list of Gaussian numbers.
#
# </details>
#
# **Back on the page.** The peaks are about $2R$ apart, and their width grows like $s\propto A$. Draw on
# paper the density of <a href="../docs/chain.md#size=20&speed=100">20 rods</a> at $A = 4$, then set it.
#
# ## 4. One rod
#
# Let $\Phi$ be the distribution function of the unit Gaussian and $u = \Phi(y/s)$. Before they are
# sorted, the $L$ numbers $u$ are independent, and each is uniform in $(0, 1)$.
#
# **Your turn.** Which probability density does the $i$-th smallest of $L$ such numbers have at $u$?
# One number lies at $u$, $i - 1$ of the others lie below it, and each of them does so with the
# probability $u$. `special.comb(n, k)` is the number of ways to choose $k$ of $n$ things.

# %%
ranks = [(0.3, 1, 1), (0.3, 2, 5), (0.6, 10, 20), (0.9, 20, 20)]


def my_ordered_density(u, i, L):
    return ...  # your code here, with special.comb(n, k)


hint = "Any of the L numbers may be the one at u. Which of the other L - 1 lie below it?"
check(my_ordered_density, solutions.ordered_density, at=ranks, hint=hint)

# %% tags=["remove-cell"]
for u, i, L in ranks:
    assert np.isclose(solutions.ordered_density(u, i, L), beta(i, L + 1 - i).pdf(u))

# %% [markdown]
# <details><summary>Solution</summary>
#
# Each of the $L$ numbers may be at $u$, and $\binom{L-1}{i-1}$ choices of others may be below.
#
# ```python
# def my_ordered_density(u, i, L):
#     return L * special.comb(L - 1, i - 1) * u ** (i - 1) * (1 - u) ** (L - i)
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
    return norm.pdf(y / s) / s * beta(i, L + 1 - i).pdf(special.ndtr(y / s))


# %% tags=["hide-input"]
fine = np.linspace(-8 * s, 8 * s, 8001)
ax = panels(width=7, height=3.2)
for i, colour in ((1, BLUE), (3, PINK), (size // 2, ORANGE), (size, GREEN)):
    ax.hist(y[:, i - 1] / s, 80, density=True, color=colour, alpha=0.35)
    ax.plot(fine / s, s * one_rod(i, chain, fine), color=colour, label=f"rod {i}")
ax.plot(fine / s, norm.pdf(fine / s), "k:", label="a free rod")
ax.set(xlabel="displacement $y/s$", ylabel=r"probability density $s\,p_i$", xlim=(-4, 4))
ax.legend()
plt.show()

# %% tags=["remove-cell"]
whole = sum(
    np.interp(exact.x - x0, fine, one_rod(i, chain, fine), left=0, right=0)
    for i, x0 in zip(exact.particle.values, chain.anchors, strict=True)
)
assert abs(whole - exact.density).max() * 2 < 1e-3

# %% [markdown]
# <details><summary>Explain</summary>
#
# It is narrower, because its neighbours leave the rod little room. The distribution of the
# outermost rod is skewed, because it has neighbours on one side only.
#
# </details>
#
# **You can stop here.** You have the exact distribution of every position and velocity of the
# elastic chain. Lesson 5 needs no more.
#
# ## 5. Where the arctanh of the paper comes from
#
# The paper fits the mean displacement by $B\,\mathrm{arctanh}(Cx)$. The exact one is the expected
# order statistic, for which Blom found a good approximation,
#
# $$\langle\Delta x_i\rangle \approx s\,\Phi^{-1}(q_i),\qquad q_i = \frac{i-3/8}{L+1/4}.$$
#
# The arctanh is the inverse of another distribution function,
# $\mathrm{arctanh}(2q-1)=\frac12\ln\frac q{1-q}$, that of the *logistic* distribution. In a dense
# chain $x\approx 2R(i-\frac{L+1}2)$, so $Cx$ takes the place of $2q-1$.
#
# **Predict.** The logistic distribution has longer tails than the Gaussian. Will the arctanh fit
# equally well at all amplitudes $A$ of the noise?
#
# **Run.** The fit is made to the exact displacements.

# %%
fits = {}
for amplitude in (1, 10, 100):
    theory = cb.equilibrium(cb.Chain(size=100, amplitude=amplitude))
    fit, unit = cb.comparison.fit_arctanh(theory), s * amplitude  # the thermal length of this chain
    off = (fit(theory.mean_position.values) - theory.mean_displacement.values) / unit
    print(f"A = {amplitude}: the arctanh is wrong by at most {abs(off).max():.4f} s")
    fits[amplitude] = off
i = theory.particle.values
blom = special.ndtri((i - 3 / 8) / (100 + 1 / 4)) - theory.mean_displacement.values / unit
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
# No. It is as good as Blom's formula at $A = 10$, and four to five times worse at 100 and 1, with
# opposite signs at the ends. At large $A$ the position $x$ contains $\langle\Delta x\rangle$
# itself, which straightens the curve. In between, this makes up for the other distribution.
#
# </details>
#
# ## 6. With gaps: a plasma
#
# With a gap the anchors $y^0_i = g\,r_i$, $r_i = i - \frac{L+1}{2}$, differ, and the points are no
# longer independent. But multiply the spring energy out:
#
# $$\sum_i\frac k2(y_i - g r_i)^2 = \frac k2\sum_i y_i^2 - kg\sum_i r_i y_i + \text{const},
# \qquad \sum_i r_i y_i = \frac12\sum_{i<j}|y_j - y_i| ,$$
#
# because the points are in order. Charged planes repel each other with a constant force, which has
# the energy $-|y_i - y_j|$. So *rods with gaps behave like charged planes in a trap*, a plasma in
# one dimension, which Baxter solved exactly in 1963.
#
# **Your turn.** Two planes push each other apart with the force 1 (here $kg/2$). With which force
# do all others push plane $i$ of $L$ to the right?


# %%
def my_push(i, L):
    return ...  # your code here


hint = "How many planes push from the left, and how many from the right?"
check(my_push, solutions.push_of_the_others, at=[(1, 5), (3, 5), (4, 10)], hint=hint)

# %% tags=["remove-cell"]
r, gap = chain.rank, 0.7
state = np.sort(np.random.default_rng(0).normal(size=chain.size))
pairs = abs(state[:, None] - state[None, :]).sum() / 2
springs = ((state - gap * r) ** 2).sum() / 2
plasma = (state**2).sum() / 2 - gap / 2 * pairs + gap**2 * (r**2).sum() / 2
assert np.isclose(springs, plasma, rtol=1e-12)
assert np.allclose(solutions.push_of_the_others(np.arange(1, size + 1), size), 2 * r)

# %% [markdown]
# <details><summary>Solution</summary>
#
# $i-1$ planes push from the left and $L-i$ from the right: $2i-L-1=2r_i$. This holds the rod at its
# anchor $g\,r_i$ against the spring.
#
# </details>
#
# **Predict.** Without a gap every rod but the middle one is pushed outward. How do the mean
# displacements change, in the middle and at the ends, when the rods get room?
#
# **Run.**

# %%
results = {}
for g in (0.0, 0.1, 0.5):
    loose = cb.Chain(size=50, gap=g)
    run = cb.simulate(loose, duration=20_000, observe="widths", seed=8, progress=False)
    results[g] = cb.equilibrium(loose), run

# %% tags=["hide-input"]
ax = panels(width=8, height=3.6)
for (g, (theory, run)), colour in zip(results.items(), (BLUE, ORANGE, GREEN), strict=True):
    mean = theory.mean_displacement
    error = run.mean_displacement_error
    agree(f"mean displacement, g = {g} R", run.mean_displacement, mean, error, unit="R")
    ax.plot(theory.particle, mean / s, color=colour, label=f"g = {g} R")
    ax.plot(run.particle, run.mean_displacement / s, "o", color=colour, ms=5, mfc="none")
ax.plot([], [], "o", color="0.4", mfc="none", label="simulation")
ax.set(xlabel="particle i", ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
ax.legend()
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# With a gap the inner rods sit at their anchors, because a rod is pushed as often from the left as
# from the right. Only a layer at either end is still pushed outward.
#
# </details>
#
# ## 7. In time
#
# Without a gap the first picture holds at every moment: *the relabelled points are independent
# oscillators*. Release the chain from a compressed state. The cloud of points then follows the
# three equations of **one** oscillator ([lesson 1](01_one_noisy_oscillator.ipynb), section 1). They
# are linear, so a matrix exponential solves them.


# %%
def moments(chain, times, start):
    """<y^2>, <yv>, <v^2> of one damped, shaken oscillator at the given times."""
    pull, damping = chain.stiffness / chain.mass, chain.damping / chain.mass
    matrix = np.array([[0, 2, 0], [-pull, -damping, 1], [0, -2 * pull, -2 * damping]])
    steady = np.array([chain.thermal_length**2, 0, chain.free_velocity_width**2])
    return np.array([steady + expm(t * matrix) @ (start - steady) for t in times])


# %% [markdown]
# **Predict.** Squeeze all room between the rods to 0.3 of its size, leave the velocities unchanged,
# and let go. Will the cloud overshoot its final width? Will it get colder on the way?
#
# **Run.** We average over 1000 chains of 50 rods, each from its own equilibrium state.

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
left, right_panel = panels(2, height=3.5)
left.plot(times, np.sqrt(exact_y2) / s, color=ORANGE, linewidth=2.2, label="exact")
left.plot(times[::2], sigma[::2] / s, "o", color="k", mfc="none", ms=4, label="1000 chains")
left.set(xlabel="time $t$ [$t_0$]", ylabel=r"width of the cloud $\sigma/s$")
left.legend()
right_panel.plot(times, exact_v2 / W**2, color=ORANGE, linewidth=2.2)
right_panel.plot(times[::2], heat[::2] / W**2, "o", color="k", mfc="none", ms=4)
right_panel.set(xlabel="time $t$ [$t_0$]", ylabel=r"$\langle v^2\rangle/W^2$")
plt.show()
points = replicas * fifty.size  # independent Gaussian points
agree("cloud width over theory", sigma / np.sqrt(exact_y2), 1, 1 / np.sqrt(2 * points))
agree("<v^2> over theory", heat / exact_v2, 1, np.sqrt(2 / points))

# %% tags=["remove-cell"]
cloud = cb.breathing_cloud(fifty, 30, every=0.5, stretch=squeeze)
error = run.displacement_width / np.sqrt(replicas)
agree("mean displacement of every rod", run.mean_displacement, cloud.mean_displacement, error)
assert abs(cloud.cloud_width.values - np.sqrt(exact_y2)).max() < 1e-6 * s
assert np.sqrt(exact_y2.max()) < 1.001 * s
assert abs(exact_v2.min() / W**2 - 0.54) < 0.01

# %% [markdown]
# <details><summary>Explain</summary>
#
# The cloud hardly overshoots. The springs are too weak to hold the velocities
# of the squeezed cloud, so it expands. As it does, the springs take energy out of the velocities.
# $\langle v^2\rangle$ falls to about $W^2/2$, because the noise replaces energy only at the rate
# $2\gamma/m$.
#
# </details>
#
# [Lesson 7](07_when_is_a_gas_a_fluid.ipynb), section 1, looks at this motion as a fluid. With a gap,
# or for $e \ne 1$, points cannot be relabelled, and this solution in time does not hold.
#
# ## Exercise
#
# **Quadratic springs.** Take $F = k\,d\,|d|$ and no gap. Which random numbers must be sorted now?
#
# <details><summary>Solution</summary>
#
# Independent draws from $\exp(-k|y|^3/3T)$ with $T = mW^2$, since $U = k|d|^3/3$. This is
# `scipy.stats.gennorm(3, scale=(3 * T / k) ** (1 / 3))`. The largest of 20 draws has the mean 1.240 R.
# `cb.equilibrium(cb.Chain(size=20, spring="quadratic"))` has the same `mean_displacement[-1]`.
#
# </details>
