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
# **Question.** A rod hangs on a spring. Friction slows it down, noise shakes it. It never comes
# to rest, and it never flies off. How fast does it go, how far does it get, how soon does it
# forget where it was - and how far may you trust the computer that tells you?
#
# This is the chain of [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460)
# with a single rod, `Chain(size=1)`: nobody to collide with, the paper's "free case". Everything
# can be worked out by hand, so it is the place to learn the equation, its Fokker-Planck equation,
# and the time-stepping scheme that all the other notebooks use.

# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.linalg import expm, solve_continuous_lyapunov, solve_discrete_lyapunov

from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate

BLUE, ORANGE, GREEN, PURPLE, RED = "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00"

# %%
chain = Chain(size=1)
path = simulate(chain, duration=200, every=0.1, observe="snapshots", seed=7, progress=False)
x, v = path.position.values[0, :, 0], path.velocity.values[0, :, 0]
t = path.time.values - path.time.values[0]

fig, (left, right) = plt.subplots(
    1, 2, figsize=(10, 3.4), width_ratios=(2, 1), layout="constrained"
)
left.plot(t, x, color=BLUE, label="position x [R]")
left.plot(t, v, color=ORANGE, label="velocity v [R/T]")
left.set(xlabel="time t [T]", xlim=(0, t[-1]), ylim=(-3.3, 3.3))
left.legend(loc="upper right", ncols=2)
right.plot(x, v, color=BLUE, linewidth=0.8)
right.plot(x[-1], v[-1], "o", color=RED, label="now")
right.set(xlabel="position x [R]", ylabel="velocity v [R/T]")
right.legend(loc="upper left")
plt.show()
# %% [markdown]
# On the left a swing that is never quite regular; on the right the same motion in phase space: it
# turns round and round, and each time on another orbit.
#
# ## 1. The Langevin equation
#
# The rod's displacement $x$ from its anchor obeys (the paper's equation of motion)
#
# $$m\ddot x = -\gamma\dot x - kx + A\,\xi(t),\qquad
# \langle\xi(t)\rangle = 0,\quad \langle\xi(t)\,\xi(t')\rangle = \delta(t-t').$$
#
# **Units.** Lengths are measured in rod radii R, masses in M, times in $\mathsf{T}=\sqrt{M/k}$.
# The rod has the mass of a sphere of unit density, $m=\frac{4\pi}{3}$ M. In these units $k=1$,
# and $\gamma$ and $A$ are 1 unless said otherwise. Because $\delta(t)$ has the unit of 1/time,
# $\xi$ has that of $1/\sqrt{\text{time}}$, and $A$ that of force times $\sqrt{\text{time}}$.
#
# **How fast, how far?** Three averages are enough. During a short time $dt$ the noise changes the
# velocity by a random $\frac{A}{m}\sqrt{dt}\,\xi$, with $\xi$ a Gaussian number of variance 1; on
# average it adds $\frac{A^2}{m^2}dt$ to $v^2$. Therefore
#
# $$\frac{d}{dt}\langle x^2\rangle = 2\langle xv\rangle,\qquad
# \frac{d}{dt}\langle xv\rangle = \langle v^2\rangle - \frac km\langle x^2\rangle
# - \frac\gamma m\langle xv\rangle,\qquad
# \frac{d}{dt}\langle v^2\rangle = -\frac{2k}{m}\langle xv\rangle
# - \frac{2\gamma}{m}\langle v^2\rangle + \frac{A^2}{m^2}.$$
#
# In the steady state all three vanish. The first says $\langle xv\rangle=0$, the third then gives
# the velocity, the second the position:
#
# $$\langle v^2\rangle = W^2,\quad W=\frac{A}{\sqrt{2m\gamma}},\qquad
# \langle x^2\rangle = s^2,\quad s=\sqrt{T/k},\qquad T = mW^2 = \frac{A^2}{2\gamma}.$$
#
# $T$ plays the part of a temperature (in units of energy): $\frac m2\langle v^2\rangle = \frac
# k2\langle x^2\rangle = \frac T2$ is equipartition. Here noise and friction are given separately,
# and $T$ follows from them.
#
# **Predict.** Make the rod twice as heavy. Do its velocities get smaller? Does it stay closer to
# its anchor? And what does twice the friction do?
#
# **Run.**

# %%
variants = {
    "as it is": chain,
    "mass doubled": chain.replace(mass=2 * chain.mass),
    "friction doubled": chain.replace(damping=2),
}
for name, one in variants.items():
    run = simulate(one, duration=100_000, observe="widths", seed=1, progress=False)
    W_measured, W_error = run.velocity_width.item(), run.velocity_width_error.item()
    s_measured, s_error = run.displacement_width.item(), run.displacement_width_error.item()
    W, s = one.free_velocity_width, one.thermal_length
    print(f"{name:17s} W = {W:.4f}, measured {W_measured:.4f} ± {W_error:.4f} R/T;", end="  ")
    print(f"s = {s:.4f}, measured {s_measured:.4f} ± {s_error:.4f} R")
    assert abs(W_measured - W) < 5 * W_error
    assert abs(s_measured - s) < 5 * s_error

# %% [markdown]
# **Explain.** The heavier rod is slower by $\sqrt2$, but it gets just as far: $s=A/\sqrt{2\gamma
# k}$ does not know the mass. Friction takes both down by $\sqrt2$, because the noise does not
# grow with it.
#
# ## 2. The Fokker-Planck equation
#
# The widths are not all. Take very many copies of the rod. Their density $f(x, v, t)$ in phase
# space is carried along by velocity and force, and the random kicks make it diffuse in $v$:
#
# $$\partial_t f + v\,\partial_x f - \frac{k}{m}x\,\partial_v f
# = \partial_v\!\left[\frac{\gamma}{m}v f + \frac{A^2}{2m^2}\,\partial_v f\right].$$
#
# This is Kramers' equation. (Collisions with other rods would add terms on the right; beyond
# restitution 1 the package solves that equation, too.) Try a Gaussian in each variable,
#
# $$f = \frac{1}{2\pi W s}\,e^{-v^2/2W^2}\,e^{-x^2/2s^2}.$$
#
# On the right $\partial_v f=-\frac{v}{W^2}f$, and the square bracket is zero since
# $\frac{A^2}{2m^2}=\frac\gamma m W^2$: *friction and noise balance at every $v$*. On the left
# $v\,\partial_xf=-\frac{xv}{s^2}f$ and $-\frac km x\,\partial_vf=+\frac{k}{m}\frac{xv}{W^2}f$
# cancel since $W^2=\frac km s^2$. So this $f$ is stationary. Position and velocity of the same
# instant are *independent*, although one is the derivative of the other.
#
# **Predict.** Watch one rod for a very long time instead of very many rods once. Will the times
# it spends at each $x$ and $v$ show the same $f$?
#
# **Run.**

# %%
long = simulate(chain, duration=200_000, every=1, observe="snapshots", seed=2, progress=False)
x, v = long.position.values[0, :, 0], long.velocity.values[0, :, 0]
W, s = chain.free_velocity_width, chain.thermal_length

fig, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")
counts = left.hist2d(x / s, v / W, bins=60, range=[(-3.5, 3.5)] * 2, cmap="Blues", density=True)
left.set(xlabel="x / s", ylabel="v / W", aspect="equal")
fig.colorbar(counts[3], ax=left, label="density f s W")
angle = np.linspace(0, 2 * np.pi, 200)
for r in (1, 2, 3):
    left.plot(r * np.cos(angle), r * np.sin(angle), color=RED, linewidth=0.8)
left.plot([], [], color=RED, label="circles: 1, 2, 3 widths")
left.legend(loc="upper right", fontsize=8)

edges = np.linspace(-4.5, 4.5, 46)
middle = (edges[1:] + edges[:-1]) / 2
for values, colour, symbol, name in ((x / s, BLUE, "o", "x / s"), (v / W, ORANGE, "^", "v / W")):
    density, _ = np.histogram(values, edges, density=True)
    right.semilogy(middle, density, symbol, color=colour, markersize=4, label=name)
right.semilogy(
    middle, np.exp(-(middle**2) / 2) / np.sqrt(2 * np.pi), color="black", label="Gaussian"
)
right.set(xlabel="in units of the width", ylabel="probability density", ylim=(1e-5, 1))
right.legend()
plt.show()


# %%
def mean_and_error(values, blocks=50):  # blocks much longer than the memory of the rod
    means = [block.mean() for block in np.array_split(values, blocks)]
    return np.mean(means), np.std(means, ddof=1) / np.sqrt(blocks)


expected = {
    "<x v> / (s W)": (x * v / (s * W), 0),
    "<x^4> / s^4": ((x / s) ** 4, 3),
    "<v^4> / W^4": ((v / W) ** 4, 3),
    "<x^2 v^2> / (s W)^2": ((x * v / (s * W)) ** 2, 1),
}
for name, (values, theory) in expected.items():
    mean, error = mean_and_error(values)
    print(f"{name:20s} {mean:7.4f} ± {error:.4f}, Gaussian and independent: {theory}")
    assert abs(mean - theory) < 5 * error

# %% [markdown]
# **Explain.** Yes: after a few swings the rod has forgotten where it was, so different stretches
# of one long history are as good as different rods. That is what "ergodic" means here, and why
# `simulate` averages over time by default.
#
# ## 3. How it forgets
#
# Write the equation as a system for the pair $z=(x,v)$,
#
# $$\dot z = \mathsf M z + \text{noise},\qquad
# \mathsf M=\begin{pmatrix}0&1\\-k/m&-\gamma/m\end{pmatrix}.$$
#
# It is linear, so the mean does not feel the noise at all: $\langle z(t)\rangle = e^{\mathsf
# Mt}z(0)$. With $\beta=\gamma/2m$ and $\Omega=\sqrt{k/m-\beta^2}$ the eigenvalues of $\mathsf M$
# are $-\beta\pm i\Omega$: a damped swing. The covariance matrix $\mathsf C$ of $(x,v)$ obeys
# $\dot{\mathsf C}=\mathsf{MC}+\mathsf{CM}^{\mathsf T}+\mathsf D$, where $\mathsf D$ has only the
# entry $A^2/m^2$ for $v$; these are the three equations of section 1. From a sharp start
#
# $$\mathsf C(t)=\mathsf C_\infty-e^{\mathsf Mt}\,\mathsf C_\infty\,e^{\mathsf M^{\mathsf T}t}.$$
#
# (Insert it to check; it is zero at $t=0$.) A Gaussian stays a Gaussian, so mean and covariance
# are the full solution of Kramers' equation.

# %%
k, m, gamma, A = chain.stiffness, chain.mass, chain.damping, chain.amplitude
M = np.array([[0, 1], [-k / m, -gamma / m]])
D = np.diag([0, A**2 / m**2])
C_infinity = solve_continuous_lyapunov(M, -D)  # solves M C + C M^T = -D
assert np.allclose(C_infinity, np.diag([s**2, W**2]))

beta = gamma / (2 * m)
Omega = np.sqrt(k / m - beta**2)
print(f"decay rate beta = {beta:.4f} /T, frequency Omega = {Omega:.4f} /T")
print(
    f"one swing takes {2 * np.pi / Omega:.1f} T, and leaves {np.exp(-2 * np.pi * beta / Omega):.2f}"
)

# %% [markdown]
# **Predict.** A thousand copies start together at $x=4s$, at rest. Sketch the cloud at a quarter
# of a swing, at a half, and after one and five swings.
#
# **Run.**

# %%
copies = 1000
start = given_start(chain, [4 * s], replicas=copies)
cloud = simulate(
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
t = cloud.time.values
z = np.stack([cloud.position.values[:, :, 0], cloud.velocity.values[:, :, 0]])  # (2, copies, times)
E = np.array([expm(M * time) for time in t])
mean = E @ np.array([4 * s, 0])
covariance = C_infinity - E @ C_infinity @ E.transpose(0, 2, 1)

fig, ax = plt.subplots(figsize=(7.5, 4.8), layout="constrained")
circle = 2 * np.stack([np.cos(angle), np.sin(angle)])
for place, colour in ((2, ORANGE), (4, GREEN), (8, PURPLE), (40, BLUE)):
    ax.plot(z[0, :, place] / s, z[1, :, place] / W, ".", color=colour, markersize=2, alpha=0.6)
    ellipse = mean[place][:, None] + np.linalg.cholesky(covariance[place]) @ circle
    name = f"t = {t[place]:.1f} T"
    ax.plot(ellipse[0] / s, ellipse[1] / W, color=colour, linewidth=2, label=name)
way = np.array([expm(M * time) @ [4 * s, 0] for time in np.linspace(0, 66, 500)])
ax.plot(way[:, 0] / s, way[:, 1] / W, "k--", linewidth=1, label="mean, theory")
ax.plot(4, 0, "kx", label="start")
ax.set(xlabel="x / s", ylabel="v / W", aspect="equal")
ax.legend(loc="upper left", bbox_to_anchor=(1.02, 1), title="ellipses: 2 widths, theory")
plt.show()
# %%
measured = z.mean(axis=1).T
pulls = (measured[1:] - mean[1:]) / np.sqrt(covariance[1:, [0, 1], [0, 1]] / copies)
variances = z[:, :, 1:].var(axis=1, ddof=1).T / covariance[1:, [0, 1], [0, 1]]
variance_pulls = (variances - 1) / np.sqrt(2 / (copies - 1))  # a Gaussian's variance
print(f"means of x and v: off by at most {abs(pulls).max():.1f} standard errors")
print(f"variances: off by at most {abs(variance_pulls).max():.1f} standard errors")
assert abs(pulls).max() < 5
assert abs(variance_pulls).max() < 5

# %% [markdown]
# **Explain.** The cloud is carried round the spiral of $e^{\mathsf Mt}z(0)$ and widens on the
# way. It first widens in $v$, where the noise acts, and the swing turns that into a width in $x$.
# At the end nothing is left of the start: the ellipse has become the circle of section 2.
#
# **The same matrix tells how the *steady* motion forgets.** Choose the moments at which the
# steady rod has the velocity $v_0$: from there on its mean velocity is $(e^{\mathsf
# Mt})_{vv}v_0$, since its position then has mean zero. Multiply by $v_0$ and average:
#
# $$\frac{\langle v(0)\,v(t)\rangle}{W^2} = (e^{\mathsf Mt})_{vv}
# = e^{-\beta t}\left(\cos\Omega t-\frac\beta\Omega\sin\Omega t\right).$$
#
# This is Onsager's regression: a fluctuation decays on average as a push by hand does.


# %%
def correlation(values, most):
    lags = np.arange(most + 1)
    return np.array([np.mean(values[: values.size - n] * values[n:]) for n in lags])


most = 40
blocks = np.array([correlation(block, most) for block in np.array_split(v, 50)]) / W**2
measured, error = blocks.mean(axis=0), blocks.std(axis=0, ddof=1) / np.sqrt(len(blocks))
lag = np.arange(most + 1.0)  # snapshots are 1 T apart
closed_form = np.exp(-beta * lag) * (np.cos(Omega * lag) - beta / Omega * np.sin(Omega * lag))
assert np.allclose(closed_form, [expm(M * time)[1, 1] for time in lag])

fine = np.linspace(0, most, 400)
curve = np.exp(-beta * fine) * (np.cos(Omega * fine) - beta / Omega * np.sin(Omega * fine))
fig, ax = plt.subplots(figsize=(7, 3), layout="constrained")
ax.plot(fine, curve, color=ORANGE, linewidth=2, label=r"$(e^{\mathsf{M}t})_{vv}$")
ax.errorbar(lag, measured, error, fmt="o", color="black", markersize=3, label="simulation")
ax.axhline(0, color="0.7", linewidth=0.8)
ax.set(xlabel="time t [T]", ylabel=r"$\langle v(0)\,v(t)\rangle\,/\,W^2$", xlim=(-0.5, most + 0.5))
ax.legend()
plt.show()
pulls = (measured - closed_form) / error
print(f"off by at most {abs(pulls).max():.1f} standard errors")
assert abs(pulls).max() < 5

# %% [markdown]
# ## 4. Your own simulation, in ten lines
#
# Euler's scheme takes the equation at its word: during $\Delta t$ all forces stay what they are.
# Random kicks add up like a random walk, so the noise contributes $\frac Am\sqrt{\Delta t}\,\xi$
# and *not* something proportional to $\Delta t$. The paper uses this scheme.


# %%
def euler(chain, dt, duration, copies, rng):
    k, m, gamma, A = chain.stiffness, chain.mass, chain.damping, chain.amplitude
    x, v = np.zeros((2, copies))
    for _ in range(round(duration / dt)):
        xi = rng.standard_normal(copies)
        v = v + dt / m * (-k * x - gamma * v) + A / m * np.sqrt(dt) * xi
        x = x + dt * v
    return x, v


# %% [markdown]
# **Predict.** A swing takes 13 time units. Is $\Delta t = 1$ short enough? By how much will
# $\langle v^2\rangle$ be off?
#
# **Run.**

# %%
rng = np.random.default_rng(4)
copies = 20_000
for dt in (1, 0.5, 0.25):
    x, v = euler(chain, dt, 60, copies, rng)
    print(f"dt = {dt:4}: <v^2> = {np.mean(v**2) / W**2:.3f} W^2", end=", ")
    print(f"<x^2> = {np.mean(x**2) / s**2:.3f} s^2   (± {np.sqrt(2 / copies):.3f})")

# %% [markdown]
# **Explain.** At $\Delta t=1$, a thirteenth of a swing, the rod is hotter by a fifth than it
# should be; half the step, and less than half of the error is left. To see more than the noise
# allows, note that one step is a linear map, $z' = \mathsf B z + \mathsf b\,\xi$, so the
# covariance matrix that it leaves unchanged solves
#
# $$\mathsf C = \mathsf{BCB}^{\mathsf T}+\mathsf{bb}^{\mathsf T},$$
#
# a *discrete Lyapunov equation*. No random number is needed to know what Euler's scheme will
# give.


# %%
def euler_map(chain, dt):
    k, m, gamma, A = chain.stiffness, chain.mass, chain.damping, chain.amplitude
    kick = np.array([[1, 0], [-k * dt / m, 1 - gamma * dt / m]])
    drift = np.array([[1, dt], [0, 1]])
    b = drift @ [0, A / m * np.sqrt(dt)]
    return drift @ kick, np.outer(b, b)


def errors(scheme, dt):  # relative errors of <x^2> and <v^2> in the steady state
    C = solve_discrete_lyapunov(*scheme(chain, dt))
    return np.array([C[0, 0] / s**2, C[1, 1] / W**2]) - 1


exact = errors(euler_map, 1.0)
print(f"Euler at dt = 1: <x^2> off by {exact[0]:+.4f}, <v^2> off by {exact[1]:+.4f}")
x, v = euler(chain, 1.0, 60, copies, rng)
for values, width, error in ((x, s, exact[0]), (v, W, exact[1])):
    assert abs(np.mean(values**2) / width**2 / (1 + error) - 1) < 5 * np.sqrt(2 / copies)
assert 0.21 < exact[1] < 0.22
ratio = errors(euler_map, 0.01) / errors(euler_map, 0.005)
print(f"half the step: error of <x^2> smaller by {ratio[0]:.2f}, of <v^2> by {ratio[1]:.2f}")
assert np.allclose(ratio, [4, 2], rtol=0.02)

# %% [markdown]
# The error of $\langle v^2\rangle$ is of first order in $\Delta t$. That of $\langle x^2\rangle$
# happens to be of second order: positions fare better than velocities. There is one more error,
# in $\langle xv\rangle$, which should be zero. From $x'=x+v'\Delta t$ and $\langle
# x'^2\rangle=\langle x^2\rangle$ it follows that $\langle x'v'\rangle=\frac{\Delta t}2\langle
# v^2\rangle$: position and velocity of the scheme belong to times half a step apart.

# %%
C = solve_discrete_lyapunov(*euler_map(chain, 0.1))
assert np.isclose(C[0, 1], 0.1 / 2 * C[1, 1])

# %% [markdown]
# ## 5. Splitting: solve exactly what you can
#
# Where does Euler lose? Take friction and noise alone, $m\dot v=-\gamma v+A\xi$. The exact result
# after $\Delta t$ is known (Ornstein and Uhlenbeck):
#
# $$v' = c\,v + W\sqrt{1-c^2}\;\xi,\qquad c=e^{-\gamma\Delta t/m}.$$
#
# If $\langle v^2\rangle=W^2$ before, then $c^2W^2+(1-c^2)W^2=W^2$ after, *at any step*. Euler has
# $1-\gamma\Delta t/m$ in place of $c$. Spring and flight alone are a problem of mechanics: half a
# kick, flight, half a kick is Verlet's scheme, which neither heats nor cools on the long run. Put
# the two together symmetrically:
#
# 1. friction and noise over $\Delta t/2$, exactly;
# 2. half a spring kick, $v\to v-\frac{\Delta t}{2m}kx$;
# 3. flight, $x\to x+v\,\Delta t$ (in a chain: with all collisions);
# 4. half a spring kick; 5. friction and noise over $\Delta t/2$.
#
# Symmetric in time means: the leading error, of first order, cancels. Step 5 and the next step's
# 1 can be drawn as one, so the scheme costs one random number per step, as Euler's does. This is
# the default of `simulate` (`stepper="splitting"`).


# %%
def splitting(chain, dt, duration, copies, rng):
    k, m, gamma, W = chain.stiffness, chain.mass, chain.damping, chain.free_velocity_width
    c = np.exp(-gamma * dt / (2 * m))
    x, v = np.zeros((2, copies))
    for _ in range(round(duration / dt)):
        v = c * v + W * np.sqrt(1 - c**2) * rng.standard_normal(copies)
        v = v - dt / (2 * m) * k * x
        x = x + dt * v
        v = v - dt / (2 * m) * k * x
        v = c * v + W * np.sqrt(1 - c**2) * rng.standard_normal(copies)
    return x, v


def splitting_map(chain, dt):
    k, m, gamma, W = chain.stiffness, chain.mass, chain.damping, chain.free_velocity_width
    c = np.exp(-gamma * dt / (2 * m))
    heat, noise = np.diag([1, c]), np.diag([0, W**2 * (1 - c**2)])
    half_kick = np.array([[1, 0], [-k * dt / (2 * m), 1]])
    verlet = half_kick @ np.array([[1, dt], [0, 1]]) @ half_kick
    B = heat @ verlet @ heat
    return B, heat @ verlet @ noise @ verlet.T @ heat + noise


exact = errors(splitting_map, 1.0)
print(f"splitting at dt = 1: <x^2> off by {exact[0]:+.4f}, <v^2> off by {exact[1]:+.0e}")
x, v = splitting(chain, 1.0, 60, copies, rng)
for values, width, error in ((x, s, exact[0]), (v, W, exact[1])):
    assert abs(np.mean(values**2) / width**2 / (1 + error) - 1) < 5 * np.sqrt(2 / copies)

# %% [markdown]
# The velocities are right to rounding errors at *any* step, and $\langle
# x^2\rangle=s^2/(1-(\omega_0\Delta t/2)^2)$ with $\omega_0=\sqrt{k/m}$: of second order. (For a
# linear spring. The Maxwellian is untouched by friction and noise; and Verlet's scheme conserves
# a quadratic form close to the energy, in which $v$ enters as before and $x$ a bit weaker.)

# %%
omega = np.sqrt(k / m)
for dt in (0.01, 0.1, 1, 3):
    exact = errors(splitting_map, dt)
    assert abs(exact[1]) < 1e-9
    assert abs(exact[0] + 1 - 1 / (1 - (omega * dt / 2) ** 2)) < 1e-9

# %% [markdown]
# ## 6. The order, measured
#
# **Predict.** Draw the errors against the step on logarithmic axes. What are the slopes?
#
# **Run.** Lines: the Lyapunov equation. Symbols: `simulate`, with both steppers. On the right
# there is no steady state but a relaxing mean, from $x=s$ at rest, after half a swing: again
# without noise, since one step multiplies the mean by $\mathsf B$.

# %%
steps = np.geomspace(0.01, 2.5, 25)
lines = {
    "euler": np.array([errors(euler_map, dt) for dt in steps]),
    "splitting": np.array([errors(splitting_map, dt) for dt in steps]),
}
measured = {}
for stepper in lines:
    for dt in (0.3, 0.6, 1.2, 2.4):
        run = simulate(
            chain,
            duration=1_000_000,
            time_step=dt,
            stepper=stepper,
            observe="widths",
            seed=5,
            progress=False,
        )
        ratio = np.array([run.displacement_width.item() / s, run.velocity_width.item() / W])
        error = [run.displacement_width_error.item() / s, run.velocity_width_error.item() / W]
        measured[stepper, dt] = ratio**2 - 1, 2 * ratio * np.array(error)

half_swing = np.pi / Omega
relaxed = expm(M * half_swing) @ [s, 0]
counts = np.unique(np.geomspace(3, 640, 20).astype(int))
transients = {}
for stepper, scheme in (("euler", euler_map), ("splitting", splitting_map)):
    ends = [np.linalg.matrix_power(scheme(chain, half_swing / n)[0], n) @ [s, 0] for n in counts]
    transients[stepper] = [np.linalg.norm((end - relaxed) / [s, W]) for end in ends]

# %%
fig, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
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
    right.loglog(half_swing / counts, values, "-", color=colour, label=name)
right.set(xlabel=r"time step $\Delta t$ [T]", ylabel="error of the mean after half a swing")
right.legend()
plt.show()
# %%
small = steps < 0.1
slopes = {
    name: np.polyfit(np.log(steps[small]), np.log(abs(lines[name[0]][small, name[1]])), 1)[0]
    for name in styles
}
fine = counts > 60
for stepper, values in transients.items():
    fit = np.polyfit(np.log(half_swing / counts[fine]), np.log(np.array(values)[fine]), 1)
    slopes[stepper, "transient"] = fit[0]
for name, slope in slopes.items():
    print(f"{name[0]:9s} {({0: '<x^2>', 1: '<v^2>'}).get(name[1], name[1]):9s}: order {slope:.2f}")
expected = {
    ("euler", 1): 1,
    ("euler", 0): 2,
    ("euler", "transient"): 1,
    ("splitting", 0): 2,
    ("splitting", "transient"): 2,
}
assert all(abs(slopes[name] - order) < 0.05 for name, order in expected.items())

worst = 0
for (stepper, dt), (off, error) in measured.items():
    scheme = {"euler": euler_map, "splitting": splitting_map}[stepper]
    worst = max(worst, np.max(abs(off - errors(scheme, dt)) / error))
print(f"simulate and the Lyapunov equation: at most {worst:.1f} standard errors apart")
assert worst < 5

# %% [markdown]
# **Explain.** In the steady positions the two do not differ much. But the velocities, and
# everything on the way to the steady state, are of first order with Euler and of second with
# splitting, at the same cost. That is why the default step of `simulate` may be as long as 0.1
# time units: splitting is then wrong by 0.06 % in $\langle x^2\rangle$ and not at all in $\langle
# v^2\rangle$, Euler by 1.3 % in $\langle v^2\rangle$, that is 0.6 % in the width.

# %%
for name, scheme in (("Euler", euler_map), ("splitting", splitting_map)):
    exact = errors(scheme, 0.1)
    print(f"dt = 0.1, {name:9s}: <x^2> off by {exact[0]:.1e}, <v^2> by {abs(exact[1]):.1e}")
assert abs(errors(splitting_map, 0.1)[0] - 0.0006) < 5e-5
assert abs(errors(euler_map, 0.1)[1] - 0.013) < 5e-4
assert abs(np.sqrt(1 + errors(euler_map, 0.1)[1]) - 1.006) < 5e-4

# %% [markdown]
# ## Exercises
#
# **1. A spring that is not linear.** With `Chain(size=1, spring="quadratic")` the force is
# $F=kx|x|$. What are the stationary distributions of $x$ and $v$? Compute $\langle
# x^4\rangle/\langle x^2\rangle^2$ and $\langle v^4\rangle/\langle v^2\rangle^2$, which are both 3
# for a Gaussian, and compare with a simulation.
#
# <details><summary>Solution</summary>
#
# In section 2 only the last cancellation used the linear force. With $U(x)=\frac k3|x|^3$ in
# place of $\frac k2x^2$, $f\sim e^{-mv^2/2T}\,e^{-U(x)/T}$ is stationary. Velocities are the same
# Gaussian as before; displacements are not Gaussian, but flatter at the top with thinner tails.
# With $\langle|x|^n\rangle = (3T/k)^{n/3}\,\Gamma(\frac{n+1}3)/\Gamma(\frac13)$ the ratio for $x$
# is $\Gamma(\frac53)\,\Gamma(\frac13)=2.418$.
#
# ```python
# soft = Chain(size=1, spring="quadratic")
# run = simulate(soft, duration=200_000, every=1, observe="snapshots", seed=6, progress=False)
# for values in (run.position.values, run.velocity.values):
#     print(np.mean(values**4) / np.mean(values**2) ** 2)
# ```
#
# gives 2.43 and 3.00: the velocities know nothing of the spring. (Errors of some hundredths are
# what section 2 had with as long a run.)
# </details>
#
# **2. Where the schemes blow up.** At which time step does each of the two maps $\mathsf B$ get
# an eigenvalue of modulus 1? What does `simulate` say if you ask for more?
#
# <details><summary>Solution</summary>
#
# `np.abs(np.linalg.eigvals(B)).max()` crosses 1 at $\Delta t=3.21$ for Euler and at $\Delta
# t=2/\omega_0 =4.09$ for splitting, with or without friction. Above $2/\omega_0$ `simulate`
# refuses to start. With Euler at 3.3 it starts, and the result's `status` is `diverged`.
# </details>
#
# **3. Two lines swapped.** In `euler`, compute the new $x$ from the *old* velocity. Harmless?
#
# <details><summary>Solution</summary>
#
# No. $\mathsf B=\begin{pmatrix}1&\Delta t\\-k\Delta t/m&1-\gamma\Delta t/m\end{pmatrix}$, and the
# noise enters $v$ only. At $\Delta t=0.1$ the error of $\langle x^2\rangle$ is 11 % instead of
# 0.06 %, that of $\langle v^2\rangle$ 12 % instead of 1.3 %. Without friction every step
# multiplies the area in phase space by $\det\mathsf B=1+k\Delta t^2/m$: the swing is blown up,
# and friction has to fight it. At $\Delta t=\gamma/k=1$ it loses, $\det\mathsf B=1$.
# </details>
#
# **4. What is the diffusion constant?** For a free Brownian particle $\int_0^\infty\langle
# v(0)\,v(t)\rangle\,dt$ is the diffusion constant. Compute it for the rod, and also
# $\tau=\int_0^\infty\langle x(0)\,x(t)\rangle\,dt/s^2$, and compare $\tau$ with the
# `autocorrelation_time` that `simulate` reports.
#
# <details><summary>Solution</summary>
#
# $\int_0^\infty e^{\mathsf Mt}dt=-\mathsf M^{-1}=\begin{pmatrix}\gamma/k&m/k\\-1&0\end{pmatrix}$.
# The entry for velocities is 0: the rod is tied to its anchor and does not diffuse. The negative
# parts of the curve in section 3 cancel the positive ones. (Without a spring the same calculation
# gives $m/\gamma$, hence Einstein's $W^2m/\gamma=T/\gamma$.) The entry for positions is
# $\tau=\gamma/k=1$. `simulate(chain, duration=200_000, observe="widths",
# seed=2).autocorrelation_time` is 0.70. It is estimated from 64 blocks, and so only good to about
# a sixth: the seeds from 0 to 7 give 0.70 to 1.13.
# </details>
