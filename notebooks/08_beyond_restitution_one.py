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
# # Beyond restitution 1
#
# **Question.** At restitution $e = 1$ all rods of a chain have the same velocity width. If collisions
# lose or add energy, Boltzmann's distribution does not hold. Can we still compute how fast each rod
# moves, without fitting anything? And how many rods can a chain have whose collisions add energy? The
# theory of [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) is for $e = 1$.
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = \frac{4\pi}3 M$), times in $t_0 =
# \sqrt{M/k}$. A collision gives $v_1' - v_2' = -e(v_1 - v_2)$. A single rod has the velocity width $W
# = A/\sqrt{2m\gamma}$ and the thermal length $s = W\sqrt{m/k}$.
#
# *90 minutes. `make lessons` writes copies without outputs and solutions.*
#
# **Two minutes on the page.** At $e = 0.95$ a collision takes a tenth of the energy of approach. Draw
# <a href="../docs/chain.md#preset=loss">the velocity widths</a> of 100 rods that you expect, then set
# $e$.
#
# **What you may change.** The `damping`, from 0.5 to 2, and all seeds. After a change run all cells
# below it again.

# %% tags=["hide-input"]
import warnings

import matplotlib.pyplot as plt
import numpy as np
from scipy.linalg import solve_banded
from scipy.special import ndtri
from solutions import lesson_08 as solutions
from teaching import BLUE, GREEN, ORANGE, PINK, agree, check, choose, mean_and_error, panels, safe

from crazybilliards.kinetic import UnmeasuredWarning
from crazybilliards.model import DivergedWarning

# Here errors are measured, and some chains are meant to diverge.
warnings.simplefilter("ignore", UnmeasuredWarning)
warnings.simplefilter("ignore", DivergedWarning)

# %%
damping = 1

# %% tags=["hide-input"]
if not safe(
    0.5 <= damping <= 2,
    f"This lesson is for damping from 0.5 to 2, not {damping}: its runs are too short for less, "
    "and more hides what collisions do. The lesson goes on with damping = 1.",
):
    damping = 1

# %% [markdown]
# ## 1. A collision, seen differently
#
# Subtract the rods' own length from their positions: $y_i = x_i - 2R(i - \frac{L+1}2)$. The rods
# become points, and without gaps all anchors lie at $y = 0$. Now **exchange the names** of two
# points that collide. Then they pass through one another. For $e = 1$ each point keeps its own
# velocity. Otherwise each loses the fraction $(1 - e)/2$ of its velocity relative to the other one.
#
# **Your turn.** How much kinetic energy, in units of $m$, does the pair gain in the collision?


# %%
def my_gain(v, u, e):
    return ...  # your code here


cases = [(1.0, -1.0, 0.9), (0.3, 2.0, 1.05), (0.5, -0.2, 1.0)]
hint = "Each point changes its velocity by (1 - e)/2 of the relative velocity."
check(my_gain, solutions.gain, at=cases, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_gain(v, u, e):
#     return (e**2 - 1) / 4 * (v - u) ** 2
# ```
#
# The gain is negative for $e < 1$ and positive for $e > 1$.
# </details>
#
# ## 2. A gas that cools and conducts
#
# Take $W$, $s$ and $m$ as units, so that $T = \langle v^2\rangle$ is 1 for a free rod, and $\Gamma =
# \gamma/\sqrt{km}$. Rods whose points are a gap $g = 1/n$ apart press on one another with $P = nT$.
# The springs hold them together, $P_{i-1} - P_i = y_i$ (lesson 5). A balance of heat along the label
# $l$, which counts the rods, tells $T$:
#
# $$2\Gamma\,(1 - T) = \Lambda - \frac{d}{dl}\Big(\lambda\,\frac{dT}{dl}\Big),\qquad
# \lambda = \frac{3n^2T}{3\Gamma + c\,n\sqrt T},\quad c = \frac{9}{2\sqrt\pi}\,(1 - e^2).$$
#
# Noise and damping supply the left side. $\Lambda$ is what collisions take from $\langle v^2\rangle$
# of a point per time. The heat conductivity $\lambda$ comes from fast points, which carry heat to
# cold places. Damping stops them, and inelastic collisions do, too.
#
# **Your turn.** Let the velocities of the points at one place be independent Gaussians of the
# variance $T$. A point meets others with the relative velocity $w$ at the rate $n|w|$, and $\langle
# |w|^3\rangle = 8\,T^{3/2}/\sqrt\pi$. What is $\Lambda$?


# %%
def my_loss(n, T, e):
    return ...  # your code here


hint = "Section 1 has the energy of a pair. Half is that of one point, and <v^2> is twice it."
check(my_loss, solutions.loss, at=[(1.0, 1.0, 0.5), (2.0, 0.3, 0.95)], hint=hint)

# %% tags=["remove-cell"]
v, u = np.random.default_rng(1).normal(size=(2, 1_000_000))
taken = -(abs(v - u) * solutions.gain(v, u, 0.5)).mean()
assert np.isclose(taken, solutions.loss(1, 1, 0.5), rtol=0.01)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_loss(n, T, e):
#     return 2 / np.sqrt(np.pi) * (1 - e**2) * n * T**1.5
# ```
# </details>
#
# A theory in which points that meet are independent is a *mean field*. Now write it. Each of the $L$
# rods has a $y$ and a $T$, and between two neighbours lies a contact. At an open end there is no
# force and no flux. Both balances link a rod with its neighbours only, so each is a *tridiagonal*
# system of equations. The loss of a rod is its rate `loss`, $\Lambda/T$, times $T_i$:
#
# $$2\Gamma\,(1 - T_i) = \mathrm{loss}_i\,T_i + \lambda_{i-1}(T_i - T_{i-1})
# + \lambda_i\,(T_i - T_{i+1}).$$
#
# **Your turn.** Solve this for all $T_i$. `tridiagonal(diagonal, beside, right)` solves a symmetric
# system whose matrix has `diagonal`, and `beside` above and below it. `at_rods` adds what the
# contacts on both sides of each rod have.


# %%
def tridiagonal(diagonal, beside, right):
    bands = [np.append(0, beside), diagonal, np.append(beside, 0)]
    return solve_banded((1, 1), bands, right)


def at_rods(contacts):
    return np.append(contacts, 0) + np.append(0, contacts)


# %%
def my_temperatures(loss, conduction, Gamma):  # of all rods; of all contacts; a number
    return ...  # your code here


rates = [(np.array([0.3, 0.5, 0.9, 0.2]), np.array([1.0, 2.0, 0.5]), 0.4)]
hint = "Move all T to one side: the other has 2 Gamma, and -conduction is beside the diagonal."
check(my_temperatures, solutions.temperatures, at=rates, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_temperatures(loss, conduction, Gamma):
#     diagonal = 2 * Gamma + loss + at_rods(conduction)
#     return tridiagonal(diagonal, -conduction, np.full(loss.size, 2 * Gamma))
# ```
# </details>
#
# The places follow from Newton's method, one tridiagonal system a turn. We take both in turns:


# %%
def mean_field(chain):
    """Return the velocity widths over W of all rods of a chain."""
    L, e = chain.size, chain.restitution
    Gamma = chain.damping / np.sqrt(chain.mass * chain.stiffness)
    y, T = ndtri((np.arange(L) + 0.5) / L), np.ones(L)
    for _ in range(40):
        between = (T[1:] + T[:-1]) / 2
        n = 1 / np.diff(y)
        off = -y - np.diff(np.pad(n * between, 1))  # spring and both neighbours
        y = y + tridiagonal(1 + at_rods(n**2 * between), -(n**2) * between, off)
        n = 1 / np.diff(y)
        loss = at_rods(solutions.loss(n, between, e) / between) / 2
        T = solutions.temperatures(loss, solutions.conduction(n, between, e, Gamma), Gamma)
    return np.sqrt((1 - 1 / L) * T + 1 / L)  # the noise also moves the centre of mass


# %% [markdown]
# **Predict.** Does heat flow (1) from the ends to the centre, or (2) from the centre to the ends?

# %%
my_choice = "..."  # your code here: 1 or 2

ways = "from the ends to the centre", "from the centre to the ends"
choose(my_choice, *ways, right=solutions.HEAT_FLOWS, hint="Which rods have few neighbours?")

# %% [markdown]
# **Run.**

# %%
import crazybilliards as cb

settings = {"replicas": 2, "seed": 1, "progress": False}
chains = {e: cb.Chain(size=100, restitution=e, damping=damping) for e in (0.95, 0.5)}
observe, runs = ["widths", "covariances"], {}
for e, chain in chains.items():
    runs[e] = cb.simulate(chain, duration=1000, every=0.5, observe=observe, **settings)
W = chain.free_velocity_width
own = {e: mean_field(chain) for e, chain in chains.items()}
package = cb.steady_state(chains[0.95], correlations=False).velocity_width / W

# %% tags=["hide-input"]
ax = panels(width=7)
for e, colour, symbol in ((0.95, BLUE, "o"), (0.5, ORANGE, "s")):
    width, error = runs[e].velocity_width / W, runs[e].velocity_width_error / W
    look = {"color": colour, "markersize": 4, "markerfacecolor": "none", "linewidth": 0.8}
    ax.errorbar(width.particle[::2], width[::2], error[::2], fmt=symbol, label=f"e = {e}", **look)
    ax.plot(width.particle, own[e], color=colour)
ax.set(xlabel="particle i", ylabel="velocity width $W_v/W$", ylim=(0, 1))
ax.legend(title="symbols: simulation\nlines: mean field", loc="upper center")
plt.show()


def off(theory, run):
    """Return theory over simulation - 1 of W_v of the rods 3 to L - 2."""
    square = run.velocity_width.values**2 / W**2
    square = (square + square[::-1]) / 2  # both halves of the chain are the same
    return (theory / np.sqrt(square) - 1)[2:-2]


print(f"e = 0.95: at most {100 * abs(off(own[0.95], runs[0.95])).max():.1f} % off,", end=" ")
print(f"and {100 * abs(own[0.95] / package - 1)[2:-2].max().item():.1f} % from `steady_state`")

# %% tags=["remove-cell"]
error = (runs[0.95].velocity_width_error / runs[0.95].velocity_width).values[2:-2]
assert (abs(off(own[0.95], runs[0.95])) < 0.03 + 5 * error).all()
assert abs(own[0.95] / package - 1).max() < 0.03
assert own[0.95][0] > 1.5 * own[0.95][50]

# %% [markdown]
# <details><summary>Explain</summary>
#
# From both ends to the centre: the rods at the ends have neighbours on one side only.
#
# The rods in the centre are less than half as fast as free rods. One collision changes little,
# but a point crosses 99 others in half a period, so the product $\frac{1-e}2L$ counts, here 2.5. At
# $e = 0.95$ your theory is right within a few per cent, and nothing was fitted. At $e = 0.5$ it is
# too cold inside.
# </details>
#
# ## 3. A gas that remembers
#
# **Your turn.** By how much does the product $vu$ of two velocities change in a collision?


# %%
def my_change_of_product(v, u, e):
    return ...  # your code here: v' u' - v u


pairs = [(1.0, 0.0, 0.5), (2.0, -1.0, 0.0), (0.3, 0.2, 1.0), (-0.5, -2.0, 0.75)]
hint = "Write v u = (v+u)^2/4 - (v-u)^2/4. The sum is conserved."
check(my_change_of_product, solutions.change_of_product, at=pairs, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_change_of_product(v, u, e):
#     return (1 - e**2) / 4 * (v - u) ** 2
# ```
#
# **The covariance that a collision makes is half of what it takes from the squares**, because $(v +
# u)^2$ is conserved. Every collision makes the two rods more alike.
# </details>
#
# Rods that are alike lose less when they meet: what counts is their *relative temperature* $\Theta =
# \langle v_i^2\rangle - \langle v_iv_{i+1}\rangle$. `steady_state(chain)` solves the same gas with
# its *fluctuations*. Each collision makes a covariance, and the sound of the gas carries it along the
# chain.
#
# **Predict.** Which share of $\langle v_i^2\rangle$ is $\Theta$ in the centre, at $e = 0.5$?
#
# **Run.**

# %%
remembering = {e: cb.steady_state(chain) for e, chain in chains.items()}
widths = {"mean field": own[0.5], "gas": remembering[0.5].velocity_width.values / W}
for name, width in widths.items():
    print(f"e = 0.5, centre, {name}: W_v {100 * off(width, runs[0.5])[42:54].mean():+.0f} %")
for name, result in (("simulation", runs[0.5]), ("gas", remembering[0.5])):
    covariance = result.neighbour_covariance[44:55].mean().item()
    square = (result.velocity_width[44:56] ** 2).mean().item()
    print(f"e = 0.5, centre, {name}: Theta is {1 - covariance / square:.2f} of <v_i^2>")

# %% tags=["hide-input"]
left, other = panels(2, width=9.5)
run, particle = runs[0.5], runs[0.5].particle
look = {"color": "k", "markersize": 3, "markerfacecolor": "none", "linewidth": 0.8}
width, error = run.velocity_width / W, run.velocity_width_error / W
left.errorbar(particle, width, error, fmt="o", label="simulation", **look)
for (name, width), style in zip(widths.items(), ("--", "-"), strict=True):
    left.plot(particle, width, style, color=ORANGE if style == "--" else BLUE, label=name)
left.set(xlabel="particle i", ylabel="velocity width $W_v/W$", ylim=(0, None), title="$e = 0.5$")
left.legend()
for e, colour in ((0.95, PINK), (0.5, GREEN)):
    seen, theory = (each[e].neighbour_covariance / W**2 for each in (runs, remembering))
    other.plot(particle[:-1], seen, "o", color=colour, mfc="none", ms=3, label=f"e = {e}")
    other.plot(particle[:-1], theory, color=colour)
other.set(xlabel="particle i", ylabel=r"$\langle v_iv_{i+1}\rangle/W^2$", ylim=(0, None))
other.set_title("symbols: simulation; lines: gas")
other.legend(loc="upper center")
plt.show()

# %% tags=["remove-cell"]
for name, least, most in (("mean field", -0.24, -0.1), ("gas", -0.06, 0.06)):
    assert least < off(widths[name], runs[0.5])[42:54].mean() < most

# %% [markdown]
# <details><summary>Explain</summary>
#
# Neighbours share a large part of their velocities, and no collision between them can take that. The
# mean field does not know this and is too cold. With memory the widths are right. The theory takes
# fluctuations for small, so its covariances are too large near $e = 1$, where they matter little.
# </details>
#
# **You can stop here.** You have written a theory that predicts how fast every rod moves, and know
# why rods that lose energy move together. What follows is about collisions that add energy.
#
# ## 4. How many rods can a driven chain have?
#
# For $e > 1$ longer chains are hotter. The distance $r = y_i - y_j$ of two points is an oscillator,
# $m\ddot r = -\gamma\dot r - kr$. The points meet when $r = 0$. With weak damping this happens once
# in half a period, $\pi\sqrt{m/k}$, **whatever the amplitude**. At that moment all their relative
# energy $E_{ij} = \frac m4\dot r^2 + \frac k4r^2$ is kinetic, and the encounter adds $(e^2 -
# 1)E_{ij} \approx 2(e-1)E_{ij}$.
#
# With the centre of mass at rest, $\sum_{i<j}E_{ij} = \frac L2E$ over all pairs. So in half a period
# encounters add $(e-1)LE$. Half of $E$ is kinetic, and damping takes $\frac\gamma mE$ per time.
#
# **Your turn.** Gain and loss are equal at the critical size $L_c$. Write it.


# %%
def my_critical_size(chain):
    return ...  # your code here: from chain.damping, .mass, .stiffness and .restitution


driven_chains = [(cb.Chain(restitution=e, damping=d),) for e, d in ((1.05, 1), (1.02, 4))]
hint = "In half a period damping takes pi gamma / sqrt(k m) times E."
check(my_critical_size, solutions.critical_size, at=driven_chains, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_critical_size(chain):
#     root = np.sqrt(chain.stiffness * chain.mass)
#     return np.pi * chain.damping / ((chain.restitution - 1) * root)
# ```
# </details>
#
# Without collisions the noise holds the energy at $E_0$. So below $L_c$ there is a steady state with
# $E_0/E = 1 - L/L_c$, and none above.
#
# **Back on the page.** <a href="../docs/chain.md#challenge=runaway">Make 15 rods run away.</a>
# Compute first which $e$ you need at $\gamma = 1$.
#
# **Run.** $W^2/\langle v^2\rangle$ of steady chains against $L/L_c$:

# %%
small = cb.Chain(restitution=1.05, damping=1)
critical, square = solutions.critical_size(small), small.free_velocity_width**2
sizes = np.array([6, 12, 18, 22, 26])
inverse, error = np.zeros((2, sizes.size))
for i, L in enumerate(sizes):
    chain = small.replace(size=int(L))
    run = cb.simulate(chain, duration=5000, observe=["widths"], **settings)
    heat = (run.velocity_width**2).mean()
    inverse[i] = square / heat
    # All rods of a chain heat and cool together: their errors are not independent.
    error[i] = inverse[i] * 2 * (run.velocity_width_error * run.velocity_width).mean() / heat

# %% tags=["hide-input"]
ax = panels(width=6, height=3)
ax.errorbar(sizes / critical, inverse, error, fmt="o", markerfacecolor="none", label="simulation")
ax.plot([0, 1], [1, 0], "k-", linewidth=1, label="$1 - L/L_c$", zorder=0)
ax.set(xlabel="size over critical size, $L/L_c$", ylabel=r"$W^2/\langle v^2\rangle$")
ax.legend()
plt.show()
share = 1 / sizes  # of the centre of mass, which collisions cannot drive
law = 1 / (share + (1 - share) / (1 - sizes / critical))
agree("law with the share of the centre of mass", inverse, law, np.hypot(error, 0.02))

# %% [markdown]
# The points lie a little above the line, because collisions cannot drive the centre of mass, which
# keeps its share $E_0/L$.
#
# ## 5. Flippers
#
# Above $L_c$ the energy grows, exponentially on linear springs. On quadratic springs, $F = k\,d\,|d|$,
# the period of a rod depends on its energy $E_1$. In the potential $ky^3/3$ lengths grow like
# $E_1^{1/3}$.
#
# **Your turn.** A rod has 64 times the energy of another one. By which factor is its period longer or
# shorter?

# %%
my_factor_of_the_period = ...  # your code here: below 1 if it is shorter

hint = "A period is a length over a speed, and speeds grow like the root of the energy."
check(my_factor_of_the_period, solutions.period_factor(64), hint=hint)

# %% [markdown]
# **Predict.** A hundred rods on quadratic springs start at rest. How does their energy look in time on
# a logarithmic axis?

# %%
my_choice = "..."  # your code here: 1 straight, 2 bent down or 3 bent up

hint = "Each half period adds the same fraction of the energy. Do half periods become shorter?"
choose(my_choice, "straight", "bent down", "bent up", right=solutions.QUADRATIC_GROWTH, hint=hint)

# %% [markdown]
# **Run.** Six runs of each kind, from rest:

# %%
linear = cb.Chain(size=100, restitution=1.01, damping=0.4)
ends = {"linear": {"duration": 300, "time_step": 0.02}, "quadratic": {"duration": 100}}
ends["quadratic"]["time_step"] = 0.005
settings = {"warmup": 0, "observe": ["energy"], "every": 0.2, "progress": False}
grown = {
    spring: [
        cb.simulate(linear.replace(spring=spring), seed=seed, **end, **settings)
        for seed in range(6)
    ]
    for spring, end in ends.items()
}
last = [run.attrs["end_time"] for run in grown["quadratic"]]
print(f"quadratic springs: the energy is infinite at t = {np.mean(last):.1f} t_0", end=", ")
print(f"which scatters by {np.std(last, ddof=1):.1f} t_0")

# %%
late = [run.kinetic_energy.sel(time=slice(150, None)) for run in grown["linear"]]
rates = [np.polyfit(each.time, np.log(each), 1)[0] for each in late]
rate, rate_error = mean_and_error(rates)
balance = linear.damping / linear.mass * (linear.size / solutions.critical_size(linear) - 1)
print(f"linear springs: rate {rate:.4f} ± {rate_error:.4f}, balance {balance:.4f} per t_0")

# %% tags=["hide-input"]
ax = panels(width=7)
for (spring, runs_of), colour in zip(grown.items(), (BLUE, ORANGE), strict=True):
    for run in runs_of:
        ax.semilogy(run.time, run.kinetic_energy, color=colour, linewidth=0.8, alpha=0.7)
    ax.plot([], [], color=colour, label=f"{spring} springs")
ax.set(xlabel="time $t$ [$t_0$]", ylabel=r"kinetic energy [$M R^2/t_0^2$]", ylim=(1, 1e12))
ax.legend()
plt.show()

# %% tags=["remove-cell"]
assert all(run.attrs["status"] == "diverged" for run in grown["quadratic"])
assert 35 < np.mean(last) < 45
assert abs(rate / balance - 1) < 0.03

# %% [markdown]
# <details><summary>Explain</summary>
#
# On linear springs the line is straight. On quadratic springs 64 times the energy halves the period,
# so the frequency is proportional to $E^{1/6}$, and
#
# $$\dot E = \alpha E^{7/6} - \beta E .$$
#
# Without damping $u = E^{-1/6}$ falls on a straight line, $\dot u = -\alpha/6$, and reaches zero: the
# energy becomes infinite at a finite time $t_c$, as $(t_c - t)^{-6}$. **A divergence is a result.**
# `simulate` stops there with the status `diverged`, and returns what it has measured.
# </details>
#
# ## Exercises
#
# **1.** Give the chain with $e = 0.5$ a gap of $0.5\,R$. How much faster is its centre? Ask
# `steady_state` first, then `simulate`.
#
# <details><summary>Solution</summary>
#
# `chains[0.5].replace(gap=0.5)` has $0.80\,W$ in the centre, in place of $0.22\,W$. Rods stay near
# their anchors, and meet seldom.
# </details>
#
# **2.** How many rods share the energy at the end, on quadratic springs?
#
# <details><summary>Solution</summary>
#
# ```python
# settings |= {"observe": ["snapshots"], "every": 0.1}
# run = cb.simulate(linear.replace(spring="quadratic"), seed=0, **ends["quadratic"], **settings)
# energy = run.velocity.values[0] ** 2
# print(energy.sum(axis=1) ** 2 / (energy**2).sum(axis=1))
# ```
#
# At first some forty, and at last one or two. The rod in the lead has the shortest period and meets
# others most often, so its lead grows. A fit of $(t_c - t)^{-p}$ to the growth therefore gives less than 6.
# </details>
