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
# **Question.** A hundred rods on springs are all shaken equally hard. When they meet they stick
# together instead of bouncing. Which of them move most, which least, and how little do they move?
#
# The chain is that of [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460).
# Between collisions rod $i$ obeys
#
# $$m\ddot x_i = -\gamma\dot x_i - k(x_i - x^0_i) + A\,\xi_i(t),$$
#
# with independent white noises $\xi_i$ of unit strength. A collision conserves momentum and gives
# $v_1' - v_2' = -e\,(v_1 - v_2)$. Lengths are in rod radii $R$, masses in $M$ (a rod has
# $m = 4\pi/3\,M$), and times in $T = \sqrt{M/k}$. In these units $\gamma = A = 1$. The rods touch
# when they sit at their anchors $x^0_i$. Without collisions the velocity of a rod is Gaussian with
# the width $W = A/\sqrt{2m\gamma}$ ([lesson 1](01_one_noisy_oscillator.ipynb)).
#
# *Level: third year. You need: lessons 1 and 2. Time: 120 minutes (sections 1 to 4: 60 minutes). To
# predict before you see the results, type `make lessons` in the folder of the project, and open the
# copy of this lesson without outputs in `build/lessons/`.*

# %% tags=["hide-input"]
import json
from collections import defaultdict

import matplotlib.pyplot as plt
import numpy as np
from teaching import BLUE, GREEN, ORANGE, PINK, agree, check, mean_and_error, panels, right

from crazybilliards.reproduction.fits import fit_avalanches, fit_scaling

# %%
import crazybilliards as cb

sticky = cb.Chain(size=100, restitution=0)
W = sticky.free_velocity_width
print(f"a free rod: W = {W:.4f} R/T")

# %% [markdown]
# ## 1. Three rods are enough
#
# **Predict.** Take one rod, then two, then three, at $e = 0$. A rod in a pair has one neighbour.
# In a row of three the middle rod has two. Which rod has the narrowest velocity distribution?
#
# **Run.** We measure the velocity width $W_v(i) = \sqrt{\langle v_i^2\rangle}$.

# %%
small = {}
for size in (1, 2, 3):
    few = sticky.replace(size=size)
    run = cb.simulate(few, duration=30_000, observe="widths", seed=3, progress=False)
    width, error = run.velocity_width.values / W, run.velocity_width_error.values / W
    print(f"{size} rod(s): W_v/W = {width.round(4)}, standard errors {error.round(4)}")
    small[size] = width, error

# %% tags=["remove-cell"]
agree("one rod", small[1][0], 1, small[1][1])
assert (small[2][0] < 1 - 5 * small[2][1]).all()
width, error = small[3]
difference = (width[0] + width[2]) / 2 - width[1]
assert difference > 5 * np.sqrt(error[1] ** 2 + (error[0] ** 2 + error[2] ** 2) / 4)

# %% [markdown]
# <details><summary>Explain</summary>
#
# The middle rod of three has the narrowest distribution, because it is hit from both sides. An
# outer rod is hit from one side only. It flies outward freely, and the noise has time to heat it
# until its spring brings it back.
#
# </details>
#
# **How much do collisions take?** In a steady state the energy of a rod balances. The noise puts in
# $A^2/2m$ per unit of time, and the damping takes out $\gamma\langle v^2\rangle$. The spring takes
# and gives back the same amount. Collisions take the rest.
#
# **Your turn.** Which share of the noise's power do collisions take from a rod with the velocity
# width `width`? Use $W^2 = A^2/(2m\gamma)$.


# %% tags=["remove-cell"]
def share_of_collisions(width):
    return 1 - (width / W) ** 2


power, damping = sticky.amplitude**2 / (2 * sticky.mass), sticky.damping
for width in (0.1, 0.3):
    assert right(share_of_collisions(width), (power - damping * width**2) / power)


# %%
def my_share(width):
    return ...  # your code here


check(my_share, share_of_collisions, at=[(W,), (0.1,)], hint="A free rod loses nothing: share 0.")

# %% [markdown]
# <details><summary>Solution</summary>
#
# $$\frac{A^2/2m - \gamma W_v^2}{A^2/2m} = 1 - \frac{W_v(i)^2}{W^2},$$
#
# so the line is `return 1 - (width / W) ** 2`. This is derived here, and it is exact.
#
# </details>
#
# **How small can the width become?** Suppose that $n$ rods move as one block. The block is one free
# oscillator. Its mass is the mass of all its rods together. The damping and the noise of every rod
# act on it. The noises of different rods are independent.
#
# **Your turn.** Which velocity width does a block of `n` rods have? Compute its mass, its damping
# and the amplitude of its noise from those of one rod, which are `sticky.mass`, `sticky.damping`
# and `sticky.amplitude`. Then use the width of a free oscillator, $A/\sqrt{2m\gamma}$.


# %% tags=["remove-cell"]
def width_of_block(n):
    return np.sqrt(n) * sticky.amplitude / np.sqrt(2 * n * sticky.mass * n * sticky.damping)


assert right(width_of_block, lambda n: W / np.sqrt(n), at=[(1,), (2,), (100,)])
heavy = {"mass": 4 * sticky.mass, "damping": 4 * sticky.damping, "amplitude": 2 * sticky.amplitude}
assert right(width_of_block(4), sticky.replace(**heavy).free_velocity_width)


# %%
def my_width_of_block(n):
    return ...  # your code here


check(
    my_width_of_block,
    width_of_block,
    at=[(2,), (100,)],
    hint="The squares of independent noises add: n noises have sqrt(n) times the amplitude of one. "
    "If your width does not depend on n, you have added the amplitudes.",
)

# %% [markdown]
# <details><summary>Solution</summary>
#
# The block has the mass $nm$, the damping $n\gamma$ and the noise amplitude $\sqrt n\,A$, so its
# width is $\sqrt n\,A/\sqrt{2\,nm\,n\gamma}=W/\sqrt n$. A larger block is slower, because the
# noises of its rods partly cancel.
#
# ```python
# def my_width_of_block(n):
#     mass, damping = n * sticky.mass, n * sticky.damping
#     amplitude = np.sqrt(n) * sticky.amplitude
#     return amplitude / np.sqrt(2 * mass * damping)
# ```
#
# </details>
#
# Collisions conserve momentum, so they do not change the motion of the centre of mass. At every $e$
# it moves like a block of all $L$ rods, with $\langle V^2\rangle = W^2/L$. If all rods moved as
# one, each would have $W_v = W/\sqrt L$. This is the smallest possible width (exercise 1). We call
# it the floor.
#
# ## 2. The profile
#
# **Predict.** What does $W_v(i)$ look like for 100 rods at $e = 0$, 0.5 and 0.95? At
# $e = 0.95$ a collision takes only a tenth of the energy of the relative motion. Will that chain
# be close to the elastic one?
#
# **Run.** First look at the velocities of all rods for a while. Time runs to the right, and every
# row is a rod.

# %%
films = {}
for e in (1, 0):
    one = sticky.replace(restitution=e)
    films[e] = cb.simulate(
        one, duration=64, every=0.25, observe="snapshots", seed=1, progress=False
    )

# %% tags=["hide-input"]
axes = panels(2, height=4, sharey=True)
for ax, (e, film) in zip(axes, films.items(), strict=True):
    time = film.time - film.time[0]
    v = film.velocity.isel(replica=0).transpose("particle", "time") / W
    colours = ax.pcolormesh(time, film.particle, v, cmap="PuOr", vmin=-2, vmax=2, rasterized=True)
    ax.set(xlabel="time t [T]", title=f"restitution e = {e}")
axes[0].set_ylabel("particle i")
axes[0].figure.colorbar(colours, ax=axes, label="velocity $v/W$")
plt.show()

# %% [markdown]
# Now average over time. The error bar of one rod, `velocity_width_error`, is right to 10 or 20 %.
# But neighbours move together, so the errors of neighbouring rods are not independent. A mean over
# rods and a fit to a profile are therefore less accurate than the error bars of single rods
# suggest. Their errors must come from the scatter between whole runs, so we make a few independent
# runs of each chain.


# %%
def independent_runs(chain, number, duration, **settings):
    """Return runs that differ in their random numbers only; 60 T are 7 relaxation times."""
    settings = {"duration": duration, "warmup": 60, "observe": "widths", **settings}
    return [cb.simulate(chain, seed=seed, progress=False, **settings) for seed in range(number)]


profiles = {
    0: independent_runs(sticky, 6, 1500),
    0.5: independent_runs(sticky.replace(restitution=0.5), 3, 500),
    0.95: independent_runs(sticky.replace(restitution=0.95), 3, 1000),
}


# %% tags=["hide-input"]
def centre_width(run, share=0.1):
    """Return the root mean square velocity of the middle rods: a tenth of them, at least two."""
    size = run.sizes["particle"]
    half = max(round(share * size / 2), 1)
    middle = slice(size // 2 - half, size - size // 2 + half)
    return float(np.sqrt((run.velocity_width[middle] ** 2).mean()))


left, right_panel = panels(2, height=3.8)
for (e, runs), colour, symbol in zip(profiles.items(), (BLUE, ORANGE, GREEN), "osD", strict=True):
    width, error = mean_and_error([run.velocity_width / W for run in runs])
    i = runs[0].particle
    left.errorbar(i, width, error, fmt=symbol, color=colour, mfc="none", ms=4, label=f"e = {e}")
    right_panel.plot(i, 100 * (1 - width**2), symbol, color=colour, mfc="none", ms=4)
    border, centre = np.mean(width[[0, -1]]), np.mean([centre_width(run) for run in runs]) / W
    print(
        f"e = {e}: W_v/W = {border:.3f} at the border, {centre:.3f} in the centre; "
        f"collisions take {100 * (1 - centre**2):.0f} % in the centre"
    )
    assert centre < border < 1
widths, stated = (
    np.array([run[name] for run in profiles[0]])
    for name in ("velocity_width", "velocity_width_error")
)
one_rod = np.sqrt(np.var(widths, axis=0, ddof=1).mean() / (stated**2).mean())
independent = np.sqrt((stated[:, 45:55] ** 2).mean() / 10)
ten_rods = np.std([centre_width(run) for run in profiles[0]], ddof=1) / independent
print("e = 0, scatter between runs over the stated error:")
print(f"    one rod {one_rod:.1f}, mean over ten rods as if they were independent {ten_rods:.1f}")
assert 0.7 < one_rod < 1.4 < ten_rods
left.axhline(1, color="k", linewidth=1, label="e = 1, exact")
left.axhline(1 / np.sqrt(100), color="0.4", linestyle=":", label=r"floor $1/\sqrt{L}$")
left.set(xlabel="particle i", ylabel="velocity width $W_v/W$", ylim=(0, 1.05))
left.legend(fontsize=9, loc="center", bbox_to_anchor=(0.5, 0.72), ncols=2)
right_panel.set(xlabel="particle i", ylabel="power that collisions take [%]", ylim=(0, 100))
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# The elastic chain moves equally fast everywhere. The chain at $e=0$ moves fast at its borders and
# slowly inside. Inside there are broad stripes: many rods have one velocity. The profile of
# $W_v(i)$ is therefore narrow inside and wide at both borders. Even at $e = 0.95$ the centre is far
# from elastic, because a rod collides so often in a damping time that small losses add up. The
# border depends on $e$ much less.
#
# </details>
#
# The profiles at $e = 0$ and 0.5 nearly coincide. To see why, divide the mean square velocity of a
# rod into two parts,
#
# $$\langle v_i^2\rangle = h + \Theta,\qquad h = \langle v_iv_{i+1}\rangle,\qquad
# \Theta = \tfrac12\langle(v_i - v_{i+1})^2\rangle .$$
#
# (Both rods have nearly the same $\langle v^2\rangle$.) The part $h$ is the motion that a rod shares
# with its neighbour, and $\Theta$ is the relative motion of the two.
#
# **Predict.** A collision takes all of the energy of the relative motion at $e = 0$, three quarters of
# it at 0.5, and a tenth at 0.95. Which of the two parts depends more on $e$? Which is the larger one?
#
# **Run.** We measure both parts in the centre.

# %%
parts = {}
for e in profiles:
    one = sticky.replace(restitution=e)
    run = cb.simulate(one, duration=3000, observe=["widths", "covariances"], seed=1, progress=False)
    middle = run.isel(particle=slice(45, 55), contact=slice(45, 54))
    whole = float((middle.velocity_width**2).mean()) / W**2
    shared = float(middle.neighbour_covariance.mean()) / W**2
    parts[e] = shared, whole - shared
    print(f"e = {e}: <v^2> = {whole:.4f} W^2, h = {shared:.4f} W^2, rest {whole - shared:.4f} W^2")

# %% tags=["remove-cell"]
(shared, relative), (shared_half, relative_half), (_, relative_elastic) = parts.values()
assert abs(shared_half / shared - 1) < 0.2
assert 1.1 < relative_half / relative < 1.5 < 8 < relative_elastic / relative
assert shared > 1.5 * relative

# %% [markdown]
# <details><summary>Explain</summary>
#
# A collision conserves $v_i + v_{i+1}$ and takes the fraction $1 - e^2$ of the energy that belongs to
# $v_i - v_{i+1}$. At $e = 0$ and 0.5 this fraction is 1 and 0.75, so $\Theta$ differs by a quarter only.
# And $\Theta$ is the smaller part, about a third of $\langle v_i^2\rangle$. The larger part $h$ is nearly
# the same in both chains. Because collisions conserve momentum, what they take from the squares of
# two rods becomes covariance of the two ([*Neighbours remember*](seminar_neighbours_remember.ipynb) shows this), and
# in both chains they take 95 % of the noise's power. Together $W_v$ differs by 2 %. At $e = 0.95$ a
# collision takes a tenth of the relative energy, and $\Theta$ is eleven times as large as at $e = 0$.
#
# </details>
#
# ## 3. Two power laws
#
# The paper fits $W_v(i)$ by a power law from either border (its equation `eq:power_law`),
#
# $$W_v(i) = a\,\big[(i - c)^{\,\nu} + (L + 1 - c - i)^{\,\nu}\big],$$
#
# and finds $\nu \approx -0.46$ at $e = 0$ for all $L$. The parameter $c$ says where the two power
# laws begin, which need not be at the first rod. `fit_border_power_law` fits this to all rods.
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
fits = {size: [cb.fit_border_power_law(run) for run in runs_of[size]] for size in (30, 100, 300)}
for size, each in fits.items():
    nu, nu_error = mean_and_error([fit.exponent for fit in each])
    c, c_error = mean_and_error([fit.origin for fit in each])
    print(f"L = {size}: nu = {nu:.3f} ± {nu_error:.3f}, c = {c:.2f} ± {c_error:.2f}")

# %% tags=["hide-input"]
ax = panels(width=7, height=4)
for (size, each), colour, symbol in zip(fits.items(), (BLUE, ORANGE, GREEN), "osD", strict=True):
    width, error = mean_and_error([run.velocity_width / W for run in runs_of[size]])
    shown = np.unique(np.geomspace(1, size, 40).round().astype(int))
    style = {"fmt": symbol, "color": colour, "mfc": "none", "ms": 5, "label": f"L = {size}"}
    ax.errorbar(shown, width[shown - 1], error[shown - 1], **style)
    fine = np.geomspace(1, size, 300)
    ax.plot(fine, np.mean([fit(fine) for fit in each], axis=0) / W, color=colour, linewidth=1)
    assert abs(np.mean([fit.exponent for fit in each]) + 0.46) < 0.05
ax.set(xscale="log", yscale="log", xlabel="particle i", ylabel="velocity width $W_v/W$")
ax.minorticks_off()
ax.set_yticks([0.15, 0.2, 0.3, 0.4, 0.6, 0.8], labels=["0.15", "0.2", "0.3", "0.4", "0.6", "0.8"])
ax.legend(title="symbols: simulation\nlines: two power laws")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# They nearly do. In a short chain the power law of the *other* border contributes as well, so the
# points of $L = 30$ lie highest. The exponents agree with the paper's within their errors, and they
# are the same for all three chains. The power laws begin somewhat outside the outermost rods ($c <
# 0$), and in longer chains further outside. Long runs of 30, 100, 300 and 1000 rods give $c =
# -0.22(1)$, $-0.30(2)$, $-0.49(3)$ and $-0.67(5)$, with $\nu = -0.449(2)$, $-0.449(2)$,
# $-0.458(3)$ and $-0.458(2)$. An exact law would have one $c$ for all lengths. The sum of two power
# laws therefore describes the profile very well, but it is not an exact law. Exercise 2 shows how
# $\nu$ changes if $c$ is left out.
#
# </details>
#
# ## 4. The centre
#
# **Predict.** If every rod moved with all the others, the central width would fall like $L^{-1/2}$,
# along the floor. If the power laws of section 3 held exactly, it would fall like $L^{\nu}$. Which
# of the two is it?
#
# **Run.**

# %%
sizes = np.array(list(runs_of))
table = [mean_and_error([centre_width(run) for run in runs]) for runs in runs_of.values()]
centre, centre_error = np.transpose(table)
scaling = fit_scaling(sizes, centre, centre_error)
print(f"exponent {scaling.exponent:.3f} ± {scaling.exponent_error:.3f}")
for size, value in zip(sizes, centre, strict=True):
    print(f"L = {size}: as slow as a block of {(W / value) ** 2:.1f} rods that move as one")

# %% tags=["hide-input"]
ax = panels(width=6)
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
assert abs(scaling.exponent + 0.38) < 0.03

# %% [markdown]
# <details><summary>Explain</summary>
#
# It is neither of the two: the exponent is $-0.38$, as in the paper. A block of $n$ rods that moves
# as one has the width $W/\sqrt n$ (section 1). So $n = (W/W_v)^2$ is the number of rods that a rod
# in the centre effectively moves with. It grows with $L$, but more slowly than $L$: the chain never
# becomes one block.
#
# </details>
#
# ## 5. Avalanches
#
# A push runs along the chain from rod to rod. The package follows such waves to the right with the
# following rule. When rod $i$ hits $i+1$ and their common momentum points right, a wave starts at
# the **origin** $i$, and its **front** is at $i + 1$. The next collision of the front decides. If
# it is with the right neighbour of the front, and the common momentum again points right, the front
# moves on. Otherwise the wave ends. Its size is the number of collisions, $N_c$ = last front -
# origin.
#
# This rule extends the paper's, which the package calls `"triggered-collisions"`. In the paper's
# rule every hit starts a wave, and rods that stick together pass nothing on.


# %%
def count_waves(collisions):
    """Return {origin: sizes of its waves that have ended}, by the rule above."""
    waves, ended = [], defaultdict(list)  # waves: (origin, front)
    for rod, points_right in collisions:  # rod hits rod + 1
        touched = [(origin, front) for origin, front in waves if front in (rod, rod + 1)]
        waves = [wave for wave in waves if wave not in touched]
        for origin, front in touched:
            if front == rod and points_right:
                waves.append((origin, rod + 1))
            else:
                ended[origin].append(front - origin)
        if points_right:
            waves.append((rod, rod + 1))
    return dict(ended)


# %% [markdown]
# **Predict.** Rod 1 hits 2, 2 hits 3, and 3 hits 4. Then 5 comes from the right and pushes 4 back.
# How many waves does the rule count, and how long are they?
#
# **Run.**

# %%
story = [(1, True), (2, True), (3, True), (4, False)]
print(count_waves(story))

# %% tags=["remove-cell"]
assert count_waves(story) == {1: [3], 2: [2], 3: [1]}

# %% [markdown]
# <details><summary>Explain</summary>
#
# One push makes three waves, because every collision on the way starts a wave of its own.
# Avalanches are therefore *not* independent of one another.
#
# </details>
#
# **Predict.** Is there a typical size of avalanches? Or is there none, as in a power law
# $p(N_c) \sim N_c^{-\tau}$?
#
# **Run.** We take 200 rods at a *fixed* time step of 0.01. Rods in contact are kicked anew in every
# step, so the count depends on the step (section 6).

# %%
two_hundred = sticky.replace(size=200)
settings = {"duration": 200, "time_step": 0.01, "observe": "avalanches", "progress": False}
waves = [cb.simulate(two_hundred, seed=seed, **settings).avalanche_count for seed in range(4)]
print(waves[0].dims, f"{sum(int(each.sum()) for each in waves):,} avalanches")

# %%
SMALLEST, LARGEST = 10, 60
origins = {"in the centre, 81 to 120": slice(81, 120), "at the border, 1 to 40": slice(1, 40)}
counts_of, tau = {}, defaultdict(dict)
for name, chosen in origins.items():
    counts = np.array([run.sel(particle=chosen).sum("particle").values for run in waves], float)
    for sizes in ((3, 10), (10, 25), (25, 60), (SMALLEST, LARGEST)):
        fits = [fit_avalanches(each, smallest=sizes[0], largest=sizes[1]) for each in counts]
        tau[name][sizes] = mean_and_error([fit.exponent for fit in fits])
    counts_of[name] = counts, fits

# %% tags=["hide-input"]
edges = np.unique(np.geomspace(1, 200, 22).round().astype(int))
middle = np.sqrt(edges[:-1] * (edges[1:] - 1))
ax = panels(width=7, height=4)
for (name, (counts, fits)), colour, symbol in zip(
    counts_of.items(), (BLUE, ORANGE), "os", strict=True
):
    binned = np.add.reduceat(counts, edges[:-1] - 1, axis=1) / np.diff(edges)
    p, error = mean_and_error(binned / counts.sum(axis=1, keepdims=True))
    seen = p > 0
    bars = np.minimum(error, 0.9 * p)[seen]
    style = {"fmt": symbol, "color": colour, "mfc": "none", "ms": 5, "label": f"origins {name}"}
    ax.errorbar(middle[seen], p[seen], bars, **style)
    n = np.arange(SMALLEST, LARGEST + 1.0)
    law = n ** -tau[name][SMALLEST, LARGEST][0]
    share = counts[:, SMALLEST - 1 : LARGEST].sum() / counts.sum()
    ax.plot(n, share * law / law.sum(), color=colour, linewidth=1.5)
    print(name)
    for (low, high), (exponent, error) in tau[name].items():
        print(f"    tau = {exponent:.2f} ± {error:.2f} for N_c = {low} to {high}")
    scatter = np.std([fit.exponent for fit in fits], ddof=1)
    print(f"    scatter of the runs {scatter:.3f}, one run claims {fits[0].exponent_error:.3f}")
    assert scatter > fits[0].exponent_error
    exponents = [exponent for exponent, _ in tau[name].values()]
    assert exponents[0] < 2.2 < exponents[1] < exponents[2]
ax.set(xscale="log", yscale="log", xlabel="avalanche size $N_c$", ylabel="probability $p(N_c)$")
ax.legend()
plt.show()

# %% [markdown]
# The lines are fits by **maximum likelihood** (`fit_avalanches`) to sizes 10 to 60. They are not
# straight lines through logarithmic bins. A power law $p(N) = N^{-\tau}/\sum_{n} n^{-\tau}$ has the
# log-likelihood $-\tau\sum_j \ln N_j - J\ln\sum_n n^{-\tau}$ for $J$ avalanches. Its maximum gives
# $\tau$.
#
# <details><summary>Explain</summary>
#
# There are avalanches of all sizes up to a hundred. But the points bend everywhere, and a fit to
# larger sizes gives a larger $\tau$: from 1.8 to 3.8 in the centre. One line from 10 to 60 gives
# about 3, but the distribution is no power law. The paper quotes an exponent around $-2.2$ for 1000
# rods. Here the chain is shorter, and the step matters as well (exercise 3). An exponent must
# therefore be quoted with the range of its fit and with the time step.
#
# The scatter between the runs is larger than the error that one run claims, because avalanches that
# meet go on and end together.
#
# </details>
#
# ## 6. What the time step does
#
# In a computer the noise comes in kicks, one per step $dt$, of the velocity $A\sqrt{dt}/m$. A step
# is long or short according to the ratio of this kick to the width, $r = (A\sqrt{dt}/m)/W_v$.
#
# **Rods stay in contact for too long.** In the continuous chain the noise never pauses. Two rods
# that have met separate at once, and meet again and again. With one kick per step they stay in
# contact until the next kick, and half of all kicks only press them together. They are therefore in
# contact for too long, and rods in contact lose what the noise gives to their relative motion.
#
# We compute the same chain, at $e = 0$, in three ways.
#
# * **Euler's scheme**, `stepper="euler"`, is the paper's. The rods are kicked, and then they fly
#   and collide. The velocities are taken right after the collisions. (The paper does not say when
#   it took them.)
# * **Half kicks**: half a kick, then flight and collisions, then the other half. The velocities are
#   taken between two half kicks. `method="contact-dynamics"` does this, and at $e = 0$ its
#   collisions are the exact ones ([lesson 3](03_collisions_and_restitution.ipynb)).
# * **The default** does the same with one correction. The noise that separates rods in contact is
#   made 1.224 times as strong. For this, each kick is compared with the mean kick of the rods that
#   are in contact, and its difference from this mean is multiplied. The momentum does not change.
#   The number is not fitted to any chain. It follows from a single pair of rods: with this factor
#   the times from one closing of their contact to the next add up to those of the continuous chain.
#
# For $dt \to 0$ all three are the same.
#
# **Predict.** With a longer step, will $W_v$ in the centre be too small or too large in each of the
# three? And in the elastic chain?
#
# **Run.** 100 rods, each step a quarter of the one before.


# %%
def third_widths(runs):
    """Return the root mean square velocity of the middle third: more rods, less noise."""
    return [centre_width(run, share=1 / 3) for run in runs]


def at_steps(steps, **settings):
    runs = [independent_runs(sticky, 8, 1500, time_step=dt, **settings) for dt in steps]
    return np.array([third_widths(each) for each in runs])  # (steps, runs)


steps = np.array([0.1, 0.025, 0.00625, 0.0015625])
widths = {
    "Euler": at_steps(steps, stepper="euler"),
    "half kicks": at_steps(steps[:3], method="contact-dynamics"),
    "default": at_steps(steps[:3]),
}

# %% tags=["hide-input"]
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
# The error of Euler's scheme should vanish like $dt^{3/4}$, by the following argument. Rods that
# have met separate and meet again at random. In a unit of time a contact closes about $dt^{-1/4}$
# times, because a shorter step resolves shorter separations. Each time it then stays closed for
# about $dt$ too long. We therefore draw $W_v$ against $dt^{3/4}$, and extrapolate the three shortest
# steps to zero by a straight line.

# %%
euler, half_kicks, default = table.values()
fit = np.polyfit(steps[1:] ** 0.75, euler[1:, 0], 1, w=1 / euler[1:, 1], cov="unscaled")
(slope, limit), limit_error = fit[0], np.sqrt(fit[1][1, 1])
print(f"Euler, extrapolated to dt = 0: {limit:.4f} ± {limit_error:.4f}")


def kick_over_width(dt):
    return sticky.amplitude / sticky.mass * np.sqrt(dt) / limit  # r


for k, dt in enumerate(steps[:3]):
    off = [f"{name} {100 * (rows[k, 0] / limit - 1):+.1f} %" for name, rows in table.items()]
    print(f"dt = {dt:g}, r = {kick_over_width(dt):.2f}: {', '.join(off)}")

# %% tags=["hide-input"]
ax = panels(width=7, height=4)
for (name, rows), colour, symbol in zip(
    table.items(), (ORANGE, PINK, BLUE), ("s", "^", "o"), strict=True
):
    x = steps[: len(rows)] ** 0.75
    ax.errorbar(x, *rows.T, fmt=symbol, color=colour, mfc="none", label=name)
ends = np.array([0, 0.07])
ax.plot(ends, limit + slope * ends, color=ORANGE, linewidth=1)
fine = np.linspace(0, 0.18, 200)
estimate = limit * (1 + 0.1 * kick_over_width(fine ** (4 / 3)) ** 3)
ax.plot(fine, estimate, color=BLUE, linewidth=1, label="$W_v(1 + 0.1\\,r^3)$")
ax.errorbar(chosen_dt**0.75, *chosen, fmt="D", color=GREEN, label="default, step chosen")
ax.set(xlabel="$dt^{3/4}$ [T$^{3/4}$]", ylabel="central width $W_v$ [R/T]")
ax.legend(fontsize=9, loc="lower left")
plt.show()
gained, gained_error = mean_and_error(widths["default"][2] / widths["half kicks"][2] - 1)
print(f"the correction at dt = {steps[2]:g}: {100 * gained:+.2f} ± {100 * gained_error:.2f} %")
estimated = profiles[0][0].attrs["time_step_error"]
print(f"the step that simulate chooses: error by the result's own estimate {100 * estimated:.1f} %")

# %% tags=["remove-cell"]
assert (np.diff(euler[:, 0]) > 0).all()
assert euler[-1, 0] < limit
for k in (0, 1):
    error = np.hypot(default[k, 1], limit_error) / limit
    agree("r^3", default[k, 0] / limit - 1, 0.1 * kick_over_width(steps[k]) ** 3, error)
assert default[0, 0] > limit + 5 * np.hypot(default[0, 1], limit_error)
assert gained > 5 * gained_error
agree("the chosen step", chosen[0], limit, np.hypot(chosen[1], limit_error))
agree("the elastic chain", elastic[0], W, elastic[1])
assert estimated < 0.005

# %% [markdown]
# <details><summary>Explain</summary>
#
# **In Euler's scheme** the central width is too small, by 3 % even where the kick is a quarter of
# the width. The points lie on the line, so the error falls like $dt^{3/4}$. A step four times
# shorter costs four times the work and leaves a third of the error.
#
# **Half kicks** have this error too, and another one of the opposite sign. The second half of the
# kick comes after the collisions. It adds $A^2dt/(2m^2)$ to $W_v^2$, which is the fraction $r^2/4$
# of $W_v$. At a long step this is more than the first error, at a short one less, and at some step
# in between the two cancel. At shorter steps the width hardly changes with $dt$: in long runs it is
# 1.0 % too small at $dt = 0.025$ and 1.3 % at 0.00625. It is therefore no sign of convergence when
# a shorter step gives the same result.
#
# **In the default** the correction removes the error in $dt^{3/4}$. The same random numbers drive
# both schemes at the same step, so the difference that the correction makes is known much better
# than either width. The remaining error is about $0.1\,r^3$ (the line): 10 % at $r = 1$, and 1 % at
# 0.5. The elastic chain is right at any step.
#
# </details>
#
# `simulate` chooses a step with $r \approx 0.3$. For $e\neq1$ every result carries the estimate
# $0.1\,r^3$ for its narrowest rod in `run.attrs["time_step_error"]`, which is 0.3 % here. For
# Euler's scheme and for Contact Dynamics the estimate is $0.24\,r^{3/2}$. Above $e = 0.163$ rods do
# not stay in contact in this way, and the default corrects nothing. There the estimate is
# $0.1\,(1 - e)\,r^{3/2}$: at $e = 0.2$ the central width of 100 rods is 0.9 % too small at the step
# that `simulate` chooses. Any result about a dissipative chain needs a study of the time step.
#
# **Does your result depend on $dt$?** Such a study by hand is one way to find out. `simulate_limit`
# is another. It chooses a step whose stated error is a quarter of the wanted accuracy, and runs the
# chain until the statistical error is small enough, too. A second run at twice the step checks the
# stated error. The error bar of the limit $dt \to 0$ contains both errors.

# %%
vanishing = cb.simulate_limit(sticky, accuracy=0.01, seed=1, observe="widths", progress=False)
change, error = (vanishing.attrs[f"double_step_change{end}"] for end in ("", "_error"))
print(f"at twice the step W_v in the centre changes by {change:+.1%} ± {error:.1%}")
third = centre_width(vanishing, share=1 / 3)
print(f"middle third as dt -> 0: {third:.4f}, by the straight line {limit:.4f} ± {limit_error:.4f}")

# %% tags=["remove-cell"]
assert abs(change) < 5 * error
agree("the limit", third, limit, np.hypot(0.01 * limit, limit_error))

# %% [markdown]
# ## Exercises
#
# **1.** Show that collisions do not change the motion of the centre of mass: measure $L\langle
# V^2\rangle$ at $e = 0$, where $V$ is the mean velocity of the rods. (Take `observe="snapshots"`.)
#
# <details><summary>Solution</summary>
#
# ```python
# chain = cb.Chain(size=30, restitution=0)
# film = cb.simulate(chain, duration=20_000, every=1, observe="snapshots", progress=False)
# V = film.velocity.mean("particle")
# print(30 * float((V**2).mean()) / W**2)
# ```
#
# prints 0.98 with a statistical error of 0.02: $\langle V^2\rangle = W^2/L$, as for rods that never
# meet.
#
# </details>
#
# **2.** How does the exponent $\nu$ change if $c$ is left out, or if the rods are weighted by their
# error bars? Use `cb.fit_border_power_law(run, shifted=False)` and `(run, weighted=True)` for all
# `runs_of`.
#
# <details><summary>Solution</summary>
#
# Without $c$ the exponents are $-0.420 \pm 0.002$, $-0.425 \pm 0.003$ and $-0.430 \pm 0.004$ for 30,
# 100 and 300 rods. They are flatter by 0.02 to 0.03, and their errors are smaller. The reason is
# that $\nu$ and $c$ are correlated by 0.9 (`fit.correlation`), so a wrong $c$ goes with a wrong
# $\nu$. Weights change $\nu$ by about its error here. In the long runs of 1000 rods they make it
# $-0.474(2)$ instead of $-0.458(2)$, which is another sign that there is no exact power law.
#
# </details>
#
# **3.** Repeat the avalanches with time steps four times longer and four times shorter. How does
# $\tau$ change (origins in the centre, $N_c$ = 10 to 60)?
#
# <details><summary>Solution</summary>
#
# $\tau = 2.52 \pm 0.05$ at $dt = 0.04$, $3.10 \pm 0.07$ at 0.01, and $3.61 \pm 0.12$ at 0.0025. With
# a shorter step rods in contact are kicked more often and collide again (there are 3.6 times as many
# avalanches at 0.0025 as at 0.04). A wave then meets such a collision sooner and ends.
#
# </details>
#
# **4.** Fit the two power laws to the chain at $e = 0.95$, `profiles[0.95]`. Is the exponent
# the same as at $e = 0$?
#
# <details><summary>Solution</summary>
#
# It is not: $\nu = -0.69 \pm 0.06$ from three runs, against $-0.456 \pm 0.005$ at $e = 0$, and
# $c = -14 \pm 2$. The power laws begin fourteen rods outside the chain, because its profile is much
# flatter at the border. The correlation of $c$ and $\nu$ is 0.99. Without $c$ the fit gives
# $-0.266$, which lies on the other side of the value at $e = 0$.
#
# </details>
