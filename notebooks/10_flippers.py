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
# rods on springs do the same to one another: every collision multiplies their relative velocity by
# $e = 1.01$. Damping takes energy out. In this chain the energy grows without end. Does it grow
# exponentially, or does it become infinite in a finite time? What decides which?
#
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) found both. This lesson
# repeats their simulations and explains the two laws by a balance of energy. Then it shows that the
# balance is not enough for the second law.
#
# The units are the rod radius $R$ for lengths, $M$ for masses (a rod has $m = 4\pi/3\,M$), and $T =
# \sqrt{M/k}$ for times. Between collisions rod $i$ obeys $m\ddot x = -\gamma\dot x - F(x - x_i^0) +
# A\,\xi(t)$ with white noise $\xi$. Linear springs have $F(d) = k d$, quadratic ones $F(d) = k d|d|$.
#
# *Level: fourth year. You need: lesson 9, sections 1 and 4; a separable differential equation.
# Time: 100 minutes. To predict before you see the results, type `make lessons` in the folder of the
# project, and open the copy of this lesson without outputs in `build/lessons/`.*

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import quad
from scipy.optimize import linear_sum_assignment
from teaching import BLUE, GREEN, ORANGE, check, mean_and_error, panels, played, right

from crazybilliards.reproduction.fits import fit_growth, fit_singularity, tail_length

# %% [markdown]
# ## 1. Two springs
#
# Two chains have the same rods, the same restitution, the same damping and the same noise. All rods
# start at rest, at their anchors. Only the springs differ.
#
# **Predict.** How does the energy of each chain grow with time? Think of a straight line on a
# logarithmic scale, of a curve that bends down, and of one that bends up.
#
# **Run.** We simulate twelve runs for each kind of spring.

# %%
import crazybilliards as cb

linear = cb.Chain(size=100, restitution=1.01, damping=0.4)
quadratic = linear.replace(spring="quadratic")


def release(chain, seed, **settings):
    """Let a chain go from rest and watch its kinetic energy from the beginning."""
    return cb.simulate(chain, warmup=0, observe=["energy"], seed=seed, progress=False, **settings)


seeds = range(12)
slow = [release(linear, seed, duration=300, time_step=0.02, every=0.2) for seed in seeds]
fast = [release(quadratic, seed, duration=100, time_step=0.002, every=0.1) for seed in seeds]
end = np.array([run.attrs["end_time"] for run in fast])
print("status of the quadratic runs:", {run.attrs["status"] for run in fast})
print(f"they end at t = {end.mean():.1f} T, with a standard deviation of {end.std(ddof=1):.1f} T")

# %% tags=["hide-input"]
ax = panels(width=7)
for runs, colour, name in ((slow, BLUE, "linear springs"), (fast, ORANGE, "quadratic springs")):
    for run in runs:
        ax.semilogy(run.time, run.kinetic_energy, color=colour, linewidth=0.8, alpha=0.7)
    ax.plot([], [], color=colour, label=name)
ax.set(xlabel="time t [T]", ylabel=r"kinetic energy [M R$^2$/T$^2$]", ylim=(1, 1e12))
ax.legend(frameon=False)
plt.show()

# %% tags=["remove-cell"]
assert all(run.attrs["status"] == "diverged" for run in fast)
assert all(run.attrs["status"] == "completed" for run in slow)
assert all(np.isfinite(run.kinetic_energy).all() for run in fast)
assert 35 < end.mean() < 45

# %% [markdown]
# <details><summary>Explain</summary>
#
# Every line is a run with its own noise. With linear springs the energy becomes a straight line on
# this scale, so it grows exponentially. With quadratic springs the energy of all runs grows faster
# and faster, and becomes infinite at nearly the same time, near 40 T.
#
# **A divergence is a result.** `simulate` stops when a rod is a million times faster than a typical
# one. It returns everything that it has measured before, with the status `diverged` and the time
# `end_time`. The result never contains a NaN. (A long run on linear springs ends in the same way, but
# much later, because an exponential reaches every speed.)
# </details>
#
# ## 2. Linear springs: one balance of energy
#
# [Lesson 9](09_beyond_restitution_one.ipynb), section 4, derives the balance of energy for linear
# springs. In half a period $\pi\sqrt{m/k}$ each pair of rods meets once, and the encounters add
# $(e^2-1)\frac L2E \approx (e-1)LE$ to the energy $E$. Damping takes $\frac\gamma mE$ per time. So
#
# $$\dot E = \frac\gamma m\left(\frac L{L_c} - 1\right)E,\qquad
# L_c = \frac{\pi\gamma}{(e-1)\sqrt{km}} .$$
#
# Above the critical size $L_c$ the energy grows exponentially. The paper has this balance in words
# and proportionalities, $\dot E\sim C_fE-\gamma E$ with an unknown collision frequency $C_f$.
#
# The numbers of our chain:

# %%
L, e, m, k, gamma = 100, linear.restitution, linear.mass, linear.stiffness, linear.damping
critical = np.pi * gamma / ((e - 1) * np.sqrt(k * m))
first_order = gamma / m * (L / critical - 1)
print(f"L_c = {critical:.1f} rods; rate with e - 1: {first_order:.4f} per T")

# %% [markdown]
# **Task.** Write the rate of growth $\dot E/E$ as a function. Keep $(e^2-1)/2$, and do not replace it
# by $e - 1$.


# %% tags=["remove-cell"]
def growth_rate_solution(L, e):
    return (e**2 - 1) / 2 * L / (np.pi * np.sqrt(m / k)) - gamma / m


chains = [(100, 1.01), (200, 1.01), (50, 1.05)]
assert right(growth_rate_solution, growth_rate_solution, at=chains)
assert not right(
    lambda L, e: gamma / m * (L * (e - 1) * np.sqrt(k * m) / np.pi / gamma - 1),
    growth_rate_solution,
    at=chains,
)
unexpanded = growth_rate_solution(L, e)


# %%
def growth_rate(L, e):
    return ...  # your code here


hint = "the gain of half a period, divided by half a period, minus gamma/m"
check(growth_rate, growth_rate_solution, at=chains, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def growth_rate(L, e):
#     return (e**2 - 1) / 2 * L / (np.pi * np.sqrt(m / k)) - gamma / m
# ```
#
# The rate is 0.0608 per T here. With $e - 1$ it is 0.0600 per T.
# </details>
#
# **Predict.** Does the simulation tell the two rates apart?
#
# **Run.** We fit an exponential from 150 T on. The noise no longer matters there, and the chain has
# forgotten its start.

# %%
late = [run.sel(time=slice(150, None)) for run in slow]
fits = [fit_growth(run.time.values, run.kinetic_energy.values) for run in late]
rate, rate_error = mean_and_error([fit.rate for fit in fits])
print(f"measured rate: {rate:.5f} +- {rate_error:.5f} per T, from twelve runs")
print(f"balance: {unexpanded:.5f} with e^2 - 1, {first_order:.5f} with e - 1")
print(f"error that one fit gives: {fits[0].rate_error:.5f} per T")
print(f"scatter of the fits:      {np.std([fit.rate for fit in fits], ddof=1):.5f} per T")

# %% tags=["remove-cell"]
assert first_order + 5 * rate_error < rate < unexpanded - 5 * rate_error
assert abs(rate / unexpanded - 1) < 0.007

# %% [markdown]
# <details><summary>Explain</summary>
#
# It does, and it agrees with neither of them. The measured rate lies between the two, 0.5 % below the
# balance with $(e^2-1)/2$ and 0.8 % above the first order, and it is many standard errors away from
# both. The balance is a good approximation and not an exact law, although nothing in it was fitted:
# it takes the energy to be the same during half a period, in which it grows by half.
#
# The error is the scatter of twelve independent runs divided by $\sqrt{12}$. The error that one fit
# gives is not reliable, because the energy of a single run wanders slowly about its mean growth.
# </details>
#
# ## 3. The cloud in phase space
#
# In the reduced coordinate $y$ rods that exchange their names in a collision are points that pass
# through one another. A point on a linear spring runs round the origin of the $(y, v)$ plane once in
# $2\pi\sqrt{m/k} = 12.9$ T.
#
# **Predict.** Colour each point by its angle at the start. Do the colours keep their order while the
# cloud turns and grows, or do the points mix?
#
# **Run.** The simulation knows rods and not points. To colour the points we follow them from picture
# to picture: we turn the cloud by the known angle, and look which point is closest.

# %%
every, frames, frequency = 0.6, 60, np.sqrt(k / m)
watch = {"every": every, "observe": ["snapshots"], "progress": False}
film = cb.simulate(linear, warmup=60, duration=64 * every, time_step=0.02, seed=0, **watch)
y = linear.reduced(film.position.values[0])[:frames]
cloud = y + 1j * film.velocity.values[0][:frames] / frequency  # a turn is now a phase

points = [cloud[0]]
for later in cloud[1:]:
    expected = points[-1] * np.exp(-1j * frequency * every)
    points.append(later[linear_sum_assignment(abs(expected[:, None] - later))[1]])
points = np.array(points)

# %% tags=["hide-input"]
picture, ax = plt.subplots(figsize=(4.6, 4.6), dpi=100)
reach = 1.05 * abs(points).max()
look = {"cmap": "twilight", "s": 18, "edgecolors": "0.3", "linewidths": 0.4}
dots = ax.scatter(points[0].real, points[0].imag * frequency, c=np.angle(points[0]), **look)
ax.set(xlim=(-reach, reach), ylim=(-reach * frequency, reach * frequency))
ax.set(xlabel="y [R]", ylabel="v [R/T]")
title = ax.set_title("")


def draw(number):
    """Move the points of the picture to those of one snapshot."""
    dots.set_offsets(np.column_stack([points[number].real, points[number].imag * frequency]))
    title.set_text(f"t = {film.time.values[number]:.1f} T")


film_of_the_cloud = played(picture, draw, range(frames), a_second=10)
film_of_the_cloud

# %% tags=["hide-input"]
# A turn back by the angle travelled should leave every point where it was, except for the growth.
turned = points * np.exp(1j * frequency * every * np.arange(frames))[:, None]
kept = abs(np.angle(turned[20] / turned[0]))
print(f"after 12 T the median point is {np.median(kept):.2f} rad away from a rigid turn")
growth = np.sqrt((abs(points[-1]) ** 2).mean() / (abs(points[0]) ** 2).mean())
expected_growth = np.exp(unexpanded / 2 * every * (frames - 1))
print(f"the cloud grew {growth:.2f} times; exp(rate t/2) = {expected_growth:.2f}")

# %% tags=["remove-cell"]
assert len(film_of_the_cloud.html) < 1e6
assert np.median(kept) < 0.5
assert abs(growth / expected_growth - 1) < 0.15

# %% [markdown]
# <details><summary>Explain</summary>
#
# The cloud turns nearly three times and becomes about three times as large. Its amplitude grows at
# half the rate of the energy. The colours blur slowly, because each encounter changes a velocity.
# But they keep their order. All points turn at the same rate, so they all meet equally often and
# gain the same *fraction* of their energy.
# </details>
#
# ## 4. Quadratic springs: why a finite time
#
# **Predict.** On a quadratic spring, does a rod with a large amplitude have a longer or a shorter
# period than a rod with a small amplitude? What does this mean for the number of encounters per
# time?
#
# **Run.** A rod of energy $E_1$ moves in the potential $ky^3/3$. Half a period takes
# $\tau(E_1) = 2\int_0^a\mathrm{d}y\,/\sqrt{2(E_1 - ky^3/3)/m}$ with the amplitude $a$.


# %%
def half_period(energy):
    """Return half the period of a rod on a quadratic spring [T]."""
    amplitude = (3 * energy / k) ** (1 / 3)
    integral = quad(lambda x: (1 - x**3) ** -0.5, 0, 1)[0]  # x = y/a
    return 2 * amplitude * integral / np.sqrt(2 * energy / m)


for energy in (1.0, 64.0, 64.0**2):
    print(f"energy {energy:6.0f}: half a period takes {half_period(energy):.3f} T")

# %% tags=["remove-cell"]
assert np.isclose(half_period(1.0), 2 * half_period(64.0))

# %% [markdown]
# <details><summary>Explain</summary>
#
# The period is shorter: 64 times the energy halves it, so the frequency is proportional to
# $E_1^{1/6}$. Rods with more energy meet more often.
# </details>
#
# Each half period adds a fixed fraction of the energy. Therefore
#
# $$\dot E = \alpha E^{7/6} - \beta E,\qquad \beta = \frac{6\gamma}{5m} .$$
#
# (Damping takes $2\gamma/m$ times the kinetic energy per time. In a cubic potential the virial
# theorem says $2\langle E_\mathrm{kin}\rangle = 3\langle E_\mathrm{pot}\rangle$, so the kinetic
# energy is 3/5 of $E$.) Without damping $u = E^{-1/6}$ falls on a straight line, $\dot u =
# -\alpha/6$. It reaches zero at some time $t_c$, so $E \propto (t_c - t)^{-6}$. With damping
# $\dot u = -\alpha/6 + \beta u/6$, and
#
# $$E = \left[\frac{\beta/\alpha}{1 - \mathrm{e}^{-\beta(t_c - t)/6}}\right]^6 .$$
#
# The exponent that one measures is the slope $-\mathrm{d}\ln E/\mathrm{d}\ln(t_c - t)$. By this
# formula it is below 6, and it approaches 6 near the end:

# %%
beta = 6 * gamma / (5 * m)
for time_left in (1, 10, 20, 40):
    slope = beta * time_left / (np.exp(beta * time_left / 6) - 1)
    print(f"{time_left:3d} T before the end the exponent is {slope:.2f}")

# %% tags=["remove-cell"]
left = np.geomspace(0.1, 100, 200)
formula = (beta / 0.1 / (1 - np.exp(-beta * left / 6))) ** 6
numerical = -np.gradient(np.log(formula), np.log(left))
closed = beta * left / (np.exp(beta * left / 6) - 1)
assert np.abs(numerical / closed - 1)[1:-1].max() < 0.01

# %% [markdown]
# Damping can also be removed exactly. Let $G = E\,\mathrm{e}^{\beta t}$ and $\theta =
# \frac6\beta(1 - \mathrm{e}^{-\beta t/6})$. Then $\mathrm{d}G/\mathrm{d}\theta = \alpha G^{7/6}$,
# which gives a pure power law with the exponent 6.
#
# **Predict.** We fit $C\,(t_c - t)^{-p}$ to the simulated energies above a threshold, once as they
# are and once with damping removed. Which exponents $p$ do you expect?
#
# **Run.** `fit_singularity` fits $C$, $t_c$ and $p$. The raw snapshots give the whole energy,
# springs included, and the share of every rod.


# %% tags=["hide-input"]
class Run:
    """Energies of the rods of one chain, from release to the end."""

    def __init__(self, chain, seed, **settings):
        run = cb.simulate(
            chain, warmup=0, observe=["snapshots"], seed=seed, progress=False, **settings
        )
        y, v = chain.reduced(run.position.values[0]), run.velocity.values[0]
        rods = chain.mass / 2 * v**2 + chain.potential(y)
        self.time = run.time.values
        self.kinetic = (chain.mass / 2 * v**2).sum(axis=1)
        self.energy = rods.sum(axis=1)
        self.share = rods.max(axis=1) / self.energy
        self.number = self.energy**2 / (rods**2).sum(axis=1)  # rods that share the energy


# %%
runaways = [Run(quadratic, seed, duration=100, time_step=0.002, every=0.02) for seed in range(12)]


def beyond(time, energy, threshold):
    """Return the times and energies from the first energy above a threshold."""
    first = int(np.argmax(energy > threshold))
    return time[first:], energy[first:]


def exponents(run, threshold):
    """Return the fitted exponent, as it is and with damping removed."""
    t, E = beyond(run.time, run.kinetic, threshold)
    theta = 6 / beta * (1 - np.exp(-beta * (t - t[0]) / 6))
    G = E * np.exp(beta * (t - t[0]))
    return fit_singularity(t, E).exponent, fit_singularity(theta, G).exponent


fitted = {
    threshold: mean_and_error([exponents(run, threshold) for run in runaways])
    for threshold in (1e3, 1e4, 1e5, 1e6)
}

# %% tags=["hide-input"]
print("threshold   exponent, as it is   exponent, damping removed")
for threshold, (p, error) in fitted.items():
    columns = threshold, p[0], error[0], p[1], error[1]
    print("  {:.0e}      {:.2f} +- {:.2f}          {:.2f} +- {:.2f}".format(*columns))

# %% tags=["remove-cell"]
for p, error in fitted.values():
    assert p[0] < 5.4
    assert p[1] + 5 * error[1] < 6
assert fitted[1e3][0][1] > fitted[1e3][0][0]

# %% [markdown]
# <details><summary>Explain, first attempt</summary>
#
# The exponents of the energy as it is lie between 4 and 5, well below 6. With damping removed they
# should be 6. They are near 5: larger than before, but not 6. So damping is one reason for a small
# exponent, and there must be another one.
# </details>
#
# ## 5. How many rods share the energy?
#
# **Predict.** On linear springs all rods have the same period. On quadratic springs a rod with a
# little more energy has a shorter one. What becomes of its lead?
#
# **Run.** The number of rods that share the energy is $P = (\sum E_i)^2/\sum E_i^2$. It is $L$ if all
# rods have the same energy, and 1 if one rod has everything.

# %%
steady = [Run(linear, seed, duration=300, time_step=0.02, every=0.2) for seed in range(6)]


def shared_by(runs, energy):
    """Return the numbers P at the moments when the runs first exceed an energy."""
    return [run.number[np.argmax(run.energy > energy)] for run in runs]


for energy in (1e3, 1e5, 1e7, 1e9):
    each, other = np.mean(shared_by(steady, energy)), np.mean(shared_by(runaways, energy))
    print(f"E = {energy:.0e}: on linear springs {each:.0f} rods, on quadratic ones {other:.1f}")
richest = np.mean([run.share[-1] for run in runaways])
print(f"share of the richest rod at the end, on quadratic springs: {richest:.2f}")

# %% tags=["hide-input"]
ax = panels(width=6.4)
named = ((steady, BLUE, "linear springs"), (runaways, ORANGE, "quadratic springs"))
for runs, colour, name in named:
    for run in runs:
        ax.loglog(run.energy, run.number, color=colour, linewidth=0.7, alpha=0.5)
    ax.plot([], [], color=colour, label=name)
ax.set(xlabel=r"energy of the chain [M R$^2$/T$^2$]", ylabel="rods that share it, P")
ax.set(xlim=(1e2, 1e12), ylim=(0.8, 120))
ax.set_yticks([1, 3, 10, 30, 100], ["1", "3", "10", "30", "100"])
ax.legend(frameon=False)
plt.show()

# %% tags=["remove-cell"]
assert min(shared_by(steady, 1e9)) > 20
assert max(shared_by(runaways, 1e9)) < 4
assert richest > 0.9

# %% [markdown]
# <details><summary>Explain</summary>
#
# On quadratic springs the rod in the lead meets others more often, so its lead grows. In the end
# one point has nearly all the energy. This changes the law of growth, because the frequency is that
# of a *rod*. If $P$ rods share $E$, each has the frequency of the energy $E/P$, and
#
# $$\alpha = \alpha_1 P^{-1/6} .$$
#
# As $P$ falls from some 40 to 1, $\alpha$ grows to nearly twice its value. The energy then grows more
# steeply than $E^{7/6}$, and a steeper law has a smaller exponent: $\dot E\propto E^{1+1/p}$ gives
# $(t_c-t)^{-p}$.
# </details>
#
# **The last rod** can be computed without any fit. It passes through the $L - 1$ others, which are
# nearly at rest, and each of them changes its velocity by $v \to v + \frac{e-1}2 v$. So half a period
# multiplies its energy by $[(1+e)/2]^{2(L-1)}$. Half a period takes $\tau(E) = c\,E^{-1/6}$ (section
# 4), so
#
# $$\alpha_1 = \frac{2(L-1)}{c}\ln\frac{1+e}2 .$$

# %%
c = half_period(1.0)
factor = ((1 + e) / 2) ** (2 * (L - 1))
alpha_1 = np.log(factor) / c
print(f"half a period multiplies the energy by {factor:.2f}; alpha_1 = {alpha_1:.4f}")

# %% [markdown]
# **Predict.** Follow the last rod from turning point to turning point. How long do 200 half periods
# take, if the energy at the start is $10^6$ and the first one takes about 0.6 T?
#
# **Run.**


# %%
def last_rod(energy, halves):
    """Follow one rod from turning point to turning point: energy, and time since the first."""
    energies, times = [energy], [0.0]
    for _ in range(halves):
        after = factor * energies[-1]
        # Half of the way in with the old energy, half of the way out with the new one.
        times.append(times[-1] + half_period(energies[-1]) / 2 + half_period(after) / 2)
        energies.append(after * np.exp(-beta * (times[-1] - times[-2])))
    return np.array(energies), np.array(times)


energies, times = last_rod(1e6, 200)
print(f"half a period at the start takes {half_period(1e6):.2f} T")
print(f"100 half periods take {times[100]:.4f} T, 200 of them {times[-1]:.4f} T")

# %% tags=["remove-cell"]
assert times[-1] - times[100] < 1e-6  # the sum converges: infinitely many in a finite time

# %% [markdown]
# <details><summary>Explain</summary>
#
# The energies form a geometric sequence, so the times form one too, and their sum converges.
# Infinitely many half periods take a finite time. This is the film of a bouncing ball that comes to
# rest, run backwards.
# </details>
#
# **Predict.** Does the simulated energy grow smoothly in the last moments of a run?
#
# **Run.** We compare the runs with one rod that has all the energy, and with 40 rods that share it.

# %% tags=["hide-input"]
left_ax, right_ax = panels(2, width=9.5, height=3.8)
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


def alone(run):
    """Return at which times one rod has nearly all of a large energy."""
    return (run.share > 0.9) & (run.energy > 1e8)


run = max(runaways, key=lambda run: alone(run).sum())
begin = int(np.argmax(alone(run)))
still = run.kinetic / run.energy
first = begin + int(np.argmin(still[begin : begin + 15]))
energies, times = last_rod(run.energy[first], 9)
right_ax.semilogy(run.time[begin:], run.energy[begin:], color=ORANGE, label="simulation, one run")
look = {"markersize": 5, "markerfacecolor": "none", "label": "one rod, from turn to turn"}
right_ax.plot(run.time[first] + times, energies, "ko", **look)
right_ax.set(xlabel="time t [T]", ylabel=r"energy [M R$^2$/T$^2$]")
right_ax.set(ylim=(run.energy[begin] / 3, 1e12), xlim=(run.time[begin] - 0.1, run.time[-1] + 0.2))
right_ax.legend(frameon=False)
plt.show()
growth, growth_error = mean_and_error(ratios)
print(f"ln of the factor per half period: {growth:.3f} +- {growth_error:.3f}")
print(f"of one rod without the others: {np.log(factor):.3f}")

# %% tags=["remove-cell"]
assert alone(run).any()
assert abs(growth / np.log(factor) - 1) < 0.03

# %% [markdown]
# <details><summary>Explain</summary>
#
# On the left the law $(t_c - t)^{-6}$ is a straight line near the end. The runs are bent. Far from
# the end they fall as if some tens of rods shared the energy, and at the end as one rod. So the
# exponent 6 is right for the last moments only. Over any range that a fit can use, the exponent comes
# out smaller, and it depends on the range.
#
# On the right the energy climbs in steps. It rises when the one rod crosses the others, and it stays
# constant on the way out and back. The circles use the simulation for their first point only. The
# logarithm of the factor per half period is 1 % below that of one rod, because the rest of the energy
# (less than a tenth) belongs to slower rods.
# </details>
#
# ## 6. Flippers with a steady state
#
# With more damping the chain has a steady state. For $e = 1.05$ and $\gamma = 4$ the critical size is
# 123 rods, and 100 rods are below it. But a point that happens to be fast passes all the others, and
# each of them drives it on.
#
# **Predict.** What does the distribution of the velocities of the outermost left rod look like? Is it
# symmetric? Is it a Gaussian?
#
# **Run.** We compare $\gamma = 4$ with $\gamma = 10$.

# %%
settings = {
    "observe": ["widths", "velocities", "avalanches"],
    "particles": [*range(1, 11), 100],
    "progress": False,
}
weak, strong = (
    [
        cb.simulate(
            cb.Chain(size=100, restitution=1.05, damping=g), duration=2500, seed=s, **settings
        )
        for s in range(4)
    ]
    for g in (4.0, 10.0)
)


# %% tags=["hide-input"]
def border_density(runs):
    """Return v and p(v) of the left border, averaged with the mirror image of the right one."""
    p = np.mean([run.velocity_density.sel(particle=[1, 100]).values for run in runs], axis=0)
    return runs[0].velocity_bin.values, (p[0] + p[1][::-1]) / 2


def border_width(runs):
    """Return the velocity width of the two outermost rods."""
    return np.sqrt(np.mean([run.velocity_width.sel(particle=[1, 100]).values ** 2 for run in runs]))


axes = panels(2, width=9, sharey=True)
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
axes[0].figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
plt.show()

tails = []
for run in weak:
    v, p = border_density([run])
    v, p, w = v[v < 0], p[v < 0], border_width([run])
    tails.append(tail_length(v, p, 5 * w) / tail_length(v, p, 3 * w))
ratio, ratio_error = mean_and_error(tails)
print(f"length of the tail beyond 5 widths over that beyond 3: {ratio:.2f} +- {ratio_error:.2f}")
print("(an exponential has 1, a Gaussian 0.65)")
excess = {}
for runs, g in ((weak, 4), (strong, 10)):
    border = [run.velocity_kurtosis.sel(particle=[1, 100]).mean().item() for run in runs]
    excess[g] = mean_and_error(border)  # 0 for a Gaussian, 3 for exp(-|v|)
    print("gamma = {}: excess kurtosis of the border {:.2f} +- {:.2f}".format(g, *excess[g]))

# %% tags=["remove-cell"]
assert ratio > 0.75
assert excess[4][0] - 5 * excess[4][1] > 2
assert excess[10][0] + 5 * excess[10][1] < 2

# %% [markdown]
# <details><summary>Explain</summary>
#
# At $\gamma = 4$ the distribution has a tail on one side. The left rod is thrown to the left, so the
# tail is at negative velocities. It is a straight line on this scale, so it is close to an
# exponential and far from a Gaussian. Each of the other 99 points pushes a point that crosses the
# whole chain. If they were at rest and nothing damped it, it would leave the chain $1.025^{99} =
# 11.5$ times as fast as it came. It comes out as the rod at the border.
#
# At $\gamma = 10$ the damping stops most points on the way. The distribution is nearly a Gaussian,
# with a faint tail of the same kind.
# </details>
#
# **Avalanches.** The same push can be followed from rod to rod. A wave starts when a rod hits its
# right neighbour and their total momentum points to the right. Its size grows by one for each further
# neighbour that is hit.
#
# **Predict.** Count the waves that begin at the ten leftmost rods. At which damping do more of them
# reach 80 rods?
#
# **Run.**

# %%
counts, spanning = {}, {}
for runs, g in ((weak, 4), (strong, 10)):
    left_end = [run.avalanche_count.sel(particle=slice(1, 10)).sum("particle") for run in runs]
    counts[g] = np.array([each.values for each in left_end])  # of sizes 1, 2, 3...
    spanning[g] = mean_and_error([1e4 * each[79:].sum() / each.sum() for each in counts[g]])
    print("gamma = {}: of 10^4 waves {:.0f} +- {:.0f} reach 80 rods".format(g, *spanning[g]))

# %% tags=["hide-input"]
ax = panels(width=5.6)
for g, colour, symbol in ((4, BLUE, "o"), (10, ORANGE, "s")):
    total = counts[g].sum(axis=0)
    sizes = np.arange(1, total.size + 1)[total > 0]
    look = {"markersize": 4, "markerfacecolor": "none", "label": rf"$\gamma$ = {g}"}
    ax.loglog(sizes, total[total > 0] / total.sum(), symbol, color=colour, **look)
ax.set(xlabel="collisions of a wave, $N_c$", ylabel="share of the waves")
ax.legend(frameon=False)
plt.show()

# %% tags=["remove-cell"]
surplus = spanning[4][0] - spanning[10][0]
assert surplus > 5 * np.hypot(spanning[4][1], spanning[10][1])

# %% [markdown]
# <details><summary>Explain</summary>
#
# At $\gamma = 4$ several times as many waves cross the chain. These waves are the fast points, seen
# rod by rod.
# </details>
#
# ## Exercises
#
# **1.** Is the finite time real, or is it an effect of the time step? Repeat the quadratic runs of
# section 1 with steps from 0.02 T to 0.0005 T.
#
# <details><summary>Solution</summary>
#
# Twelve runs each end at $39.4 \pm 0.4$ T (step 0.02), $39.6 \pm 0.5$ (0.008), $39.8 \pm 0.4$
# (0.002) and $39.5 \pm 0.4$ (0.0005). The step makes no difference, and the balance gives the
# reason. At the energy $E$ the remaining time is of the order of $6/(\alpha E^{1/6})$. A step becomes
# too long only at energies where nearly no time remains.
# </details>
#
# **2.** Can damping prevent the divergence of the quadratic chain? Noise alone holds it at the energy $E_0 =
# \frac53\cdot \frac{LA^2}{4\gamma}$, so $\dot E = \alpha E^{7/6} - \beta(E - E_0)$. From which
# $\gamma$ on does this equation have a state at rest? Take $\alpha = \alpha_1P^{-1/6}$ with
# $P = 45$. Try it.
#
# <details><summary>Solution</summary>
#
# The right side is smallest at $E^{1/6} = 6\beta/7\alpha$, and its value there is
# $\beta(E_0 - E/7)$. It reaches zero if $(6\beta/7\alpha)^6 > 7E_0$, which with $\beta = 6\gamma/5m$
# means $\gamma > 0.95$. Six simulations each: at $\gamma = 0.4$, 0.6 and 0.8 all diverge, after about
# 40, 48 and 67 T. At $\gamma = 1$ they still diverge, but after 110 to 160 T, when a fluctuation
# carries them over the barrier. At 1.2 and 1.5 none diverged in 1000 T. The barrier is finite, so
# they will diverge at some later time.
# </details>
#
# **3.** Linear springs: measure the growth rate for $L = 70$, 80, 130 and 160. Where does the
# balance of section 2 begin to fail, and why?
#
# <details><summary>Solution</summary>
#
# The measured rates are $0.0142$, $0.0291$ (in 300 T), $0.1093$ and $0.1593$ (in 150 T) per T, with
# errors up to 0.0001. The balance with $e^2 - 1$ gives 0.0139, 0.0296, 0.1077 and 0.1546. At
# $L = 160$ it is 3 % too low. There the energy grows by a factor $\mathrm{e}$ in half a period, and
# the balance assumes a small change. At $L = 70$, near the critical size, growth is so slow that the
# noise still matters in the fit: in 150 T one finds $0.0155 \pm 0.0004$, in 1000 T $0.0131$. The
# latter is 6 % less than the balance says, because the rate is the small difference of the drive and
# the damping, $0.0955$.
# </details>
