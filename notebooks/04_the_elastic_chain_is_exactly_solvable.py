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
# them pushes all the others about. Can one know where each rod is, on average and at every
# moment, *without simulating a single collision*?
#
# The picture below says yes, once it is understood. The chain is that of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) at restitution 1. The
# paper found in its simulations that all rods then have the same velocity distribution. The exact
# solution is not in the paper; it is derived here.
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = 4\pi/3\,M$), times in
# $T = \sqrt{M/k}$, $k$ being the stiffness of the springs.

# %%
import ipywidgets
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import trapezoid
from scipy.linalg import expm
from scipy.special import ndtr, ndtri
from scipy.stats import beta, norm

from crazybilliards.comparison import deviation, fit_arctanh, smooth
from crazybilliards.kinetic import breathing_cloud, equilibrium, equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate

BLUE, ORANGE, GREEN, PINK = "#0072B2", "#E69F00", "#009E73", "#CC79A7"

# %% [markdown]
# Between collisions rod $i$ obeys
#
# $$m\ddot x_i = -\gamma\dot x_i - k(x_i - x^0_i) + A\,\xi_i(t),$$
#
# with independent white noises $\xi_i$ of unit strength (the paper's equation of motion; here
# $\gamma = A = 1$ in our units). Let us take $L$ such oscillators that know nothing of one
# another and share one rest position, and move them with a ten-line scheme.


# %%
def independent_oscillators(chain, steps, dt, seed):
    """Move L damped, shaken oscillators that do not collide: the semi-implicit Euler scheme."""
    rng = np.random.default_rng(seed)
    y, v = np.zeros((2, chain.size))
    path = np.empty((steps, chain.size))
    for n in range(steps):
        push = -chain.damping * v - chain.stiffness * y
        kick = chain.amplitude * rng.standard_normal(chain.size) / np.sqrt(dt)
        v = v + dt / chain.mass * (push + kick)
        y = y + dt * v
        path[n] = y
    return path


chain = Chain(size=20)  # restitution 1, no gap between the anchors, linear springs
s, W = chain.thermal_length, chain.free_velocity_width
dt = 0.05
path = independent_oscillators(chain, steps=2400, dt=dt, seed=4)[1200:]
time = dt * np.arange(len(path))
marked = {0: BLUE, 9: ORANGE, 19: GREEN}

fig, axes = plt.subplots(1, 2, figsize=(10, 3.8), sharey=True, layout="constrained")
for ax, lines, title in (
    (axes[0], path, "20 points that pass through one another"),
    (axes[1], np.sort(path, axis=1), "20 points that bounce off one another"),
):
    ax.plot(time, lines, color="0.8", linewidth=0.7)
    for i, colour in marked.items():
        ax.plot(time, lines[:, i], color=colour, linewidth=1.6, label=f"number {i + 1}")
    ax.set(xlabel="time t [T]", title=title, ylim=(-3.2, 2.5))
    ax.legend(loc="lower center", ncols=3)
axes[0].set_ylabel("position y [R]")
plt.show()

# %% [markdown]
# Both panels show **the same curves**: the ink is the same, only the names differ. On the right,
# number $i$ is at every moment the $i$-th from the left (one `np.sort`). There the coloured
# points never cross: they bounce.
#
# This is more than a trick of drawing. When two equal masses collide elastically they *swap
# velocities*. That is what two points do that pass through one another and then swap names.
#
# ## 1. Rods become points
#
# Rods have a length, $2R$. Take it out:
#
# $$y_i = x_i - 2R\Big(i - \frac{L+1}{2}\Big) .$$
#
# Rods that touch, $x_{i+1} - x_i = 2R$, have $y_{i+1} = y_i$. So the rods are points with
# $y_1 \le y_2 \le \dots \le y_L$. The anchors are a distance $2R + g$ apart, $g$ being the gap, so
# in $y$ they are $g$ apart. **Without gap all anchors are at $y = 0$**, and the points of the
# picture are our chain.
#
# ## 2. The velocities
#
# A free rod has a Gaussian velocity of width $W = A/\sqrt{2m\gamma}$ and the temperature
# $T = mW^2$. An elastic collision exchanges two velocities. It conserves the energy, so it leaves
#
# $$p(y, v) \propto \exp\Big[-\frac1T\sum_i\Big(\frac m2 v_i^2 + U(y_i - y^0_i)\Big)\Big]
# \qquad\text{on}\quad y_1 \le \dots \le y_L$$
#
# as it is, and springs, damping and noise leave it as it is too: they do so for every single
# rod. This is the Gibbs measure of *ordered* points, and it is the stationary state for any
# spring energy $U$ and any gap. It is a product of a part with positions and a part with
# velocities.
#
# **Predict.** Three chains: without gap, with a gap, and with a gap and springs that pull like
# $k\,d^2$ instead of $k\,d$. In which of them is the velocity width $W_v(i) =
# \sqrt{\langle v_i^2\rangle}$ of a rod near the border different from that in the centre?
#
# **Run.**

# %%
kinds = {
    "no gap": Chain(size=30),
    "gap 0.3 R": Chain(size=30, gap=0.3),
    "gap 0.3 R, quadratic springs": Chain(size=30, gap=0.3, spring="quadratic"),
}
fig, ax = plt.subplots(figsize=(7, 3.2), layout="constrained")
for number, (name, each) in enumerate(kinds.items()):
    run = simulate(each, duration=30_000, observe="widths", seed=5, progress=False)
    pulls = ((run.velocity_width - W) / run.velocity_width_error).values
    print(f"{name}: W_v - W is at most {abs(pulls).max():.1f} standard errors")
    assert abs(pulls).max() < 5
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
# **Explain.** In none. The velocities do not know that there are other rods: $W_v(i) = W$
# *exactly*, for every rod, at any gap and for any spring. What collisions do change is where the
# rods are.
#
# ## 3. Sorting random numbers
#
# Without gap the Gibbs measure of the positions is that of $L$ *independent* Gaussian numbers of
# width
#
# $$s = \sqrt{T/k} = \frac{A}{\sqrt{2\gamma k}}$$
#
# (the thermal length), put in order. Statisticians call the $i$-th smallest of $L$ draws the
# $i$-th **order statistic**.
#
# **Predict.** Draw 20 Gaussian numbers, sort them, add the rods' lengths back. Do this
# 50 000 times. Which of these will agree with a simulation of the chain: the mean displacements,
# their widths, the density of the rods?
#
# **Run.** First the whole theory:

# %%
rng = np.random.default_rng(1)
draws = 50_000
y = np.sort(s * rng.standard_normal((draws, chain.size)), axis=1)
x = y + 2 * chain.radius * chain.rank  # rank: i - (L+1)/2

# %% [markdown]
# No force, no collision, no time. Now the simulation, which has all of them, and `equilibrium`,
# which works out the Gibbs measure by integrals along the chain.

# %%
run = simulate(chain, duration=100_000, seed=2, progress=False)
exact = equilibrium(chain)

mean, width = y.mean(axis=0), y.std(axis=0)
mean_error = width / np.sqrt(draws)
# The error of a measured width: from the scatter of (y - mean)^2.
width_error = ((y - mean) ** 2).std(axis=0) / (2 * width * np.sqrt(draws))

sorting = {"mean_displacement": (mean, mean_error), "displacement_width": (width, width_error)}
fig, axes = plt.subplots(1, 2, figsize=(10, 3.4), layout="constrained")
for ax, (name, (value, error)) in zip(axes, sorting.items(), strict=True):
    ax.plot(exact.particle, exact[name] / s, color=ORANGE, linewidth=2.5, label="equilibrium")
    ax.plot(run.particle, run[name] / s, "o", color="k", mfc="none", ms=8, label="simulation")
    ax.plot(run.particle, value / s, "x", color=BLUE, ms=5, label="sorted random numbers")
    ax.set(xlabel="particle i", xticks=(1, 5, 10, 15, 20))
    pulls_run = ((run[name] - exact[name]) / run[f"{name}_error"]).values
    pulls_sorted = (value - exact[name].values) / error
    print(
        f"{name}: from the exact one at most {abs(pulls_run).max():.1f} (simulation) and "
        f"{abs(pulls_sorted).max():.1f} (sorting) standard errors"
    )
    assert abs(pulls_run).max() < 5
    assert abs(pulls_sorted).max() < 5
axes[0].set_ylabel(r"mean displacement $\langle\Delta x\rangle/s$")
axes[1].set_ylabel("displacement width $W_x/s$")
axes[0].legend()
plt.show()

# %% [markdown]
# And the density, where the rods show as a row of peaks (the right half of the chain):

# %%
edges = exact.x.values[::2]
count = np.histogram(x, edges)[0]
# At most one centre of a rod fits into a bin, so a bin is a coin that was tossed `draws` times.
chance = np.diff(exact.label.values[::2])  # label N(x): the mean number of rods to the left of x
likely = chance > 100 / draws
pulls_sorted = (count - draws * chance)[likely] / np.sqrt(draws * (chance * (1 - chance))[likely])
pulls_run = deviation(smooth(run), smooth(exact)).maximum_in_errors
print(f"sorting: at most {abs(pulls_sorted).max():.1f} standard errors in {likely.sum()} bins")
print(f"simulation, smoothed: at most {pulls_run:.1f} standard errors")
assert abs(pulls_sorted).max() < 5
assert pulls_run < 5

fig, ax = plt.subplots(figsize=(9, 3.4), layout="constrained")
heights = count / draws / np.diff(edges)
ax.stairs(heights, edges, color=BLUE, fill=True, alpha=0.4, label="sorted random numbers")
ax.plot(exact.x, exact.density, color=ORANGE, linewidth=2, label="equilibrium")
ax.plot(run.x[::2], run.density[::2], "o", color="k", mfc="none", ms=4, label="simulation")
ax.set(xlim=(0, 24), ylim=(0, 2.5), xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(ncols=3, loc="upper center")
plt.show()

# %% [markdown]
# **Explain.** All three agree, everywhere. The elastic chain without gap *is* a sorted list of
# independent Gaussian numbers.
#
# ## 4. One rod
#
# The distribution of one order statistic is known in closed form. Let $\Phi$ be the distribution
# function of the unit Gaussian and $u = \Phi(y/s)$. The $L$ numbers $u$ are uniform in $(0, 1)$;
# the $i$-th smallest has $i - 1$ below and $L - i$ above, so its density is proportional to
# $u^{i-1}(1-u)^{L-i}$: a Beta distribution with the parameters $i$ and $L + 1 - i$. For the rod,
#
# $$p_i(y) = \frac1s\,\varphi(y/s)\;\mathrm{Beta}_{i,\,L+1-i}\big(\Phi(y/s)\big),
# \qquad \varphi = \Phi' .$$

# %%
fine = np.linspace(-8 * s, 8 * s, 8001)


def one_rod(i, chain, y):
    """Density of the reduced position of rod i of an elastic chain without gap [1/R]."""
    s, L = chain.thermal_length, chain.size
    return norm.pdf(y / s) / s * beta(i, L + 1 - i).pdf(ndtr(y / s))


fig, ax = plt.subplots(figsize=(7, 3.2), layout="constrained")
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
print("mean displacements:", f"{abs(closed_mean - exact.mean_displacement).max() / s:.1e} s apart")
print("densities:", f"{abs(whole - exact.density).max() * 2:.1e} of close packing apart")
assert abs(closed_mean - exact.mean_displacement).max() < 1e-5 * s
assert abs(whole - exact.density).max() * 2 < 1e-3

# %% [markdown]
# The histograms are the sorted numbers. A rod in the centre is held by its neighbours to a small
# part of the room that a free rod takes. The outermost rod is pushed out, and its
# distribution is skewed: it has neighbours on one side only.
#
# ## 5. Where the arctanh of the paper comes from
#
# The paper measures the mean displacement and fits it by $B\,\mathrm{arctanh}(Cx)$. We know what
# is behind it: the expected order statistic. There is a good approximation to it, by Blom,
#
# $$\langle\Delta x_i\rangle \approx s\,\Phi^{-1}(q_i),\qquad q_i = \frac{i-3/8}{L+1/4},$$
#
# the value of $y$ that a fraction $q_i$ of the Gaussian lies below. Now compare with the
# arctanh, which is a logarithm: $\mathrm{arctanh}(z) = \frac12\ln\frac{1+z}{1-z}$, and with
# $z = 2q - 1$ it is $\frac12\ln\frac{q}{1-q}$. That is the inverse distribution function of the
# *logistic* distribution. So the fit says: the rods are sorted **logistic** numbers, and
# in a dense chain, where $x \approx 2R(i - \frac{L+1}2)$, $Cx$ plays the part of $2q-1$.
#
# **Predict.** The two distributions look alike in the middle, but the logistic one has the longer
# tails. Will the arctanh fit equally well at all driving amplitudes $A$? (In units of $s$ the
# exact solution does not depend on $A$ at all.)
#
# **Run.** The fit is made to the exact displacements, so no simulation is needed.

# %%
fig, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
off = {}
for amplitude, colour, style in ((1, BLUE, "--"), (10, GREEN, "-."), (100, PINK, ":")):
    each = Chain(size=100, amplitude=amplitude)
    theory, unit = equilibrium(each), each.thermal_length
    i = theory.particle.values
    fit = fit_arctanh(theory)
    arctanh = fit(theory.mean_position.values) / unit
    exact_mean = theory.mean_displacement.values / unit
    blom = ndtri((i - 3 / 8) / (each.size + 1 / 4))
    off[amplitude] = abs(arctanh - exact_mean).max()
    if amplitude == 1:
        off_blom = abs(blom - exact_mean).max()
        left.plot(i, exact_mean, color="0.7", linewidth=5, label="exact")
        left.plot(i, blom, color=ORANGE, linewidth=1.5, label="Blom")
        left.plot(i, arctanh, style, color=colour, label="arctanh fit, A = 1")
        right.plot(i, blom - exact_mean, color=ORANGE, linewidth=1.5, label="Blom, any A")
    right.plot(i, arctanh - exact_mean, style, color=colour, label=f"arctanh, A = {amplitude}")
    print(
        f"A = {amplitude}: B = {fit.scale / unit:.2f} s, 1/C = {1 / fit.steepness:.0f} R, "
        f"arctanh off by at most {off[amplitude]:.4f} s"
    )
print(f"Blom: off by at most {off_blom:.4f} s")
left.set(xlabel="particle i", ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
right.set(xlabel="particle i", ylabel="difference from exact, in s", ylim=(-0.1, 0.06))
left.legend()
right.legend(ncols=2, loc="lower center", fontsize=9)
plt.show()
assert off_blom < 0.01
assert off[10] < 0.02 < 0.04 < min(off[1], off[100])

# %% [markdown]
# **Explain.** Blom's formula has no free number and is right to a hundredth of $s$, in
# the same way at all $A$. The arctanh, with its two free numbers, is as good at $A = 10$ and four
# to five times worse at 100 and 1, with opposite signs at the ends. At large $A$ the mean
# position $x$ is not proportional to the label any more but contains $\langle\Delta x\rangle$
# itself, which straightens the curve; in between there is an amplitude where this hides the
# difference of the two distributions. So the arctanh is a good drawing of the curve, and no law:
# nothing in the chain makes a logistic distribution.
#
# ## 6. With gaps: a plasma in one dimension
#
# With a gap the anchors $y^0_i = g\,r_i$, $r_i = i - \frac{L+1}{2}$, differ. The points are no
# longer independent. But multiply out the spring energy,
#
# $$\sum_i\frac k2(y_i - g r_i)^2 = \frac k2\sum_i y_i^2 - kg\sum_i r_i y_i + \text{const},
# \qquad \sum_i r_i y_i = \frac12\sum_{i<j}(y_j - y_i),$$
#
# where the last sum is over all pairs: $y_k$ is added $k - 1$ times and taken away $L - k$
# times. The points are in order, so $y_j - y_i = |y_j - y_i|$, and the energy is
#
# $$\frac k2\sum_i y_i^2 - \frac{kg}{2}\sum_{i<j}|y_i - y_j| + \text{const}.$$
#
# Charges that are planes repel each other with a constant force, the energy being
# $-|y_i - y_j|$. So *rods with gaps are like charges in a trap*: the one-dimensional
# one-component plasma, solved exactly by Baxter in 1963. The names of the rods have disappeared
# from the energy. (This is derived here, for linear springs.)

# %%
r, gap = chain.rank, 0.7
state = np.sort(np.random.default_rng(0).normal(size=chain.size))
pairs = abs(state[:, None] - state[None, :]).sum() / 2
springs = ((state - gap * r) ** 2).sum() / 2
plasma = (state**2).sum() / 2 - gap / 2 * pairs + gap**2 * (r**2).sum() / 2
print(f"energy of one state: {springs:.10f} as springs, {plasma:.10f} as a plasma")
assert np.isclose(springs, plasma, rtol=1e-12)

# %% [markdown]
# `equilibrium(chain)` takes any gap: given $y_{i+1}$, the points to its left do not care about
# those to its right, so all integrals over the chain can be done one rod after another.
# `equilibrium_states(chain, replicas, seed)` uses the same integrals backwards to draw *independent*
# states, positions and velocities, from the exact distribution: sorting, generalised.
#
# **Predict.** Without gap every rod but the middle one is pushed outward. What happens to
# $\langle\Delta x\rangle$ in the middle of the chain, and at its ends, when the rods get room?
#
# **Run.** Simulation, theory and exact samples at three gaps.

# %%
fig, ax = plt.subplots(figsize=(8, 3.8), layout="constrained")
gaps = {0.0: BLUE, 0.1: ORANGE, 0.5: GREEN}
for g, colour in gaps.items():
    loose = Chain(size=50, gap=g)
    theory = equilibrium(loose)
    run = simulate(loose, duration=20_000, observe="widths", seed=8, progress=False)
    states = equilibrium_states(loose, 20_000, seed=7)
    d = states.position.values - loose.anchors
    pulls_run = (
        (run.mean_displacement - theory.mean_displacement) / run.mean_displacement_error
    ).values
    pulls = (d.mean(axis=0) - theory.mean_displacement.values) / (d.std(axis=0) / np.sqrt(len(d)))
    print(
        f"g = {g}: from equilibrium at most {abs(pulls_run).max():.1f} (simulation) and "
        f"{abs(pulls).max():.1f} (exact samples) standard errors"
    )
    assert abs(pulls_run).max() < 5
    assert abs(pulls).max() < 5
    ax.plot(theory.particle, theory.mean_displacement / s, color=colour, label=f"g = {g} R")
    ax.plot(run.particle, run.mean_displacement / s, "o", color=colour, ms=6, mfc="none")
    ax.plot(run.particle, d.mean(axis=0) / s, "x", color="k", ms=3.5)
ax.plot([], [], "o", color="0.4", mfc="none", label="simulation")
ax.plot([], [], "x", color="k", ms=3.5, label="exact samples")
ax.set(xlabel="particle i", ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
ax.legend()
plt.show()

# %% [markdown]
# **Explain.** With a gap the inner rods sit at their anchors: a rod is pushed as often from the
# left as from the right. Only a layer at either end is still pushed out. In the language of
# plasmas the trap is a background charge, and the plasma is neutral inside; the layer is its
# surface. Move the slider:


# %%
def displacements(gap):
    """Draw <dx>(i) for a gap, exactly."""
    theory = equilibrium(Chain(size=50, gap=gap))
    _, ax = plt.subplots(figsize=(7, 3), layout="constrained")
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
# Without gap the argument of the first picture holds at every moment, not only in the stationary
# state: *the points, relabelled, are independent oscillators*. So release the chain from a
# compressed state and the cloud of points follows the equations of **one** oscillator. Its three
# second moments obey (from $\dot y = v$ and the equation of motion)
#
# $$\frac{d}{dt}\begin{pmatrix}\langle y^2\rangle\\ \langle yv\rangle\\ \langle v^2\rangle
# \end{pmatrix} = \begin{pmatrix}0 & 2 & 0\\ -k/m & -\gamma/m & 1\\ 0 & -2k/m & -2\gamma/m
# \end{pmatrix}\begin{pmatrix}\langle y^2\rangle\\ \langle yv\rangle\\ \langle v^2\rangle
# \end{pmatrix} + \begin{pmatrix}0\\ 0\\ A^2/m^2\end{pmatrix}.$$
#
# They are linear: a matrix exponential solves them.


# %%
def moments(chain, times, start):
    """<y^2>, <yv>, <v^2> of one damped, shaken oscillator at the given times."""
    pull, damping = chain.stiffness / chain.mass, chain.damping / chain.mass
    matrix = np.array([[0, 2, 0], [-pull, -damping, 1], [0, -2 * pull, -2 * damping]])
    steady = np.array([chain.thermal_length**2, 0, chain.free_velocity_width**2])
    return np.array([steady + expm(t * matrix) @ (start - steady) for t in times])


# %% [markdown]
# **Predict.** We take the stationary state, squeeze all room between the rods to 0.3 of what it
# was, leave the velocities as they are, and let go. Will the cloud overshoot its final width? Will
# it get colder on the way?
#
# **Run.** An ensemble of 1000 chains of 50 rods, each from its own exact equilibrium state, and
# averages over the ensemble at equal times.

# %%
fifty, replicas, squeeze = Chain(size=50), 1000, 0.3
states = equilibrium_states(fifty, replicas, seed=11)
squeezed = fifty.physical(squeeze * fifty.reduced(states.position.values))
start = given_start(fifty, squeezed, states.velocity.values, replicas=replicas)
ensemble = simulate(
    fifty,
    start=start,
    replicas=replicas,
    average="ensemble",
    duration=30,
    every=0.5,
    observe="widths",
    seed=12,
    progress=False,
)
times = ensemble.time.values
measured = ensemble.mean_displacement**2 + ensemble.displacement_width**2  # <y_i^2>
sigma = np.sqrt(measured.mean("particle")).values
heat = (ensemble.velocity_width**2).mean("particle").values

moments_exact = moments(fifty, times, np.array([(squeeze * s) ** 2, 0, W**2]))
exact_sigma, exact_heat = np.sqrt(moments_exact[:, 0]), moments_exact[:, 2]
cloud = breathing_cloud(fifty, 30, every=0.5, stretch=squeeze)
assert abs(cloud.cloud_width.values - exact_sigma).max() < 1e-6 * s

# 50 000 independent Gaussian points: the relative error of a width is 1/sqrt(2 n).
points = replicas * fifty.size
pulls_sigma = (sigma / exact_sigma - 1) * np.sqrt(2 * points)
pulls_heat = (heat / exact_heat - 1) * np.sqrt(points / 2)
print(f"cloud width: at most {abs(pulls_sigma).max():.1f} standard errors at {times.size} times")
print(f"<v^2>: at most {abs(pulls_heat).max():.1f} standard errors")
assert abs(pulls_sigma).max() < 5
assert abs(pulls_heat).max() < 5

# %% [markdown]
# `breathing_cloud` solves the same motion in the variables of a fluid: the width $\sigma$ of the
# cloud and its temperature. It also gives the mean position of every rod: the cloud stays
# Gaussian, so rod $i$ is at $\sigma(t)$ times the $i$-th expected order statistic. With
# `evolving=False` the temperature is held constant: that is the isothermal fluid, the paper's
# two equations with a constant $W^2$. (The paper itself uses them at rest only.)

# %%
isothermal = breathing_cloud(fifty, 30, every=0.5, stretch=squeeze, evolving=False)
fig, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.5), layout="constrained")
left.plot(times, exact_sigma / s, color=ORANGE, linewidth=2.2, label="exact")
left.plot(times, isothermal.cloud_width / s, "--", color=BLUE, label="isothermal fluid")
left.plot(times[::2], sigma[::2] / s, "o", color="k", mfc="none", ms=4, label="1000 chains")
left.set(xlabel="time t [T]", ylabel=r"width of the cloud $\sigma/s$")
left.legend()
middle.plot(times, exact_heat / W**2, color=ORANGE, linewidth=2.2)
middle.axhline(1, linestyle="--", color=BLUE)
middle.plot(times[::2], heat[::2] / W**2, "o", color="k", mfc="none", ms=4)
middle.set(xlabel="time t [T]", ylabel=r"$\langle v^2\rangle/W^2$")
for i, colour in ((50, GREEN), (45, PINK), (35, BLUE)):
    at = ensemble.sel(particle=i).mean_displacement
    right.plot(times, cloud.mean_displacement.sel(particle=i) / s, color=colour, label=f"rod {i}")
    right.plot(times[::2], at[::2] / s, "o", color=colour, mfc="none", ms=4)
right.set(xlabel="time t [T]", ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
right.legend(loc="center right", bbox_to_anchor=(1, 0.7))
plt.show()

error = ensemble.displacement_width / np.sqrt(replicas)
pulls = ((ensemble.mean_displacement - cloud.mean_displacement) / error).values
widest = cloud.cloud_width.values.max() / s
widest_isothermal = isothermal.cloud_width.values.max() / s
print(f"rods: at most {abs(pulls).max():.1f} standard errors, {pulls.size} rods and times")
print(f"largest width {widest:.3f} s (isothermal {widest_isothermal:.3f} s)")
print(f"smallest <v^2> {exact_heat.min() / W**2:.3f} W^2")
assert abs(pulls).max() < 5
assert widest < 1.001
assert widest_isothermal > 1.5
assert abs(exact_heat.min() / W**2 - 0.54) < 0.01

# %% [markdown]
# **Explain.** The exact cloud comes back to its width without overshooting to speak of; the
# isothermal fluid swings to one and a half times the width. In the stationary state the springs
# hold a cloud of width $s$ against the velocities. In the squeezed cloud they are too
# weak, so it expands, and as it expands the springs take energy out of the velocities: it cools to
# about half of $W^2$. The noise makes up for that only at the rate $2\gamma/m$, not at once as the
# isothermal fluid assumes. At no time is any rod further from the exact solution than chance
# allows.
#
# With a gap, or for $e \ne 1$, the points know their names again, and this solution in time ends.
# There the package has theories that are good, but not exact: `hydrodynamics` and `phase_space`.
#
# ## Exercises
#
# **1.** Two rods with a gap. Their distance $z = y_2 - y_1$ is a Gaussian number with mean $g$ and
# variance $2s^2$, cut off at 0. Derive $\langle\Delta x_2\rangle$, and compare with
# `equilibrium(Chain(size=2, gap=0.5))`.
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
# print(float(equilibrium(Chain(size=2, gap=0.5)).mean_displacement[1]))
# ```
#
# Both give 0.254580 R.
# </details>
#
# **2.** How does the width $W_x$ of a rod in the centre depend on $L$, without gap? Use
# `equilibrium` for $L$ = 11, 101 and 1001 and compare with
# $W_x \approx \sqrt{\pi/2}\;s/\sqrt L$, the known result for the median of many Gaussian draws.
#
# <details><summary>Solution</summary>
#
# ```python
# for L in (11, 101, 1001):
#     width = float(equilibrium(Chain(size=L)).displacement_width[L // 2])
#     print(L, width / (np.sqrt(np.pi / 2) * s / np.sqrt(L)))
# ```
#
# The ratios are 0.980, 0.998 and 0.9998: the width falls like $L^{-1/2}$. A rod in the centre of a
# long chain is held by its neighbours alone.
# </details>
#
# **3.** Quadratic springs, $F = k\,d\,|d|$, no gap. Which random numbers must be sorted now? Try
# it for 20 rods and compare the outermost rod with `equilibrium`.
#
# <details><summary>Solution</summary>
#
# Independent draws from $w(y) \propto \exp(-k|y|^3/3T)$, as $U = k|d|^3/3$. scipy knows this as
# the generalised normal distribution:
#
# ```python
# from scipy.stats import gennorm
#
# soft = Chain(size=20, spring="quadratic")
# scale = (3 * soft.temperature / soft.stiffness) ** (1 / 3)
# draws = gennorm(3, scale=scale).rvs((50_000, 20), random_state=1)
# last = np.sort(draws, axis=1)[:, -1]
# print(last.mean(), "+-", last.std() / np.sqrt(50_000))
# print(float(equilibrium(soft).mean_displacement[-1]))
# ```
#
# The sorted numbers give 1.2403 $\pm$ 0.0012 R, `equilibrium` 1.2397 R.
# </details>
#
# **4.** Does sorting still work for $e = 0.9$? Compare the outermost rod of a simulation with the
# order statistic.
#
# <details><summary>Solution</summary>
#
# ```python
# lossy = simulate(Chain(size=20, restitution=0.9), duration=20_000, seed=1, progress=False)
# print(float(lossy.mean_displacement[-1] / s), float(exact.mean_displacement[-1] / s))
# ```
#
# It does not: the simulation gives $1.285 \pm 0.005\;s$, the order statistic $1.867\;s$. Inelastic
# rods do not just swap their velocities. They cool each other, and a colder chain is shorter.
# </details>
