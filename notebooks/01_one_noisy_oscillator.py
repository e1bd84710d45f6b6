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
# # One noisy oscillator
#
# **Question.** A rod hangs on a spring. Damping slows it, and noise shakes it. It never comes to
# rest, and it never flies away. How fast does it move? How far does it get? How soon does it forget
# where it was? And how wrong is a simulation that moves in finite steps?
#
# This is the chain of [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460)
# with a single rod, which has no neighbour to collide with. Everything about it can be computed by
# hand.
#
# *90 minutes. `make lessons` writes copies without outputs and solutions.*
#
# **Two minutes on the page.** Look at
# <a href="../docs/chain.md#size=2&gap=5&second=velocities">two rods that hardly ever meet</a>. Guess
# how many swings a rod takes to forget where it was. Then draw on paper the distribution of velocities
# that you expect, and compare it with what the page measures at 300 $t_0$/s.

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy.linalg import expm, solve_discrete_lyapunov
from solutions import lesson_01 as solutions
from teaching import BLUE, GREEN, ORANGE, PINK, RED, agree, check, mean_and_error, panels, safe

# %% [markdown]
# **What you may change.** The `damping`, from 0.2 to 4. Above 4.09 the rod creeps back to
# its anchor without swinging, and the steps of section 3 are then too long. Seeds may be changed,
# too. After a change run all cells below it again.

# %%
damping = 1

# %% tags=["hide-input"]
if not safe(
    0.2 <= damping <= 4,
    f"This lesson is for damping from 0.2 to 4, not {damping}: with less the rod forgets too "
    "slowly for these runs, and with more it does not swing. The lesson goes on with damping = 1.",
):
    damping = 1

# %%
import crazybilliards as cb

chain = cb.Chain(size=1, damping=damping)
path = cb.simulate(chain, duration=200, every=0.1, observe="snapshots", seed=7, progress=False)
x, v = path.position.values[0, :, 0], path.velocity.values[0, :, 0]
t = path.time.values - path.time.values[0]

# %% tags=["hide-input"]
left, right_panel = panels(2, height=3.4, width_ratios=(2, 1))
left.plot(t, x, color=PINK, label="position x [R]")
left.plot(t, v, color=GREEN, linewidth=1, label="velocity v [$R/t_0$]")
left.set(xlabel="time $t$ [$t_0$]", xlim=(0, t[-1]), ylim=np.array([-1.1, 1.5]) * abs(x).max())
left.legend(loc="upper right", ncols=2)
right_panel.plot(x, v, color="0.3", linewidth=0.8)
right_panel.plot(x[-1], v[-1], "o", color=RED, label="now")
right_panel.set(xlabel="position x [R]", ylabel="velocity v [$R/t_0$]")
right_panel.legend(loc="upper left")
plt.show()

# %% [markdown]
# The right panel shows the same motion in phase space. The point turns round and round, each time
# on another orbit.
#
# ## 1. The Langevin equation
#
# The rod's displacement $x$ from its anchor obeys
#
# $$m\ddot x = -\gamma\dot x - kx + A\,\xi(t),\qquad
# \langle\xi(t)\rangle = 0,\quad \langle\xi(t)\,\xi(t')\rangle = \delta(t-t').$$
#
# Lengths are measured in rod radii R, masses in M, and times in $t_0=\sqrt{M/k}$. In these
# units $k=1$ and $m=\frac{4\pi}{3}$. The damping $\gamma$ (`damping`) and the noise amplitude $A$
# are 1 unless another value is given.
#
# **How fast, and how far?** During a short time $dt$ the noise changes the velocity by
# $\frac{A}{m}\sqrt{dt}\,\zeta$, where $\zeta$ is a Gaussian number of variance 1. On average this
# adds $\frac{A^2}{m^2}dt$ to $v^2$. So
#
# $$\frac{d}{dt}\langle x^2\rangle = 2\langle xv\rangle,\qquad
# \frac{d}{dt}\langle xv\rangle = \langle v^2\rangle - \frac km\langle x^2\rangle
# - \frac\gamma m\langle xv\rangle,\qquad
# \frac{d}{dt}\langle v^2\rangle = -\frac{2k}{m}\langle xv\rangle
# - \frac{2\gamma}{m}\langle v^2\rangle + \frac{A^2}{m^2}.$$
#
# In the steady state all three derivatives vanish. The first equation gives $\langle xv\rangle=0$.
# The third then gives the velocity, and the second the position:
#
# $$\langle v^2\rangle = W^2,\quad W=\frac{A}{\sqrt{2m\gamma}},\qquad
# \langle x^2\rangle = s^2,\quad s=W\sqrt{m/k}.$$
#
# Here $mW^2 = A^2/2\gamma$ acts as a temperature in units of energy, because $\frac m2\langle
# v^2\rangle = \frac k2\langle x^2\rangle = \frac12mW^2$ is equipartition.
#
# **Predict.** Make the rod twice as heavy. Does it move more slowly? Does it stay closer to its
# anchor? Enter the two factors by which $W$ and $s$ change.

# %%
my_factors = ...  # your code here: [factor of W, factor of s]

hint = "Insert W into s. Does the mass remain?"
check(my_factors, solutions.FACTORS_OF_TWICE_THE_MASS, hint=hint, tolerance=0.01)

# %% [markdown]
# **Run.**

# %%
variants = {
    "as it is": chain,
    "mass doubled": chain.replace(mass=2 * chain.mass),
    "damping doubled": chain.replace(damping=2 * damping),
}
for name, one in variants.items():
    run = cb.simulate(one, duration=50_000, observe="widths", seed=1, progress=False)
    W, s = one.free_velocity_width, one.thermal_length
    agree(f"{name}, W", run.velocity_width, W, run.velocity_width_error, unit="R/t_0")
    agree(f"{name}, s", run.displacement_width, s, run.displacement_width_error, unit="R")

# %% [markdown]
# <details><summary>Explain</summary>
#
# The heavier rod is slower by the factor $\sqrt2$, but it gets just as far, because
# $s=A/\sqrt{2\gamma k}$ does not contain the mass. Twice the damping reduces both widths by
# $\sqrt2$, because the noise does not grow with the damping.
#
# </details>
#
# **Back on the page.** Now <a href="../docs/chain.md#preset=noise">the noise</a> becomes twice as
# strong. Draw the velocity widths in units of $W$ that you expect for many rods, then set $A = 6$.
#
# ## 2. The Fokker-Planck equation
#
# The widths do not describe the whole distribution. Imagine very many copies of the rod. Their
# density $f(x, v, t)$ in phase space is carried along by velocity and force, and the kicks make it
# diffuse in $v$. In $dt$ the kicks change $v$ by a random amount of mean square $(A/m)^2dt$. A
# diffusion constant is half the mean square per time, here $A^2/2m^2$:
#
# $$\partial_t f + v\,\partial_x f - \frac{k}{m}x\,\partial_v f
# = \partial_v\!\left[\frac{\gamma}{m}v f + \frac{A^2}{2m^2}\,\partial_v f\right].$$
#
# Let us try a Gaussian in each variable,
#
# $$f = \frac{1}{2\pi W s}\,e^{-v^2/2W^2}\,e^{-x^2/2s^2}.$$
#
# On the right, $\partial_v f=-\frac{v}{W^2}f$. The square bracket is zero since
# $\frac{A^2}{2m^2}=\frac\gamma m W^2$, so damping and noise balance at every $v$. On the left,
# $v\,\partial_xf=-\frac{xv}{s^2}f$ and $-\frac km x\,\partial_vf=+\frac{k}{m}\frac{xv}{W^2}f$
# cancel since $W^2=\frac km s^2$. This $f$ is therefore stationary.
#
# **Predict.** Now watch a single rod for a very long time, instead of very many rods once. Will the
# share of time that it spends at each $x$ and $v$ follow the same $f$? If it does, for which share
# of the time is the rod faster than $2W$, to the left or to the right?

# %%
my_share = ...  # your code here: a number between 0 and 1

hint = "A Gaussian variable is within two widths with the probability 95.4 %."
check(my_share, solutions.SHARE_BEYOND_TWO_WIDTHS, hint=hint, tolerance=0.03)

# %% [markdown]
# **Run.**

# %%
long = cb.simulate(chain, duration=200_000, every=1, observe="snapshots", seed=2, progress=False)
x, v = long.position.values[0, :, 0], long.velocity.values[0, :, 0]
k, m, gamma, A = chain.stiffness, chain.mass, chain.damping, chain.amplitude
W, s = chain.free_velocity_width, chain.thermal_length

# %% tags=["hide-input"]
left, right_panel = panels(2, height=3.8)
counts = left.hist2d(x / s, v / W, bins=60, range=[(-3.5, 3.5)] * 2, cmap="Greys", density=True)
left.set(xlabel="x / s", ylabel="v / W", aspect="equal")
left.figure.colorbar(counts[3], ax=left, label="density f s W")
angle = np.linspace(0, 2 * np.pi, 200)
for r in (1, 2, 3):
    left.plot(r * np.cos(angle), r * np.sin(angle), color=RED, linewidth=0.8)
left.plot([], [], color=RED, label="circles: 1, 2, 3 widths")
left.legend(loc="upper right", fontsize=8)
edges = np.linspace(-4.5, 4.5, 46)
middle = (edges[1:] + edges[:-1]) / 2
for values, colour, symbol, name in ((x / s, PINK, "o", "x / s"), (v / W, GREEN, "^", "v / W")):
    density, _ = np.histogram(values, edges, density=True)
    right_panel.semilogy(middle, density, symbol, color=colour, markersize=4, label=name)
gauss = np.exp(-(middle**2) / 2) / np.sqrt(2 * np.pi)
right_panel.semilogy(middle, gauss, color="black", label="Gaussian")
right_panel.set(xlabel="in units of the width", ylabel="probability density", ylim=(1e-5, 1))
right_panel.legend()
plt.show()

# %% [markdown]
# Cut the history into 50 blocks, each much longer than the memory of the rod. The scatter of the
# block means gives the error.

# %%
shares = {
    "share of time with |v| > 2 W": (abs(v) > 2 * W, solutions.SHARE_BEYOND_TWO_WIDTHS),
    "mean of x v / (s W)": (x * v / (s * W), 0),
    "mean of (x/s)² (v/W)²": ((x * v / (s * W)) ** 2, 1),
}
for name, (values, theory) in shares.items():
    mean, error = mean_and_error([block.mean() for block in np.array_split(values, 50)])
    agree(name, mean, theory, error)

# %% [markdown]
# <details><summary>Explain</summary>
#
# Yes, it does. After a few swings the rod has forgotten where it was. Different stretches of one
# long history are therefore as good as different rods. This is what "ergodic" means. Position and
# velocity at the same instant are *independent*, although the velocity is the derivative of the
# position.
#
# </details>
#
# ## 3. Your own simulation
#
# Euler's scheme keeps all forces constant during a step $\Delta t$. The velocity changes first. The
# new velocity then moves the rod. The kicks of a step add up like a random walk, so the noise
# contributes $\frac Am\sqrt{\Delta t}\,\zeta$, which is *not* proportional to $\Delta t$.
#
# **Your turn.** Write one step. `zeta` is a Gaussian number of variance 1.


# %% tags=["hide-input"]
def expected_step(x, v, dt, zeta):
    return solutions.euler_step(x, v, dt, zeta, chain)


states = [(1.0, 0.0, 0.1, 0.0), (0.0, 1.0, 0.1, 0.0), (0.0, 0.0, 0.1, 1.0), (1.0, -2.0, 0.3, 0.5)]


# %%
def my_step(x, v, dt, zeta):
    return ...  # your code here: the new x and the new v


hint = "The noise grows like sqrt(dt); move x with the new v."
also = [solutions.with_other_sign(expected_step)]
check(my_step, expected_step, at=states, hint=hint, also=also)

# %% tags=["remove-cell"]
x_then, v_then, dt, zeta = states[-1]
v_now = v_then + A / m * np.sqrt(dt) * zeta - dt / m * (k * x_then + gamma * v_then)
assert np.allclose(expected_step(*states[-1]), (x_then + dt * v_now, v_now))

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_step(x, v, dt, zeta):
#     v = v + dt / m * (-k * x - gamma * v) + A / m * np.sqrt(dt) * zeta
#     return x + dt * v, v
# ```
#
# </details>
#
# **Predict.** Without damping a swing takes $2\pi\sqrt{m/k}\approx13\,t_0$. Is a twelfth of
# it short enough for a step? Will $\langle v^2\rangle$ be too large or too small? What does half the
# step do to the error?
#
# **Run.** The code calls `expected_step`, so it runs whether or not you have written yours.


# %%
def euler(dt, duration, copies, rng):
    x, v = np.zeros((2, copies))
    for _ in range(round(duration / dt)):
        x, v = expected_step(x, v, dt, rng.standard_normal(copies))
    return x, v


rng, copies = np.random.default_rng(4), 20_000
swing = 2 * np.pi * np.sqrt(m / k)
for parts in (12, 24, 48):
    x, v = euler(swing / parts, 10 * m / gamma, copies, rng)
    print(f"swing / {parts}: <v^2> = {np.mean(v**2) / W**2:.3f} W^2", end=", ")
    print(f"<x^2> = {np.mean(x**2) / s**2:.3f} s^2   (± {np.sqrt(2 / copies):.3f})")

# %% [markdown]
# <details><summary>Explain</summary>
#
# With a twelfth of a swing $\langle v^2\rangle$ is too large by a quarter. For short steps half the
# step halves the error: it is of first order in $\Delta t$. The error of $\langle x^2\rangle$ is much
# smaller and of second order.
#
# </details>
#
# **You can stop here.** You have derived how fast and how far the rod moves, found its whole
# distribution, and written a simulation whose error you know. Lesson 2 needs no more.
#
# ## 4. How it forgets
#
# Write the equation as a system for the pair $z=(x,v)$,
#
# $$\dot z = \mathsf G z + \text{noise},\qquad
# \mathsf G=\begin{pmatrix}0&1\\-k/m&-\gamma/m\end{pmatrix}.$$
#
# The noise does not change the mean, so $\langle z(t)\rangle = e^{\mathsf Gt}z(0)$. The eigenvalues
# of $\mathsf G$ are $-\beta\pm i\Omega$ with $\beta=\gamma/2m$ and $\Omega=\sqrt{k/m-\beta^2}$,
# which is a damped swing. The covariance matrix obeys the three equations of section 1,
# $\dot{\mathsf C}=\mathsf{GC}+\mathsf{CG}^\top+\mathsf D$, where $\mathsf D$ has only the entry
# $A^2/m^2$ for $v$. If all copies start from one point, its solution is
#
# $$\mathsf C(t)=\mathsf C_\infty-e^{\mathsf Gt}\,\mathsf C_\infty\,e^{\mathsf G^\top t},\qquad
# \mathsf C_\infty=\begin{pmatrix}s^2&0\\0&W^2\end{pmatrix}.$$
#
# **Predict.** A thousand copies start together at $x=4s$, at rest. Sketch the cloud after a quarter
# of a swing, after half a swing, after one swing and after five swings.
#
# **Run.**

# %%
copies = 1000
start = cb.given_start(chain, [4 * s], replicas=copies)
settings = {"duration": 5 * swing, "every": swing / 8, "average": "ensemble", "progress": False}
cloud = cb.simulate(chain, start=start, replicas=copies, observe="snapshots", seed=3, **settings)
t = cloud.time.values
z = np.stack([cloud.position.values[:, :, 0], cloud.velocity.values[:, :, 0]])  # (2, copies, times)

# %%
G = np.array([[0, 1], [-k / m, -gamma / m]])
C_infinity = np.diag([s**2, W**2])
E = np.array([expm(G * time) for time in t])
mean = E @ np.array([4 * s, 0])
covariance = C_infinity - E @ C_infinity @ E.transpose(0, 2, 1)

# %% tags=["hide-input"]
ax = panels(width=7.5, height=4.8)
circle = 2 * np.stack([np.cos(angle), np.sin(angle)])
for place, colour in ((2, ORANGE), (4, GREEN), (8, PINK), (40, BLUE)):
    ax.plot(z[0, :, place] / s, z[1, :, place] / W, ".", color=colour, markersize=2, alpha=0.6)
    ellipse = mean[place][:, None] + np.linalg.cholesky(covariance[place]) @ circle
    name = f"t = {t[place]:.1f} $t_0$"
    ax.plot(ellipse[0] / s, ellipse[1] / W, color=colour, linewidth=2, label=name)
way = np.array([expm(G * time) @ [4 * s, 0] for time in np.linspace(0, t[-1], 500)])
ax.plot(way[:, 0] / s, way[:, 1] / W, "k--", linewidth=1, label="mean, theory")
ax.plot(4, 0, "kx", label="start")
ax.set(xlabel="x / s", ylabel="v / W", aspect="equal")
ax.legend(loc="upper left", bbox_to_anchor=(1.02, 1), title="ellipses: 2 widths, theory")
plt.show()
variances = covariance[1:, [0, 1], [0, 1]]
scatter = np.sqrt(variances / copies)
agree("mean x", z[0, :, 1:].mean(axis=0), mean[1:, 0], scatter[:, 0], unit="R")
agree("mean v", z[1, :, 1:].mean(axis=0), mean[1:, 1], scatter[:, 1], unit="R/t_0")
ratios = z[:, :, 1:].var(axis=1, ddof=1).T / variances
agree("measured variances over theory", ratios, 1, np.sqrt(2 / (copies - 1)))

# %% tags=["remove-cell"]
D = np.diag([0, A**2 / m**2])
assert np.allclose(G @ C_infinity + C_infinity @ G.T, -D)

# %% [markdown]
# <details><summary>Explain</summary>
#
# The cloud is carried along the spiral $e^{\mathsf Gt}z(0)$ and widens on the way. It first widens
# in $v$, where the noise acts. The swing then turns this width into a width in $x$. At the end the
# cloud does not depend on the start: the ellipse has become the circle of section 2.
#
# </details>
#
# ## 5. A better step
#
# Take damping and noise alone, $m\dot v=-\gamma v+A\xi$. During $\Delta t$ damping multiplies the
# velocity by $c=e^{-\gamma\Delta t/m}$. The kicks add up to a Gaussian number of mean 0. Its width
# $\sigma$ does not depend on $v$, so the velocity after the step is $v' = c\,v + \sigma\,\zeta$.
#
# **Your turn.** Write this step so that it is exact, however long $\Delta t$ is. To find $\sigma$,
# use that velocities of the width $W$ before the step have this width after it.


# %% tags=["hide-input"]
def damping_and_noise(v, dt, zeta):
    return solutions.damping_and_noise(v, dt, zeta, chain)


pushes = [(1.0, 0.5, 0.0), (0.0, 0.5, 1.0), (-0.4, 8.0, 0.7)]


# %%
def my_exact_step(v, dt, zeta):
    return ...  # your code here: the new v


hint = "The variances of c v and of sigma zeta add up to W**2: c**2 W**2 + sigma**2 = W**2."
also = [solutions.with_other_sign(damping_and_noise)]
check(my_exact_step, damping_and_noise, at=pushes, hint=hint, also=also)

# %% tags=["remove-cell"]
# A short step gives the kick of section 1. Two steps give what one step of twice the length gives.
assert np.isclose(damping_and_noise(0, 1e-9, 1), A / m * np.sqrt(1e-9))
c, kick = damping_and_noise(1, 0.3, 0), damping_and_noise(0, 0.3, 1)
assert np.isclose(damping_and_noise(1, 0.6, 0), c**2)
assert np.isclose(damping_and_noise(0, 0.6, 1), kick * np.sqrt(1 + c**2))

# %% [markdown]
# <details><summary>Solution</summary>
#
# Before the step $\langle v^2\rangle=W^2$, and after it $\langle v'^2\rangle=c^2W^2+\sigma^2$. The
# two are equal if $\sigma=W\sqrt{1-c^2}$.
#
# ```python
# def my_exact_step(v, dt, zeta):
#     c = np.exp(-gamma * dt / m)
#     return c * v + W * np.sqrt(1 - c**2) * zeta
# ```
#
# </details>
#
# The **splitting scheme** of `simulate` is symmetric in time: damping and noise over $\Delta t/2$,
# half a spring kick, flight (in a chain: with all collisions), half a spring kick, damping and
# noise over $\Delta t/2$.
#
# One step of either scheme is a linear map, $z' = \mathsf B z + \text{noise}$. The covariance matrix
# that it leaves unchanged solves a *discrete Lyapunov equation*,
# $\mathsf C = \mathsf{BCB}^\top+\mathsf N$, where $\mathsf N$ is the covariance of the noise of a
# step. This gives the errors of a scheme without any random number.


# %%
def euler_map(dt):
    kick = np.array([[1, 0], [-k * dt / m, 1 - gamma * dt / m]])
    flight = np.array([[1, dt], [0, 1]])
    b = flight @ [0, A / m * np.sqrt(dt)]
    return flight @ kick, np.outer(b, b)


def splitting_map(dt):
    c = np.exp(-gamma * dt / (2 * m))
    heat, noise = np.diag([1, c]), np.diag([0, W**2 * (1 - c**2)])
    half_kick = np.array([[1, 0], [-k * dt / (2 * m), 1]])
    verlet = half_kick @ np.array([[1, dt], [0, 1]]) @ half_kick
    return heat @ verlet @ heat, heat @ verlet @ noise @ verlet.T @ heat + noise


# %% [markdown]
# **Predict.** Draw the errors of both schemes against the step on logarithmic axes. What are the
# slopes?
#
# **Run.** Lines come from the Lyapunov equation, symbols from `simulate` with both steppers, for two
# rods so far apart that they never meet (a single rod would be moved exactly).


# %%
def errors(scheme, dt):  # relative errors of <x^2> and <v^2> in the steady state
    C = solve_discrete_lyapunov(*scheme(dt))
    return np.array([C[0, 0] / s**2, C[1, 1] / W**2]) - 1


maps = {"euler": euler_map, "splitting": splitting_map}
apart, measured = chain.replace(size=2, gap=100, restitution=0), {}
for stepper in maps:
    for dt in swing / np.array([32, 16, 8]):
        how = {"stepper": stepper, "time_step": dt, "observe": "widths", "progress": False}
        run = cb.simulate(apart, duration=200_000, seed=5, **how).isel(particle=0)
        x, v = run.displacement_width.item() / s, run.velocity_width.item() / W
        dx, dv = run.displacement_width_error.item() / s, run.velocity_width_error.item() / W
        measured[stepper, dt] = np.array([x**2 - 1, v**2 - 1]), np.array([2 * x * dx, 2 * v * dv])

# %% tags=["hide-input"]
steps = swing * np.geomspace(0.001, 0.15, 25)
lines = {name: np.array([errors(scheme, dt) for dt in steps]) for name, scheme in maps.items()}
ax = panels(width=7, height=4)
styles = {
    ("euler", 1): (RED, "o", "Euler", r"$\langle v^2\rangle$"),
    ("euler", 0): (ORANGE, "s", "Euler", r"$\langle x^2\rangle$"),
    ("splitting", 0): (BLUE, "^", "splitting", r"$\langle x^2\rangle$"),
}
for (stepper, which), (colour, symbol, name, moment) in styles.items():
    dashes = "--" if (stepper, which) == ("euler", 0) else "-"
    line = abs(lines[stepper][:, which])
    ax.loglog(steps, line, dashes, color=colour, label=f"{name}, {moment}", zorder=3)
    slope = np.polyfit(np.log(steps[:10]), np.log(line[:10]), 1)[0]
    print(f"{name}, <{'xv'[which]}^2>: order {slope:.2f}")
    for (each, dt), (off, error) in measured.items():
        if each == stepper and abs(off[which]) > 3 * error[which]:  # else nothing to draw
            ax.errorbar(dt, abs(off[which]), error[which], fmt=symbol, color=colour, markersize=5)
ax.set(xlabel=r"time step $\Delta t$ [$t_0$]", ylabel="relative error in the steady state")
ax.legend(title=r"$\langle v^2\rangle$ of splitting: no error")
plt.show()
for stepper, scheme in maps.items():
    seen = {dt: found for (each, dt), found in measured.items() if each == stepper}
    off, error = np.transpose(list(seen.values()), (1, 0, 2))  # (steps, moments)
    theory = [errors(scheme, dt) for dt in seen]
    agree(f"{stepper}, errors of <x^2> and <v^2> at three steps", off, theory, error)

# %% tags=["remove-cell"]
for dt in (0.01, 0.1, 1, 3):
    exact = errors(splitting_map, dt)
    assert abs(exact[1]) < 1e-9
    assert abs(exact[0] + 1 - 1 / (1 - k / m * (dt / 2) ** 2)) < 1e-9
assert abs(errors(splitting_map, 0.1)[0] - 0.0006) < 5e-5
assert abs(errors(euler_map, 0.1)[1] - 0.013) < 5e-4
assert np.allclose(errors(euler_map, 0.01) / errors(euler_map, 0.005), [4, 2], rtol=0.02)

# %% [markdown]
# <details><summary>Explain</summary>
#
# For the velocities Euler's scheme is of first order. The splitting scheme has no error there, at
# any step, and an error of second order for the positions,
# $\langle x^2\rangle=s^2/(1-\frac km(\Delta t/2)^2)$. At $\Delta t=0.1$ Euler's scheme is wrong by
# 1.3 % in $\langle v^2\rangle$, and splitting by 0.06 % in $\langle x^2\rangle$.
#
# </details>
#
# ## Exercise
#
# **A spring that is not linear.** With `cb.Chain(size=1, spring="quadratic")` the force is
# $F=kx|x|$. What are the stationary distributions of $x$ and $v$? Compute
# $\langle x^4\rangle/\langle x^2\rangle^2$ and $\langle v^4\rangle/\langle v^2\rangle^2$, which are
# both 3 for a Gaussian, and compare with a simulation.
#
# <details><summary>Solution</summary>
#
# In section 2 only the last cancellation used the linear force. With $U(x)=\frac k3|x|^3$ in
# place of $\frac k2x^2$, $f\sim e^{-v^2/2W^2}\,e^{-U(x)/mW^2}$ is stationary. With
# $\langle|x|^n\rangle = (3mW^2/k)^{n/3}\,\Gamma(\frac{n+1}3)/\Gamma(\frac13)$ the ratio for $x$
# is $\Gamma(\frac53)\,\Gamma(\frac13)=2.418$. For $v$ it stays 3.
#
# </details>
