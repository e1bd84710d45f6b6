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
# **Question.** Three equal rods lie on a line. Two are at rest and touch. The third one hits them.
# Momentum and energy are the same before and after. Which velocities come out?
#
# The conservation laws alone do not decide this. The package has two collision laws, and this
# lesson explains both: event-driven collisions, and *Contact Dynamics*, the method of the paper
# ([Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460)). It then explains what
# happens when collisions lose energy.
#
# *Level: second year. You need: momentum and energy, numpy; no other lesson. Time: 75 minutes, and
# 50 minutes more for sections 5 and 6, which are optional. To predict before you see the results,
# type `make lessons` in the folder of the project, and open the copy of this lesson without outputs
# in `build/lessons/`.*

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle
from scipy.optimize import isotonic_regression
from teaching import COLOURS, RED, agree, check, panels, played, right


def film(chain, x, v, *, duration, every, time_step=None, **settings):
    """Simulate from positions x and velocities v; return times, positions, velocities."""
    run = cb.simulate(
        chain,
        start=cb.given_start(chain, x, v),
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
    """Draw rods as bands, 2 R wide, with time upwards."""
    for i, centre in enumerate(x.T):
        colour = COLOURS[i % len(COLOURS)]
        ax.fill_betweenx(t, centre - 1, centre + 1, color=colour, alpha=0.75, linewidth=0)
    ax.set_xlabel("position x [R]")


# %% [markdown]
# Here R is the rod radius, T the time unit, and velocities are in R/T. `film` is a short helper: it
# calls `simulate` with a given start and returns times, positions and velocities.
#
# **Predict.** The first rod has the velocity 1. What are the three velocities after the collision?
#
# **Run.** In the pictures time runs upwards, and a band is a rod, 2 R wide.

# %%
import crazybilliards as cb

free = {"amplitude": 0, "damping": 0, "stiffness": 0}  # no noise, no friction, no springs
cradle = cb.Chain(size=3, **free)
x, v = cradle.anchors - [3.02, 0, 0], np.array([1.0, 0, 0])
methods = ("event-driven", "contact-dynamics")
films = {method: film(cradle, x, v, duration=7, every=0.05, method=method) for method in methods}

# %% tags=["hide-input"]
axes = panels(2, width=9, height=3.4, sharex=True, sharey=True)
after = {}
for ax, method in zip(axes, methods, strict=True):
    t, positions, velocities = films[method]
    spacetime(ax, t, positions)
    ax.set_title(f'method="{method}"')
    after[method] = velocities[-1]
    print(f"{method:16s} velocities after: {after[method].round(6)}", end="; ")
    print(f"momentum {after[method].sum():.6f}, energy {np.sum(after[method] ** 2):.6f} m/2")
axes[0].set_ylabel("time t [T]")
plt.show()

# %% tags=["remove-cell"]
assert np.allclose(after["event-driven"], [0, 0, 1])
assert np.allclose(after["contact-dynamics"], [-1 / 3, 2 / 3, 2 / 3])
for velocities in after.values():
    assert np.isclose(velocities.sum(), 1)
    assert np.isclose(np.sum(velocities**2), 1)

# %% [markdown]
# The left picture shows what a Newton's cradle does. The right one shows the answer of Contact
# Dynamics. Both conserve momentum and energy. Section 5 explains where the difference comes from.
#
# ## 1. The collision law
#
# Two rods of equal mass meet with velocities $v_1 > v_2$. Momentum is conserved. The relative
# velocity is reversed and multiplied by the **restitution** $e$:
#
# $$v_1'+v_2'=v_1+v_2,\qquad v_1'-v_2'=-e\,(v_1-v_2).$$
#
# **Your turn.** Solve these two equations for the velocities after the collision.


# %% tags=["remove-cell"]
def collide(v1, v2, e):
    mean, closing = (v1 + v2) / 2, v1 - v2
    return mean - e / 2 * closing, mean + e / 2 * closing


pairs = [(1.0, 0.0, 1.0), (2.0, -1.0, 0.0), (1.0, 0.5, 0.5)]
assert right(lambda v1, v2, e: (v2, v1), collide, at=pairs[:1])
for v1, v2, e in pairs:
    new_1, new_2 = collide(v1, v2, e)
    assert np.isclose(new_1 + new_2, v1 + v2)
    assert np.isclose(new_1 - new_2, -e * (v1 - v2))


# %%
def my_collision(v1, v2, e):
    return ...  # your code here: the two velocities after the collision


check(
    my_collision,
    collide,
    at=pairs,
    hint="Add both equations; then subtract them. At e = 1 the velocities (1, 0) become (0, 1). "
    "With a wrong sign of e they stay (1, 0), as if the rods had passed through each other.",
)

# %% [markdown]
# <details><summary>Solution</summary>
#
# With the mean $\bar v=\frac{v_1+v_2}2$ and the closing speed $\Delta v=v_1-v_2$ the result is
# $v_{1,2}'=\bar v\mp\frac e2\Delta v$.
#
# ```python
# def my_collision(v1, v2, e):
#     mean, closing = (v1 + v2) / 2, v1 - v2
#     return mean - e / 2 * closing, mean + e / 2 * closing
# ```
#
# </details>
#
# At $e=1$ the rods swap their velocities. At $e=0$ they move on together.
#
# **How much energy does a collision take?** At $e<1$ it turns a part of the kinetic energy into
# heat. Look at the two rods from their centre of mass, which moves with the velocity
# $\frac{v_1+v_2}2$. The collision does not change this velocity, so it can only take energy from
# the motion that you see from there.
#
# **Your turn.** Compute the energy that a collision takes from two rods of mass $m$ that meet with
# the closing speed $\Delta v=v_1-v_2$. First write down their two velocities as seen from the
# centre of mass.


# %% tags=["remove-cell"]
def energy_taken(closing, e, m):
    return (1 - e**2) / 4 * m * closing**2


meetings = [(1.0, 0.0, 1.0), (3.0, 0.5, 2.0), (2.0, 1.0, 1.0), (1.5, 0.9, 4.0)]
for closing, e, m in meetings:
    before, after = np.array([0.7 + closing, 0.7]), np.array(collide(0.7 + closing, 0.7, e))
    assert np.isclose(m / 2 * np.sum(before**2 - after**2), energy_taken(closing, e, m))
assert not right(lambda closing, e, m: -energy_taken(closing, e, m), energy_taken, at=meetings)


# %%
def my_energy_taken(closing, e, m):
    return ...  # your code here: the kinetic energy before, minus that after the collision


check(
    my_energy_taken,
    energy_taken,
    at=meetings,
    hint="Before the collision the velocities are +closing/2 and -closing/2, afterwards e times as "
    "large. For e < 1 the answer is positive: with a wrong sign the rods would gain energy.",
)

# %% [markdown]
# <details><summary>Solution</summary>
#
# Seen from the centre of mass, the rods have the velocities $\pm\frac12\Delta v$ before the
# collision and $\mp\frac e2\Delta v$ after it. Each of them has lost
# $\frac m2\big(\frac{\Delta v}2\big)^2(1-e^2)$, so the collision takes
#
# $$\Delta E = \frac{1-e^2}{4}\,m\,\Delta v^2 .$$
#
# ```python
# def my_energy_taken(closing, e, m):
#     before = 2 * m / 2 * (closing / 2) ** 2
#     after = 2 * m / 2 * (e * closing / 2) ** 2
#     return before - after
# ```
#
# </details>
#
#
# ## 2. Take the rods' own length out
#
# A rod is an obstacle of length 2 R. Its length has no other effect. Subtract it:
#
# $$y_i = x_i - 2R\left(i-\tfrac{L+1}{2}\right).$$
#
# The velocities stay the same, and rods that touch ($x_{i+1}-x_i=2R$) have $y_{i+1}=y_i$. The rods
# have become **points that may meet but not pass**, $y_1\le y_2\le\dots\le y_L$. `Chain.reduced`
# and `Chain.physical` convert in the two directions.
#
# Now write a simulation of your own. Points fly straight until the next two neighbours meet. Find
# the time of this contact, move all points to it, collide the two, and repeat.


# %%
def next_contact(y, v):
    """Return which gap closes next, and how long this takes."""
    closing = v[:-1] - v[1:]
    due = np.full(closing.size, np.inf)
    np.divide(np.diff(y), closing, out=due, where=closing > 0)
    return np.argmin(due), max(due.min(), 0)


# %%
def billiard(y, v, e, duration):
    y, v, now = y.copy(), v.copy(), 0.0
    times, paths, closing = [now], [y], []
    while True:
        i, wait = next_contact(y, v)
        step = min(wait, duration - now)
        now, y = now + step, y + v * step
        times.append(now)
        paths.append(y.copy())
        if step < wait:
            return np.array(times), np.array(paths), v, np.array(closing)
        closing.append(v[i] - v[i + 1])
        v[i], v[i + 1] = collide(v[i], v[i + 1], e)
        y[i + 1] = y[i]


# %% [markdown]
# **Predict.** Take twelve rods with random velocities at $e=1$. Draw them as rods in $x$ and as
# points in $y$. What will the second picture look like?
#
# **Run.**

# %%
rods = cb.Chain(size=12, gap=1, **free)
y = rods.reduced_anchors
v = np.random.default_rng(5).standard_normal(rods.size) - 0.25 * y
duration = 8.0
t, x, _ = film(rods, rods.physical(y), v, duration=duration, every=0.05)
times, paths, v_end, closing = billiard(y, v, 1, duration)
print(f"{len(closing)} collisions")

# %% tags=["hide-input"]
left, right_panel = panels(2, height=4, sharey=True)
spacetime(left, t, x)
left.set(ylabel="time t [T]", title="rods: simulate")
for i in range(rods.size):
    right_panel.plot(paths[:, i], times, color=COLOURS[i % 6])
right_panel.set(xlabel="reduced position y [R]", title="points: our own billiard")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# The colours change at every crossing, but the *lines* are straight. Equal masses that swap
# velocities move like points that pass through one another and then swap names.
#
# </details>
#
# Elastic rods therefore need no search for collisions. Let the points fly freely to $y_i+v_i t$,
# then **sort** the pairs $(y,v)$ by $y$. This is what `simulate` does at $e=1$, in one pass per time
# step, however many collisions there are. Each collision swaps two neighbours, so the number of
# collisions is the number of pairs that are out of order before the sorting.

# %%
flown = y + v * duration
order = np.argsort(flown)
print("largest difference from the billiard:", abs(flown[order] - paths[-1]).max(), "R")
print(sum(np.sum(flown[:i] > flown[i]) for i in range(rods.size)), "pairs are out of order")

# %% tags=["remove-cell"]
assert np.allclose(paths[-1], np.sort(flown))
assert np.allclose(v_end, v[order])
assert np.allclose(paths[-1], rods.reduced(x[-1]))
assert sum(np.sum(flown[:i] > flown[i]) for i in range(rods.size)) == len(closing)

# %% [markdown]
# ## 3. Rods that stick: e = 0
#
# At $e=0$ points that meet stay together. A simulation can again go from one collision to the next,
# while clusters grow.


# %%
def sticky(y, v, duration):
    members = np.ones(y.size, dtype=int)
    while y.size > 1:
        i, wait = next_contact(y, v)
        if wait > duration:
            break
        duration -= wait
        y, v = y + v * wait, v.copy()
        v[i] = np.average(v[i : i + 2], weights=members[i : i + 2])  # momentum
        members[i] += members[i + 1]
        y, v, members = (np.delete(each, i + 1) for each in (y, v, members))
    return np.repeat(y + v * duration, members), np.repeat(v, members)


# %% [markdown]
# Is there a shortcut like sorting? A cluster moves with the mean velocity of its members, and it
# lies at the mean of the places that they would have without collisions. The reason is momentum:
# collisions do not change the mean position of a group that no other rod touches. The final state
# therefore has this form. Cut the row $z_i=y_i+v_it$ into blocks, and replace every block by its
# mean, such that the means ascend. To find the blocks, pool two neighbouring blocks whenever they
# are in the wrong order, until all are in order. This is the **pool-adjacent-violators algorithm**
# (PAVA):


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
# Statisticians know the result as **isotonic regression**: it is the ascending row that is closest
# to $z$ in the sense of least squares. In mechanics it says that sticky points end at the
# *projection* of their free positions onto the allowed ones.
#
# **Predict.** Compare five answers: our clusters, our PAVA, scipy's isotonic regression, `simulate`
# in one single step, and `simulate` with Contact Dynamics. How many of them differ?
#
# **Run.**

# %%
clusters, _ = sticky(y, v, duration)
answers = {"PAVA": pool_adjacent_violators(flown), "scipy": isotonic_regression(flown).x}
glue = rods.replace(restitution=0)
for method in methods:
    _, x, _ = film(glue, glue.physical(y), v, duration=duration, every=duration, method=method)
    answers[f"simulate, {method}"] = glue.reduced(x[-1])
for name, answer in answers.items():
    print(f"{name:28s} differs from the clusters by {abs(answer - clusters).max():.0e} R")

# %% tags=["remove-cell"]
for answer in answers.values():
    assert np.allclose(answer, clusters, atol=1e-12)

# %% tags=["hide-input"]
history = np.linspace(0, duration, 400)
lines = np.array([pool_adjacent_violators(y + v * now) for now in history])
left, right_panel = panels(2, height=4)
for i in range(rods.size):
    left.plot(y[i] + v[i] * history, history, color="0.8", linewidth=1)
    left.plot(lines[:, i], history, color=COLOURS[i % 6])
left.set(xlabel="reduced position y [R]", ylabel="time t [T]", title="sticky points; grey: free")
left.set_xlim(-8, 8)
label = np.arange(1, rods.size + 1)
right_panel.plot(label, flown, "o", color="0.5", label="free flight, z")
right_panel.step(label, clusters, where="mid", color=COLOURS[0], label="clusters = regression")
right_panel.set(xlabel="rod i", ylabel=f"y at t = {duration:g} T [R]")
right_panel.legend()
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# All answers are the same. The left picture was drawn by regressions, one for each time, each of
# them straight from the start. No collision was followed. A projection is unique, so at $e=0$ all
# laws agree, whether they treat collisions one by one or all at once. (The same argument holds for
# long times with the velocities in place of $z$: they alone decide which points end in one cluster,
# see exercise 4.)
#
# </details>
#
# ## 4. In between
#
# Now the same twelve rods at three restitutions.
#
# **Predict.** The momentum is the same in all three chains. Which chain is the widest at the end?
#
# **Run.**

# %%
restitutions = (0, 0.5, 1)
films = {}
for e in restitutions:
    one = rods.replace(restitution=e)
    films[e] = film(one, one.physical(y), v, duration=duration, every=0.16, time_step=0.04)
    energy = np.sum(films[e][2] ** 2, axis=1)
    print(f"e = {e}: width {np.ptp(films[e][1][-1]):.1f} R", end=", ")
    print(f"{energy[-1] / energy[0]:.0%} of the energy remains")

# %% tags=["remove-cell"]
assert all(np.isclose(films[e][2][-1].sum(), v.sum()) for e in restitutions)
spans = [np.ptp(films[e][1][-1]) for e in restitutions]
assert spans == sorted(spans)

# %% tags=["hide-input"]
axes = panels(3, height=4, sharex=True, sharey=True)
for ax, e in zip(axes, restitutions, strict=True):
    spacetime(ax, *films[e][:2])
    ax.set_title(f"e = {e}")
axes[0].set_ylabel("time t [T]")
plt.show()

# %% tags=["hide-input"]
fig, axes = plt.subplots(3, 1, figsize=(7, 2.4), sharex=True, dpi=100)
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


played(fig, show, range(len(films[0][0])), a_second=10)

# %% [markdown]
# <details><summary>Explain</summary>
#
# Elastic rods hand on their velocities, keep the whole energy, and spread the most. At $e=0$ a few
# clusters fly apart and never meet again. The chain at $e=\frac12$ is closer to sticking than to
# bouncing, because rods that have just met meet again and again.
#
# </details>
#
# **Where did the energy go?** Each collision should take $\frac{1-e^2}4m\,\Delta v^2$, and nothing
# else should take any energy. We count it collision by collision.

# %%
m = rods.mass
for e in (0.7, 0.9, 1, 1.1):
    _, _, v_end, closing = billiard(y, v, e, duration)
    lost = m / 2 * (np.sum(v**2) - np.sum(v_end**2))
    counted = np.sum((1 - e**2) / 4 * m * closing**2)
    print(f"e = {e}: {len(closing):3d} collisions took {counted:8.4f} of {lost:8.4f} M R²/T² lost")

# %% tags=["remove-cell"]
for e in (0.7, 0.9, 1, 1.1):
    _, _, v_end, closing = billiard(y, v, e, duration)
    lost = m / 2 * (np.sum(v**2) - np.sum(v_end**2))
    assert np.isclose(np.sum((1 - e**2) / 4 * m * closing**2), lost)
    one = rods.replace(restitution=e)
    _, _, simulated = film(one, one.physical(y), v, duration=duration, every=duration)
    assert np.allclose(simulated[-1], v_end)

# %% [markdown]
# For $e>1$ collisions *add* energy. The paper calls such rods "flippers".
#
# ## 5. Newton's cradle, and what Contact Dynamics does (optional)
#
# *Sections 5 and 6 are optional, because no other lesson needs them. To skip both, go on with
# exercise 4.*
#
# We return to the first question. With event-driven collisions the first rod swaps velocities with
# the second, and the second with the third. All these collisions of two rods happen at the same
# instant, but *one after the other*.
#
# Contact Dynamics does not use any order. It takes all contacts of a time step and solves for all
# impulses at once. The velocities $u$ after the step must satisfy, for every contact,
#
# $$u_{i+1}-u_i\ \ge\ b_i,\qquad \text{impulse}_i\ge 0,\qquad\text{one of the two an equality}.$$
#
# For a contact that closes within the step, $b_i=e\,(v_i-v_{i+1})$. For a contact that only must not
# overlap, $b_i=-\mathrm{gap}_i/\Delta t$, which is 0 if the rods touch. The impulses are those that
# bring $u$ as close to $v$ as the inequalities allow. This is a projection again, and isotonic
# regression solves it: with $B_i=b_1+\dots+b_{i-1}$ the inequalities say that $u_i-B_i$ ascends.


# %%
def contact_dynamics(v, e):  # for rods that are all in contact
    B = np.concatenate([[0], np.cumsum(e * np.maximum(v[:-1] - v[1:], 0))])
    return pool_adjacent_violators(v - B) + B


# %% [markdown]
# **Predict.** Five rods are in contact, $e=1$, and the first one moves with the velocity 1.
# Compute $u$ by hand: write down $b$ and $B$, and pool $v-B$.

# %%
u = ...  # your code here: a list of five velocities
solution = contact_dynamics(np.eye(5)[0], 1)
hint = "b = (1, 0, 0, 0), so v - B = (1, -1, -1, -1, -1)."
check(u, solution, hint=hint, tolerance=2e-3)

# %% [markdown]
# **Run.**

# %%
for size in (3, 5):
    hit, chain = np.eye(size)[0], cb.Chain(size=size, **free)
    for method in methods:
        _, _, velocities = film(chain, chain.anchors, hit, duration=1, every=1, method=method)
        print(f"{size} rods, {method:16s}: {np.round(velocities[-1], 4)}")

# %% tags=["remove-cell"]
for size in (3, 5):
    hit, chain = np.eye(size)[0], cb.Chain(size=size, **free)
    ends = {
        method: film(chain, chain.anchors, hit, duration=1, every=1, method=method)[2][-1]
        for method in methods
    }
    assert np.allclose(ends["event-driven"], billiard(np.zeros(size), hit, 1, 1)[2])
    assert np.allclose(ends["event-driven"], hit[::-1])
    assert np.allclose(ends["contact-dynamics"], contact_dynamics(hit, 1))
    closed = np.append((2 - size) / size, [2 / size] * (size - 1))
    assert np.allclose(contact_dynamics(hit, 1), closed)
assert right([-0.6, 0.4, 0.4, 0.4, 0.4], contact_dynamics(np.eye(5)[0], 1))

# %% [markdown]
# <details><summary>Explain</summary>
#
# $v-B=(1,-1,-1,-1,-1)$ is pooled into one block of mean $-\frac35$, and $u=-\frac35+B=
# (-\frac35,\frac25,\frac25,\frac25,\frac25)$. With $L$ rods,
# $u=(\frac{2-L}L,\frac2L,\dots,\frac2L)$. This is the elastic collision of one rod with a *rigid*
# body of $L-1$ rods, because all contacts act at the same instant. Momentum and energy are
# conserved. The conservation laws alone do not decide between the two laws.
#
# </details>
#
# Both laws describe idealisations. If there is the least space between the rods, one collision
# comes after the other, and the order decides. Let us put a gap between the rods and shorten the
# time step:

# %%
chain = cb.Chain(size=3, gap=0.1, **free)
start = chain.anchors, np.array([1.0, 0, 0])
ends = {}
print("time step [T]   velocities after Contact Dynamics, energy [m/2]")
for dt in (1, 0.5, 0.2, 0.08, 0.02):
    steps = {"duration": 4, "every": 1, "time_step": dt}
    ends[dt] = film(chain, *start, **steps, method="contact-dynamics")[2][-1]
    print(f"{dt:13g}   {ends[dt].round(4)}, {np.sum(ends[dt] ** 2):.3f}")

# %% tags=["remove-cell"]
assert np.allclose(ends[0.08], [0, 0, 1])
assert np.allclose(ends[0.02], [0, 0, 1])
assert max(np.sum(ends[dt] ** 2) for dt in (1, 0.5, 0.2)) < 0.95

# %% [markdown]
# As soon as a step contains one contact at a time, Contact Dynamics is right. With longer steps it
# loses energy even at $e=1$. The reason is the contact of the second and the third rod. It must not
# overlap at the end of the step, but it was not closing at the beginning, so there is no closing
# speed that the restitution could reverse. In a long, dense chain the step would have to be shorter
# than the shortest time between two collisions. The package therefore computes collisions in their
# order by default, and keeps Contact Dynamics for the comparison with the paper. At $e=0$, the main
# case of the paper, the two laws agree.
#
# ## 6. Inelastic collapse (optional)
#
# *This section is optional too. To skip it, go on with exercise 4.*
#
# For $0<e<1$ infinitely many collisions can happen in a finite time. A bouncing ball shows it. Each
# bounce takes $e$ times as long as the one before, the sum $1+e+e^2+\dots=1/(1-e)$ is finite, and
# then the ball lies still. Rods can do this to one another without gravity.
#
# Take three rods, and let the outer two move towards the middle one. Let $a$ be the closing speed of
# the contact that collides, and $b$ that of the other contact (negative if it opens). The collision
# changes them to
#
# $$a\to-e\,a,\qquad b\to b+\tfrac{1+e}2a,$$
#
# and then the two contacts change roles. The closing speeds $a_n$ of successive collisions
# therefore obey
#
# $$a_{n+1}=\tfrac{1+e}{2}\,a_n-e\,a_{n-1},\qquad a_n\sim\lambda^n,\qquad
# \lambda^2-\tfrac{1+e}2\lambda+e=0 .$$
#
# If $\lambda=\sqrt e\,e^{\pm i\theta}$ is complex, with $\cos\theta=\frac{1+e}{4\sqrt e}$, then
# $a_n$ oscillates. The rods separate when it turns negative, after at most $\pi/\theta$ collisions,
# rounded up. If $\lambda$ is real, $a_n$ need never turn negative. The border between the two cases
# is $(1+e)^2=16e$, or $e_c=7-4\sqrt3=0.0718$.
#
# **Predict.** At $e=1$ the angle is $\theta=\pi/3$, and three rods collide at most three times, as
# pictures of three crossing lines show. How many collisions can there be at $e=0.1$, at $e=0.08$,
# and at $e=0.05$?
#
# **Run.** We follow gaps and closing speeds instead of positions, because the gaps become too small
# to be computed as differences of positions.


# %%
def three_rods(e, gaps, closing, most):
    """Return the times between collisions, and their closing speeds; at most ``most`` of them."""
    gaps, closing, waits, speeds = list(gaps), list(closing), [], []
    while len(waits) < most and max(closing) > 0:
        due = [g / c if c > 0 else np.inf for g, c in zip(gaps, closing, strict=True)]
        i = int(due[1] < due[0])
        waits.append(due[i])
        speeds.append(closing[i])
        gaps[1 - i] -= closing[1 - i] * due[i]
        gaps[i] = 0.0
        closing[1 - i] += (1 + e) / 2 * closing[i]
        closing[i] *= -e
    return np.array(waits), np.array(speeds)


# %%
directions = np.geomspace(1e-4, 3, 300)  # of the start, in the plane of the two closing speeds
restitutions = np.concatenate([[0.0725, 0.074, 0.08, 0.085, 0.1, 0.12], np.linspace(0.15, 1, 18)])
most_seen = []
for e in restitutions:
    runs = [three_rods(e, (0, 1), (np.sin(u), np.cos(u)), 1000) for u in directions]
    most_seen.append(max(len(waits) for waits, _ in runs))
waits, speeds = three_rods(0.05, (0.1, 1), (1, 1), most=40)

# %% tags=["hide-input"]
critical = 7 - 4 * np.sqrt(3)
left, right_panel = panels(2)
fine = np.linspace(critical + 1e-4, 1, 2000)
fine_bound = np.ceil(np.pi / np.arccos((1 + fine) / (4 * np.sqrt(fine))) - 1e-9)
left.semilogy(fine, fine_bound, color=COLOURS[1], label=r"$\pi/\theta$, rounded up")
left.plot(restitutions, most_seen, "o", color="black", label="most seen in 300 starts")
left.axvline(critical, color=RED, linestyle="--", label="$e_c = 0.0718$")
left.set(xlabel="restitution e", ylabel="collisions of three rods", xlim=(0, 1))
left.set_yticks([3, 5, 10, 20, 50], ["3", "5", "10", "20", "50"])
left.legend()
n = np.arange(1, len(waits) + 1)
right_panel.semilogy(n, speeds, "o", color=COLOURS[0], label="closing speed [R/T]")
right_panel.semilogy(n, waits, "^", color=RED, label="time since the last one [T]")
right_panel.set(xlabel="number of the collision", title="e = 0.05")
right_panel.legend()
plt.show()
large, small = np.sort(np.roots([1, -(1 + 0.05) / 2, 0.05]))[::-1]
print(f"e = 0.05: lambda = {large:.3f} and {small:.3f};", end=" ")
print(f"speeds fall by {speeds[-1] / speeds[-2]:.4f}, times by {waits[-1] / waits[-2]:.4f}")
print(f"40 collisions after {waits.sum():.6f} T; the last ten took {waits[-10:].sum():.0e} T")

# %% tags=["remove-cell"]
theta = np.arccos((1 + restitutions) / (4 * np.sqrt(restitutions)))
bound = np.ceil(np.pi / theta - 1e-9)
assert dict(zip(restitutions, most_seen, strict=True))[0.1] == 7
assert dict(zip(restitutions, most_seen, strict=True))[0.08] == 11
assert np.all(most_seen <= bound)
assert np.mean(most_seen == bound) > 0.9
assert len(waits) == 40  # as many as we asked for
assert np.isclose(speeds[-1] / speeds[-2], large)
assert np.isclose(waits[-1] / waits[-2], small / large)

# %% [markdown]
# <details><summary>Explain</summary>
#
# At most seven collisions happen at $e=0.1$, and eleven at $e=0.08$. Below $e_c$ the number has no
# bound. At $e=0.05$ every collision has 0.4 times the speed of the one before and comes after 0.3125
# times its waiting time. This is a geometric series, as for the ball. A program that takes
# collisions one at a time never gets past the limit of this series. With more rods the same happens
# at larger $e$.
#
# </details>
#
# **How `simulate` avoids the collapse.** After a collapse the rods move together. `simulate`
# therefore joins a pair that would separate more slowly than `merging` (here 0.1) times the velocity
# kick of one step's noise. Such a pair is a *cluster*, which moves as one body until the end of the
# step. The next kick may separate it. Each collision that does not merge costs at least a fixed
# amount of energy, so there are finitely many. (Without noise the limit is a billionth of the
# typical speed.)
#
# **Predict.** Make `merging` much smaller and much larger, in a chain with noise, friction and
# springs. What changes: the number of collisions, the velocities, or both?
#
# **Run.**

# %%
noisy = cb.Chain(size=50, restitution=0.2)
settings = {"duration": 800, "observe": ["widths", "collisions"], "seed": 8, "progress": False}
centres = {}
print("merging   collisions per rod and T   velocity width in the centre [R/T]")
for merging in (1e-6, 0.003, 0.03, 0.1, 1):
    run = cb.simulate(noisy, merging=merging, **settings)
    rate = run.collision_rate.sum().item() / noisy.size
    centre = run.sel(particle=[25, 26]).mean()
    centres[merging] = rate, centre.velocity_width.item(), centre.velocity_width_error.item()
    print(f"{merging:7g}   {rate:25.1f}   {centres[merging][1]:.4f} ± {centres[merging][2]:.4f}")

# %% tags=["remove-cell"]
_, default, default_error = centres[0.1]
for merging, (_, centre, error) in centres.items():
    agree(f"merging {merging}", centre, default, np.hypot(error, default_error))
assert centres[1e-6][0] > 3 * centres[0.03][0] > 5 * centres[1][0]

# %% [markdown]
# <details><summary>Explain</summary>
#
# Only the number of collisions changes. There are infinitely many, and the threshold says which of
# them are counted. The velocities do not depend on the threshold: the count goes from 13 to 77
# collisions per rod and time, and the width stays the same. (The time step changes the count as
# well, and a long step also changes the width: see section 6 of the next lesson.)
#
# </details>
#
# ## Exercises
#
# **1. Two rods at once.** Five rods are in contact, $v=(1,1,0,0,0)$, $e=1$. What comes out, event
# by event and with Contact Dynamics? Then let one rod hit at $e=0.9$, event by event.
#
# <details><summary>Solution</summary>
#
# Event by event the result is $(0,0,0,1,1)$: two rods go in, and two come out. Contact Dynamics
# gives $(-\frac15,-\frac15,\frac45, \frac45,\frac45)$, the collision of two bodies of two and three
# rods. Try `contact_dynamics(v, 1)` and `billiard(np.zeros(5), v, 1, 1)`. With $e=0.9$ and one rod
# there are ten collisions, all at the same instant, and $(0.0435, 0.0454, 0.0473, 0.0493,
# 0.8145)$ comes out. The last rod flies off, and the others follow slowly.
#
# </details>
#
# **2. One collision more.** What is the largest restitution at which three rods can collide four
# times? Ten times?
#
# <details><summary>Solution</summary>
#
# $n$ collisions need $\pi/\theta>n-1$, that is $\frac{1+e}{4\sqrt e}>\cos\frac\pi{n-1}$. For
# $n=4$ this says $1+e>2\sqrt e$, which is true for every $e$ below 1, but not at $e=1$. For
# $n=10$ solve the quadratic equation for $\sqrt e$: $e<0.0830$.
#
# </details>
#
# **3. Collapse with more rods.** Let `billiard` collide rods that start evenly spaced and all fly
# towards the middle, $v=-y$ plus a little randomness, at $e=0.6$. Add a limit on the number of
# collisions. How many rods does it take until they collide more than ten thousand times?
#
# <details><summary>Solution</summary>
#
# With `y = np.arange(L) - (L - 1) / 2` and `v = -y + 0.1 * rng.standard_normal(L)`, and four sets
# of random numbers each, there are 84 to 117 collisions of 10 rods, 319 to 462 of 12, and 1311 to
# 2188 of 13. With 14 rods the number exceeds 10 000. Elastic rods would have at most
# $L(L-1)/2=91$.
#
# </details>
#
# **4. How many clusters fly apart?** A hundred sticky points start close together with random,
# independent velocities. After a long time they form clusters. How many are there on average?
#
# <details><summary>Solution</summary>
#
# After a long time $y_i+v_it$ may be replaced by $v_it$, so count the blocks of the regression of
# the velocities themselves:
#
# ```python
# draws = np.random.default_rng(9).standard_normal((2000, 100))
# np.mean([np.unique(pool_adjacent_violators(v)).size for v in draws])
# ```
#
# gives 5.22 (± 0.04). For independent values of any distribution the mean is
# $1+\frac12+\frac13+\dots+\frac1{L}$ (a theorem of Sparre Andersen), 5.19 for $L=100$. It grows
# like $\ln L$: a million rods end in 14 clusters.
#
# </details>
