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
# # When is a gas a fluid?
#
# **Question.** A fluid knows the density, the flow and the temperature at each place, and nothing
# else. When is that enough to say how rods will move? Let a gas of rods out of one half of its box.
# Does it slosh to and fro? Does it have sound, and how fast is it?
#
# The equations are those of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460), with one more for the
# temperature. All collisions are elastic. Lengths are in rod radii $R$.
#
# *90 minutes. `make lessons` writes copies without outputs and solutions.*
#
# **Two minutes on the page.** All rods begin with
# <a href="../docs/chain.md#challenge=maxwell">the same speed</a>. Predict the kurtosis of their
# velocities after a long time, for one mass and for two. Then measure both.

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import curve_fit
from solutions import lesson_07 as solutions
from teaching import BLUE, GREEN, ORANGE, PINK, RED, agree, check, choose, panels, safe

# %% [markdown]
# **What you may change.** The number of rods `size` from 32 to 128, the ratio of the two masses from
# 1.5 to 5, and seeds. Then run all cells again.

# %%
size, ratio = 64, 3

# %% tags=["hide-input"]
if not safe(
    32 <= size <= 128 and 1.5 <= ratio <= 5,
    f"This lesson is for 32 to 128 rods and ratios from 1.5 to 5, not {size} and {ratio}: fewer "
    "rods, or nearly equal masses, have no clear sound, and more take long. The lesson goes on "
    "with 64 rods and the ratio 3.",
):
    size, ratio = 64, 3

# %% [markdown]
# ## 1. A fluid in two ordinary equations
#
# In [lesson 5](05_from_the_kinetic_equation_to_the_force_balance.ipynb) the fluid was at rest. With a
# flow $V(x,t)$ the paper has a continuity and a velocity equation,
#
# $$\rho_t + (\rho V)_x = 0,\qquad
# V_t + VV_x = -\frac1\rho\left(\frac{\rho W^2}{1-2R\rho}\right)_{\!x}
# - \frac km\langle\Delta x\rangle - \frac\gamma m V .$$
#
# The **isothermal fluid** has a constant $W^2$, as at rest. The **fluid with a temperature** has one
# more equation, which is not in the paper,
#
# $$(W^2)_t + V(W^2)_x = -\frac{2W^2\,V_x}{1-2R\rho} - \frac{2\gamma}{m}\left(W^2 - W_0^2\right),
# \qquad W_0^2=\frac{A^2}{2m\gamma}.$$
#
# Its first term is the adiabatic law of a gas with one degree of freedom: what expands cools. The
# second term is the exchange of heat with noise and damping.
#
# Squeeze a chain on springs and let go, as in
# [lesson 4](04_the_elastic_chain_is_exactly_solvable.ipynb), section 7. In the coordinate $y$, where
# rods are points, the chain is a Gaussian cloud. Its width $\sigma(t)$ changes, and its form does
# not, so the flow is $V = (\sigma'/\sigma)\,y$. The velocity equation then becomes an ordinary one,
#
# $$\sigma'' = \frac{W^2}{\sigma} - \frac km\sigma - \frac\gamma m\sigma'.$$
#
# **Your turn.** Insert the flow into the equation for $W^2$, which is the same everywhere. A length
# $dx$ is $dy=(1-2R\rho)\,dx$ in $y$. Write $(W^2)'$; `heat` is $W^2$, and `W` is $W_0$.

# %%
import crazybilliards as cb

chain = cb.Chain(size=50)
s, W, Gamma = chain.thermal_length, chain.free_velocity_width, chain.damping / chain.mass


def my_heat_rate(sigma, sigma_rate, heat):
    return ...  # your code here: from these, W and Gamma, which is gamma/m


clouds = [(s, 0.0, 2 * W**2), (s, W, W**2), (0.5 * s, -W, 0.3 * W**2)]
hint = "V_x / (1 - 2 R rho) is V_y, which is sigma_rate / sigma."
check(my_heat_rate, lambda *cloud: solutions.heat_rate(*cloud, chain), at=clouds, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_heat_rate(sigma, sigma_rate, heat):
#     return -2 * heat * sigma_rate / sigma - 2 * Gamma * (heat - W**2)
# ```
#
# </details>
#
# **Predict.** The rods are squeezed to $\sigma = 0.3\,s$, where $s$ is the width at rest. Which fluid
# becomes clearly wider than $s$ before it comes to rest: (1) the isothermal one, (2) that with a
# temperature, (3) both or (4) neither?

# %%
my_choice = "..."  # your code here: a number from 1 to 4

fluids = "isothermal", "with a temperature", "both", "neither"
hint = "Which of them cools while it expands, and is then pushed less?"
choose(my_choice, *fluids, right=solutions.OVERSHOOTS, hint=hint)

# %% [markdown]
# **Run.** We solve both pairs of equations, and release 400 chains of rods.


# %%
def rates(t, state, exchange):
    sigma, rate, heat = state
    warming = solutions.heat_rate(sigma, rate, heat, chain) if exchange else 0.0
    return rate, heat / sigma - (W / s) ** 2 * sigma - Gamma * rate, warming


squeeze, times = 0.3, np.linspace(0, 24, 49)
start, accurate = (squeeze * s, 0.0, W**2), {"t_eval": times, "rtol": 1e-8}
isothermal, warm = (
    solve_ivp(rates, (0, 24), start, args=(each,), **accurate).y for each in (False, True)
)

# %%
copies = 400
states = cb.equilibrium_states(chain, copies, seed=3)
squeezed = chain.physical(squeeze * chain.reduced(states.position.values))
start = cb.given_start(chain, squeezed, states.velocity.values, replicas=copies)
settings = {"duration": 24, "every": 0.5, "average": "ensemble", "progress": False}
run = cb.simulate(chain, start=start, replicas=copies, observe="widths", seed=4, **settings)
cloud = np.sqrt((run.mean_displacement**2 + run.displacement_width**2).mean("particle"))
points = copies * chain.size  # independent Gaussian points
agree("widths of rods and fluid", cloud / warm[0], 1, 1 / np.sqrt(2 * points))

# %% tags=["hide-input"]
left, right_panel = panels(2, height=3.4)
left.plot(times, isothermal[0] / s, "--", color=PINK, label="isothermal fluid")
left.plot(times, warm[0] / s, color=GREEN, label="fluid with a temperature")
left.plot(times, cloud / s, "o", color="k", mfc="none", ms=4, label="rods")
left.set(xlabel="time $t$ [$t_0$]", ylabel=r"width of the cloud $\sigma/s$", ylim=(0, 1.8))
left.legend(loc="lower right")
right_panel.plot(times, isothermal[2] / W**2, "--", color=PINK)
right_panel.plot(times, warm[2] / W**2, color=GREEN)
right_panel.set(xlabel="time $t$ [$t_0$]", ylabel="temperature $W^2/W_0^2$", ylim=(0, 1.1))
plt.show()
print(f"widest: isothermal {isothermal[0].max() / s:.2f} s, rods {float(cloud.max()) / s:.2f} s")

# %% tags=["remove-cell"]
exact = cb.breathing_cloud(chain, 24, every=0.5, stretch=squeeze)
assert np.allclose(exact.cloud_width, warm[0], rtol=1e-5)
assert isothermal[0].max() > 1.4 * s
assert warm[0].max() < 1.01 * s

# %% [markdown]
# <details><summary>Explain</summary>
#
# The isothermal one. An expanding gas does work and *cools*, to $0.4\,W_0^2$, so that the push
# $W^2/\sigma$ becomes weaker. The noise returns the heat only at the rate $2\gamma/m$. **A
# closure that is right at rest can be wrong on the way to it.** The fluid with a temperature is exact
# here.
#
# </details>
#
# Is the fluid with a temperature then always right? Take the springs away, and put the rods between
# two walls. From here on the mean mass and the temperature are 1, so $W =
# \sqrt{T/\langle m\rangle} = 1$ as well. The rods leave the *free length* $l = X - 2RL$ of the box,
# in which they are points ([lesson 6](06_the_pressure_on_a_wall.ipynb), section 2).

# %%
L, room = size, size  # rods, and the free length l [R]
kappa = np.pi / room  # of the longest wave


def gas(ratio):
    """Return rods between walls, with T = 1, the mean mass 1, and hardly any noise and damping."""
    damping = 0.001 * kappa
    kinds = {"mass": 2 / (1 + ratio), "mass_ratio": ratio, "stiffness": 0, "box": room + 2 * L}
    return cb.Chain(size=L, damping=damping, amplitude=np.sqrt(2 * damping), **kinds)


# %%
def follow(chain, start, duration):
    """Return y and v over 25 times, replica and rod, without noise and damping."""
    chain = chain.replace(damping=0, amplitude=0)
    times = {"duration": duration, "every": duration / 24, "time_step": duration / 24}
    settings = {"replicas": start.sizes["replica"], "average": "ensemble", "progress": False}
    run = cb.simulate(chain, start=start, observe="snapshots", seed=2, **times, **settings)
    run = run.transpose("time", "replica", "particle")
    return chain.reduced(run.position.values), run.velocity.values


# %% [markdown]
# ## 2. Rods of one mass
#
# At the start all rods are in the left half of the free length, with Maxwell's velocities. There is
# no noise and no damping.
#
# **Predict.** Will the gas slosh, so that for some time more than half of the rods are on the right?
# Or will it only spread?

# %%
my_choice = "..."  # your code here: 1 slosh or 2 spread

hint = "Rods of one mass exchange their velocities. How do the points move, if names do not count?"
choose(my_choice, "slosh", "spread", right=solutions.RELEASED, hint=hint)

# %% [markdown]
# Equal rods that collide exchange their velocities. In $y$ one can as well say that points fly
# through one another. Each point then flies alone, and the walls are mirrors: a point that would be
# beyond a wall is where its mirror image is.
#
# **Your turn.** A point would be at $y$ if there were no walls. Where is it between the walls at
# `low` and `high`? It may have met many mirrors.


# %%
def my_mirrored(y, low, high):
    return ...  # your code here


flights = [(0.3, -1.0, 1.0), (1.4, -1.0, 1.0), (-1.5, -1.0, 1.0), (8.2, -1.0, 1.0)]
hint = "np.mod(y - low, 2 * room) is the way from low, there and back. np.minimum turns it round."
check(my_mirrored, solutions.mirrored, at=flights, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_mirrored(y, low, high):
#     room = high - low
#     way = np.mod(y - low, 2 * room)
#     return low + np.minimum(way, 2 * room - way)
# ```
#
# </details>
#
# **Run.** The same start twice: rods with all their collisions, and points between mirrors.

# %%
# A ratio that is not quite 1 makes the package compute every collision.
rng, equal, runs = np.random.default_rng(1), gas(1 + 1e-9), 300
y0 = np.sort(rng.uniform(-room / 2, 0, (runs, L)), axis=1)
v0 = rng.normal(size=y0.shape)
start = cb.given_start(equal, equal.physical(y0), v0, replicas=runs)
y, v = follow(equal, start, 2 * room)

# %%
t = np.linspace(0, 2 * room, 25)
flown = solutions.mirrored(y0 + t[:, None, None] * v0, -room / 2, room / 2)
rods_beyond, points_beyond = (np.mean(each > 0, axis=(1, 2)) for each in (y, flown))
apart = abs(y - np.sort(flown, axis=2)).max()
print(f"rods and sorted points are at most {apart:.0e} R apart")

# %% [markdown]
# The mirrors turn waves $\cos\kappa_q(y+\frac l2)$ with $\kappa_q = \pi q/l$ into themselves. In the
# time $t$ a point flies a Gaussian distance of the width $Wt$, which multiplies a wave by
# $e^{-(\kappa_qWt)^2/2}$. The sum over the waves of the start is the exact share on the right,
#
# $$f(t) = \frac12 - \sum_{q=1,3,\dots}\Big(\frac{2}{\pi q}\Big)^2 e^{-(\kappa_qWt)^2/2}.$$

# %%
q = np.arange(1, 2001, 2)
decay = np.exp(-((q * kappa * t[:, None]) ** 2) / 2)
law = 0.5 - ((2 / (np.pi * q)) ** 2 * decay).sum(axis=1)
scatter = np.sqrt(law * (1 - law) / (runs * L))[1:]  # the points are independent
agree("share beyond the middle", rods_beyond[1:], law[1:], scatter)

# %% tags=["hide-input"]
look = {"color": "k", "fillstyle": "none"}
ax = panels(width=6, height=3)
ax.plot(t / room, law, color=RED, label="exact")
ax.plot(t / room, points_beyond, "x", color=BLUE, label="points between mirrors")
ax.plot(t / room, rods_beyond, "o", label="rods of one mass", **look)
ax.axhline(0.5, color="0.6", linewidth=0.8)
ax.set(xlabel="time t [l/W]", ylabel="share beyond the middle", ylim=(0, 0.7))
ax.legend(loc="lower right")
plt.show()

# %% [markdown]
# <details><summary>Explain</summary>
#
# The gas does not slosh. Fast points come back from the right wall while slow ones still arrive, and
# $f$ rises to a half.
#
# </details>
#
# ## 3. What a fluid would do
#
# Take a small wave in a fluid at rest. Its density is $1 + r\cos\kappa(y+\frac l2)$, its velocity
# $u\sin\kappa(y+\frac l2)$ and its temperature $1 + \theta\cos\kappa(y+\frac l2)$, each in units of
# its value at rest, $u$ in units of $W$. Measure time in $1/\kappa W$. With $V=0$ at the walls the
# equations of section 1 become
#
# $$\dot r = -u,\qquad \dot u = r + \theta - \Gamma u,\qquad \dot\theta = -2u - 2\Gamma_T\theta .$$
#
# Here $\Gamma$ is the rate of damping. The noise exchanges heat at the rate $2\Gamma_T$.
#
# **Your turn.** Write the matrix of these equations for the vector $(r, u, \theta)$.


# %%
def my_matrix(damping, heat):  # Gamma and Gamma_T
    return ...  # your code here


hint = "Row by row: what multiplies r, u and theta in each of the three equations?"
check(my_matrix, solutions.wave_matrix, at=[(0.0, 0.0), (0.2, 0.3)], hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_matrix(damping, heat):
#     return np.array([[0, -1, 0], [1, -damping, 1], [0, -2, -2 * heat]])
# ```
#
# </details>
#
# The isothermal fluid has $\theta = 0$, which leaves the first two rows and columns. The frequencies
# are the imaginary parts of the eigenvalues, and the speed of sound is $\omega/\kappa$:

# %%
M = solutions.wave_matrix(0, 0)
for name, part in {"isothermal fluid": M[:2, :2], "fluid with a temperature": M}.items():
    print(f"{name}: speed of sound {np.linalg.eigvals(part).imag.max():.4f} W")

# %% [markdown]
# A temperature that stays constant needs an exchange of heat that is faster than the wave,
# $2\Gamma_T\gg1$. Rods of one mass have $\Gamma_T=\Gamma$, and with $\Gamma > 2$ the isothermal wave
# does not swing at all. So noise and damping never give them isothermal sound.
#
# Now watch the longest wave in the rods. Its momentum is $p = \sum_i m_iv_i\sin\kappa(y_i+\frac
# l2)$. A gas at rest has small random waves, and $C(t) = \langle p(t)\,p(0)\rangle/\langle
# p(0)^2\rangle$ says how they go on. In a fluid $C(t)$ is the $u(t)$ of a wave that starts with
# $u=1$ and $r=\theta=0$.


# %%
def momentum(ratio, runs=2000):
    """Return p of the longest wave, over time and replica, for one period of sound at sqrt(3) W."""
    chain = gas(ratio)
    y, v = follow(chain, cb.equilibrium_states(chain, runs, seed=1), 2 * room / np.sqrt(3))
    return (chain.rod_masses * v * np.sin(kappa * (y + room / 2))).sum(axis=2)


def correlation(p):
    """Return C(t) and its standard error."""
    C = (p * p[0]).mean(axis=1) / (p[0] ** 2).mean()
    rest = (p - C[:, None] * p[0]) * p[0]
    return C, rest.std(axis=1) / np.sqrt(p.shape[1]) / (p[0] ** 2).mean()


def fluids(times):
    """Return u(t) of the isothermal fluid and of the fluid with a temperature."""
    return [np.array([expm(part * t)[1, 1] for t in times]) for part in (M[:2, :2], M)]


# %% [markdown]
# **Predict.** For rods of one mass without damping the density of the wave decays as $e^{-t^2/2}$
# (section 2, $t$ in units of $1/\kappa W$). What follows for $C(t)$, if $\dot r=-u$?
#
# **Run.**

# %%
tau = np.linspace(0, 2 * np.pi / np.sqrt(3), 25)  # kappa W t
C_one, error_one = correlation(momentum(1))
exact = (1 - tau**2) * np.exp(-(tau**2) / 2)
agree("C(t), rods of one mass", C_one[1:], exact[1:], error_one[1:])
for name, u in zip(("isothermal", "with a temperature"), fluids(tau), strict=True):
    print(f"rods and fluid, {name}: {np.sqrt(np.mean((C_one - u) ** 2)):.2f} apart (rms)")

# %% [markdown]
# <details><summary>Explain</summary>
#
# Two derivatives follow, one for each $u$: $C = -\frac{d^2}{dt^2}e^{-t^2/2} = (1-t^2)\,e^{-t^2/2}$.
# The wave swings back once, to $-0.45$, and is gone. Both fluids would swing for ever.
#
# </details>
#
# **You can stop here.** You know why a fluid needs a temperature, why equal elastic rods are none,
# and which sound a fluid would have.
#
# ## 4. Two masses
#
# On the page equal rods have kept their one speed, and rods of two masses have come to Maxwell's law.
#
# **Your turn.** Write both velocities after an elastic collision of the masses $m_1$ and $m_2$.


# %%
def my_collision(v1, v2, m1, m2):
    return ...  # your code here: the new v1 and the new v2


hits = [(1.0, 0.0, 1.0, 1.0), (1.0, -1.0, 1.0, 3.0), (0.5, 0.2, 2.0, 1.0)]
hint = "Seen from the centre of mass, both velocities change their signs."
check(my_collision, solutions.collision, at=hits, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_collision(v1, v2, m1, m2):
#     centre = (m1 * v1 + m2 * v2) / (m1 + m2)
#     return 2 * centre - v1, 2 * centre - v2
# ```
#
# </details>
#
# **Back on the page.** <a href="../docs/chain.md#challenge=count">Two rods and a wall</a>: how often
# do they hit one another, and the light rod the wall, if the heavy one has 1, 100 or 10 000 times its
# mass? Predict, count on the page, and then by your law.

# %%
for masses in (1, 100, 10_000, 1_000_000):
    light, heavy, count = 0.0, -1.0, 0  # velocities; the wall is at the left
    while light > heavy or light < 0:
        if light > heavy:
            light, heavy = solutions.collision(light, heavy, 1, masses)
        else:
            light = -light
        count += 1
    print(f"mass ratio {masses}: {count} hits")

# %% [markdown]
# <details><summary>Explain</summary>
#
# The counts are the digits of $\pi$. At the mass ratio $r$ the energy is a circle in the plane of
# $v_1$ and $\sqrt r\,v_2$. Two hits turn the point on it by twice the angle $\arctan\sqrt{1/r}$,
# until it has gone half the way round.
#
# </details>
#
# Unequal rods mix their velocities. Each small piece of their gas forgets all but its density, mean
# velocity and temperature. The equations of a fluid assume this *local equilibrium*.
#
# ## 5. Sound
#
# **Predict.** Will $C(t)$ of two masses follow one of the fluids? Which one, without noise and
# damping?
#
# Waves of rods become lower with each swing. Fit a damped wave,
# $\ddot C + 2\beta\dot C + (\omega^2+\beta^2)\,C = 0$. It begins at $C = 1$, and with the slope 0,
# because motion without noise looks the same backwards in time, $C(-t) = C(t)$.
#
# **Your turn.** Write its solution.


# %%
def my_wave(t, omega, beta):
    return ...  # your code here: use np.exp, np.cos and np.sin


waves = [(0.0, 1.7, 0.3), (1.0, 1.7, 0.3), (2.5, 1.2, 0.1)]
hint = "Try exp(-beta t) (cos(omega t) + c sin(omega t)). For which c is the slope 0 at t = 0?"
check(my_wave, solutions.damped_wave, at=waves, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_wave(t, omega, beta):
#     return np.exp(-beta * t) * (np.cos(omega * t) + beta / omega * np.sin(omega * t))
# ```
#
# </details>
#
# **Run.** With $t$ in units of $1/\kappa W$, $\omega$ is the speed of sound in units of $W$. Its error
# comes from 100 random choices of the replicas. 1 % is added, because the damping of rods is not
# exactly exponential.


# %%
def fitted(p):
    return curve_fit(solutions.damped_wave, tau, correlation(p)[0], p0=(1.7, 0.2))[0]


p_two = momentum(ratio)
choices = np.random.default_rng(5).integers(0, p_two.shape[1], (100, p_two.shape[1]))
speed, decay = fitted(p_two)
scatter = np.std([fitted(p_two[:, each])[0] for each in choices])
speed_error = np.hypot(scatter, 0.01 * speed)
print(f"speed of sound: {speed:.3f} ± {speed_error:.3f} W; damping {decay:.2f} kappa W")
agree("speed of sound, fluid with a temperature", speed, np.sqrt(3), speed_error, unit="W")

# %% tags=["hide-input"]
axes = panels(2, height=3.6, sharey=True)
fine = np.linspace(0, tau[-1], 200)
law = (1 - fine**2) * np.exp(-(fine**2) / 2)
fit = solutions.damped_wave(fine, speed, decay)
C_two, error_two = correlation(p_two)
shown = (
    ("one mass", C_one, error_one, law, ":", RED, "exact"),
    (f"masses 1 : {ratio}", C_two, error_two, fit, "-", ORANGE, "damped wave"),
)
for ax, (title, C, error, curve, dashes, colour, name) in zip(axes, shown, strict=True):
    cold, warm = fluids(fine)
    ax.plot(fine, cold, "--", color=PINK, label="isothermal fluid")
    ax.plot(fine, warm, "-.", color=GREEN, label="fluid with a temperature")
    ax.plot(fine, curve, dashes, color=colour, linewidth=2, label=name)
    ax.errorbar(tau, C, error, fmt="o", markersize=4, label="rods", **look)
    ax.set(title=title, xlabel=r"time t [$1/\kappa W$]", ylim=(-1.1, 1.65))
    ax.legend(ncols=2, loc="upper center", fontsize=9)
axes[0].set_ylabel(r"$\langle p(t)\,p(0)\rangle/\langle p(0)^2\rangle$")
plt.show()

# %% tags=["remove-cell"]
cold, warm = fluids(tau)
assert np.sqrt(np.mean((C_two - cold) ** 2)) > 0.6 > 0.35 > np.sqrt(np.mean((C_two - warm) ** 2))
assert apart < 1e-4

# %% [markdown]
# <details><summary>Explain</summary>
#
# The sound of two masses has the speed $\sqrt3\,W$ of the fluid with a temperature. The isothermal
# fluid of the paper is wrong here: nothing takes the heat away that compression makes. The fluid
# lacks viscosity and heat conduction, which damp the rods' wave. With more rods they damp less.
#
# So a gas is a fluid if its collisions *mix* the velocities faster than the wave changes. In one
# dimension equal masses do not mix, however often they collide.
#
# </details>
#
# ## Exercise
#
# **Does it slosh?** Repeat section 2 with two masses: `cb.compare_relaxation(gas(ratio),
# "gathered", 0.5, ...)` lets the rods and both fluids out of the left half. Draw the centre of the
# gas over time for each.
#
# <details><summary>Solution</summary>
#
# ```python
# times = {"duration": 2 * room, "every": room / 16, "progress": False}
# tree = cb.compare_relaxation(gas(ratio), "gathered", 0.5, replicas=200, **times)
# for name in ("isothermal", "evolving"):
#     plt.plot(tree[name].time / room, tree[name].centre / room, label=name)
# rods = tree["simulation"]
# plt.plot(rods.time / room, rods.mean_displacement.mean("particle") / room, "o", label="rods")
# plt.legend()
# ```
#
# It sloshes: the centre passes the middle and returns. That of the fluid with a temperature goes
# further.
#
# </details>
