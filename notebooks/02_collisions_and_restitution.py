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
# # Collisions and restitution
#
# **Question.** Three equal rods on a line. Two are at rest and touch; the third one hits them.
# Nothing is lost: momentum and energy are the same before and after. What comes out?
#
# Two laws, two answers. Both are correct mechanics, as far as the conservation laws go:

# %%
import matplotlib.pyplot as plt
import numpy as np
from IPython.display import HTML
from matplotlib.animation import FuncAnimation
from matplotlib.patches import Rectangle
from scipy.optimize import isotonic_regression

from crazybilliards.comparison import standalone_page
from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate

COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9")


def film(chain, x, v, *, duration, every, time_step=None, **settings):  # x and v in time
    run = simulate(
        chain,
        start=given_start(chain, x, v),
        duration=duration,
        every=every,
        time_step=time_step or every,  # without springs any step will do
        average="ensemble",  # of one copy: its states at equal times, the first being the start
        observe="snapshots",
        progress=False,
        **settings,
    )
    return run.time.values, run.position.values[0], run.velocity.values[0]


def spacetime(ax, t, x):
    for i, centre in enumerate(x.T):
        colour = COLOURS[i % len(COLOURS)]
        ax.fill_betweenx(t, centre - 1, centre + 1, color=colour, alpha=0.75, linewidth=0)
    ax.set_xlabel("position x [R]")


# %%
free = {"amplitude": 0, "damping": 0, "stiffness": 0}  # no noise, no friction, no springs
cradle = Chain(size=3, **free)
x, v = cradle.anchors - [3.02, 0, 0], np.array([1.0, 0, 0])
methods = ("event-driven", "contact-dynamics")
fig, axes = plt.subplots(1, 2, figsize=(9, 3.4), sharex=True, sharey=True, layout="constrained")
after = {}
for ax, method in zip(axes, methods, strict=True):
    t, positions, velocities = film(cradle, x, v, duration=7, every=0.05, method=method)
    spacetime(ax, t, positions)
    ax.set_title(f'method="{method}"')
    after[method] = velocities[-1]
    print(f"{method:16s} velocities after: {after[method].round(6)}", end="; ")
    print(f"momentum {after[method].sum():.6f}, energy {np.sum(after[method] ** 2):.6f} m/2")
axes[0].set_ylabel("time t [T]")
plt.show()
# %%
assert np.allclose(after["event-driven"], [0, 0, 1])
assert np.allclose(after["contact-dynamics"], [-1 / 3, 2 / 3, 2 / 3])
for velocities in after.values():
    assert np.isclose(velocities.sum(), 1)
    assert np.isclose(np.sum(velocities**2), 1)

# %% [markdown]
# In these pictures time runs upwards, and a band is a rod, 2 R wide (R is the rod radius; T the
# time unit, velocities are in R/T). On the left is what a Newton's cradle does. The right is the
# answer of *Contact Dynamics*, the method of the paper ([Mani, Böttcher, Herrmann and
# Helbing](https://arxiv.org/abs/1404.7460)). This notebook explains both, and what happens when
# collisions do lose energy.
#
# ## 1. The collision law
#
# Two rods of equal mass meet with velocities $v_1 > v_2$. Momentum is conserved; the relative
# velocity is reversed and reduced by the **restitution** $e$:
#
# $$v_1'+v_2'=v_1+v_2,\qquad v_1'-v_2'=-e\,(v_1-v_2).$$
#
# With the mean $\bar v=\frac{v_1+v_2}2$ and the closing speed $\Delta v=v_1-v_2$ this gives
# $v_{1,2}'=\bar v\mp\frac e2\Delta v$. The energy in the relative motion is $\frac m4\Delta v^2$,
# so a collision takes
#
# $$\Delta E = \frac{1-e^2}{4}\,m\,\Delta v^2 .$$
#
# At $e=1$ nothing is lost, and the rods swap their velocities. At $e=0$ they go on together.
#
# ## 2. Take the rods' own length out
#
# A rod is an obstacle 2 R long, and that is all its length does. Subtract it:
#
# $$y_i = x_i - 2R\left(i-\tfrac{L+1}{2}\right).$$
#
# Velocities stay the same, and rods that touch ($x_{i+1}-x_i=2R$) have $y_{i+1}=y_i$. The rods
# have become **points that may meet but not pass**, $y_1\le y_2\le\dots\le y_L$. `Chain.reduced`
# and `Chain.physical` go there and back.
#
# Now write a simulation of your own. Points fly straight until the next two neighbours meet: find
# out when, go there, collide, repeat.


# %%
def billiard(y, v, e, duration):  # every collision in its order
    y, v, now = y.copy(), v.copy(), 0.0
    times, paths, collisions = [now], [y.copy()], []
    while True:
        closing, gap = v[:-1] - v[1:], np.diff(y)
        due = np.full(closing.size, np.inf)
        np.divide(gap, closing, out=due, where=closing > 0)
        i = np.argmin(due)  # the contact that closes next
        dt = min(max(due[i], 0), duration - now)
        now += dt
        y += v * dt
        times.append(now)
        paths.append(y.copy())
        if now >= duration:
            return np.array(times), np.array(paths), v, np.array(collisions)
        mean = (v[i] + v[i + 1]) / 2
        v[i], v[i + 1] = mean - e / 2 * closing[i], mean + e / 2 * closing[i]
        y[i + 1] = y[i]
        collisions.append(closing[i])


# %% [markdown]
# **Predict.** Twelve rods with random velocities at $e=1$. Draw them as rods in $x$ and as points
# in $y$. What will the second picture look like?
#
# **Run.**

# %%
rods = Chain(size=12, gap=1, **free)
rng = np.random.default_rng(5)
y = rods.reduced_anchors
v = rng.standard_normal(rods.size) - 0.25 * y
duration = 8.0

t, x, _ = film(rods, rods.physical(y), v, duration=duration, every=0.05, time_step=0.05)
times, paths, v_end, collisions = billiard(y, v, 1, duration)
fig, (left, right) = plt.subplots(1, 2, figsize=(10, 4), sharey=True, layout="constrained")
spacetime(left, t, x)
left.set(ylabel="time t [T]", title="rods: simulate")
for i in range(rods.size):
    right.plot(paths[:, i], times, color=COLOURS[i % 6])
right.set(xlabel="reduced position y [R]", title="points: our own billiard")
plt.show()
print(f"{len(collisions)} collisions")

# %%
flown = y + v * duration
assert np.allclose(paths[-1], np.sort(flown))
assert np.allclose(v_end, v[np.argsort(flown)])
assert np.allclose(paths[-1], rods.reduced(x[-1]))

# %% [markdown]
# **Explain.** The colours change places at every crossing, but the *lines* are straight: equal
# masses that swap velocities might as well pass through one another and swap names. So elastic
# rods need no search for collisions at all:
#
# > fly freely, $y_i+v_i t$, then **sort** the pairs $(y,v)$ by $y$.
#
# That is what `simulate` does at $e=1$, in a single pass per time step, however many collisions
# there are. The number of collisions is the number of pairs that are out of order before sorting:

# %%
inversions = sum(np.sum(flown[:i] > flown[i]) for i in range(rods.size))
print(f"{inversions} pairs out of order")
assert inversions == len(collisions)

# %% [markdown]
# ## 3. Rods that stick: e = 0
#
# At the other end, points that meet stay together. Again one can go from one collision to the
# next, clusters growing on the way.


# %%
def sticky(y, v, duration):
    y, v, members, left = y.copy(), v.copy(), np.ones(y.size, dtype=int), duration
    while y.size > 1:
        closing, due = v[:-1] - v[1:], np.full(y.size - 1, np.inf)
        np.divide(np.diff(y), closing, out=due, where=closing > 0)
        i = np.argmin(due)
        if due[i] > left:
            break
        left -= due[i]
        y += v * due[i]
        v[i] = np.average(v[i : i + 2], weights=members[i : i + 2])  # momentum
        members[i] += members[i + 1]
        y, v, members = (np.delete(each, i + 1) for each in (y, v, members))
    return np.repeat(y + v * left, members), np.repeat(v, members)


# %% [markdown]
# Is there a shortcut like sorting? A cluster moves with the mean velocity of its members, and it
# lies at the mean of where they would be without the collisions (momentum again: collisions do
# not change the mean position of a group that nobody else touches). So the final state has this
# form: cut the row $z_i=y_i+v_it$ into blocks, and replace every block by its mean, such that the
# means ascend. Which blocks? Pool two neighbours whenever they are in the wrong order, until none
# is. This is the **pool-adjacent-violators algorithm** (PAVA):


# %%
def pool_adjacent_violators(z):
    blocks = []  # mean and number of members
    for mean in z:
        members = 1
        while blocks and blocks[-1][0] > mean:
            left, others = blocks.pop()
            mean = (left * others + mean * members) / (others + members)
            members += others
        blocks.append((mean, members))
    return np.repeat([mean for mean, _ in blocks], [members for _, members in blocks])


# %% [markdown]
# Statisticians know the result as **isotonic regression**: the ascending row that is closest to
# $z$ in the sense of least squares. In mechanics: sticky points end at the *projection* of their
# free positions onto the allowed ones.
#
# **Predict.** Our clusters, our PAVA, scipy's isotonic regression, `simulate` in one single step,
# and `simulate` with Contact Dynamics: how many different answers?
#
# **Run.**

# %%
clusters, cluster_velocities = sticky(y, v, duration)
answers = {
    "PAVA": pool_adjacent_violators(flown),
    "scipy": isotonic_regression(flown).x,
}
glue = rods.replace(restitution=0)
for method in methods:
    _, x, _ = film(glue, glue.physical(y), v, duration=duration, every=duration, method=method)
    answers[f"simulate, {method}"] = glue.reduced(x[-1])
for name, answer in answers.items():
    print(f"{name:28s} differs from the clusters by {abs(answer - clusters).max():.0e} R")
    assert np.allclose(answer, clusters, atol=1e-12)

history = np.linspace(0, duration, 400)
lines = np.array([pool_adjacent_violators(y + v * now) for now in history])
fig, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for i in range(rods.size):
    left.plot(y[i] + v[i] * history, history, color="0.8", linewidth=1)
    left.plot(lines[:, i], history, color=COLOURS[i % 6])
left.set(xlabel="reduced position y [R]", ylabel="time t [T]", title="sticky points; grey: free")
left.set_xlim(-8, 8)
label = np.arange(1, rods.size + 1)
right.plot(label, flown, "o", color="0.5", label="free flight, z")
right.step(label, clusters, where="mid", color=COLOURS[0], label="clusters = isotonic regression")
right.set(xlabel="rod i", ylabel=f"y at t = {duration:g} T [R]")
right.legend()
plt.show()
# %% [markdown]
# **Explain.** One answer. Two things are worth a second thought. The picture of the clusters'
# whole history was drawn by regressions, one for each time, each straight from the start; no
# collision was followed. And a projection is unique, so at $e=0$ all laws agree, event by event
# or all at once. (With $z$ taken as velocities the same argument holds for long times: only the
# velocities decide who ends up with whom, exercise 4.)
#
# ## 4. In between
#
# The same twelve rods at three restitutions.
#
# **Predict.** The momentum is the same in all three. Which chain is the widest after a while?
#
# **Run.**

# %%
restitutions = (0, 0.5, 1)
films = {}
fig, axes = plt.subplots(1, 3, figsize=(10, 4), sharex=True, sharey=True, layout="constrained")
for ax, e in zip(axes, restitutions, strict=True):
    one = rods.replace(restitution=e)
    films[e] = film(one, one.physical(y), v, duration=duration, every=0.16, time_step=0.04)
    spacetime(ax, *films[e][:2])
    energy = np.sum(films[e][2] ** 2, axis=1)
    ax.set_title(f"e = {e}: {energy[-1] / energy[0]:.0%} of the energy left")
    assert np.isclose(films[e][2][-1].sum(), v.sum())
spans = [np.ptp(films[e][1][-1]) for e in restitutions]
assert spans == sorted(spans)
axes[0].set_ylabel("time t [T]")
plt.show()
# %%
fig, axes = plt.subplots(3, 1, figsize=(7, 2.4), sharex=True, layout="constrained", dpi=70)
patches = {}
for ax, e in zip(axes, restitutions, strict=True):
    patches[e] = [
        ax.add_patch(Rectangle((0, -1), 2, 2, color=COLOURS[i % 6])) for i in range(rods.size)
    ]
    ax.set(xlim=(-28, 28), ylim=(-1.6, 1.6), yticks=[], ylabel=f"e = {e}")
axes[-1].set_xlabel("position x [R]")


def show(frame):
    for e in restitutions:
        for patch, centre in zip(patches[e], films[e][1][frame], strict=True):
            patch.set_x(centre - 1)


animation = FuncAnimation(fig, show, frames=len(films[0][0]), interval=100)
plt.close(fig)
HTML(standalone_page(animation))

# %% [markdown]
# **Explain.** Elastic rods hand their velocities on, the whole energy stays, and they spread the
# most. With $e=0$ a few clusters fly apart that have nothing more to say to one another.
# $e=\frac12$ is nearer to sticking than to bouncing: rods that have just met meet again, and
# again.
#
# **Where did the energy go?** Count it collision by collision: each should take
# $\frac{1-e^2}4m\,\Delta v^2$, and nothing else should take any.

# %%
m = rods.mass
for e in (0.7, 0.9, 1, 1.1):
    _, _, v_end, closing = billiard(y, v, e, duration)
    lost = m / 2 * (np.sum(v**2) - np.sum(v_end**2))
    counted = np.sum((1 - e**2) / 4 * m * closing**2)
    _, _, simulated = film(
        rods.replace(restitution=e), rods.physical(y), v, duration=duration, every=duration
    )
    print(
        f"e = {e}: {len(closing):3d} collisions took {counted:8.4f}, gone are {lost:8.4f} M R²/T²"
    )
    assert np.isclose(counted, lost)
    assert np.allclose(simulated[-1], v_end)

# %% [markdown]
# Above $e=1$ collisions *add* energy: the paper's "flippers".
#
# ## 5. Newton's cradle, and what Contact Dynamics does
#
# Back to the question. With event-driven collisions the first rod swaps velocities with the
# second, which swaps with the third: a chain of two-rod collisions, all at the same instant, but
# *one after the other*.
#
# Contact Dynamics does not know any order. It takes all the contacts of a time step and solves
# for all impulses at once. The velocities $u$ after the step must satisfy, for every contact,
#
# $$u_{i+1}-u_i\ \ge\ b_i,\qquad \text{impulse}_i\ge 0,\qquad\text{one of the two an equality},$$
#
# where $b_i=e\,(v_i-v_{i+1})$ for a contact that closes within the step, and
# $b_i=-\mathrm{gap}_i/\Delta t$ for one that must just not overlap (0 if the rods touch). The
# impulses are those that bring $u$ as close to $v$ as the inequalities allow. That is a
# projection once more, and isotonic regression solves it: with $B_i=b_1+\dots+b_{i-1}$ the
# inequalities say that $u_i-B_i$ ascends.
#
# **Predict.** For the cradle, $v=(1,0,0)$ and $b=(1,0)$. Compute $u$ by hand.
#
# **Run.**


# %%
def contact_dynamics(v, e):  # for rods in contact, all of them
    B = np.concatenate([[0], np.cumsum(e * np.maximum(v[:-1] - v[1:], 0))])
    return pool_adjacent_violators(v - B) + B


for size in (3, 5):
    hit = np.eye(size)[0]
    chain = Chain(size=size, **free)
    ends = {}
    for method in methods:
        _, _, velocities = film(chain, chain.anchors, hit, duration=1, every=1, method=method)
        ends[method] = velocities[-1]
        print(f"{size} rods, {method:16s}: {np.round(velocities[-1], 4)}")
    ours = billiard(np.zeros(size), hit, 1, 1)[2]
    assert np.allclose(ends["event-driven"], ours)
    assert np.allclose(ends["event-driven"], hit[::-1])
    assert np.allclose(ends["contact-dynamics"], contact_dynamics(hit, 1))
    assert np.allclose(
        contact_dynamics(hit, 1), np.append((2 - size) / size, [2 / size] * (size - 1))
    )

# %% [markdown]
# **Explain.** $v-B=(1,-1,-1)$ is pooled into one block of mean $-\frac13$, and $u=-\frac13+B=
# (-\frac13,\frac23,\frac23)$. With $L$ rods, $u=(\frac{2-L}L,\frac2L,\dots,\frac2L)$: the elastic
# collision of one rod with a *rigid* body of $L-1$ rods. No rod in it has time to notice that it
# is made of several. Momentum and energy are conserved; the conservation laws alone do not decide
# between the two.
#
# Both describe idealisations. Order is what decides: if there is the least space between the
# rods, one collision comes after the other. Put a gap between them and shorten the time step:

# %%
gap = 0.1
chain = Chain(size=3, gap=gap, **free)
print("time step [T]   velocities after Contact Dynamics, energy [m/2]")
ends = {}
for dt in (1, 0.5, 0.2, 0.08, 0.02):
    _, _, velocities = film(
        chain, chain.anchors, hit[:3], duration=4, every=1, time_step=dt, method="contact-dynamics"
    )
    ends[dt] = velocities[-1]
    print(f"{dt:13g}   {ends[dt].round(4)}, {np.sum(ends[dt] ** 2):.3f}")
assert np.allclose(ends[0.08], [0, 0, 1])
assert np.allclose(ends[0.02], [0, 0, 1])
assert max(np.sum(ends[dt] ** 2) for dt in (1, 0.5, 0.2)) < 0.95

# %% [markdown]
# As soon as a step sees one contact at a time, Contact Dynamics is right. With longer steps it
# even loses energy at $e=1$: the contact between the second and the third rod must not overlap at
# the end of the step, but it was not closing at its beginning, so there is no velocity that
# restitution could give back. In a chain of many rods that lie close together, the step would
# have to be shorter than the shortest time between two collisions, and that is why the package
# computes collisions in their order by default and keeps Contact Dynamics for comparison with the
# paper. At $e=0$, the paper's main case, the two agree.
#
# ## 6. Inelastic collapse
#
# With $0<e<1$ there is a trap. Drop a ball: bounce after bounce takes $e$ times as long as the
# one before, infinitely many of them fit into a finite time, $1+e+e^2+\dots=1/(1-e)$, and then
# the ball lies still. Rods can do this to one another without gravity.
#
# Three rods, the outer two pushing towards the middle one. Let $a$ be the closing speed of the
# contact that collides and $b$ that of the other one (negative: it opens). The collision makes
#
# $$a\to-e\,a,\qquad b\to b+\tfrac{1+e}2a,$$
#
# and then the two contacts change parts. Closing speeds $a_n$ of successive collisions therefore
# obey
#
# $$a_{n+1}=\tfrac{1+e}{2}\,a_n-e\,a_{n-1},\qquad a_n\sim\lambda^n,\qquad
# \lambda^2-\tfrac{1+e}2\lambda+e=0 .$$
#
# Complex $\lambda=\sqrt e\,e^{\pm i\theta}$ with $\cos\theta=\frac{1+e}{4\sqrt e}$: $a_n$
# oscillates, and when it turns negative the rods separate; that takes at most $\pi/\theta$
# collisions, rounded up. Real $\lambda$: it need not turn negative, ever. The border is
# $(1+e)^2=16e$, $e_c=7-4\sqrt3=0.0718$.
#
# **Predict.** At $e=1$, $\theta=\pi/3$: three rods collide at most three times, which you can see
# in pictures of three crossing lines. How many collisions can there be at $e=0.1$? At $e=0.08$?
# At $e=0.05$?
#
# **Run.** We follow gaps and closing speeds, not positions: the gaps get far too small to be
# differences of positions.


# %%
def three_rods(e, gaps, closing, most):  # durations between collisions, closing speeds
    gaps, closing, waits, speeds = list(gaps), list(closing), [], []
    while len(waits) < most:
        due = [g / c if c > 0 else np.inf for g, c in zip(gaps, closing, strict=True)]
        i = int(due[1] < due[0])
        if due[i] == np.inf:
            break
        waits.append(due[i])
        speeds.append(closing[i])
        gaps[1 - i] -= closing[1 - i] * due[i]
        gaps[i] = 0.0
        closing[1 - i] += (1 + e) / 2 * closing[i]
        closing[i] *= -e
    return np.array(waits), np.array(speeds)


critical = 7 - 4 * np.sqrt(3)
directions = np.geomspace(1e-4, 3, 300)  # of the start, in the plane of the two closing speeds
values = np.concatenate([[0.0725, 0.074, 0.08, 0.085, 0.1, 0.12], np.linspace(0.15, 1, 18)])
most_seen = []
for e in values:
    counts = [len(three_rods(e, (0, 1), (np.sin(u), np.cos(u)), 1000)[0]) for u in directions]
    most_seen.append(max(counts))
theta = np.arccos((1 + values) / (4 * np.sqrt(values)))
bound = np.ceil(np.pi / theta - 1e-9)
waits, speeds = three_rods(0.05, (0.1, 1), (1, 1), 40)

fig, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
fine = np.linspace(critical + 1e-4, 1, 2000)
fine_bound = np.ceil(np.pi / np.arccos((1 + fine) / (4 * np.sqrt(fine))) - 1e-9)
left.semilogy(fine, fine_bound, color=COLOURS[1], label=r"$\pi/\theta$, rounded up")
left.plot(values, most_seen, "o", color="black", label="most seen in 300 starts")
left.axvline(critical, color=COLOURS[4], linestyle="--", label="$e_c = 0.0718$")
left.set(xlabel="restitution e", ylabel="collisions of three rods", xlim=(0, 1))
left.set_yticks([3, 5, 10, 20, 50], ["3", "5", "10", "20", "50"])
left.legend()
n = np.arange(1, len(waits) + 1)
right.semilogy(n, speeds, "o", color=COLOURS[0], label="closing speed [R/T]")
right.semilogy(n, waits, "^", color=COLOURS[4], label="time since the last one [T]")
right.set(xlabel="number of the collision", title="e = 0.05")
right.legend()
plt.show()
# %%
large, small = np.sort(np.roots([1, -(1 + 0.05) / 2, 0.05]))[::-1]
print(f"e = 0.05: lambda = {large:.3f} and {small:.3f};", end=" ")
print(f"speeds fall by {speeds[-1] / speeds[-2]:.4f}, times by {waits[-1] / waits[-2]:.4f}")
print(f"40 collisions after {waits.sum():.6f} T; the last ten took {waits[-10:].sum():.0e} T")
assert dict(zip(values, most_seen, strict=True))[0.1] == 7
assert dict(zip(values, most_seen, strict=True))[0.08] == 11
assert np.all(most_seen <= bound)
assert np.mean(most_seen == bound) > 0.9
assert len(waits) == 40  # as many as we asked for
assert np.isclose(speeds[-1] / speeds[-2], large)
assert np.isclose(waits[-1] / waits[-2], small / large)

# %% [markdown]
# **Explain.** Seven at $e=0.1$, eleven at 0.08; below $e_c$ the number has no bound. At $e=0.05$
# every collision is at 0.4 times the speed of the last one and comes after 0.3125 times its
# waiting time: a geometric series, as with the ball. A program that takes collisions one at a
# time will never get past that instant. With more rods the same happens at larger $e$.
#
# **The way out.** Physically, nothing happens any more: the rods move together. So let them. In
# `simulate`, a pair that would separate more slowly than `merging` (0.03) times the velocity kick
# of one step's noise becomes a *cluster* that moves as one until the end of the step; the next
# kick may tear it apart. Each collision that does not merge then costs at least a fixed amount of
# energy, so there are finitely many. (Without noise the limit is a billionth of the typical
# speed.)
#
# **Predict.** Make `merging` much smaller and much larger, in a chain with noise, friction and
# springs. What changes: the number of collisions, the velocities, both?
#
# **Run.**

# %%
noisy = Chain(size=50, restitution=0.2)
print("merging   collisions per rod and T   velocity width in the centre [R/T]")
table = {}
for merging in (1e-6, 0.003, 0.03, 0.1, 1):
    run = simulate(
        noisy,
        duration=800,
        merging=merging,
        observe=["widths", "collisions"],
        seed=8,
        progress=False,
    )
    rate = run.collision_rate.sum().item() / noisy.size
    centre = run.velocity_width.sel(particle=[25, 26]).mean().item()
    error = run.velocity_width_error.sel(particle=[25, 26]).mean().item()
    table[merging] = rate, centre, error
    print(f"{merging:7g}   {rate:25.1f}   {centre:.4f} ± {error:.4f}")
for _, centre, error in table.values():
    assert abs(centre - table[0.03][1]) < 5 * np.hypot(error, table[0.03][2])
assert table[1e-6][0] > 3 * table[0.03][0] > 5 * table[1][0]

# %% [markdown]
# **Explain.** The number of collisions is a matter of definition: of infinitely many, one counts
# those above a threshold. The velocities do not care where the threshold lies: from 13 to 77
# collisions per rod and time, and always the same width. (The time step changes the count as well,
# and a long one the width: section 6 of the next notebook.)
#
# ## Exercises
#
# **1. Two rods at once.** Five rods in contact, $v=(1,1,0,0,0)$, $e=1$. What comes out, event by
# event and with Contact Dynamics? Then let $e=0.9$ and one rod hit, event by event.
#
# <details><summary>Solution</summary>
#
# Event by event $(0,0,0,1,1)$: two go in, two come out. Contact Dynamics:
# $(-\frac15,-\frac15,\frac45, \frac45,\frac45)$, two bodies of two and three rods. Try
# `contact_dynamics(v, 1)` and `billiard(np.zeros(5), v, 1, 1)`. With $e=0.9$ and one rod hitting
# there are ten collisions, all at the same instant, and $(0.0435, 0.0454, 0.0473, 0.0493,
# 0.8145)$ comes out: the last rod flies off, the others follow slowly.
# </details>
#
# **2. One collision more.** What is the largest restitution at which three rods can collide four
# times? Ten times?
#
# <details><summary>Solution</summary>
#
# $n$ collisions need $\pi/\theta>n-1$, that is $\frac{1+e}{4\sqrt e}>\cos\frac\pi{n-1}$. For
# $n=4$ this says $1+e>2\sqrt e$, true for every $e$ below 1 (only not at $e=1$ itself). For
# $n=10$ solve the quadratic equation for $\sqrt e$: $e<0.0830$.
# </details>
#
# **3. Collapse with more rods.** Let `billiard` collide rods that start evenly spaced and all fly
# towards the middle, $v=-y$ plus a little randomness, at $e=0.6$. Add a limit on the number of
# collisions, and find out how many rods it takes until they collide more than ten thousand times.
#
# <details><summary>Solution</summary>
#
# With `y = np.arange(L) - (L - 1) / 2` and `v = -y + 0.1 * rng.standard_normal(L)`, four random
# numbers each: 84 to 117 collisions of 10 rods, 319 to 462 of 12, 1311 to 2188 of 13, and with 14
# it does not end (10 000 and counting). Elastic rods would have at most $L(L-1)/2=91$.
# </details>
#
# **4. How many clusters fly apart?** A hundred sticky points start close together with random,
# independent velocities. After a long time they form clusters: how many, on average?
#
# <details><summary>Solution</summary>
#
# After a long time $y_i+v_it$ is as good as $v_it$, so count the blocks of the regression of the
# velocities themselves:
#
# ```python
# draws = np.random.default_rng(9).standard_normal((2000, 100))
# np.mean([np.unique(pool_adjacent_violators(v)).size for v in draws])
# ```
#
# gives 5.22 (± 0.04). For independent values of whatever distribution the mean is
# $1+\frac12+\frac13+\dots+\frac1{L}$ (a theorem of Sparre Andersen), 5.19 for $L=100$. It grows
# like $\ln L$: a million rods end in 14 clusters.
# </details>
