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
# ([Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460)). It also shows what
# happens when collisions lose energy.
#
# *90 minutes. `make lessons` writes copies without outputs and solutions.*
#
# **Two minutes on the page.** Does <a href="../docs/chain.md#challenge=push">a push</a> at the left
# end of 20 rods arrive at the right end, at $e = 1$ and at $e = 0.9$? Predict how many of three
# pushes do, and then push.

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import isotonic_regression
from solutions import lesson_03 as solutions
from teaching import GREEN, PINK, RED, check, panels, safe

OF_RODS = (GREEN, "0.25", PINK, "0.65")


def watch(chain, x, v, *, duration, every, **settings):
    """Simulate from positions x and velocities v; return times, positions, velocities."""
    run = cb.simulate(
        chain,
        start=cb.given_start(chain, x, v),
        duration=duration,
        every=every,
        time_step=every,  # without springs any step will do
        average="ensemble",  # of one copy: its states at equal times, the first being the start
        observe="snapshots",
        progress=False,
        **settings,
    )
    return run.time.values, run.position.values[0], run.velocity.values[0]


def spacetime(ax, t, x):
    """Draw rods as bands, 2 R wide, with time upwards."""
    for i, centre in enumerate(x.T):
        colour = OF_RODS[i % len(OF_RODS)]
        ax.fill_betweenx(t, centre - 1, centre + 1, color=colour, alpha=0.75, linewidth=0)
    ax.set_xlabel("position x [R]")


# %% [markdown]
# **What you may change.** The number of rods `size`, from 3 to 12, and the `seed` of their random
# velocities. With more rods, collisions that lose energy may never end (section 6). The
# explanations quote the numbers of 12 rods.
#
# Lengths are in rod radii R, times in $t_0$, velocities in $R/t_0$. `watch` is a short helper: it calls
# `simulate` with a given start, and returns times, positions and velocities.

# %%
size, seed = 12, 5

# %% tags=["hide-input"]
if not safe(
    3 <= size <= 12,
    f"This lesson is for 3 to 12 rods, not {size}: collisions of more rods may never end. "
    "The lesson goes on with 12.",
):
    size = 12

# %% [markdown]
# **Predict.** The first rod has the velocity 1. Enter the three velocities after the collision.

# %%
my_velocities = ...  # your code here: three velocities

hint = "Their sum and the sum of their squares must both be 1. No rod passes through another."
also = [solutions.AFTER_ONE_BODY_HITS_TWO]
check(my_velocities, solutions.AFTER_THE_CRADLE, hint=hint, also=also, tolerance=0.01)

# %% [markdown]
# **Run.** In the pictures time runs upwards, and a band is a rod, 2 R wide.

# %%
import crazybilliards as cb

free = {"amplitude": 0, "damping": 0, "stiffness": 0}  # no noise, no damping, no springs
cradle = cb.Chain(size=3, **free)
x, v = cradle.anchors - [3.02, 0, 0], np.array([1.0, 0, 0])
methods = ("event-driven", "contact-dynamics")
watched = {method: watch(cradle, x, v, duration=7, every=0.05, method=method) for method in methods}

# %% tags=["hide-input"]
axes = panels(2, width=9, height=3.4, sharex=True, sharey=True)
after = {}
for ax, method in zip(axes, methods, strict=True):
    t, positions, velocities = watched[method]
    spacetime(ax, t, positions)
    ax.set_title(f'method="{method}"')
    after[method] = velocities[-1]
    print(f"{method:16s} velocities after: {after[method].round(6)}", end="; ")
    print(f"momentum {after[method].sum():.6f}, energy {np.sum(after[method] ** 2):.6f} m/2")
axes[0].set_ylabel("time $t$ [$t_0$]")
plt.show()

# %% tags=["remove-cell"]
assert np.allclose(after["event-driven"], solutions.AFTER_THE_CRADLE)
assert np.allclose(after["contact-dynamics"], solutions.AFTER_ONE_BODY_HITS_TWO)
for velocities in after.values():
    assert np.isclose(velocities.sum(), 1)
    assert np.isclose(np.sum(velocities**2), 1)

# %% [markdown]
# Newton's cradle does what the left picture shows. Both laws conserve momentum and energy. Section
# 5 explains the difference.
#
# ## 1. The collision law
#
# Two rods of equal mass meet with velocities $v_1 > v_2$. Momentum is conserved. The relative
# velocity is reversed and multiplied by the **restitution** $e$:
#
# $$v_1'+v_2'=v_1+v_2,\qquad v_1'-v_2'=-e\,(v_1-v_2).$$
#
# **Your turn.** Solve these two equations for the velocities after the collision.

# %%
pairs = [(1.0, 0.0, 1.0), (2.0, -1.0, 0.0), (1.0, 0.5, 0.5)]


def my_collision(v1, v2, e):
    return ...  # your code here: the two velocities after the collision


hint = "Add both equations; then subtract them. At e = 1 two rods swap their velocities."
check(my_collision, solutions.collide, at=pairs, hint=hint)

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
# **Back on the page.** The push went from rod to rod. Which share of its velocity arrives after 19
# such collisions at $e = 0.9$? Which at
# <a href="../docs/chain.md#size=20&damping=0.3&gap=0.5&restitution=0.98">0.98</a>? Push, and compare.
#
# **How much energy does a collision take?** Look at the two rods from their centre of mass. The
# collision does not change its velocity, so only the motion that you see from there can lose
# energy.
#
# **Your turn.** Compute the energy that a collision takes from two rods of mass $m$ that meet with
# the closing speed $\Delta v=v_1-v_2$.

# %%
meetings = [(1.0, 0.0, 1.0), (3.0, 0.5, 2.0), (2.0, 1.0, 1.0), (1.5, 0.9, 4.0)]


def my_energy_taken(closing, e, m):
    return ...  # your code here: the kinetic energy before, minus that after the collision


hint = "Seen from there, the velocities before are +closing/2 and -closing/2. And after?"
check(my_energy_taken, solutions.energy_taken, at=meetings, hint=hint)

# %% tags=["remove-cell"]
for closing, e, m in meetings:
    before, ends = np.array([0.7 + closing, 0.7]), solutions.collide(0.7 + closing, 0.7, e)
    lost = m / 2 * np.sum(before**2 - np.square(ends))
    assert np.isclose(lost, solutions.energy_taken(closing, e, m))

# %% [markdown]
# <details><summary>Solution</summary>
#
# The velocities are $\pm\frac12\Delta v$ before the collision, and $\mp\frac e2\Delta v$ after it.
# Each rod has lost $\frac m2\big(\frac{\Delta v}2\big)^2(1-e^2)$, so the collision takes
#
# $$\Delta E = \frac{1-e^2}{4}\,m\,\Delta v^2 .$$
#
# ```python
# def my_energy_taken(closing, e, m):
#     return 2 * m / 2 * (closing / 2) ** 2 * (1 - e**2)
# ```
#
# </details>
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
# Now we write a simulation of our own. Points fly straight until the next two neighbours meet. Find
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
        v[i], v[i + 1] = solutions.collide(v[i], v[i + 1], e)
        y[i + 1] = y[i]


# %% [markdown]
# **Predict.** Take twelve rods with random velocities at $e=1$. Draw them as rods in $x$ and as
# points in $y$. What will the second picture look like?
#
# **Run.**

# %%
rods = cb.Chain(size=size, gap=1, **free)
y = rods.reduced_anchors
v = np.random.default_rng(seed).standard_normal(rods.size) - 0.25 * y
duration = 8.0
t, x, _ = watch(rods, rods.physical(y), v, duration=duration, every=0.05)
times, paths, v_end, closing = billiard(y, v, 1, duration)
print(f"{len(closing)} collisions")

# %% tags=["hide-input"]
left, right_panel = panels(2, height=4, sharey=True)
spacetime(left, t, x)
left.set(ylabel="time $t$ [$t_0$]", title="rods: simulate")
for i in range(rods.size):
    right_panel.plot(paths[:, i], times, color=OF_RODS[i % len(OF_RODS)])
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
# Elastic rods therefore need no search for collisions.
#
# **Your turn.** Compute the positions of elastic points after the time `duration`, from left to
# right, without following any collision.

# %%
starts = [(np.array([0.0, 1.0, 2.0]), np.array([1.0, 0.0, -1.0]), 3.0), (y, v, duration)]


def my_elastic(y, v, duration):
    return ...  # your code here: an array of positions


hint = "Where would free points be? Then give the leftmost place to the first point, and so on."
check(my_elastic, solutions.elastic, at=starts, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_elastic(y, v, duration):
#     return np.sort(y + v * duration)
# ```
#
# </details>
#
# This is what `simulate` does at $e=1$, in one pass per time step, however many collisions there
# are. Each collision swaps two neighbours, so the number of collisions is the number of pairs that
# are out of order before the sorting.

# %%
flown = y + v * duration
off = abs(solutions.elastic(y, v, duration) - paths[-1]).max()
print(f"largest difference from the billiard: {off:.0e} R")
print(sum(np.sum(flown[:i] > flown[i]) for i in range(rods.size)), "pairs are out of order")

# %% tags=["remove-cell"]
assert off < 1e-12
assert np.allclose(v_end, v[np.argsort(flown)])
assert np.allclose(paths[-1], rods.reduced(x[-1]))
assert sum(np.sum(flown[:i] > flown[i]) for i in range(rods.size)) == len(closing)

# %% [markdown]
# ## 3. Collisions that lose energy
#
# **Predict.** Now the same rods at three restitutions. Which chain is the widest at the end? Which
# part of the energy remains at $e=\frac12$?
#
# **Run.**

# %%
restitutions = (0, 0.5, 1)
watched = {}
for e in restitutions:
    one = rods.replace(restitution=e)
    watched[e] = watch(one, one.physical(y), v, duration=duration, every=0.04)
    energy = np.sum(watched[e][2] ** 2, axis=1)
    print(f"e = {e}: width {np.ptp(watched[e][1][-1]):.1f} R", end=", ")
    print(f"{energy[-1] / energy[0]:.0%} of the energy remains")

# %% tags=["remove-cell"]
assert all(np.isclose(watched[e][2][-1].sum(), v.sum()) for e in restitutions)
spans = [np.ptp(watched[e][1][-1]) for e in restitutions]
assert spans == sorted(spans)

# %% tags=["hide-input"]
axes = panels(3, height=3.4, sharex=True, sharey=True)
for ax, e in zip(axes, restitutions, strict=True):
    spacetime(ax, *watched[e][:2])
    ax.set_title(f"e = {e}")
axes[0].set_ylabel("time $t$ [$t_0$]")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# Elastic rods hand on their velocities, keep the whole energy, and spread the most. At $e=0$ a few
# clusters fly apart and never meet again. At $e=\frac12$ hardly more energy remains than at $e=0$,
# because rods that have just met meet again and again.
#
# </details>
#
# **Where did the energy go?** We count $\frac{1-e^2}4m\,\Delta v^2$ collision by collision.

# %%
m = rods.mass
for e in (0.8, 0.9, 1, 1.1):
    _, _, v_end, closing = billiard(y, v, e, duration)
    lost = m / 2 * (np.sum(v**2) - np.sum(v_end**2))
    counted = np.sum(solutions.energy_taken(closing, e, m))
    took = f"{counted:8.4f} of {lost:8.4f} M R²/t_0² lost"
    print(f"e = {e}: {len(closing):3d} collisions took {took}")

# %% tags=["remove-cell"]
for e in (0.8, 0.9, 1, 1.1):
    _, _, v_end, closing = billiard(y, v, e, duration)
    lost = m / 2 * (np.sum(v**2) - np.sum(v_end**2))
    assert np.isclose(np.sum(solutions.energy_taken(closing, e, m)), lost)
    one = rods.replace(restitution=e)
    _, _, simulated = watch(one, one.physical(y), v, duration=duration, every=duration)
    assert np.allclose(simulated[-1], v_end)

# %% [markdown]
# For $e>1$ collisions *add* energy. The paper calls such rods "flippers".
#
# **You can stop here.** You have solved the collision law, written a billiard of your own, found
# that elastic rods only need sorting, and accounted for the energy. No other lesson needs more.
#
# ## 4. Rods that stick: e = 0
#
# At $e=0$ points that meet stay together. Is there a shortcut like sorting? A cluster moves with
# the mean velocity of its members, so it lies at the mean of the places that they would have
# without collisions. The final state therefore has this form: cut the row $z_i=y_i+v_it$ into
# blocks, and replace every block by its mean, such that the means ascend. To find the blocks, pool
# two neighbouring blocks whenever they are in the wrong order, until all are in order. This is the
# **pool-adjacent-violators algorithm** (PAVA).
#
# **Your turn.** Free points would be at $z=(0, 4, 1, 3, 1)$. Do PAVA by hand: where are the
# sticky points?

# %%
my_places = ...  # your code here: five positions

z = np.array([0, 4, 1, 3, 1])
hint = "Pool 4 and 1, then 3 and 1. Are the two means in order?"
check(my_places, solutions.pool_adjacent_violators(z), hint=hint, tolerance=1e-3)

# %% [markdown]
# <details><summary>Solution</summary>
#
# 4 and 1 are pooled at 2.5, then 3 and 1 at 2. These two blocks are in the wrong order, too, and
# are pooled at 2.25. The answer is $(0, 2.25, 2.25, 2.25, 2.25)$.
#
# </details>
#
# Statisticians know the result as **isotonic regression**: it is the ascending row that is closest
# to $z$ in the sense of least squares.
#
# **Predict.** Compare scipy's isotonic regression, our PAVA, `simulate` in one single step, and
# `simulate` with Contact Dynamics, for the rods above. How many of the four differ?
#
# **Run.**

# %%
answers = {"PAVA": solutions.pool_adjacent_violators(flown)}
glue = rods.replace(restitution=0)
for method in methods:
    _, x, _ = watch(glue, glue.physical(y), v, duration=duration, every=duration, method=method)
    answers[f"simulate, {method}"] = glue.reduced(x[-1])
for name, answer in answers.items():
    off = abs(answer - isotonic_regression(flown).x).max()
    print(f"{name:26s} differs from isotonic regression by {off:.0e} R")

# %% tags=["hide-input"]
history = np.linspace(0, duration, 400)
lines = np.array([isotonic_regression(y + v * now).x for now in history])
ax = panels(width=6, height=4)
for i in range(rods.size):
    ax.plot(y[i] + v[i] * history, history, color="0.85", linewidth=1)
    ax.plot(lines[:, i], history, color=OF_RODS[i % len(OF_RODS)])
ax.set(xlabel="reduced position y [R]", ylabel="time $t$ [$t_0$]", xlim=(1.5 * y[0], 1.5 * y[-1]))
ax.set_title("sticky points; light grey: free points")
plt.show()

# %% tags=["remove-cell"]
for answer in answers.values():
    assert np.allclose(answer, isotonic_regression(flown).x, atol=1e-12)

# %% [markdown]
# <details><summary>Explain</summary>
#
# None. The picture was drawn by regressions, one for each time, each of them straight from the
# start. No collision was followed. The nearest ascending row is unique, so at $e=0$ all laws agree,
# whether they treat collisions one by one or all at once.
#
# </details>
#
# ## 5. Newton's cradle, and what Contact Dynamics does
#
# Event by event, the first rod of the cradle swaps velocities with the second, and then the second
# with the third. Contact Dynamics solves for all impulses of a time step *at once*. The velocities
# $u$ after the step must satisfy, for every contact,
#
# $$u_{i+1}-u_i\ \ge\ b_i,\qquad \text{impulse}_i\ge 0,\qquad\text{one of the two an equality}.$$
#
# For a contact that closes, $b_i=e\,(v_i-v_{i+1})$. For rods that touch and do not close, $b_i=0$.
# With $B_i=b_1+\dots+b_{i-1}$ this says that $u_i-B_i$ ascends, and PAVA finds it from $v-B$.
#
# **Your turn.** Five rods are in contact, $e=1$, and the first one moves with the velocity 1. Write
# down $b$ and $B$, pool $v-B$, and add $B$.

# %%
my_u = ...  # your code here: five velocities

hint = "b = (1, 0, 0, 0), so v - B = (1, -1, -1, -1, -1)."
check(my_u, solutions.contact_dynamics(np.eye(5)[0], 1), hint=hint, tolerance=2e-3)

# %% [markdown]
# **Run.**

# %%
for number in (3, 5):
    hit, chain = np.eye(number)[0], cb.Chain(size=number, **free)
    for method in methods:
        _, _, velocities = watch(chain, chain.anchors, hit, duration=1, every=1, method=method)
        print(f"{number} rods, {method:16s}: {np.round(velocities[-1], 4)}")

# %% tags=["remove-cell"]
for number in (3, 5):
    hit, chain = np.eye(number)[0], cb.Chain(size=number, **free)
    ends = {
        method: watch(chain, chain.anchors, hit, duration=1, every=1, method=method)[2][-1]
        for method in methods
    }
    assert np.allclose(ends["event-driven"], billiard(np.zeros(number), hit, 1, 1)[2])
    assert np.allclose(ends["event-driven"], hit[::-1])
    closed = np.append((2 - number) / number, [2 / number] * (number - 1))
    assert np.allclose(ends["contact-dynamics"], closed)
    assert np.allclose(solutions.contact_dynamics(hit, 1), closed)

# %% [markdown]
# <details><summary>Explain</summary>
#
# $v-B$ is pooled into one block of mean $-\frac35$, so
# $u=(-\frac35,\frac25,\frac25,\frac25,\frac25)$. This is the elastic collision of one rod with a
# *rigid* body of four, because all contacts act at the same instant.
#
# </details>
#
# If rods have any space between them, collisions come one after the other. Contact Dynamics then
# needs steps so short that each has one contact. With longer ones it loses energy even at $e=1$.
# `simulate` therefore computes collisions in their order by default.
#
# ## 6. Inelastic collapse
#
# For $0<e<1$ infinitely many collisions can happen in a finite time, as those of a bouncing ball
# that comes to rest. Take three rods, and let the outer two move towards the middle one. A contact
# that closes with the speed $a$ collides, and the other one closes with $b$. The collision changes
# $a\to-e\,a$ and $b\to b+\frac{1+e}2a$, and the two contacts change roles. The closing speeds $a_n$
# of successive collisions obey
#
# $$a_{n+1}=\tfrac{1+e}{2}\,a_n-e\,a_{n-1},\qquad a_n\sim\lambda^n,\qquad
# \lambda^2-\tfrac{1+e}2\lambda+e=0 .$$
#
# If $\lambda=\sqrt e\,e^{\pm i\theta}$ is complex, $\cos\theta=\frac{1+e}{4\sqrt e}$, then $a_n$
# oscillates. The rods separate when it turns negative, after at most $\pi/\theta$ collisions,
# rounded up. If $\lambda$ is real, below $e_c=7-4\sqrt3=0.0718$, they need never separate.
#
# **Predict.** Three elastic rods collide at most three times. How often at $e=0.1$?

# %%
my_number = ...  # your code here: a whole number

hint = "Compute theta from its cosine, and round pi / theta up."
check(my_number, solutions.most_collisions(0.1), hint=hint)

# %% [markdown]
# **Run.** We follow gaps and closing speeds, because gaps become too small for differences of
# positions.


# %%
def three_rods(e, gaps, closing, most=1000):
    """Return how often three rods collide; at most ``most`` times."""
    gaps, closing, number = list(gaps), list(closing), 0
    while number < most and max(closing) > 0:
        due = [g / c if c > 0 else np.inf for g, c in zip(gaps, closing, strict=True)]
        i = int(due[1] < due[0])
        gaps[1 - i] -= closing[1 - i] * due[i]
        gaps[i] = 0.0
        closing[1 - i] += (1 + e) / 2 * closing[i]
        closing[i] *= -e
        number += 1
    return number


# %%
directions = np.geomspace(1e-4, 3, 300)  # of the start, in the plane of the two closing speeds
seen = np.concatenate([[0.0725, 0.074, 0.08, 0.085, 0.1, 0.12], np.linspace(0.15, 1, 18)])
most_seen = []
for e in seen:
    runs = [three_rods(e, (0, 1), (np.sin(u), np.cos(u))) for u in directions]
    most_seen.append(max(runs))
print(
    f"most at e = 0.1: {most_seen[4]}; at e = 0.05: {three_rods(0.05, (0.1, 1), (1, 1))}, the limit"
)

# %% tags=["hide-input"]
critical = 7 - 4 * np.sqrt(3)
ax = panels(width=7, height=3.2)
fine = np.linspace(critical + 1e-4, 1, 2000)
ax.semilogy(fine, solutions.most_collisions(fine), color=PINK, label=r"$\pi/\theta$, rounded up")
ax.plot(seen, most_seen, "o", color="black", label="most seen in 300 starts")
ax.axvline(critical, color=RED, linestyle="--", label="$e_c = 0.0718$")
ax.set(xlabel="restitution e", ylabel="collisions of three rods", xlim=(0, 1))
ax.set_yticks([3, 5, 10, 20, 50], ["3", "5", "10", "20", "50"])
ax.legend()
plt.show()

# %% tags=["remove-cell"]
assert most_seen[4] == solutions.most_collisions(0.1) == 7
assert np.all(most_seen <= solutions.most_collisions(seen))
assert np.mean(most_seen == solutions.most_collisions(seen)) > 0.9

# %% [markdown]
# <details><summary>Explain</summary>
#
# At most seven collisions happen at $e=0.1$. Below $e_c$ the number has no bound. With more rods
# the same happens at larger $e$. `simulate` therefore joins a pair that would separate very slowly.
#
# </details>
#
# ## Exercise
#
# **How many clusters fly apart?** A hundred sticky points start close together with random,
# independent velocities. After a long time they form clusters. How many are there on average?
#
# <details><summary>Solution</summary>
#
# After a long time $y_i+v_it$ may be replaced by $v_it$, so count the blocks of the regression of
# the velocities themselves:
#
# ```python
# draws = np.random.default_rng(9).standard_normal((2000, 100))
# np.mean([np.unique(isotonic_regression(v).x).size for v in draws])
# ```
#
# gives 5.22 (± 0.04). For independent values of any distribution the mean is
# $1+\frac12+\frac13+\dots+\frac1{L}$ (a theorem of Sparre Andersen), 5.19 for $L=100$.
#
# </details>
