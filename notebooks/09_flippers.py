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
# # Flippers
#
# **Question.** The flippers of a pinball machine throw the ball back faster than it came. A hundred
# rods on springs do that to one another: every collision multiplies their relative velocity by
# $e = 1.01$. Damping works against it. The energy grows without end, but *how*: exponentially, or
# to infinity in a finite time? And what decides?
#
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) saw both. This notebook
# repeats their simulations, derives the two laws from one balance of energy, and then finds that
# the second one hides a third actor.
#
# Units: the rod radius $R$ for lengths, $M$ for masses (a rod has $m = 4\pi/3\,M$), $T =
# \sqrt{M/k}$ for times. Between collisions rod $i$ obeys $m\ddot x = -\gamma\dot x - F(x - x_i^0) +
# A\,\xi(t)$ with white noise $\xi$; $F(d) = k d$ for linear springs, $k d|d|$ for quadratic ones.
#
# Everything below runs in well under a minute (the first run compiles for some seconds more).

# %%
import matplotlib.pyplot as plt
import numpy as np
from IPython.display import HTML
from matplotlib.animation import FuncAnimation
from scipy.integrate import quad
from scipy.optimize import linear_sum_assignment

from crazybilliards.comparison import fit_growth, fit_singularity, standalone_page, tail_length
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

BLUE, ORANGE, GREEN, PINK = "#0072B2", "#E69F00", "#009E73", "#CC79A7"

# %% [markdown]
# ## 1. Two springs, two fates
#
# Both chains have the same rods, the same restitution, the same damping and the same noise. All
# rods start at rest, at their anchors. Only the springs differ.

# %%
linear = Chain(size=100, restitution=1.01, damping=0.4)
quadratic = linear.replace(spring="quadratic")


def release(chain, seed, **settings):
    """Let a chain go from rest and watch its kinetic energy from the beginning."""
    return simulate(chain, warmup=0, observe=["energy"], seed=seed, progress=False, **settings)


seeds = range(12)
slow = [release(linear, seed, duration=150, time_step=0.02, every=0.2) for seed in seeds]
fast = [release(quadratic, seed, duration=100, time_step=0.002, every=0.1) for seed in seeds]

fig, ax = plt.subplots(figsize=(7, 3.8), layout="constrained")
for runs, colour, name in ((slow, BLUE, "linear springs"), (fast, ORANGE, "quadratic springs")):
    for run in runs:
        ax.semilogy(run.time, run.kinetic_energy, color=colour, linewidth=0.8, alpha=0.7)
    ax.plot([], [], color=colour, label=name)
ax.set(xlabel="time t [T]", ylabel=r"kinetic energy [M R$^2$/T$^2$]", ylim=(1, 1e12))
_ = ax.legend(frameon=False)

# %% [markdown]
# Every line is a run with noise of its own. Linear springs give a straight line on this scale: an
# exponential. With quadratic springs all runs shoot up at about the same time, near 40 T, and there
# is nothing after that. The chain did not stop, and the program did not fail:

# %%
end = np.array([run.attrs["end_time"] for run in fast])
print("status of the quadratic runs:", {run.attrs["status"] for run in fast})
print(f"they end at t = {end.mean():.1f} T, give or take {end.std(ddof=1):.1f} T")
assert all(run.attrs["status"] == "diverged" for run in fast)
assert all(run.attrs["status"] == "completed" for run in slow)
assert all(np.isfinite(run.kinetic_energy).all() for run in fast)
assert 35 < end.mean() < 45

# %% [markdown]
# **A divergence is a result.** `simulate` stops when a rod is a million times faster than a
# typical one. It gives back everything measured before, with the status `diverged` and the time
# `end_time`; there is never a NaN in it. (A long run on linear springs ends in the same way. It
# only takes much longer: an exponential reaches any speed.)

# %% [markdown]
# ## 2. Linear springs: one balance of energy
#
# Take the rods' own length out, $y_i = x_i - 2R(i - \frac{L+1}{2})$. The rods become points with
# one common anchor at $y = 0$. Exchange the labels of two points when they collide: then they pass
# *through* one another, and the collision only multiplies their relative velocity by $e$.
#
# **One pair.** The distance $r = y_i - y_j$ is an oscillator, $m\ddot r = -\gamma\dot r - kr$. Two
# points meet when $r = 0$, once in half a period $\pi\sqrt{m/k}$ (weak damping), whatever the
# amplitude. All the energy of their relative motion, $E_{ij} = \frac m4\dot r^2 + \frac k4 r^2$, is
# then kinetic, and the encounter adds $(e^2-1)E_{ij}$.
#
# **All pairs.** With the centre of mass at rest, $\sum_{i<j} E_{ij} = \frac L2 E$. So half a period
# brings $(e^2-1)\frac L2 E \approx (e-1)LE$. Damping takes $2\gamma/m$ times the kinetic energy per
# time, which is half of $E$: $\gamma/m$ per time, $\pi\gamma/\sqrt{km}$ in half a period. Together
#
# $$\dot E = \frac\gamma m\left(\frac L{L_c} - 1\right)E,\qquad
# L_c = \frac{\pi\gamma}{(e-1)\sqrt{km}} .$$
#
# Above the critical size $L_c$ the energy grows exponentially. The paper has this balance in words and
# proportionalities, $\dot E\sim C_fE-\gamma E$ with an unknown collision frequency $C_f$. The rate and
# $L_c$ are derived here.
#
# **Predict.** What are $L_c$ and the rate here? How much changes if you keep $(e^2-1)/2 = 0.01005$
# instead of $e - 1 = 0.01$?

# %%
L, e, m, k, gamma = 100, linear.restitution, linear.mass, linear.stiffness, linear.damping
critical = np.pi * gamma / ((e - 1) * np.sqrt(k * m))
first_order = gamma / m * (L / critical - 1)
unexpanded = (e**2 - 1) / 2 * L / (np.pi * np.sqrt(m / k)) - gamma / m
print(f"L_c = {critical:.1f} rods")
print(f"rate: {first_order:.4f} per T; with e^2 - 1 not expanded {unexpanded:.4f} per T")

# %% [markdown]
# **Run.** Fit an exponential where the energy is above $10^3$: there the noise no longer matters.


# %%
def beyond(time, energy, threshold):
    """Return the times and energies from the first energy above a threshold."""
    first = int(np.argmax(energy > threshold))
    return time[first:], energy[first:]


def mean_and_error(values):
    """Return the mean of independent values and its standard error."""
    return np.mean(values), np.std(values, ddof=1) / np.sqrt(len(values))


fits = [fit_growth(*beyond(run.time.values, run.kinetic_energy.values, 1e3)) for run in slow]
rate, rate_error = mean_and_error([fit.rate for fit in fits])
print(f"measured rate: {rate:.4f} +- {rate_error:.4f} per T")
assert abs(rate - unexpanded) < 5 * rate_error
assert abs(rate / first_order - 1) < 0.02

# %% [markdown]
# **Explain.** The balance without expansion gives the rate within its error; the first order is 1 %
# off, as it should be when $e - 1$ is 1 %. Nothing was fitted. The error bar is the scatter between
# twelve independent runs. One fit alone claims to be more certain than that, because the energy of
# a single run wanders slowly about its mean growth:

# %%
print(f"error that one fit gives: {fits[0].rate_error:.5f}")
print(f"scatter of the fits:      {np.std([fit.rate for fit in fits], ddof=1):.5f}")

# %% [markdown]
# ## 3. The cloud in phase space
#
# A point on a linear spring runs round the origin of the $(y, v)$ plane, once in $2\pi\sqrt{m/k} =
# 12.9$ T. All points turn at the same speed; that is why the cloud keeps its shape and every pair
# meets once in half a turn.
#
# The simulation knows rods, not points. To colour the points we carry them on from picture to
# picture: turn the cloud by the known angle and look which point is where.

# %%
every, frames = 0.6, 60
film = simulate(
    linear,
    warmup=60,
    duration=64 * every,
    time_step=0.02,
    every=every,
    observe=["snapshots"],
    seed=0,
    progress=False,
)
frequency = np.sqrt(k / m)
y = linear.reduced(film.position.values[0])[:frames]
cloud = y + 1j * film.velocity.values[0][:frames] / frequency  # a turn is now a phase

points = [cloud[0]]
for later in cloud[1:]:
    expected = points[-1] * np.exp(-1j * frequency * every)
    points.append(later[linear_sum_assignment(abs(expected[:, None] - later))[1]])
points = np.array(points)
# A turn back by the angle travelled should leave every point where it was, growth apart.
turned = points * np.exp(1j * frequency * every * np.arange(frames))[:, None]
kept = abs(np.angle(turned[20] / turned[0]))
print(f"after 12 T the median point is {np.median(kept):.2f} rad off a rigid turn")
growth = np.sqrt((abs(points[-1]) ** 2).mean() / (abs(points[0]) ** 2).mean())
expected_growth = np.exp(unexpanded / 2 * every * (frames - 1))
print(f"the cloud grew {growth:.2f} times; exp(rate t/2) = {expected_growth:.2f}")
assert np.median(kept) < 0.5
assert abs(growth / expected_growth - 1) < 0.15

# %%
picture, ax = plt.subplots(figsize=(4.6, 4.6), dpi=60, layout="constrained")
reach = 1.05 * abs(points).max()
dots = ax.scatter(
    points[0].real,
    points[0].imag * frequency,
    c=np.angle(points[0]),
    cmap="twilight",
    s=18,
    edgecolors="0.3",
    linewidths=0.4,
)
ax.set(xlim=(-reach, reach), ylim=(-reach * frequency, reach * frequency))
ax.set(xlabel="y [R]", ylabel="v [R/T]")
title = ax.set_title("")


def draw(number):
    """Move the points of the picture to those of one snapshot."""
    dots.set_offsets(np.column_stack([points[number].real, points[number].imag * frequency]))
    title.set_text(f"t = {film.time.values[number]:.1f} T")
    return dots, title


animation = FuncAnimation(picture, draw, frames=frames, interval=100)
film_of_the_cloud = standalone_page(animation)
plt.close(picture)
HTML(film_of_the_cloud)

# %% [markdown]
# **Explain.** The wheel turns nearly three times and grows about threefold: its amplitude grows at
# half the rate of the energy. Colours blur slowly, because each encounter kicks, but no point
# overtakes the others for good: fast and slow points turn equally fast, meet equally often, and
# gain the same *fraction*.

# %% [markdown]
# ## 4. Quadratic springs: why a finite time
#
# **Predict.** On a quadratic spring, does a rod with a large amplitude swing faster or slower than
# one with a small amplitude? What does that do to the number of encounters per time?
#
# The energy of a rod with amplitude $a$ is $E_1 = ka^3/3$, so its velocity is $\sim E_1^{1/2}$, its
# amplitude $\sim E_1^{1/3}$ and its frequency $\sim E_1^{1/6}$. Each half period brings a fixed
# fraction of the energy. Hence
#
# $$\dot E = \alpha E^{7/6} - \beta E,\qquad \beta = \frac{6\gamma}{5m} .$$
#
# ($\beta$: damping takes $2\gamma/m$ times the kinetic energy, and in a cubic potential the virial
# theorem, $2\langle E_\mathrm{kin}\rangle = 3\langle E_\mathrm{pot}\rangle$, makes that 3/5 of
# $E$.) Without damping $u = E^{-1/6}$ falls on a straight line, $\dot u = -\alpha/6$, and hits
# zero at some $t_c$: $E \propto (t_c - t)^{-6}$. With damping $\dot u = -\alpha/6 + \beta u/6$, so
#
# $$E = \left[\frac{\beta/\alpha}{1 - \mathrm{e}^{-\beta(t_c - t)/6}}\right]^6 .$$

# %%
beta = 6 * gamma / (5 * m)
left = np.geomspace(0.1, 100, 200)
alpha_guess = 0.1
energy = (beta / alpha_guess / (1 - np.exp(-beta * left / 6))) ** 6
slope = -np.gradient(np.log(energy), np.log(left))
closed = beta * left / (np.exp(beta * left / 6) - 1)  # the same, differentiated by hand
assert np.abs(slope / closed - 1)[1:-1].max() < 0.01
for time_left in (1, 10, 20, 40):
    effective = np.interp(time_left, left, closed)
    print(f"{time_left:3d} T before the end the exponent is {effective:.2f}")

# %% [markdown]
# So the exponent seen in a measurement should be a little below 6, and the closer to the end the
# closer to 6.
#
# **Run.** `fit_singularity` fits $C\,(t_c - t)^{-p}$ with all three numbers free. We fit to
# everything above a threshold, for several thresholds. The raw snapshots let us compute the whole
# energy, springs included, and the share of every rod.


# %%
class Run:
    """Energies of the rods of one chain, from release to the end."""

    def __init__(self, chain, seed, **settings):
        run = simulate(
            chain, warmup=0, observe=["snapshots"], seed=seed, progress=False, **settings
        )
        y, v = chain.reduced(run.position.values[0]), run.velocity.values[0]
        rods = chain.mass / 2 * v**2 + chain.potential(y)
        self.time = run.time.values
        self.kinetic = (chain.mass / 2 * v**2).sum(axis=1)
        self.energy = rods.sum(axis=1)
        self.share = rods.max(axis=1) / self.energy
        self.number = self.energy**2 / (rods**2).sum(axis=1)  # rods that share the energy


runaways = [Run(quadratic, seed, duration=100, time_step=0.002, every=0.02) for seed in range(12)]

# %%
thresholds = (1e3, 1e4, 1e5, 1e6)
print("threshold   exponent, plain fit   exponent, damping taken out")
plain, undamped = {}, {}
for threshold in thresholds:
    both = []
    for run in runaways:
        t, E = beyond(run.time, run.kinetic, threshold)
        # E exp(beta t) against the time below obeys the equation without damping.
        free_time = 6 / beta * (1 - np.exp(-beta * (t - t[0]) / 6))
        free_energy = E * np.exp(beta * (t - t[0]))
        both.append(
            (fit_singularity(t, E).exponent, fit_singularity(free_time, free_energy).exponent)
        )
    plain[threshold], undamped[threshold] = (
        mean_and_error(each) for each in zip(*both, strict=True)
    )
    found = (*plain[threshold], *undamped[threshold])
    print("  {:.0e}      {:.2f} +- {:.2f}          {:.2f} +- {:.2f}".format(threshold, *found))

# %% [markdown]
# **Explain, first attempt.** The plain exponents lie between 4 and 5: well below 6. Damping can be
# taken out exactly. Put $G = E\,\mathrm{e}^{\beta t}$ and $\theta = \frac6\beta(1 -
# \mathrm{e}^{-\beta t/6})$; then $\mathrm{d}G/\mathrm{d}\theta = \alpha G^{7/6}$, a pure power law.
# The last column is a fit to that. It should be 6. It is higher than the plain exponent, but not 6:
# damping is part of the story, and not all of it.

# %%
for threshold in thresholds:
    exponent, error = undamped[threshold]
    assert plain[threshold][0] < 5.4
    assert exponent + 5 * error < 6
assert undamped[1e3][0] > plain[1e3][0]

# %% [markdown]
# ## 5. The winner takes all
#
# **Predict.** On linear springs all rods swing equally fast. On quadratic ones a rod that has a
# little more energy swings a little faster. What becomes of its lead?
#
# **Run.** The number of rods that share the energy is $P = (\sum E_i)^2/\sum E_i^2$: $L$ if all
# have the same, 1 if one has everything.

# %%
steady = [Run(linear, seed, duration=300, time_step=0.02, every=0.2) for seed in range(6)]
fig, ax = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
for runs, colour, name in (
    (steady, BLUE, "linear springs"),
    (runaways, ORANGE, "quadratic springs"),
):
    for run in runs:
        ax.loglog(run.energy, run.number, color=colour, linewidth=0.7, alpha=0.5)
    ax.plot([], [], color=colour, label=name)
ax.set(xlabel=r"energy of the chain [M R$^2$/T$^2$]", ylabel="rods that share it, P")
ax.set(xlim=(1e2, 1e12), ylim=(0.8, 120))
ax.set_yticks([1, 3, 10, 30, 100], ["1", "3", "10", "30", "100"])
ax.legend(frameon=False)


def shared_by(runs, energy):
    """Return the numbers P at the moments when the runs first exceed an energy."""
    return [run.number[np.argmax(run.energy > energy)] for run in runs]


for energy in (1e3, 1e5, 1e7, 1e9):
    print(
        f"E = {energy:.0e}: linear {np.mean(shared_by(steady, energy)):.0f} rods,"
        f" quadratic {np.mean(shared_by(runaways, energy)):.1f}"
    )
assert min(shared_by(steady, 1e9)) > 20
assert max(shared_by(runaways, 1e9)) < 4
print(f"share of the richest rod at the end: {np.mean([run.share[-1] for run in runaways]):.2f}")
assert np.mean([run.share[-1] for run in runaways]) > 0.9

# %% [markdown]
# **Explain.** On quadratic springs the rich get richer, and in the end one point has everything.
# This changes the law of growth, for the frequency is that of a *rod*: if $P$ rods share $E$, each
# swings like $(E/P)^{1/6}$, and
#
# $$\alpha = \alpha_1 P^{-1/6} .$$
#
# As $P$ falls from some 40 to 1, $\alpha$ grows almost twofold. The growth is steeper than
# $E^{7/6}$, and a steeper law has a smaller exponent: $\dot E\propto E^{1+1/p}$ gives
# $(t_c-t)^{-p}$.
#
# **The last rod** can be computed without any fit. It passes through the $L - 1$ others, which are
# nearly at rest, and each time $v \to v + \frac{e-1}2 v$. Half a period multiplies its energy by
# $[(1+e)/2]^{2(L-1)}$. Half a period of a point with energy $E$ takes
#
# $$\tau(E) = 2\int_0^a\frac{\mathrm{d}y}{\sqrt{2(E - ky^3/3)/m}}
# = c\,E^{-1/6},\quad\text{so}\quad \alpha_1 = \frac{2(L-1)}{c}\ln\frac{1+e}2 .$$

# %%
integral = quad(lambda x: (1 - x**3) ** -0.5, 0, 1)[0]
c = 2 * integral * (3 / k) ** (1 / 3) * np.sqrt(m / 2)
factor = ((1 + e) / 2) ** (2 * (L - 1))
alpha_1 = np.log(factor) / c
print(f"half a period multiplies the energy by {factor:.2f}; alpha_1 = {alpha_1:.4f}")


def last_rod(energy, halves):
    """Follow one rod from turning point to turning point: energy, and time since the first."""
    energies, times = [energy], [0.0]
    for _ in range(halves):
        half = c * energies[-1] ** (-1 / 6)
        after = factor * energies[-1]
        # Half of the way in before the others are met, half of it out with the new energy.
        times.append(times[-1] + half / 2 + c * after ** (-1 / 6) / 2)
        energies.append(after * np.exp(-beta * (times[-1] - times[-2])))
    return np.array(energies), np.array(times)


energies, times = last_rod(1e6, 200)
print(f"200 half periods take {times[-1]:.2f} T; 100 of them {times[100]:.2f} T")
assert times[-1] - times[100] < 1e-6  # the sum converges: infinitely many in a finite time

# %% [markdown]
# The energies form a geometric sequence, the times a converging one: like the clicks of a ball that
# bounces to rest, run backwards. Compare with the simulation, in the last moments of a run.

# %%
fig, (left_ax, right_ax) = plt.subplots(1, 2, figsize=(9.5, 3.8), layout="constrained")
ratios = []
for run in runaways:
    t, E = beyond(run.time, run.energy, 1e3)
    u = E ** (-1 / 6)
    late = u < 1e9 ** (-1 / 6)
    line = np.polyfit(t[late], u[late], 1)
    left_ax.plot(t + line[1] / line[0], u, color=ORANGE, linewidth=0.7, alpha=0.6)
    # Turning points of the richest rod: hardly any kinetic energy, between two encounters.
    still = run.kinetic / run.energy
    turns = np.flatnonzero((still[1:-1] < still[:-2]) & (still[1:-1] <= still[2:])) + 1
    turns = turns[(run.energy[turns] > 1e8) & (run.energy[turns] < 1e11)]
    turns = turns[run.share[turns] > 0.9]
    ratios.extend(np.diff(np.log(run.energy[turns])) + beta * np.diff(run.time[turns]))
left_ax.plot([], [], color=ORANGE, label="simulation, twelve runs")
ahead = np.linspace(0, 20, 200)
for number, style, name in ((1, "-", "one rod has it all"), (40, "--", "40 rods share it")):
    alpha = alpha_1 * number ** (-1 / 6)
    u = alpha / beta * (1 - np.exp(-beta * ahead / 6))
    left_ax.plot(-ahead, u, "k", linestyle=style, linewidth=1.2, label=name)
left_ax.set(xlabel="time before the end $t - t_c$ [T]", ylabel="$E^{-1/6}$, in units of M, R, T")
left_ax.set(xlim=(-17, 0.5), ylim=(0, 0.34))
left_ax.legend(frameon=False)

run = runaways[0]
begin = int(np.argmax((run.share > 0.9) & (run.energy > 1e8)))
right_ax.semilogy(run.time[begin:], run.energy[begin:], color=ORANGE, label="simulation, one run")
still = run.kinetic / run.energy
first = begin + int(np.argmin(still[begin : begin + 15]))
energies, times = last_rod(run.energy[first], 12)
right_ax.plot(
    run.time[first] + times,
    energies,
    "ko",
    markersize=5,
    markerfacecolor="none",
    label="one rod, from turn to turn",
)
right_ax.set(xlabel="time t [T]", ylabel=r"energy [M R$^2$/T$^2$]")
right_ax.set(ylim=(run.energy[begin] / 3, 1e12), xlim=(run.time[begin] - 0.1, run.time[-1] + 0.2))
right_ax.legend(frameon=False)
growth, growth_error = mean_and_error(ratios)
print(
    f"ln of the factor per half period: {growth:.3f} +- {growth_error:.3f},"
    f" one rod {np.log(factor):.3f}"
)

# %% [markdown]
# **Explain.** A straight line in this picture is the law $(t_c - t)^{-6}$. The runs are bent: far
# from the end they fall as if some tens of rods shared the energy, at the end as one rod. So the
# exponent 6 is right, but only for the last moments; over any range that a fit can use it comes out
# smaller. Exponents from fits over a few decades tell where one looked.
#
# On the right the energy climbs a staircase: a step when the one rod crosses the others, a plateau
# on the way out and back. The circles know nothing of the simulation but their first point. The
# factor per half period is 1 to 2 % below that of one rod, for the rest of the energy (less than a
# tenth) belongs to slower rods.

# %%
assert abs(growth / np.log(factor) - 1) < 0.03

# %% [markdown]
# ## 6. Flippers with a steady state
#
# With more damping the chain finds a balance: at $e = 1.05$ and $\gamma = 4$ the critical size is
# 123 rods, and 100 rods stay below it. But a point that happens to be fast passes all the others
# and is driven by each of them. What does that do to the distribution of velocities?
#
# **Predict.** Which rod carries the fast points: one in the centre or one at the border?

# %%
settings = {
    "observe": ["widths", "velocities", "avalanches"],
    "particles": [*range(1, 11), 100],
    "progress": False,
}
weak, strong = (
    [
        simulate(Chain(size=100, restitution=1.05, damping=g), duration=2500, seed=s, **settings)
        for s in range(4)
    ]
    for g in (4.0, 10.0)
)


def border_density(runs):
    """Return v and p(v) of the left border, averaged with the mirror image of the right one."""
    p = np.mean([run.velocity_density.sel(particle=[1, 100]).values for run in runs], axis=0)
    return runs[0].velocity.values, (p[0] + p[1][::-1]) / 2


def border_width(runs):
    """Return the velocity width of the two outermost rods."""
    return np.sqrt(np.mean([run.velocity_width.sel(particle=[1, 100]).values ** 2 for run in runs]))


def kurtosis(v, p):
    """Return the excess kurtosis of a distribution: 0 for a Gaussian, 3 for exp(-|v|)."""
    weight = p * np.gradient(v)
    weight /= weight.sum()
    centred = v - weight @ v
    return weight @ centred**4 / (weight @ centred**2) ** 2 - 3


fig, axes = plt.subplots(1, 2, figsize=(9, 3.6), sharey=True, layout="constrained")
for ax, runs, g in zip(axes, (weak, strong), (4, 10), strict=True):
    v, p = border_density(runs)
    w = border_width(runs)
    ax.semilogy(v / w, p * w, ".", color=BLUE, markersize=4, label="outermost rod, simulation")
    x = np.linspace(-12, 12, 400)
    gauss = np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi)
    ax.plot(x, gauss, color=ORANGE, label="Gaussian of the same width")
    ax.set(xlim=(-12, 12), ylim=(1e-6, 2), title=rf"$\gamma$ = {g}")
    ax.set(xlabel=r"velocity over its width, $v/W_v$")
axes[0].set_ylabel(r"probability density $W_v\,p(v)$")
# The left rod is thrown to the left: its outward tail is v < 0.
v, p = border_density(weak)
w = border_width(weak)
out = v < 0
length = tail_length(v[out], p[out], 3 * w)
share = (p * np.gradient(v))[v < -3 * w].sum()
x = np.linspace(-11, -3, 50)
tail = share * w / length * np.exp((x + 3) * w / length)
axes[0].plot(x, tail, color=GREEN, linestyle="--", linewidth=2, label="exponential tail")
handles, labels = axes[0].get_legend_handles_labels()
_ = fig.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
# %%
tails = []
for run in weak:
    v, p = border_density([run])
    v, p, w = v[v < 0], p[v < 0], border_width([run])
    tails.append(tail_length(v, p, 5 * w) / tail_length(v, p, 3 * w))
ratio, ratio_error = mean_and_error(tails)
print(f"length of the tail beyond 5 widths over that beyond 3: {ratio:.2f} +- {ratio_error:.2f}")
print("(an exponential has 1, a Gaussian 0.65)")
assert ratio > 0.75

excess = {}
for runs, g in ((weak, 4), (strong, 10)):
    excess[g] = mean_and_error([kurtosis(*border_density([run])) for run in runs])
    print("gamma = {}: excess kurtosis of the border {:.2f} +- {:.2f}".format(g, *excess[g]))
assert excess[4][0] - 5 * excess[4][1] > 2
assert excess[10][0] + 5 * excess[10][1] < 2

# %% [markdown]
# **Explain.** The left border is thrown to the left: its tail is on that side only. It is close to
# an exponential, a straight line on this scale, and has nothing of a Gaussian. A point that crosses the whole chain is pushed by each of the other
# 99, and would leave it $1.025^{99} = 11.5$ times as fast as it came if they were at rest and
# nothing damped it; the rod at the border is where it comes out. At $\gamma = 10$ the damping
# stops most points on the way. The distribution is a Gaussian nearly everywhere; a faint tail of
# the same kind is left.
#
# **Avalanches.** The same push can be followed from rod to rod: a wave starts when a rod hits its
# right neighbour with their total momentum to the right, and grows by one for each neighbour hit
# on. Count the waves that begin at the ten leftmost rods.

# %%
fig, ax = plt.subplots(figsize=(5.6, 3.6), layout="constrained")
spanning = {}
for runs, g, colour, symbol in ((weak, 4, BLUE, "o"), (strong, 10, ORANGE, "s")):
    counts = [run.avalanche_count.sel(particle=slice(1, 10)).sum("particle").values for run in runs]
    spanning[g] = mean_and_error([1e4 * each[79:].sum() / each.sum() for each in counts])
    total = np.sum(counts, axis=0)
    sizes = np.arange(1, total.size + 1)[total > 0]
    share = total[total > 0] / total.sum()
    ax.loglog(
        sizes,
        share,
        symbol,
        color=colour,
        markersize=4,
        markerfacecolor="none",
        label=rf"$\gamma$ = {g}",
    )
    print("gamma = {}: of 10^4 waves {:.2f} +- {:.2f} reach 80 rods".format(g, *spanning[g]))
ax.set(xlabel="collisions of a wave, $N_c$", ylabel="share of the waves")
ax.legend(frameon=False)
difference = spanning[4][0] - spanning[10][0]
assert difference > 5 * np.hypot(spanning[4][1], spanning[10][1])

# %% [markdown]
# At weak damping some waves span the chain: they are the fast points of section 5, seen rod by rod.
#
# ## Exercises
#
# **1.** Is the finite time real, or does the time step make it? Repeat the quadratic runs of
# section 1 with steps from 0.02 T to 0.0005 T.
#
# <details><summary>Solution</summary>
#
# Twelve runs each end at $39.4 \pm 0.4$ T (step 0.02), $39.6 \pm 0.5$ (0.008), $39.8 \pm 0.4$
# (0.002) and $39.5 \pm 0.4$ (0.0005): the step makes no difference. The balance says why. The time
# still left, at energy $E$, is of the order of $6/(\alpha E^{1/6})$, and a step that is too long
# matters only at energies where next to nothing is left.
# </details>
#
# **2.** Can damping save the quadratic chain? Noise alone holds it at the energy $E_0 =
# \frac53\cdot \frac{LA^2}{4\gamma}$, so $\dot E = \alpha E^{7/6} - \beta(E - E_0)$. From which
# $\gamma$ on has this a state at rest? Take $\alpha = \alpha_1P^{-1/6}$ with $P = 45$. Try it.
#
# <details><summary>Solution</summary>
#
# The right side is smallest at $E^{1/6} = 6\beta/7\alpha$ and is $\beta(E_0 - E/7)$ there. It
# reaches zero if $(6\beta/7\alpha)^6 > 7E_0$, which with $\beta = 6\gamma/5m$ means $\gamma >
# 0.95$. Six simulations each: at $\gamma = 0.4$, 0.6, 0.8 all diverge, after about 40, 48 and 67
# T. At $\gamma = 1$ they still do, but after 110 to 160 T: they wait for a fluctuation that
# carries them over the barrier. At 1.2 and 1.5 none did in 1000 T. But the barrier is finite, so
# some day one will.
# </details>
#
# **3.** Linear springs: measure the growth rate for $L = 70$, 80, 130 and 160. Where does the
# balance of section 2 begin to fail, and why?
#
# <details><summary>Solution</summary>
#
# Measured $0.0142$, $0.0291$ (in 300 T), $0.1093$ and $0.1593$ (in 150 T) per T, with errors up to
# 0.0001; the balance with $e^2 - 1$ gives 0.0139, 0.0296, 0.1077 and 0.1546. At $L = 160$ it is 3 %
# too low: the energy there grows by a factor $\mathrm{e}$ in half a period, and the balance supposed
# a small change. At $L = 70$, near the critical size, growth is so slow that the noise still counts
# in the fit: in 150 T one finds $0.0155 \pm 0.0004$, in 1000 T $0.0131$. The latter is 6 % less than
# the balance says, for the rate is the small difference of the drive and the damping, $0.0955$.
# </details>
