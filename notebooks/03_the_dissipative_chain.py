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
# # The dissipative chain
#
# **Question.** A hundred rods on springs, all shaken equally hard. Let them stick together when
# they meet instead of bouncing. Which of them come to rest, and how quiet do they get?
#
# The chain is that of [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460).
# Between collisions rod $i$ obeys
#
# $$m\ddot x_i = -\gamma\dot x_i - k(x_i - x^0_i) + A\,\xi_i(t),$$
#
# with independent white noises $\xi_i$ of unit strength. A collision conserves momentum and gives
# $v_1' - v_2' = -e\,(v_1 - v_2)$. Lengths are in rod radii $R$, masses in $M$ (a rod has
# $m = 4\pi/3\,M$), times in $T = \sqrt{M/k}$; $\gamma = A = 1$ in these units, and the rods touch
# when they sit at their anchors $x^0_i$. Without collisions the velocity of a rod is Gaussian with
# the width $W = A/\sqrt{2m\gamma}$.

# %%
import json
from collections import defaultdict

import matplotlib.pyplot as plt
import numpy as np

from crazybilliards.comparison import fit_avalanches, fit_border_power_law, fit_scaling
from crazybilliards.model import Chain
from crazybilliards.particles import simulate, simulate_limit

BLUE, ORANGE, GREEN, PINK = "#0072B2", "#E69F00", "#009E73", "#CC79A7"

# %%
sticky = Chain(size=100, restitution=0)
W = sticky.free_velocity_width
print(f"a free rod: W = {W:.4f} R/T")

fig, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True, layout="constrained")
for ax, e in zip(axes, (1, 0), strict=True):
    film = simulate(
        sticky.replace(restitution=e),
        duration=64,
        every=0.25,
        observe="snapshots",
        seed=1,
        progress=False,
    )
    time = film.time - film.time[0]
    v = film.velocity.isel(replica=0).transpose("particle", "time") / W
    colours = ax.pcolormesh(time, film.particle, v, cmap="PuOr", vmin=-2, vmax=2, rasterized=True)
    ax.set(xlabel="time t [T]", title=f"restitution e = {e}")
axes[0].set_ylabel("particle i")
fig.colorbar(colours, ax=axes, label="velocity $v/W$")
plt.show()

# %% [markdown]
# Time runs to the right, every row is a rod. The elastic chain ($e = 1$) is equally lively
# everywhere. The chain at $e = 0$ is lively at its borders, and calm inside; there it moves in
# broad stripes: many rods with one velocity.
#
# ## 1. Three rods are enough
#
# **Predict.** Take one rod, then two, then three, at $e = 0$. A rod in a pair has one neighbour.
# In a row of three the middle one has two. Who has the narrowest velocity distribution?
#
# **Run.** We measure the velocity width $W_v(i) = \sqrt{\langle v_i^2\rangle}$.

# %%
for size in (1, 2, 3):
    run = simulate(
        sticky.replace(size=size), duration=30_000, observe="widths", seed=3, progress=False
    )
    width, error = run.velocity_width.values / W, run.velocity_width_error.values / W
    print(f"{size} rod(s): W_v/W = {width.round(4)}, standard errors {error.round(4)}")
    if size == 1:
        assert abs(width[0] - 1) < 5 * error[0]
    if size == 2:
        assert (width < 1 - 5 * error).all()
    if size == 3:
        difference = (width[0] + width[2]) / 2 - width[1]
        assert difference > 5 * np.sqrt(error[1] ** 2 + (error[0] ** 2 + error[2] ** 2) / 4)

# %% [markdown]
# **Explain.** In a steady state the energy of a rod balances. The noise puts in $A^2/2m$ per unit
# of time, damping takes out $\gamma\langle v^2\rangle$, the spring takes and gives back. What is
# missing goes into collisions. As $W^2 = A^2/(2m\gamma)$,
#
# $$\text{share of the noise's power that collisions take} = 1 - \frac{W_v(i)^2}{W^2}$$
#
# (derived here, exact). The middle rod is hit from both sides; an outer rod is hit from one, flies
# outward freely, and has time to be heated again until its spring brings it back.
#
# How cold can it get? Collisions conserve momentum, so they do not touch the centre of mass. It
# is a free oscillator of mass $Lm$ driven by $L$ noises, with $\langle V^2\rangle = W^2/L$
# whatever $e$ is. If all rods moved as one, each would have
# $W_v = W/\sqrt L$: the floor (exercise 1).
#
# ## 2. The profile
#
# **Predict.** What does $W_v(i)$ look like for 100 rods at $e = 0$, 0.5 and 0.95? At
# $e = 0.95$ a collision takes only a tenth of the energy of the relative motion; will that chain
# be close to the elastic one?
#
# **Run.** A few independent runs of each. Neighbours move together, so an error bar that is worth
# anything must come from the scatter between whole runs.


# %%
def independent_runs(chain, number, duration, **settings):
    """Return runs that differ in their random numbers only; 60 T are 7 relaxation times."""
    return [
        simulate(
            chain,
            duration=duration,
            warmup=60,
            observe="widths",
            seed=seed,
            progress=False,
            **settings,
        )
        for seed in range(number)
    ]


def mean_and_error(values):
    """Return the mean over the runs and its standard error."""
    values = np.asarray(values)
    return values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(len(values))


def centre_width(run, share=0.1):
    """Root mean square velocity of the middle rods: a tenth of them, at least two."""
    size = run.sizes["particle"]
    half = max(round(share * size / 2), 1)
    middle = slice(size // 2 - half, size - size // 2 + half)
    return float(np.sqrt((run.velocity_width[middle] ** 2).mean()))


# %%
profiles = {}
for e, number, duration in ((0, 6, 1500), (0.5, 3, 500), (0.95, 3, 1000)):
    profiles[e] = independent_runs(sticky.replace(restitution=e), number, duration)

fig, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")
for (e, runs), colour, symbol in zip(profiles.items(), (BLUE, ORANGE, GREEN), "osD", strict=True):
    width, error = mean_and_error([run.velocity_width / W for run in runs])
    i = runs[0].particle
    left.errorbar(i, width, error, fmt=symbol, color=colour, mfc="none", ms=4, label=f"e = {e}")
    right.plot(i, 100 * (1 - width**2), symbol, color=colour, mfc="none", ms=4)
    border, centre = np.mean(width[[0, -1]]), np.mean([centre_width(run) for run in runs]) / W
    print(
        f"e = {e}: W_v/W = {border:.3f} at the border, {centre:.3f} in the centre; "
        f"collisions take {100 * (1 - centre**2):.0f} % in the centre"
    )
    assert centre < border < 1
left.axhline(1, color="k", linewidth=1, label="e = 1, exact")
left.axhline(1 / np.sqrt(100), color="0.4", linestyle=":", label=r"floor $1/\sqrt{L}$")
left.set(xlabel="particle i", ylabel="velocity width $W_v/W$", ylim=(0, 1.05))
left.legend(fontsize=9, loc="center", bbox_to_anchor=(0.5, 0.72), ncols=2)
right.set(xlabel="particle i", ylabel="power that collisions take [%]", ylim=(0, 100))
plt.show()

# %% [markdown]
# **Explain.** The profile is narrow inside and wide at both borders. Even at $e = 0.95$ the
# centre is far from elastic: a rod collides so often in a damping time that small losses add up.
# The border depends on $e$ much less.
#
# ## 3. Two power laws
#
# The paper fits $W_v(i)$ by a power law from either border (its equation `eq:power_law`),
#
# $$W_v(i) = a\,\big[(i - c)^{\,\nu} + (L + 1 - c - i)^{\,\nu}\big],$$
#
# and finds $\nu \approx -0.46$ at $e = 0$ for all $L$. The laws need not begin at the first rod: $c$
# says where they do. `fit_border_power_law` does this fit, to all rods.
#
# **Predict.** On doubly logarithmic axes, will chains of 30, 100 and 300 rods lie on one line
# near the border?
#
# **Run.**

# %%
runs_of = {
    10: independent_runs(sticky.replace(size=10), 6, 6000),
    30: independent_runs(sticky.replace(size=30), 6, 4000),
    100: profiles[0],
    300: independent_runs(sticky.replace(size=300), 6, 400),
}
nu = {}
fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
for size, colour, symbol in zip((30, 100, 300), (BLUE, ORANGE, GREEN), "osD", strict=True):
    runs = runs_of[size]
    width, error = mean_and_error([run.velocity_width / W for run in runs])
    fits = [fit_border_power_law(run) for run in runs]
    nu[size] = mean_and_error([fit.exponent for fit in fits])
    shown = np.unique(np.geomspace(1, size, 40).round().astype(int))
    ax.errorbar(
        shown,
        width[shown - 1],
        error[shown - 1],
        fmt=symbol,
        color=colour,
        mfc="none",
        ms=5,
        label=f"L = {size}",
    )
    fine = np.geomspace(1, size, 300)
    ax.plot(fine, np.mean([fit(fine) for fit in fits], axis=0) / W, color=colour, linewidth=1)
    c = mean_and_error([fit.origin for fit in fits])
    print(f"L = {size}: nu = {nu[size][0]:.3f} ± {nu[size][1]:.3f}, c = {c[0]:.2f} ± {c[1]:.2f}")
    assert abs(nu[size][0] + 0.46) < 0.05
ax.set(xscale="log", yscale="log", xlabel="particle i", ylabel="velocity width $W_v/W$")
ax.minorticks_off()
ax.set_yticks([0.15, 0.2, 0.3, 0.4, 0.6, 0.8], labels=["0.15", "0.2", "0.3", "0.4", "0.6", "0.8"])
ax.legend(title="symbols: simulation\nlines: two power laws")
plt.show()

# %% [markdown]
# **Explain.** Nearly. In a short chain the power law of the *other* border still counts, so the
# points of $L = 30$ lie highest. The exponents are the paper's within their errors, and the same for
# all three chains. The laws begin somewhat beyond the outermost rods, $c < 0$. The longer the chain,
# the further out: long runs of 30, 100, 300 and 1000 rods give $c = -0.22(1)$, $-0.30(2)$, $-0.49(3)$ and
# $-0.67(5)$, with $\nu = -0.449(2)$, $-0.449(2)$, $-0.458(3)$ and $-0.458(2)$. So the sum of two power laws
# describes the profile very well without being an exact law of it. Exercise 2 shows what it does to $\nu$
# to leave $c$ out.
#
# ## 4. The centre
#
# **Predict.** If every rod of the chain moved with all the others, the centre would fall like
# $L^{-1/2}$, along the floor. If the power laws of section 3 held exactly it would fall
# like $L^{\nu}$. Which is it?
#
# **Run.**

# %%
sizes = np.array(list(runs_of))
centre, centre_error = np.array(
    [mean_and_error([centre_width(run) for run in runs]) for runs in runs_of.values()]
).T
scaling = fit_scaling(sizes, centre, centre_error)

fig, ax = plt.subplots(figsize=(6, 3.6), layout="constrained")
ends = np.array([8, 400])
ax.errorbar(sizes, centre / W, centre_error / W, fmt="o", color=BLUE, mfc="none", label="centre")
ax.plot(ends, scaling(ends) / W, color=BLUE, label=f"$L^{{{scaling.exponent:.3f}}}$")
ax.plot(ends, 1 / np.sqrt(ends), ":", color="0.4", label="floor $L^{-1/2}$")
ax.set(xscale="log", yscale="log", xlabel="number of rods L", ylabel="central width $W_v/W$")
ax.minorticks_off()
ax.set_xticks(sizes, labels=sizes)
ax.set_yticks([0.05, 0.1, 0.2, 0.3, 0.5], labels=["0.05", "0.1", "0.2", "0.3", "0.5"])
ax.legend()
plt.show()
print(f"exponent {scaling.exponent:.3f} ± {scaling.exponent_error:.3f}")
for size, value in zip(sizes, centre, strict=True):
    print(f"L = {size}: as cold as a block of {(W / value) ** 2:.1f} rods that move as one")
assert abs(scaling.exponent + 0.38) < 0.03

# %% [markdown]
# **Explain.** The paper's exponent is $-0.38$. A block of $n$ rods that moves as one is driven by
# $n$ noises with $n$ masses and has the width $W/\sqrt n$. So $n = (W/W_v)^2$ is the number of
# rods that a rod in the centre effectively moves with. It grows with $L$, but more slowly than
# $L$: the chain never becomes one block.
#
# ## 5. Avalanches
#
# A push runs along the chain from rod to rod. The package follows such waves to the right with
# this rule, which extends the paper's (`"triggered-collisions"` is that one, where every hit starts
# a wave and rods that stick together pass nothing on). When rod $i$ hits $i+1$ and their momentum
# together points right, a wave starts at the **origin** $i$, and its **front** is on $i + 1$. The
# next collision of the front decides. If it is with its own right neighbour, and the momentum again
# points right, the front moves on; otherwise the wave is over. Its size is the number of collisions, $N_c$ = last front - origin.
#
# In a dozen lines, for a list of collisions:


# %%
def count_waves(collisions):
    """Return {origin: sizes of its waves that have ended}, by the rule above, naively."""
    waves = []  # (origin, front)
    ended = defaultdict(list)
    for rod, points_right in collisions:  # rod hits rod + 1
        still_running = []
        for origin, front in waves:
            if front == rod and points_right:
                still_running.append((origin, rod + 1))
            elif front in (rod, rod + 1):
                ended[origin].append(front - origin)
            else:
                still_running.append((origin, front))
        waves = still_running + ([(rod, rod + 1)] if points_right else [])
    return dict(ended)


# Rod 1 hits 2, 2 hits 3, 3 hits 4: then 5 comes from the right and pushes 4 back.
story = [(1, True), (2, True), (3, True), (4, False)]
print(count_waves(story))
assert count_waves(story) == {1: [3], 2: [2], 3: [1]}

# %% [markdown]
# One push, and three waves: every collision on the way starts a wave of its own. So avalanches
# are *not* independent of one another.
#
# **Predict.** Is there a typical size of avalanches, or none, as in a power law
# $p(N_c) \sim N_c^{-\tau}$?
#
# **Run.** 200 rods at a *fixed* time step, 0.01, because rods in contact are kicked
# anew in every step and the count depends on it (more on that below).

# %%
DT = 0.01
two_hundred = sticky.replace(size=200)
waves = [
    simulate(
        two_hundred,
        duration=200,
        time_step=DT,
        observe="avalanches",
        seed=seed,
        progress=False,
    ).avalanche_count
    for seed in range(4)
]
print(waves[0].dims, f"{sum(int(each.sum()) for each in waves):,} avalanches")

# %%
SMALLEST, LARGEST = 10, 60
origins = {"in the centre, 81 to 120": slice(81, 120), "at the border, 1 to 40": slice(1, 40)}
edges = np.unique(np.geomspace(1, 200, 22).round().astype(int))
fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
tau, by_range = {}, defaultdict(list)
for (name, chosen), colour, symbol in zip(origins.items(), (BLUE, ORANGE), "os", strict=True):
    counts = np.array([each.sel(particle=chosen).sum("particle").values for each in waves], float)
    binned = np.add.reduceat(counts, edges[:-1] - 1, axis=1) / np.diff(edges)
    p, error = mean_and_error(binned / counts.sum(axis=1, keepdims=True))
    middle = np.sqrt(edges[:-1] * (edges[1:] - 1))
    seen = p > 0
    ax.errorbar(
        middle[seen],
        p[seen],
        np.minimum(error, 0.9 * p)[seen],
        fmt=symbol,
        color=colour,
        mfc="none",
        ms=5,
        label=f"origins {name}",
    )
    fits = [fit_avalanches(each, smallest=SMALLEST, largest=LARGEST) for each in counts]
    tau[name] = mean_and_error([fit.exponent for fit in fits])
    print(
        f"{name}: tau = {tau[name][0]:.2f} ± {tau[name][1]:.2f} for N_c = {SMALLEST} to {LARGEST}"
    )
    for low, high in ((3, 10), (10, 25), (25, 60)):
        part = mean_and_error(
            [fit_avalanches(each, smallest=low, largest=high).exponent for each in counts]
        )
        print(f"    {part[0]:.2f} ± {part[1]:.2f} for N_c = {low} to {high}")
        by_range[name].append(part[0])
    scatter = np.std([fit.exponent for fit in fits], ddof=1)
    print(f"    scatter of the runs {scatter:.3f}, one run claims {fits[0].exponent_error:.3f}")
    assert scatter > fits[0].exponent_error
    n = np.arange(SMALLEST, LARGEST + 1.0)
    law = n ** -tau[name][0]
    share = counts[:, SMALLEST - 1 : LARGEST].sum() / counts.sum()
    ax.plot(n, share * law / law.sum(), color=colour, linewidth=1.5)
ax.set(xscale="log", yscale="log", xlabel="avalanche size $N_c$", ylabel="probability $p(N_c)$")
ax.legend()
plt.show()
for exponents in by_range.values():
    assert exponents[0] < 2.2 < exponents[1] < exponents[2]

# %% [markdown]
# The lines are fits by **maximum likelihood** (`fit_avalanches`) to sizes 10 to 60, and not
# straight lines through logarithmic bins. A power law
# $p(N) = N^{-\tau}/\sum_{n} n^{-\tau}$ has the log-likelihood
# $-\tau\sum_j \ln N_j - J\ln\sum_n n^{-\tau}$ of $J$ avalanches; its maximum gives $\tau$.
#
# **Explain.** Avalanches come in all sizes up to a hundred. But the points bend all the way, and
# the further out one fits, the larger $\tau$: from 1.8 to 3.8 in the centre. One line from
# 10 to 60 gives about 3, but this is no power law. The paper quotes an exponent around $-2.2$ for
# 1000 rods. Here the chain is shorter, and the step matters too (exercise 3): an exponent without
# the range of its fit, and without the time step, says little.
#
# Note the error bars as well. The scatter between the runs is larger than the error
# that one run claims, because avalanches that meet share their future.

# %% [markdown]
# ## 6. What the time step does
#
# In a computer the noise comes in kicks, one per step $dt$, of the velocity $A\sqrt{dt}/m$. The step is
# long or short according to the ratio of this kick to the width, $r = (A\sqrt{dt}/m)/W_v$.
#
# **Rods in contact linger.** In the continuous chain the noise never pauses: two rods that have met come
# apart at once, and meet again and again. With one kick a step they stay in contact until the next kick,
# and half of all kicks only press them together. So they are in contact for too long, and rods in contact
# lose what the noise gives to their relative motion.
#
# We compute the same chain, at $e = 0$, in three ways.
#
# * **Euler's scheme**, `stepper="euler"`, is the paper's: a kick, then the rods fly and collide. The
#   velocities are taken right after the collisions. (The paper does not say when it took them.)
# * **Half kicks**: half a kick, flight and collisions, the other half. The velocities are taken between two
#   half kicks. `method="contact-dynamics"` does this, and at $e = 0$ its collisions are the exact ones
#   (notebook 2).
# * **The default** does the same with one correction. The noise that pulls rods in contact apart is made
#   1.224 times as strong: each kick is compared with the mean kick of the rods that are in contact, and its
#   difference from this mean is multiplied. The momentum stays as it was. The number is not fitted to any
#   chain. It follows from a single pair of rods: with it the times from one closing of their contact to the
#   next add up to those of the continuous chain.
#
# At $dt \to 0$ all three are the same.
#
# **Predict.** With a longer step, will $W_v$ in the centre be too small or too large, in each of the
# three? And in the elastic chain?
#
# **Run.** 100 rods, each step a quarter of the one before.

# %%
steps = np.array([0.1, 0.025, 0.00625, 0.0015625])
NAMES = ("Euler", "half kicks", "default")


def third_widths(runs):
    """Root mean square velocity of the middle third: more rods, less noise."""
    return [centre_width(run, share=1 / 3) for run in runs]


def at_steps(steps, **settings):
    """Return the widths of the middle third, shape (steps, runs)."""
    return np.array(
        [third_widths(independent_runs(sticky, 8, 1500, time_step=dt, **settings)) for dt in steps]
    )


widths = {
    "Euler": at_steps(steps, stepper="euler"),
    "half kicks": at_steps(steps[:3], method="contact-dynamics"),
    "default": at_steps(steps[:3]),
}
table = {name: np.transpose(mean_and_error(each.T)) for name, each in widths.items()}
elastic_runs = independent_runs(sticky.replace(restitution=1), 8, 1500, time_step=steps[0])
elastic = mean_and_error(third_widths(elastic_runs))
chosen = mean_and_error(third_widths(profiles[0]))
chosen_dt = json.loads(profiles[0][0].attrs["provenance"])["schedule"]["time_step"]
for name, rows in table.items():
    print(f"e = 0, {name}")
    for dt, (value, error) in zip(steps, rows, strict=False):
        print(f"    dt = {dt:g}: W_v = {value:.4f} ± {error:.4f}")
print(f"e = 0, the step that simulate chooses, {chosen_dt:.4f}: {chosen[0]:.4f} ± {chosen[1]:.4f}")
print(f"e = 1, default, dt = {steps[0]}: {elastic[0]:.4f} ± {elastic[1]:.4f}; exact {W:.4f}")

# %% [markdown]
# The error of Euler's scheme should vanish like $dt^{3/4}$. The argument: rods that have met come apart and
# meet again at random, and in a unit of time a contact closes about $dt^{-1/4}$ times (the shorter the step,
# the shorter the times apart that it can show). Each time it then stays closed for about $dt$ too long. So
# draw $W_v$ against $dt^{3/4}$, and extrapolate the three shortest steps to zero by a straight line.

# %%
euler, half_kicks, default = table.values()
(slope, limit), covariance = np.polyfit(
    steps[1:] ** 0.75, euler[1:, 0], 1, w=1 / euler[1:, 1], cov="unscaled"
)
limit_error = np.sqrt(covariance[1, 1])


def ratio(dt):
    """Return r, the velocity kick of one step over the width."""
    return sticky.amplitude / sticky.mass * np.sqrt(dt) / limit


fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
for (name, rows), colour, symbol in zip(
    table.items(), (ORANGE, PINK, BLUE), ("s", "^", "o"), strict=True
):
    x = steps[: len(rows)] ** 0.75
    ax.errorbar(x, *rows.T, fmt=symbol, color=colour, mfc="none", label=name)
ends = np.array([0, 0.07])
ax.plot(ends, limit + slope * ends, color=ORANGE, linewidth=1)
fine = np.linspace(0, 0.18, 200)
estimate = limit * (1 + 0.1 * ratio(fine ** (4 / 3)) ** 3)
ax.plot(fine, estimate, color=BLUE, linewidth=1, label="$W_v(1 + 0.1\\,r^3)$")
ax.errorbar(chosen_dt**0.75, *chosen, fmt="D", color=GREEN, label="default, step chosen")
ax.set(xlabel="$dt^{3/4}$ [T$^{3/4}$]", ylabel="central width $W_v$ [R/T]")
ax.legend(fontsize=9, loc="lower left")
plt.show()

print(f"Euler, extrapolated to dt = 0: {limit:.4f} ± {limit_error:.4f}")
for k, dt in enumerate(steps[:3]):
    off = [f"{name} {100 * (table[name][k, 0] / limit - 1):+.1f} %" for name in NAMES]
    print(f"dt = {dt:g}, r = {ratio(dt):.2f}: {', '.join(off)}")
gained, gained_error = mean_and_error(widths["default"][2] / widths["half kicks"][2] - 1)
print(f"the correction at dt = {steps[2]:g}: {100 * gained:+.2f} ± {100 * gained_error:.2f} %")
estimated = profiles[0][0].attrs["time_step_error"]
print(f"the step that simulate chooses: error by the result's own estimate {100 * estimated:.1f} %")
assert (np.diff(euler[:, 0]) > 0).all()
assert euler[-1, 0] < limit
for k in (0, 1):
    error = np.hypot(default[k, 1], limit_error)
    assert abs(default[k, 0] / limit - 1 - 0.1 * ratio(steps[k]) ** 3) < 5 * error / limit
assert default[0, 0] > limit + 5 * np.hypot(default[0, 1], limit_error)
assert gained > 5 * gained_error
assert abs(chosen[0] - limit) < 5 * np.hypot(chosen[1], limit_error)
assert abs(elastic[0] - W) < 5 * elastic[1]
assert estimated < 0.005

# %% [markdown]
# **Explain.** In **Euler's scheme** the centre is too cold, by 3 % even where the kick is a quarter of the
# width. The points lie on the line: the error falls like $dt^{3/4}$. A step four times shorter, four times
# the work, leaves a third of it.
#
# **Half kicks** have this error too, and another one of the other sign. The second half of the kick comes
# after the collisions. It adds $A^2dt/(2m^2)$ to $W_v^2$, the fraction $r^2/4$ to $W_v$. At a long step this
# is more than what is missing, at a short one less, and at some step in between the two cancel. Further
# down the width hardly changes with $dt$: in long runs it is 1.0 % too small at $dt = 0.025$ and 1.3 % at
# 0.00625. So to shorten the step, and to find the same, does not show that a result has converged.
#
# **In the default** the correction takes out the error in $dt^{3/4}$. At the same step the schemes are driven
# by the same random numbers, so the difference that it makes is known much better than either width. What is
# left is about $0.1\,r^3$ (the line): 10 % at $r = 1$, 1 % at 0.5. The elastic chain is right at any step.
#
# `simulate` chooses a step with $r \approx 0.3$. Every result off $e = 1$ carries the estimate
# $0.1\,r^3$ for its narrowest rod in `run.attrs["time_step_error"]`, 0.3 % here; for Euler's scheme and for
# Contact Dynamics this is $0.24\,r^{3/2}$. Above $e = 0.163$ rods do not stay in contact in this way, and
# the default corrects nothing; there the estimate is $0.06\,r^{3/2}$: at $e = 0.2$ and 0.3 the centre of
# 100 rods is 0.7 % too cold at the step that `simulate` chooses. A time-step study is part of any result
# about a dissipative chain.

# %% [markdown]
# **Does your result depend on $dt$?** Such a study by hand is one way to answer. `simulate_limit` is another:
# it runs the chain at a long step, and corrects it by differences between pairs of runs under the same noise,
# at this step and one nine times as short. Two such runs stay close to each other, so the difference is known
# well after a short time. What it returns is the limit $dt \to 0$, with one error bar for the statistics and for
# what is left of the time step.

# %%
vanishing = simulate_limit(sticky, accuracy=0.01, seed=1, observe="widths", progress=False)
for level in json.loads(vanishing.attrs["provenance"])["levels"]:
    print(
        f"dt = {level['time_step']:.4f}: {level['value']:+.4f} ± {level['error']:.4f} "
        f"from {level['duration']:.0f} time units"
    )
third, bar = centre_width(vanishing, share=1 / 3), 0.01 * limit
print(f"middle third as dt -> 0: {third:.4f}, by the straight line {limit:.4f} ± {limit_error:.4f}")
assert vanishing.attrs["coupling"] == "strong"
assert abs(third - limit) < 5 * np.hypot(bar, limit_error)

# %% [markdown]
# ## Exercises
#
# **1.** Show that the centre of mass does not know about collisions: measure $L\langle V^2\rangle$
# at $e = 0$, where $V$ is the mean velocity of the rods. (Take `observe="snapshots"`.)
#
# <details><summary>Solution</summary>
#
# ```python
# chain = Chain(size=30, restitution=0)
# film = simulate(chain, duration=20_000, every=1, observe="snapshots", progress=False)
# V = film.velocity.mean("particle")
# print(30 * float((V**2).mean()) / W**2)
# ```
#
# 0.98 with a statistical error of 0.02: $\langle V^2\rangle = W^2/L$, as for rods that never meet.
# </details>
#
# **2.** What becomes of the exponent $\nu$ if one leaves $c$ out, or weighs the rods by their error
# bars? Use `fit_border_power_law(run, shifted=False)` and `(run, weighted=True)` for all `runs_of`.
#
# <details><summary>Solution</summary>
#
# Without $c$: $-0.420 \pm 0.002$, $-0.425 \pm 0.003$, $-0.430 \pm 0.004$ for 30, 100 and 300 rods. The
# exponent is flatter by 0.02 to 0.03, and its error is smaller: $\nu$ and $c$ are correlated by 0.9
# (`fit.correlation`), so that a wrong $c$ goes with a wrong $\nu$. Weights change it by about its
# error here. In the long runs of 1000 rods they make it $-0.474(2)$ instead of $-0.458(2)$: another sign
# that there is no exact power law.
# </details>
#
# **3.** Repeat the avalanches with time steps four times longer and four times shorter. What does
# $\tau$ (origins in the centre, $N_c$ = 10 to 60) do?
#
# <details><summary>Solution</summary>
#
# $\tau = 2.52 \pm 0.05$ at $dt = 0.04$, $3.10 \pm 0.07$ at 0.01, $3.61 \pm 0.12$ at 0.0025. The
# shorter the step, the more often rods in contact are kicked and collide again (there are 3.6
# times as many avalanches at 0.0025 as at 0.04), and the sooner a wave meets such a collision and
# ends.
# </details>
#
# **4.** Fit the two power laws to the chain at $e = 0.95$, `profiles[0.95]`. Is the exponent
# the same as at $e = 0$?
#
# <details><summary>Solution</summary>
#
# It is not: $\nu = -0.68 \pm 0.04$ from three runs, against $-0.456 \pm 0.005$ at $e = 0$, and
# $c = -13 \pm 2$. The power laws begin thirteen rods outside the chain: its profile is much flatter at
# the border. The correlation of $c$ and $\nu$ is 0.99, and without $c$ one would get $-0.266$, a value
# on the other side of that at $e = 0$.
# </details>
