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
# **Question.** A rod hangs on a spring. Friction slows it, and noise shakes it. It never comes to
# rest, and it never flies away. How fast does it move? How far does it get? How soon does it forget
# where it was? And how much of the answer is an error of the computer's time step?
#
# This is the chain of [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460)
# with a single rod, `Chain(size=1)`, which has no neighbour to collide with. The paper calls it
# the free case. Everything about it can be computed by hand. It is therefore a good place to learn
# the equation of motion, its Fokker-Planck equation, and the time-stepping scheme that all other
# lessons use.
#
# *Level: second year. You need: Newton's equation, a matrix exponential, numpy. Time: 90 minutes for
# the first half, sections 1 to 4, and 60 for the second, sections 5 and 6, which may come later.
# To predict before you see the results, type `make lessons` in the folder of the project, and open
# the copy of this lesson without outputs in `build/lessons/`.*

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy.linalg import expm, solve_continuous_lyapunov, solve_discrete_lyapunov
from teaching import BLUE, GREEN, ORANGE, PINK, RED, agree, check, mean_and_error, panels, right

# %%
import crazybilliards as cb

chain = cb.Chain(size=1)
path = cb.simulate(chain, duration=200, every=0.1, observe="snapshots", seed=7, progress=False)
x, v = path.position.values[0, :, 0], path.velocity.values[0, :, 0]
t = path.time.values - path.time.values[0]

# %% tags=["hide-input"]
left, right_panel = panels(2, height=3.4, width_ratios=(2, 1))
left.plot(t, x, color=BLUE, label="position x [R]")
left.plot(t, v, color=ORANGE, label="velocity v [R/T]")
left.set(xlabel="time t [T]", xlim=(0, t[-1]), ylim=(-3.3, 3.3))
left.legend(loc="upper right", ncols=2)
right_panel.plot(x, v, color=BLUE, linewidth=0.8)
right_panel.plot(x[-1], v[-1], "o", color=RED, label="now")
right_panel.set(xlabel="position x [R]", ylabel="velocity v [R/T]")
right_panel.legend(loc="upper left")
plt.show()

# %% [markdown]
# The left panel shows a swing that is never quite regular. The right panel shows the same motion in
# phase space. The point turns round and round, each time on another orbit.
#
# ## 1. The Langevin equation
#
# The rod's displacement $x$ from its anchor obeys the paper's equation of motion,
#
# $$m\ddot x = -\gamma\dot x - kx + A\,\xi(t),\qquad
# \langle\xi(t)\rangle = 0,\quad \langle\xi(t)\,\xi(t')\rangle = \delta(t-t').$$
#
# **Units.** Lengths are measured in rod radii R, masses in M, and times in $\mathsf{T}=\sqrt{M/k}$.
# The rod has the mass of a sphere of unit density, $m=\frac{4\pi}{3}$ M. In these units $k=1$. The
# damping $\gamma$ and the noise amplitude $A$ are 1 unless another value is given. Because
# $\delta(t)$ has the unit 1/time, $\xi$ has the unit $1/\sqrt{\text{time}}$, and $A$ has the unit
# force times $\sqrt{\text{time}}$.
#
# **How fast, and how far?** Three averages answer both questions. During a short time $dt$ the
# noise changes the velocity by $\frac{A}{m}\sqrt{dt}\,\zeta$, where $\zeta$ is a Gaussian number of
# variance 1. On average this adds $\frac{A^2}{m^2}dt$ to $v^2$. Therefore
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
# $mW^2 = A^2/2\gamma$ acts as a temperature in units of energy, because $\frac m2\langle
# v^2\rangle = \frac k2\langle x^2\rangle = \frac12mW^2$ is equipartition. In this model noise and
# friction are given separately, and the temperature follows from them.
#
# **Predict.** Make the rod twice as heavy. Does it move more slowly? Does it stay closer to its
# anchor? What does twice the friction do?
#
# **Run.**

# %%
variants = {
    "as it is": chain,
    "mass doubled": chain.replace(mass=2 * chain.mass),
    "friction doubled": chain.replace(damping=2),
}
runs = {}
for name, one in variants.items():
    run = cb.simulate(one, duration=100_000, observe="widths", seed=1, progress=False)
    print(f"{name:17s} W = {run.velocity_width.item():.4f} R/T,", end=" ")
    print(f"s = {run.displacement_width.item():.4f} R")
    runs[name] = run

# %% tags=["remove-cell"]
for name, one in variants.items():
    run = runs[name]
    agree(name, run.velocity_width, one.free_velocity_width, run.velocity_width_error)
    agree(name, run.displacement_width, one.thermal_length, run.displacement_width_error)

# %% [markdown]
# <details><summary>Explain</summary>
#
# The heavier rod is slower by the factor $\sqrt2$, but it gets just as far, because
# $s=A/\sqrt{2\gamma k}$ does not contain the mass. Twice the friction reduces both widths by
# $\sqrt2$, because the noise does not grow with the friction.
#
# </details>
#
# ## 2. The Fokker-Planck equation
#
# The widths do not describe the whole distribution. Imagine very many copies of the rod. Their
# density $f(x, v, t)$ in phase space is carried along by velocity and force, and the random kicks
# make it diffuse in $v$. In $dt$ the kicks change $v$ by a random amount of mean square
# $(A/m)^2dt$. A diffusion constant is half the mean square per time, here $A^2/2m^2$:
#
# $$\partial_t f + v\,\partial_x f - \frac{k}{m}x\,\partial_v f
# = \partial_v\!\left[\frac{\gamma}{m}v f + \frac{A^2}{2m^2}\,\partial_v f\right].$$
#
# This is Kramers' equation. Collisions with other rods would add terms on the right. For $e \ne 1$
# the package solves that equation as well. Let us try a Gaussian in each variable,
#
# $$f = \frac{1}{2\pi W s}\,e^{-v^2/2W^2}\,e^{-x^2/2s^2}.$$
#
# On the right, $\partial_v f=-\frac{v}{W^2}f$. The square bracket is zero since
# $\frac{A^2}{2m^2}=\frac\gamma m W^2$, so friction and noise balance at every $v$. On the left,
# $v\,\partial_xf=-\frac{xv}{s^2}f$ and $-\frac km x\,\partial_vf=+\frac{k}{m}\frac{xv}{W^2}f$
# cancel since $W^2=\frac km s^2$. This $f$ is therefore stationary. Position and velocity at the
# same instant are *independent*, although the velocity is the derivative of the position.
#
# **Predict.** Now watch a single rod for a very long time, instead of very many rods once. Will the
# share of time that it spends at each $x$ and $v$ follow the same $f$?
#
# **Run.**

# %%
long = cb.simulate(chain, duration=200_000, every=1, observe="snapshots", seed=2, progress=False)
x, v = long.position.values[0, :, 0], long.velocity.values[0, :, 0]
k, m, gamma, A = chain.stiffness, chain.mass, chain.damping, chain.amplitude
W, s = chain.free_velocity_width, chain.thermal_length

# %% tags=["hide-input"]
left, right_panel = panels(2, height=3.8)
counts = left.hist2d(x / s, v / W, bins=60, range=[(-3.5, 3.5)] * 2, cmap="Blues", density=True)
left.set(xlabel="x / s", ylabel="v / W", aspect="equal")
left.figure.colorbar(counts[3], ax=left, label="density f s W")
angle = np.linspace(0, 2 * np.pi, 200)
for r in (1, 2, 3):
    left.plot(r * np.cos(angle), r * np.sin(angle), color=RED, linewidth=0.8)
left.plot([], [], color=RED, label="circles: 1, 2, 3 widths")
left.legend(loc="upper right", fontsize=8)
edges = np.linspace(-4.5, 4.5, 46)
middle = (edges[1:] + edges[:-1]) / 2
for values, colour, symbol, name in ((x / s, BLUE, "o", "x / s"), (v / W, ORANGE, "^", "v / W")):
    density, _ = np.histogram(values, edges, density=True)
    right_panel.semilogy(middle, density, symbol, color=colour, markersize=4, label=name)
gauss = np.exp(-(middle**2) / 2) / np.sqrt(2 * np.pi)
right_panel.semilogy(middle, gauss, color="black", label="Gaussian")
right_panel.set(xlabel="in units of the width", ylabel="probability density", ylim=(1e-5, 1))
right_panel.legend()
plt.show()

# %% [markdown]
# The pictures look right. Moments say it in numbers. The history is cut into 50 blocks, each much
# longer than the memory of the rod. The scatter of their means gives the standard error.

# %%
moments = {
    "<x v> / (s W)": (x * v / (s * W), 0),
    "<x^4> / s^4": ((x / s) ** 4, 3),
    "<v^4> / W^4": ((v / W) ** 4, 3),
    "<x^2 v^2> / (s W)^2": ((x * v / (s * W)) ** 2, 1),
}
for name, (values, theory) in moments.items():
    mean, error = mean_and_error([block.mean() for block in np.array_split(values, 50)])
    print(f"{name:20s} {mean:7.4f} ± {error:.4f}; Gaussian and independent: {theory}")

# %% tags=["remove-cell"]
for name, (values, theory) in moments.items():
    mean, error = mean_and_error([block.mean() for block in np.array_split(values, 50)])
    agree(name, mean, theory, error)

# %% [markdown]
# <details><summary>Explain</summary>
#
# Yes, it does. After a few swings the rod has forgotten where it was. Different stretches of one
# long history are therefore as good as different rods. This is what "ergodic" means here, and it is
# the reason why `simulate` averages over time by default.
#
# </details>
#
# ## 3. How it forgets
#
# Write the equation as a system for the pair $z=(x,v)$,
#
# $$\dot z = \mathsf G z + \text{noise},\qquad
# \mathsf G=\begin{pmatrix}0&1\\-k/m&-\gamma/m\end{pmatrix}.$$
#
# The system is linear, so the noise does not change the mean: $\langle z(t)\rangle = e^{\mathsf
# Gt}z(0)$. With $\beta=\gamma/2m$ and $\Omega=\sqrt{k/m-\beta^2}$ the eigenvalues of $\mathsf G$
# are $-\beta\pm i\Omega$, which is a damped swing. The covariance matrix $\mathsf C$ of $(x,v)$
# obeys $\dot{\mathsf C}=\mathsf{GC}+\mathsf{CG}^\top+\mathsf D$, where $\mathsf D$ has only the
# entry $A^2/m^2$ for $v$. These are the three equations of section 1. If all copies start from one
# point, then
#
# $$\mathsf C(t)=\mathsf C_\infty-e^{\mathsf Gt}\,\mathsf C_\infty\,e^{\mathsf G^\top t}.$$
#
# To check this, insert it into the equation; it is zero at $t=0$. A Gaussian stays a Gaussian, so
# mean and covariance are the full solution of Kramers' equation.

# %%
G = np.array([[0, 1], [-k / m, -gamma / m]])
D = np.diag([0, A**2 / m**2])
C_infinity = solve_continuous_lyapunov(G, -D)  # solves G C + C G^T = -D
beta = gamma / (2 * m)
Omega = np.sqrt(k / m - beta**2)
remaining = np.exp(-2 * np.pi * beta / Omega)
print(f"one swing takes {2 * np.pi / Omega:.1f} T; {remaining:.2f} of its amplitude remains")

# %% tags=["remove-cell"]
assert np.allclose(C_infinity, np.diag([s**2, W**2]))

# %% [markdown]
# **Predict.** A thousand copies start together at $x=4s$, at rest. Sketch the cloud after a quarter
# of a swing, after half a swing, after one swing and after five swings.
#
# **Run.**

# %%
copies = 1000
start = cb.given_start(chain, [4 * s], replicas=copies)
cloud = cb.simulate(
    chain,
    start=start,
    replicas=copies,
    average="ensemble",
    duration=66,
    every=1.65,  # about an eighth of a swing
    observe="snapshots",
    seed=3,
    progress=False,
)

# %%
t = cloud.time.values
z = np.stack([cloud.position.values[:, :, 0], cloud.velocity.values[:, :, 0]])  # (2, copies, times)
E = np.array([expm(G * time) for time in t])
mean = E @ np.array([4 * s, 0])
covariance = C_infinity - E @ C_infinity @ E.transpose(0, 2, 1)

# %% tags=["hide-input"]
ax = panels(width=7.5, height=4.8)
circle = 2 * np.stack([np.cos(angle), np.sin(angle)])
for place, colour in ((2, ORANGE), (4, GREEN), (8, PINK), (40, BLUE)):
    ax.plot(z[0, :, place] / s, z[1, :, place] / W, ".", color=colour, markersize=2, alpha=0.6)
    ellipse = mean[place][:, None] + np.linalg.cholesky(covariance[place]) @ circle
    name = f"t = {t[place]:.1f} T"
    ax.plot(ellipse[0] / s, ellipse[1] / W, color=colour, linewidth=2, label=name)
way = np.array([expm(G * time) @ [4 * s, 0] for time in np.linspace(0, 66, 500)])
ax.plot(way[:, 0] / s, way[:, 1] / W, "k--", linewidth=1, label="mean, theory")
ax.plot(4, 0, "kx", label="start")
ax.set(xlabel="x / s", ylabel="v / W", aspect="equal")
ax.legend(loc="upper left", bbox_to_anchor=(1.02, 1), title="ellipses: 2 widths, theory")
plt.show()
variances = covariance[1:, [0, 1], [0, 1]]
agree("means of x and v", z.mean(axis=1).T[1:], mean[1:], np.sqrt(variances / copies))
measured = z[:, :, 1:].var(axis=1, ddof=1).T
agree("variances", measured / variances, 1, np.sqrt(2 / (copies - 1)))  # of a Gaussian's variance

# %% [markdown]
# <details><summary>Explain</summary>
#
# The cloud is carried along the spiral $e^{\mathsf Gt}z(0)$ and widens on the way. It first widens
# in $v$, where the noise acts. The swing then turns this width into a width in $x$. At the end the
# cloud does not depend on the start: the ellipse has become the circle of section 2.
#
# </details>
#
# **The same matrix describes how the *steady* motion forgets.** Choose the moments at which the
# steady rod has the velocity $v_0$. Its position then has mean zero, so from there on its mean
# velocity is $(e^{\mathsf Gt})_{vv}v_0$. Multiply by $v_0$ and average:
#
# $$\frac{\langle v(0)\,v(t)\rangle}{W^2} = (e^{\mathsf Gt})_{vv}
# = e^{-\beta t}\left(\cos\Omega t-\frac\beta\Omega\sin\Omega t\right).$$
#
# This is Onsager's regression: on average a spontaneous fluctuation decays as a push by hand does.


# %%
def correlation(values, most):
    lags = range(most + 1)
    return np.array([np.mean(values[: values.size - n] * values[n:]) for n in lags])


blocks = [correlation(block, 40) for block in np.array_split(v, 50)]  # snapshots are 1 T apart
measured, error = mean_and_error(np.array(blocks) / W**2)
lag = np.arange(41.0)
theory = [expm(G * time)[1, 1] for time in lag]
agree("correlation of velocities", measured, theory, error)

# %% tags=["hide-input"]
fine = np.linspace(0, 40, 400)
curve = np.exp(-beta * fine) * (np.cos(Omega * fine) - beta / Omega * np.sin(Omega * fine))
ax = panels(width=7, height=3)
ax.plot(fine, curve, color=ORANGE, linewidth=2, label=r"$(e^{\mathsf{G}t})_{vv}$")
ax.errorbar(lag, measured, error, fmt="o", color="black", markersize=3, label="simulation")
ax.axhline(0, color="0.7", linewidth=0.8)
ax.set(xlabel="time t [T]", ylabel=r"$\langle v(0)\,v(t)\rangle\,/\,W^2$", xlim=(-0.5, 40.5))
ax.legend()
plt.show()

# %% tags=["remove-cell"]
closed_form = np.exp(-beta * lag) * (np.cos(Omega * lag) - beta / Omega * np.sin(Omega * lag))
assert np.allclose(closed_form, theory)

# %% [markdown]
# ## 4. Your own simulation
#
# Euler's scheme keeps all forces constant during a step $\Delta t$. The velocity changes first. The
# new velocity then moves the rod. The paper uses Euler's scheme too, without saying which of the two
# velocities moves the rod. The random kicks of a step add up like a random walk, so the noise
# contributes $\frac Am\sqrt{\Delta t}\,\zeta$, which is *not* proportional to $\Delta t$.
#
# **Your turn.** Write one step. `zeta` is a Gaussian number of variance 1.


# %% tags=["remove-cell"]
def euler_step(x, v, dt, zeta):
    v = v + dt / m * (-k * x - gamma * v) + A / m * np.sqrt(dt) * zeta
    return x + dt * v, v


def other_sign(step):  # zeta and -zeta are equally probable
    return lambda *state: step(*state[:-1], -state[-1])


states = [(1.0, 0.0, 0.1, 0.0), (0.0, 1.0, 0.1, 0.0), (0.0, 0.0, 0.1, 1.0), (1.0, -2.0, 0.3, 0.5)]


# %%
def my_step(x, v, dt, zeta):
    return ...  # your code here: the new x and the new v


hint = "The noise grows like sqrt(dt); move x with the new v."
check(my_step, euler_step, at=states, hint=hint, also=[other_sign(euler_step)])

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
# **Predict.** A swing takes $2\pi/\Omega \approx 13$ time units (section 3). Is $\Delta t = 1$
# short enough? By how much will $\langle v^2\rangle$ be wrong?
#
# **Run.** The code calls `euler_step`, which is the step of the solution above.

# %% tags=["remove-cell"]
x_then, v_then, dt, zeta = states[-1]
v_now = v_then + A / m * np.sqrt(dt) * zeta - dt / m * (k * x_then + gamma * v_then)
assert right(euler_step(*states[-1]), (x_then + dt * v_now, v_now))
assert not right(lambda *state: euler_step(*state)[::-1], euler_step, at=states)


# %%
def euler(dt, duration, copies, rng):
    x, v = np.zeros((2, copies))
    for _ in range(round(duration / dt)):
        x, v = euler_step(x, v, dt, rng.standard_normal(copies))
    return x, v


rng, copies = np.random.default_rng(4), 20_000
for dt in (1, 0.5, 0.25):
    x, v = euler(dt, 60, copies, rng)
    print(f"dt = {dt:4}: <v^2> = {np.mean(v**2) / W**2:.3f} W^2", end=", ")
    print(f"<x^2> = {np.mean(x**2) / s**2:.3f} s^2   (± {np.sqrt(2 / copies):.3f})")

# %% [markdown]
# <details><summary>Explain</summary>
#
# At $\Delta t=1$, a thirteenth of a swing, $\langle v^2\rangle$ is too large by a fifth. With half
# the step, less than half of this error remains.
#
# </details>
#
# The statistical noise hides smaller errors. They can be computed without any noise. One step is a
# linear map, $z' = \mathsf B z + \mathsf b\,\zeta$, so the covariance matrix that it leaves
# unchanged solves
#
# $$\mathsf C = \mathsf{BCB}^\top+\mathsf{bb}^\top,$$
#
# a *discrete Lyapunov equation*.


# %%
def euler_map(chain, dt):
    k, m, gamma, A = chain.stiffness, chain.mass, chain.damping, chain.amplitude
    kick = np.array([[1, 0], [-k * dt / m, 1 - gamma * dt / m]])
    flight = np.array([[1, dt], [0, 1]])
    b = flight @ [0, A / m * np.sqrt(dt)]
    return flight @ kick, np.outer(b, b)


def errors(scheme, dt):  # relative errors of <x^2> and <v^2> in the steady state
    C = solve_discrete_lyapunov(*scheme(chain, dt))
    return np.array([C[0, 0] / s**2, C[1, 1] / W**2]) - 1


# %%
print("Euler at dt = 1: errors of <x^2> and <v^2>", errors(euler_map, 1.0).round(4))
print("half the step divides them by", errors(euler_map, 0.01) / errors(euler_map, 0.005))

# %% tags=["remove-cell"]
exact = errors(euler_map, 1.0)
x, v = euler(1.0, 60, copies, rng)
for values, width, error in ((x, s, exact[0]), (v, W, exact[1])):
    agree("Euler", np.mean(values**2) / width**2 / (1 + error), 1, np.sqrt(2 / copies))
assert 0.21 < exact[1] < 0.22
assert np.allclose(errors(euler_map, 0.01) / errors(euler_map, 0.005), [4, 2], rtol=0.02)
C = solve_discrete_lyapunov(*euler_map(chain, 0.1))
assert np.isclose(C[0, 1], 0.1 / 2 * C[1, 1])

# %% [markdown]
# The error of $\langle v^2\rangle$ is of first order in $\Delta t$, and that of $\langle
# x^2\rangle$ is of second order. There is one more error. The mean $\langle xv\rangle$ should be
# zero. From $x'=x+v'\Delta t$ and $\langle x'^2\rangle=\langle x^2\rangle$ it follows that $\langle
# x'v'\rangle=\frac{\Delta t}2\langle v^2\rangle$: position and velocity of the scheme belong to
# times that are half a step apart.
#
# ## 5. Splitting: solve exactly what can be solved
#
# *The second half begins here. It may wait: other lessons use this scheme, but not its derivation.*
#
# Take friction and noise alone, $m\dot v=-\gamma v+A\xi$. During $\Delta t$ friction multiplies the
# velocity by $c=e^{-\gamma\Delta t/m}$. The kicks of the noise add up to a Gaussian number of mean
# 0. Its width $\sigma$ does not depend on $v$, so the velocity after the step is
#
# $$v' = c\,v + \sigma\,\zeta .$$
#
# **Your turn.** Write this step so that it is exact, however long $\Delta t$ is. To find $\sigma$,
# use that friction and noise alone have a steady state too: velocities that have the width $W$
# before the step have this width after it.


# %% tags=["remove-cell"]
def friction_and_noise(v, dt, zeta):
    c = np.exp(-gamma * dt / m)
    return c * v + W * np.sqrt(1 - c**2) * zeta


pushes = [(1.0, 0.5, 0.0), (0.0, 0.5, 1.0), (-0.4, 8.0, 0.7)]
# A short step gives the kick of section 1. Two steps give what one step of twice the length gives.
assert np.isclose(friction_and_noise(0, 1e-9, 1), A / m * np.sqrt(1e-9))
c, kick = friction_and_noise(1, 0.3, 0), friction_and_noise(0, 0.3, 1)
assert right(friction_and_noise(1, 0.6, 0), c**2)
assert right(friction_and_noise(0, 0.6, 1), kick * np.sqrt(1 + c**2))
assert not right(lambda v, dt, zeta: v - gamma * dt / m * v, friction_and_noise, at=pushes)


# %%
def my_exact_step(v, dt, zeta):
    return ...  # your code here: the new v


check(
    my_exact_step,
    friction_and_noise,
    at=pushes,
    hint="The variances of c v and of sigma zeta add up to W**2: c**2 W**2 + sigma**2 = W**2.",
    also=[other_sign(friction_and_noise)],
)

# %% [markdown]
# <details><summary>Solution</summary>
#
# Before the step $\langle v^2\rangle=W^2$, and after it $\langle v'^2\rangle=c^2W^2+\sigma^2$. The
# two are equal if $\sigma=W\sqrt{1-c^2}$. Ornstein and Uhlenbeck found this result.
#
# ```python
# def my_exact_step(v, dt, zeta):
#     c = np.exp(-gamma * dt / m)
#     return c * v + W * np.sqrt(1 - c**2) * zeta
# ```
#
# </details>
#
# With this step the width stays right, however long the step is. Euler's scheme has
# $1-\gamma\Delta t/m$ in place of $c$. (In the code below `friction_and_noise` is this exact step.)
# Spring and flight alone are a problem of mechanics. Half a kick, flight, half a kick is Verlet's
# scheme, which neither heats nor cools in the long run. The **splitting scheme** puts the two
# together symmetrically:
#
# 1. friction and noise over $\Delta t/2$, exactly;
# 2. half a spring kick, $v\to v-\frac{\Delta t}{2m}kx$;
# 3. flight, $x\to x+v\,\Delta t$ (in a chain: with all collisions);
# 4. half a spring kick;
# 5. friction and noise over $\Delta t/2$.
#
# Because the scheme is symmetric in time, the leading error, of first order, cancels. Step 5 and
# step 1 of the next step can be drawn as one, so the scheme needs one random number per step, as
# Euler's scheme does. It is the default of `simulate` (`stepper="splitting"`) for all chains whose
# motion is not known exactly. That of a single rod is (section 3), and `simulate` then takes one
# exact step from snapshot to snapshot.


# %%
def splitting(dt, duration, copies, rng):
    x, v = np.zeros((2, copies))
    for _ in range(round(duration / dt)):
        v = friction_and_noise(v, dt / 2, rng.standard_normal(copies))
        v = v - dt / (2 * m) * k * x
        x = x + dt * v
        v = v - dt / (2 * m) * k * x
        v = friction_and_noise(v, dt / 2, rng.standard_normal(copies))
    return x, v


# %% tags=["hide-input"]
def splitting_map(chain, dt):
    k, m, gamma, W = chain.stiffness, chain.mass, chain.damping, chain.free_velocity_width
    c = np.exp(-gamma * dt / (2 * m))
    heat, noise = np.diag([1, c]), np.diag([0, W**2 * (1 - c**2)])
    half_kick = np.array([[1, 0], [-k * dt / (2 * m), 1]])
    verlet = half_kick @ np.array([[1, dt], [0, 1]]) @ half_kick
    return heat @ verlet @ heat, heat @ verlet @ noise @ verlet.T @ heat + noise


exact = errors(splitting_map, 1.0)
print(f"splitting at dt = 1: error of <x^2> {exact[0]:+.4f}, of <v^2> {exact[1]:+.0e}")

# %% tags=["remove-cell"]
x, v = splitting(1.0, 60, copies, rng)
for values, width, error in ((x, s, exact[0]), (v, W, exact[1])):
    agree("splitting", np.mean(values**2) / width**2 / (1 + error), 1, np.sqrt(2 / copies))
omega = np.sqrt(k / m)
for dt in (0.01, 0.1, 1, 3):
    exact = errors(splitting_map, dt)
    assert abs(exact[1]) < 1e-9
    assert abs(exact[0] + 1 - 1 / (1 - (omega * dt / 2) ** 2)) < 1e-9

# %% [markdown]
# The velocities are right to rounding errors at *any* step. The error of the positions is of second
# order, $\langle x^2\rangle=s^2/(1-(\omega_0\Delta t/2)^2)$ with $\omega_0=\sqrt{k/m}$. Both
# statements hold for a linear spring. Verlet's scheme conserves areas in phase space and, exactly,
#
# $$H' = \frac m2v^2 + \frac k2\Big[1-\Big(\frac{\omega_0\Delta t}2\Big)^2\Big]x^2 .$$
#
# Friction and noise leave the Maxwellian of $v$ unchanged. Every part of the step therefore leaves
# $e^{-H'/mW^2}$ unchanged. This distribution has the right width in $v$ and a slightly too large one
# in $x$.
#
# ## 6. The order, measured
#
# **Predict.** Draw the errors of both schemes against the step on logarithmic axes. What are the
# slopes?
#
# **Run.** Lines come from the Lyapunov equation, symbols from `simulate` with both steppers, for two
# rods so far apart that they never meet (a single rod would be moved exactly). The
# right panel shows no steady state but a relaxation: the rod starts at rest at $x=s$, and we
# compare its mean after half a swing. This needs no noise either, since one step multiplies the
# mean by $\mathsf B$.

# %%
maps = {"euler": euler_map, "splitting": splitting_map}
apart, measured = chain.replace(size=2, gap=100, restitution=0), {}
for stepper in maps:
    for dt in (0.3, 0.6, 1.2, 2.4):
        long = {"duration": 1_000_000, "observe": "widths", "seed": 5, "progress": False}
        run = cb.simulate(apart, time_step=dt, stepper=stepper, **long).sel(particle=1)
        ratio = np.array([run.displacement_width.item() / s, run.velocity_width.item() / W])
        error = [run.displacement_width_error.item() / s, run.velocity_width_error.item() / W]
        measured[stepper, dt] = ratio**2 - 1, 2 * ratio * np.array(error)

# %%
half_swing = np.pi / Omega
relaxed = expm(G * half_swing) @ [s, 0]
counts = np.unique(np.geomspace(3, 640, 20).astype(int))  # of steps
transients = {}
for stepper, scheme in maps.items():
    one_step = [scheme(chain, half_swing / n)[0] for n in counts]
    ends = [np.linalg.matrix_power(B, n) @ [s, 0] for B, n in zip(one_step, counts, strict=True)]
    transients[stepper] = [np.linalg.norm((end - relaxed) / [s, W]) for end in ends]

# %% tags=["hide-input"]
steps = np.geomspace(0.01, 2.5, 25)
lines = {name: np.array([errors(scheme, dt) for dt in steps]) for name, scheme in maps.items()}
left, right_panel = panels(2, height=4)
styles = {
    ("euler", 1): (RED, "o", "Euler", r"$\langle v^2\rangle$"),
    ("euler", 0): (ORANGE, "s", "Euler", r"$\langle x^2\rangle$"),
    ("splitting", 0): (BLUE, "^", "splitting", r"$\langle x^2\rangle$"),
}
for (stepper, which), (colour, symbol, name, moment) in styles.items():
    dashes = "--" if (stepper, which) == ("euler", 0) else "-"
    line = abs(lines[stepper][:, which])
    left.loglog(steps, line, dashes, color=colour, label=f"{name}, {moment}", zorder=3)
    for dt in (0.3, 0.6, 1.2, 2.4):
        off, error = (values[which] for values in measured[stepper, dt])
        if abs(off) > 3 * error:  # else there is nothing to draw on a logarithmic axis
            left.errorbar(dt, abs(off), error, fmt=symbol, color=colour, markersize=5)
left.set(xlabel=r"time step $\Delta t$ [T]", ylabel="relative error in the steady state")
left.legend(title=r"$\langle v^2\rangle$ of splitting: no error")
for (stepper, values), colour in zip(transients.items(), (RED, BLUE), strict=True):
    name = {"euler": "Euler", "splitting": "splitting"}[stepper]
    right_panel.loglog(half_swing / counts, values, "-", color=colour, label=name)
right_panel.set(xlabel=r"time step $\Delta t$ [T]", ylabel="error of the mean after half a swing")
right_panel.legend()
plt.show()
small, fine = steps < 0.1, counts > 60
slopes = {
    name: np.polyfit(np.log(steps[small]), np.log(abs(lines[name[0]][small, name[1]])), 1)[0]
    for name in styles
}
for stepper, values in transients.items():
    fit = np.polyfit(np.log(half_swing / counts[fine]), np.log(np.array(values)[fine]), 1)
    slopes[stepper, "transient"] = fit[0]
for name, slope in slopes.items():
    print(f"{name[0]:9s} {({0: '<x^2>', 1: '<v^2>'}).get(name[1], name[1]):9s}: order {slope:.2f}")
for (stepper, dt), (off, error) in measured.items():
    agree(f"simulate, {stepper}, dt = {dt}", off, errors(maps[stepper], dt), error)

# %% tags=["remove-cell"]
expected = {
    ("euler", 1): 1,
    ("euler", 0): 2,
    ("euler", "transient"): 1,
    ("splitting", 0): 2,
    ("splitting", "transient"): 2,
}
assert all(abs(slopes[name] - order) < 0.05 for name, order in expected.items())
assert abs(errors(splitting_map, 0.1)[0] - 0.0006) < 5e-5
assert abs(errors(euler_map, 0.1)[1] - 0.013) < 5e-4
assert abs(np.sqrt(1 + errors(euler_map, 0.1)[1]) - 1.006) < 5e-4

# %% [markdown]
# <details><summary>Explain</summary>
#
# In the steady positions the two schemes do not differ much. But for the velocities, and for
# everything on the way to the steady state, Euler's scheme is of first order and splitting of
# second, at the same cost. A step of `simulate` may therefore be as long as 0.1 time
# units. At this step the splitting scheme is wrong by 0.06 % in $\langle x^2\rangle$ and not at all
# in $\langle v^2\rangle$. Euler's scheme is wrong by 1.3 % in $\langle v^2\rangle$, which is 0.6 %
# in the width.
#
# </details>
#
# ## Exercises
#
# **1. A spring that is not linear.** With `cb.Chain(size=1, spring="quadratic")` the force is
# $F=kx|x|$. What are the stationary distributions of $x$ and $v$? Compute
# $\langle x^4\rangle/\langle x^2\rangle^2$ and $\langle v^4\rangle/\langle v^2\rangle^2$, which are
# both 3 for a Gaussian, and compare with a simulation.
#
# <details><summary>Solution</summary>
#
# In section 2 only the last cancellation used the linear force. With $U(x)=\frac k3|x|^3$ in
# place of $\frac k2x^2$, $f\sim e^{-v^2/2W^2}\,e^{-U(x)/mW^2}$ is stationary. The velocities have the
# same Gaussian as before. The distribution of the displacements is flatter at the top and has
# thinner tails than a Gaussian. With
# $\langle|x|^n\rangle = (3mW^2/k)^{n/3}\,\Gamma(\frac{n+1}3)/\Gamma(\frac13)$ the ratio for $x$
# is $\Gamma(\frac53)\,\Gamma(\frac13)=2.418$.
#
# ```python
# soft = cb.Chain(size=1, spring="quadratic")
# run = cb.simulate(soft, duration=200_000, every=1, observe="snapshots", seed=6, progress=False)
# for values in (run.position.values, run.velocity.values):
#     print(np.mean(values**4) / np.mean(values**2) ** 2)
# ```
#
# prints 2.43 and 3.00. The velocities do not depend on the spring. (Section 2 had errors of some
# hundredths in a run of the same length.)
#
# </details>
#
# **2. Where the schemes blow up.** At which time step does each of the two maps $\mathsf B$ get
# an eigenvalue of modulus 1? What does `simulate` answer if you ask for a longer step for the two
# rods `apart`?
#
# <details><summary>Solution</summary>
#
# `np.abs(np.linalg.eigvals(B)).max()` crosses 1 at $\Delta t=3.21$ for Euler and at $\Delta
# t=2/\omega_0 =4.09$ for splitting, with or without friction. `simulate` refuses to start with a
# longer step, and says which limit its scheme has.
#
# </details>
#
# **3. Two lines swapped.** Copy your `my_step` under the name `euler_step`, move $x$ with the *old*
# $v$, and run `euler(0.1, 60, copies, rng)`. Is the swap harmless?
#
# <details><summary>Solution</summary>
#
# No. Now $\mathsf B=\begin{pmatrix}1&\Delta t\\-k\Delta t/m&1-\gamma\Delta t/m\end{pmatrix}$, and
# the noise enters $v$ only. At $\Delta t=0.1$ the error of $\langle x^2\rangle$ is 11 % instead of
# 0.06 %, and that of $\langle v^2\rangle$ 12 % instead of 1.3 %. Without friction every step
# multiplies the area in phase space by $\det\mathsf B=1+k\Delta t^2/m$, so the swing grows. The
# friction has to outweigh this growth. At $\Delta t=\gamma/k=1$ it no longer does, because there
# $\det\mathsf B=1$.
#
# </details>
#
# **4. What is the diffusion constant?** For a free Brownian particle $\int_0^\infty\langle
# v(0)\,v(t)\rangle\,dt$ is the diffusion constant. Compute it for the rod. Compute also
# $\tau=\int_0^\infty\langle x(0)\,x(t)\rangle\,dt/s^2$, and compare $\tau$ with the
# `autocorrelation_time` that `simulate` reports.
#
# <details><summary>Solution</summary>
#
# $\int_0^\infty e^{\mathsf Gt}dt=-\mathsf G^{-1}=\begin{pmatrix}\gamma/k&m/k\\-1&0\end{pmatrix}$.
# The entry for velocities is 0: the rod is tied to its anchor and does not diffuse. The negative
# parts of the curve in section 3 cancel the positive ones. (Without a spring the same calculation
# gives $m/\gamma$, and with it Einstein's $W^2m/\gamma$.) The entry for positions is
# $\tau=\gamma/k=1$.
# `cb.simulate(chain, duration=200_000, observe="widths", seed=2).autocorrelation_time` is 0.70.
# This estimate uses 64 blocks and is therefore accurate to about a sixth only: the seeds from 0 to
# 7 give 0.70 to 1.13.
#
# </details>
