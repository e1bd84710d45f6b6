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
# # The fluid in time
#
# **Question.** A hundred hard rods on springs are squeezed together and let go. Do they spring
# back, overshoot and swing? And does a theory that is right *at rest* also know how the chain
# gets there?
#
# We follow one release four times: as rods, as an isothermal fluid with the equations of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460), as a fluid that has a
# temperature, and exactly. Two of the other three agree with the rods. Then we clap our
# hands: how fast does sound travel along the chain, and do rods hear it?
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = \frac{4\pi}{3}M$), times in
# $\sqrt{M/k}$, written $T$ on the axes. Restitution is 1, and there is no gap.

# %%
import matplotlib.pyplot as plt
import numpy as np
import sympy as sp
from IPython.display import HTML
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.stats import norm

from crazybilliards.comparison import animate, compare_relaxation, overlay, smooth, standalone_page
from crazybilliards.kinetic import displaced, equilibrium_states, hydrodynamics
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

BLUE, ORANGE, GREEN, PINK = "#0072B2", "#E69F00", "#009E73", "#CC79A7"

chain = Chain(size=100, amplitude=30)
s, W = chain.thermal_length, chain.free_velocity_width
omega, friction = np.sqrt(chain.stiffness / chain.mass), chain.damping / chain.mass
print(f"thermal length s = {s:.1f} R, velocity width W = {W:.2f} R/T, s/W = {s / W:.2f} T")
print(f"one free rod: frequency {omega:.3f} /T, friction gamma/m = {friction:.3f} /T")

# %% [markdown]
# The squeeze takes out of every rod's distance from its anchor 70 %: in the reduced coordinate
# $y = x - 2R\,(i-\frac{L+1}{2})$, where rods are points and all anchors coincide, every $y$ is
# multiplied by 0.3. Velocities stay as they are in the steady state. `compare_relaxation` does this
# to 200 chains, and follows them and the theories.

# %%
SQUEEZE = 0.3
tree = compare_relaxation(
    chain, "compressed", SQUEEZE, duration=16, every=0.4, replicas=200, seed=1, progress=False
)
rods, isothermal, warm, exact = (
    tree[name].to_dataset() for name in ("particles", "isothermal", "evolving", "exact")
)
time = rods.time.values

fig, ax = plt.subplots(figsize=(7, 3), layout="constrained")
for moment, name in ((0, "squeezed, t = 0"), (-1, f"t = {time[-1]:.0f} T")):
    seen = smooth(rods.isel(time=moment))
    style = {"color": (BLUE, ORANGE)[moment], "linestyle": ("-", "--")[moment]}
    ax.plot(seen.x, seen.density, label=name, **style)
ax.axhline(chain.close_packed_density, color="0.6", linewidth=1)
ax.text(-195, chain.close_packed_density + 0.005, "close packing", color="0.4")
ax.set(xlim=(-200, 200), ylim=(0, 0.56), xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(loc="lower center")

# %% [markdown]
# ## 1. The equations
#
# The paper gives a continuity and a velocity equation, with the pressure of hard rods (per mass)
# and the springs at the mean displacement $\langle\Delta x\rangle$:
#
# $$\rho_t + (\rho V)_x = 0,\qquad
# V_t + VV_x = -\frac1\rho\left(\frac{\rho W^2}{1-2R\rho}\right)_{\!x}
# - \frac km\langle\Delta x\rangle - \frac\gamma m V .$$
#
# **Closure.** Which springs pull at $x$? Those of the rods that are there. With the label
# $N(x,t) = \int_{-\infty}^x\rho$, the number of rods to the left,
# $\langle\Delta x\rangle = x - 2R\,(N - L/2)$, and the flow carries its labels with it:
# $N_t + V N_x = 0$. Nothing is put in from a simulation.
#
# **Isothermal**: $W^2$ is constant. The paper writes $W_v(r,t)$ without an equation for it, takes a
# constant in the steady state, and solves nothing in time. **With a temperature** $W^2$ has its own
# equation (derived here, not in the paper):
#
# $$(W^2)_t + V(W^2)_x = -\frac{2W^2\,V_x}{1-2R\rho}
# - \frac{2\gamma}{m}\left(W^2 - \frac{A^2}{2m\gamma}\right).$$
#
# The first term is the adiabatic law of a gas with one degree of freedom: squeeze it to half the
# room, and its temperature rises by four. The second is the exchange of heat with friction and
# noise. `hydrodynamics` solves both, through py-pde.
#
# **Predict.** The friction is less than critical ($\gamma < 2\sqrt{km}$): one free rod swings.
# Will the squeezed chain swing too?
#
# ## 2. Space and time
#
# **Run.**

# %%
fig, panels = plt.subplots(1, 3, figsize=(10, 3.8), sharey=True, layout="constrained")
shown = {"rods (200 chains)": rods, "isothermal fluid": isothermal, "fluid with temperature": warm}
for ax, (name, result) in zip(panels, shown.items(), strict=True):
    picture = smooth(result)
    image = ax.pcolormesh(
        picture.x, time, picture.density, cmap="cividis", vmin=0, vmax=0.5, rasterized=True
    )
    ax.set(title=name, xlabel="position x [R]", xlim=(-200, 200))
panels[0].set_ylabel("time t [T]")
fig.colorbar(image, ax=panels, label=r"density $\rho$ [1/R]")

# %% [markdown]
# **Explain.** The isothermal fluid overshoots: around $t = 4\,T$ its chain is longer, and less
# dense in the middle, than it will be in the end. The rods do not overshoot at all, and neither
# does the fluid with a temperature. Why?
#
# ## 3. The width of the cloud, and its heat
#
# In $y$ the stationary chain is a Gaussian cloud of width $s$, and such a cloud *breathes* without
# changing its form: $\rho_y = L\,\mathcal N(y; 0, \sigma(t)^2)$ with the flow
# $V = (\sigma'/\sigma)\,y$. Put this into the equations of section 1, which in $y$ are those of an
# ideal gas (pressure $\rho_y W^2$), and two ordinary differential equations are left:
#
# $$\sigma'' = \frac{W^2}{\sigma} - \frac km\sigma - \frac\gamma m\sigma',\qquad
# (W^2)' = -2W^2\,\frac{\sigma'}{\sigma} - \frac{2\gamma}{m}\left(W^2-W_0^2\right),$$
#
# the second being replaced by $W^2 = W_0^2$ in the isothermal case. Elastic rods that collide
# swap their velocities; exchange their names too, and they are independent oscillators that pass
# one another. Their cloud obeys *both* equations exactly.


# %%
def breathe(chain, times, squeeze, heated):
    """Width sigma, its rate, and W^2 of a cloud released at rest, in units of s, W and W^2."""
    pull = chain.stiffness / chain.mass
    loss = chain.damping / chain.mass
    free = chain.free_velocity_width**2

    def rates(t, state):
        sigma, rate, heat = state
        warming = -2 * heat * rate / sigma - 2 * loss * (heat - free) if heated else 0.0
        return [rate, heat / sigma - pull * sigma - loss * rate, warming]

    start = [squeeze * chain.thermal_length, 0.0, free]
    sigma, rate, heat = solve_ivp(
        rates, (0, times[-1]), start, t_eval=times, rtol=1e-9, atol=1e-9
    ).y
    return sigma / chain.thermal_length, rate / chain.free_velocity_width, heat / free


cold_width, cold_rate, _ = breathe(chain, time, SQUEEZE, heated=False)
width, rate, heat = breathe(chain, time, SQUEEZE, heated=True)

# The rods: y is the displacement, as all anchors coincide in y.
points = 200 * chain.size  # independent, so errors of variances are simple
rods_y2 = (rods.displacement_width**2 + rods.mean_displacement**2).mean("particle").values
rods_v2 = (rods.velocity_width**2).mean("particle").values  # the width is sqrt(<v^2>)
rods_width = np.sqrt(rods_y2) / s
kinetic = rods_v2 / W**2

fig, (left, right) = plt.subplots(1, 2, figsize=(10, 3.5), layout="constrained")
left.plot(time, cold_width, "--", color=BLUE, label="isothermal")
left.plot(time, width, color=ORANGE, linewidth=2.5, label="with temperature")
left.plot(time, rods_width, "o", color="k", markersize=4, fillstyle="none", label="rods")
left.set(xlabel="time t [T]", ylabel=r"width of the cloud $\sigma/s$", ylim=(0, 1.7))
left.legend()
right.plot(time, 1 + cold_rate**2, "--", color=BLUE, label="isothermal: motion + heat")
right.plot(time, heat + rate**2, color=ORANGE, linewidth=2.5, label="with temperature")
right.plot(time, heat, ":", color=GREEN, label="its heat $W^2$ alone")
right.plot(time, kinetic, "o", color="k", markersize=4, fillstyle="none", label="rods")
right.set(xlabel="time t [T]", ylabel=r"$\langle v^2\rangle / W_0^2$")
right.set_ylim(bottom=0)
right.legend()

# %%
pull_width = (rods_width - width) / (width / np.sqrt(2 * points))
pull_kinetic = (kinetic - heat - rate**2) / ((heat + rate**2) * np.sqrt(2 / points))
print(f"isothermal: widest {cold_width.max():.3f} s at t = {time[cold_width.argmax()]:.1f} T")
print(f"with temperature: widest {width.max():.4f} s; coldest {heat.min():.3f} of W^2")
print(f"rods: off by at most {abs(pull_width).max():.1f} standard errors in the width,")
print(f"    {abs(pull_kinetic).max():.1f} in the kinetic energy")
off = [
    np.abs(result.cloud_width / s - mine).max().item()
    for result, mine in ((isothermal, cold_width), (warm, width), (exact, width))
]
print("hydrodynamics and the package's exact solution, off by", [f"{each:.0e}" for each in off])
assert cold_width.max() > 1.5
assert width.max() < 1.001
assert heat.min() < 0.5
assert abs(pull_width).max() < 5
assert abs(pull_kinetic).max() < 5
assert max(off) < 1e-3

# %% [markdown]
# **Explain.** Follow the heat. An expanding gas does work, on the springs and on its own motion,
# and pays with its heat: the rods *cool*, to less than half of $W_0^2$, and the push fades as they
# spread. The noise gives the heat back only at the rate $2\gamma/m$, which is no faster than the
# chain moves. The isothermal fluid is kept at $W_0^2$ by decree. Heat flows in from nowhere while
# it expands, and its push carries it to 1.56 $s$.
#
# At rest this does not show: there $W^2 = W_0^2$ is right for any rods with $e = 1$. **A closure
# that is right in the steady state need not be right on the way to it.**
#
# ## 4. The animation

# %%
with plt.rc_context({"figure.dpi": 64}):
    page = standalone_page(animate(tree), fps=10)
print(f"{len(page) / 1e6:.2f} MB")
assert len(page) < 2e6
HTML(page)

# %% [markdown]
# ## 5. A motion without compression
#
# **Predict.** Push the whole chain aside by 2 $s$ instead, and let go. Does it matter now which
# fluid it is? **Run.**

# %%
pushed = displaced(chain, 2 * s)
fig, ax = plt.subplots(figsize=(6, 2.8), layout="constrained")
swings = {}
variances = {"isothermal": None, "evolving": "evolving"}  # the velocity_variance of each fluid
for fluid, variance in variances.items():
    flow = hydrodynamics(chain, pushed, 16, every=0.4, velocity_variance=variance, progress=False)
    swings["fluid, " + fluid] = flow
ringing = np.sqrt(omega**2 - friction**2 / 4)
oscillator = np.exp(-friction * time / 2) * (
    np.cos(ringing * time) + friction / (2 * ringing) * np.sin(ringing * time)
)
overlay(swings, "centre", ax=ax)
ax.plot(time[::2], 2 * s * oscillator[::2], "o", color="k", fillstyle="none", label="one free rod")
ax.set_ylabel("centre of the chain [R]")
ax.legend()
largest = max(np.abs(flow.centre - 2 * s * oscillator).max().item() / s for flow in swings.values())
print(f"largest difference from one free rod: {largest:.1e} s")
assert largest < 1e-3

# %% [markdown]
# **Explain.** It swings as a whole, like one free rod: nothing is compressed, nothing heated, and
# collisions do not change the total momentum.
#
# ## 6. Sound
#
# A small disturbance of a fluid of density $\rho_0$ at rest: $\rho = \rho_0+\rho_1$ and $V$ small.
# Keep what is of first order and, over short distances, forget springs and friction:
#
# $$\rho_{1,t} = -\rho_0 V_x,\qquad V_t = -\frac{1}{\rho_0}\,\frac{dp}{d\rho}\,\rho_{1,x}
# \quad\Rightarrow\quad V_{tt} = \frac{dp}{d\rho}\,V_{xx},\qquad c^2 = \frac{dp}{d\rho}.$$
#
# In the isothermal fluid $W^2$ stays; with a temperature, and no time to exchange heat,
# $W^2\propto\rho_y^2$ with $\rho_y = \rho/(1-2R\rho)$ (the adiabatic law).

# %%
rho, rho0, a, W2 = sp.symbols("rho rho_0 a W2", positive=True)  # a = 2R
reduced = rho / (1 - a * rho)
heated = W2 * (reduced / reduced.subs(rho, rho0)) ** 2
for name, variance in (("isothermal", W2), ("adiabatic", heated)):
    square = sp.factor(sp.diff(rho * variance / (1 - a * rho), rho).subs(rho, rho0))
    print(f"{name}: c^2 =", square)
    factor = 1 if name == "isothermal" else 3
    assert sp.simplify(square - factor * W2 / (1 - a * rho0) ** 2) == 0

# %% [markdown]
# So $c = W/(1-2R\rho)$, and $\sqrt3$ times that without exchange of heat. (Newton took air to be
# isothermal and got its speed of sound too small; Laplace put in the heat.) In the reduced
# coordinate a length $dx$ is $dy = (1-2R\rho)\,dx$: there sound has the speed $W$ *everywhere*. All
# the rest is the rods' own length, which a collision crosses at once.
#
# **Run.** Start from the steady state and give the rods in the middle a push, narrow against $s$.
# The pulse splits in two. The broken lines are $dx/dt = \pm c(x)$ with the density at rest.

# %%
WIDTH, PUSH, END = 0.08 * s, 0.02 * W, 0.8 * s / W
rest = displaced(chain, 0.0)
rest_y = rest.x - 2 * chain.radius * (rest.label - chain.size / 2)
near = np.abs(rest_y) < 6 * WIDTH
bump = np.where(near, np.exp(-((rest_y / WIDTH) ** 2) / 2), 0.0)
start = rest.assign(flow_velocity=("x", PUSH * bump))


def sound_path(times, factor):
    """Where a signal from x = 0 is, that runs with factor c(x)."""
    x, density = rest.x.values, rest.density.values

    def speed(t, place):
        return factor * W / (1 - 2 * chain.radius * np.interp(place, x, density))

    return solve_ivp(speed, (0, times[-1]), [0.0], t_eval=times, rtol=1e-8).y[0]


def crest(x, values, low, high):
    """Place of the largest value between low and high, by a parabola through its neighbours."""
    i = np.flatnonzero((x > low) & (x < high))
    i = i[values[i].argmax()]
    around = slice(i - 3, i + 4)
    curve = np.polyfit(x[around] - x[i], values[around], 2)
    return x[i] - curve[1] / (2 * curve[0])


fig, panels = plt.subplots(1, 2, figsize=(10, 3.8), sharey=True, layout="constrained")
pulses, measured = {}, {}
for ax, temperature, factor in zip(
    panels, ("isothermal", "evolving"), (1, np.sqrt(3)), strict=True
):
    variance = variances[temperature]
    flow = hydrodynamics(
        chain, start, END, velocity_variance=variance, every=END / 40, cells=1000, progress=False
    )
    pulses[temperature] = flow
    t, x = flow.time.values, flow.x.values
    path = sound_path(t, factor)
    crests = [crest(x, v, -1, 150) for v in flow.flow_velocity.values]
    measured[temperature] = crests[-1] / path[-1]
    image = ax.pcolormesh(
        x, t, flow.flow_velocity / PUSH, cmap="cividis", vmin=0, vmax=0.6, rasterized=True
    )
    for side in (-1, 1):
        ax.plot(side * path, t, "--", color="white", linewidth=1.2)
    ax.set(title=temperature, xlabel="position x [R]", xlim=(-130, 130))
    print(f"{temperature}: crest at {crests[-1]:.1f} R, path with {factor:.3f} c: {path[-1]:.1f} R")
panels[0].set_ylabel("time t [T]")
fig.colorbar(image, ax=panels, label="flow velocity V / push")
middle = W / (1 - 2 * chain.radius * rest.density.sel(x=0, method="nearest").item())
print(f"in the middle: W = {W:.1f} R/T, c = {middle:.1f} R/T")
assert all(abs(ratio - 1) < 0.03 for ratio in measured.values())

# %% [markdown]
# **Explain.** Both fluids carry sound as they should. In the dense middle it is nearly five times
# as fast as the rods themselves.
#
# ## 7. Do rods hear it?
#
# The fluid with a temperature was *exact* for the breathing cloud. **Predict**: is it right for
# sound too?
#
# In $y$, elastic rods that swap names just pass one another. So in truth a pushed rod carries its
# push at its own velocity, fast ones far, slow ones near. Each point is a damped oscillator
# with noise. One that starts at $y_0$ with the mean push $u(y_0)$ is Gaussian at time $t$,
#
# $$(y, v)\sim\mathcal N\!\big(M\,(y_0, u(y_0)),\; \Sigma - M\,\mathrm{diag}(s^2,0)\,M^\top\big),
# \qquad M = e^{Bt},\quad B = \begin{pmatrix}0&1\\-k/m&-\gamma/m\end{pmatrix},$$
#
# with $\Sigma = \mathrm{diag}(s^2, W^2)$ at rest. Integrate over the Gaussian of $y_0$, and the
# mean velocity at $y$ is known. Beside it: 10 000 simulated chains.

# %%
push, spread, moment = 0.3 * W, 0.1 * s, 0.5 * s / W


def mean_velocity(y, t, push=push, spread=spread):
    """Exact mean velocity of the points at y, at time t after a push."""
    y0 = np.linspace(-6 * s, 6 * s, 6001)
    weight = norm.pdf(y0, scale=s)
    propagator = expm(np.array([[0, 1], [-(omega**2), -friction]]) * t)
    known = propagator @ np.diag([s**2, 0]) @ propagator.T
    covariance = np.diag([s**2, W**2]) - known
    place, speed = propagator @ np.array([y0, push * np.exp(-((y0 / spread) ** 2) / 2)])
    distance = y[:, np.newaxis] - place
    here = weight * norm.pdf(distance, scale=np.sqrt(covariance[0, 0]))
    velocity = speed + covariance[1, 0] / covariance[0, 0] * distance
    return (here * velocity).sum(1) / here.sum(1)


copies = 10_000
states = equilibrium_states(chain, copies, seed=2)
state_y = chain.reduced(states.position.values)
pushed_velocity = states.velocity + push * np.exp(-((state_y / spread) ** 2) / 2)
last = simulate(
    chain,
    start=states.assign(velocity=pushed_velocity),
    replicas=copies,
    average="ensemble",
    observe=("snapshots",),
    duration=moment,
    every=moment,
    seed=3,
    progress=False,
).isel(time=-1)

edges = np.linspace(-2, 2, 41) * s
cell = np.digitize(chain.reduced(last.position.values).ravel(), edges)
velocities = last.velocity.values.ravel()
binned = np.array([velocities[cell == j].mean() for j in range(1, edges.size)])
errors = np.array(
    [velocities[cell == j].std() / np.sqrt((cell == j).sum()) for j in range(1, edges.size)]
)
fine = np.linspace(-2, 2, 401) * s
truth = mean_velocity(fine, moment)
in_bins = mean_velocity((edges[1:] + edges[:-1]) / 2, moment)

fig, ax = plt.subplots(figsize=(8, 3.8), layout="constrained")
strong = rest.assign(
    flow_velocity=("x", push * np.where(near, np.exp(-((rest_y / spread) ** 2) / 2), 0.0))
)
styles = {"isothermal": ("--", BLUE), "evolving": ("-.", PINK)}
for temperature, (style, colour) in styles.items():
    flow = hydrodynamics(
        chain,
        strong,
        moment,
        velocity_variance=variances[temperature],
        every=moment,
        cells=1000,
        progress=False,
    ).isel(time=-1)
    flow_y = flow.x - 2 * chain.radius * (flow.label - chain.size / 2)
    ax.plot(flow_y / s, flow.flow_velocity / W, style, color=colour, label="fluid, " + temperature)
ax.plot(fine / s, truth / W, color=ORANGE, linewidth=2.5, label="exact")
ax.errorbar(
    (edges[1:] + edges[:-1]) / 2 / s,
    binned / W,
    errors / W,
    fmt="o",
    color="k",
    fillstyle="none",
    markersize=4,
    label="rods, 10 000 chains",
)
ax.set(xlim=(-2, 2), xlabel="reduced position y / s", ylabel="mean velocity / W")
ax.set_title(f"t = {moment:.2f} T = 0.5 s/W after a push in the middle")
ax.legend()

# %%
pulls = (binned - in_bins) / errors
hump = crest(fine, truth, 0, 1.5 * s)
print(f"rods from the exact curve: at most {abs(pulls).max():.1f} standard errors")
print(f"highest at {hump / (W * moment):.2f} W t; sound: 1 or {np.sqrt(3):.2f}")
early = 0.1 * moment
soon = mean_velocity(0.1 * fine, early, push=0.03 * push, spread=0.1 * spread)
hump_soon = crest(0.1 * fine, soon, 0, 0.15 * s)
print(f"ten times earlier, push narrower and weaker: at {hump_soon / (W * early):.2f} W t")
print(f"height: exact {truth.max() / W:.3f} W")
assert abs(pulls).max() < 5
assert abs(hump_soon / (W * early) - np.sqrt(2)) < 0.05

# %% [markdown]
# **Explain.** No. The rods' answer is neither pulse. There is no sound: the push runs apart into
# two low humps that get broader and broader, since rods of all velocities carry it. (The push is a
# strong one, to be seen above the noise. The fluids' pulses steepen, and drift to the right
# while they part.) Shortly after a narrow and weak push the mean velocity is proportional to
# $w^2 e^{-w^2/2W^2}$ with $w = y/t$, highest at $w = \sqrt2\,W$, between the two speeds of sound.
# At the time of the picture the crests are further out, where fewer other rods share the push.
#
# A fluid presumes that collisions make velocities forget where they came from (*local
# equilibrium*). Elastic collisions of equals in one dimension do not: they only exchange names.
# The breathing cloud was exact because a Gaussian stays a Gaussian, not because there is a
# fluid. Noise and friction do make rods forget, after $m/\gamma = 4.2\,T$, and by then the push
# is lost in the springs.
#
# ## Exercises
#
# **1.** With which friction would the isothermal fluid be good enough? Compare the two widths
# for $\gamma = 1, 2, 5, 10$.
#
# <details><summary>Solution</summary>
#
# ```python
# long = np.linspace(0, 60, 1201)
# for damping in (1, 2, 5, 10):
#     slow = chain.replace(damping=damping)
#     cold, heated = (breathe(slow, long, SQUEEZE, heated=h)[0] for h in (False, True))
#     print(damping, np.abs(cold - heated).max())
# ```
#
# 0.56, 0.33, 0.11 and 0.04 $s$. Friction exchanges heat at the rate $2\gamma/m$ *and* slows the
# motion down: at $\gamma = 10$ the noise keeps the temperature nearly where it should be.
# </details>
#
# **2.** Check the label frame with the other, independent solver: `frame="eulerian"`, which has the
# two equations of section 1 on a grid of positions.
#
# <details><summary>Solution</summary>
#
# ```python
# from crazybilliards.kinetic import compressed
# other = hydrodynamics(chain, compressed(chain, SQUEEZE), 16, every=0.4, frame="eulerian",
#                       velocity_variance="evolving", progress=False)
# np.abs(other.cloud_width / s - width).max().item()
# ```
#
# 0.002: the two agree to 0.2 % of $s$ with the default 285 cells.
# </details>
#
# **3.** A wave of frequency $\omega$ exchanges heat at the rate $2\gamma/m$ while it passes. Derive
# $c^2(\omega)$ between Newton's and Laplace's limits, without springs. Which limit is section 6?
#
# <details><summary>Solution</summary>
#
# In $y$, with $\theta = \delta W^2/W^2$: $\theta_t = -2V_y - \frac{2\gamma}{m}\theta$, and the
# continuity equation says $-V_y = \partial_t\,\delta\rho_y/\rho_y$. For $e^{-i\omega t}$:
# $\theta = \frac{-2i\omega}{-i\omega+2\gamma/m}\,\frac{\delta\rho_y}{\rho_y}$, and with
# $p = \rho_y W^2$
#
# $$c^2(\omega) = W^2\left(1 + \frac{2}{1 + 2i\gamma/(m\omega)}\right).$$
#
# Slow waves have $c = W$, fast ones $\sqrt3\,W$. Our pulse has $\omega\approx W/(0.08\,s) = 6.1/T$
# against $2\gamma/m = 0.48/T$: nearly adiabatic.
# </details>
#
# **4.** The start of section 3 had the velocities of the steady state. Squeeze a chain slowly,
# without exchange of heat: which $W^2$ would it have, and what happens at release?
#
# <details><summary>Solution</summary>
#
# $W^2\propto 1/\sigma^2$, that is $1/0.3^2 = 11$ times $W_0^2$. Change the start in `breathe` to
# `free / squeeze**2`. The cloud then bursts open to
# 2.47 $s$, at $t = 2.9\,T$, cooling on the way to 0.37 $W_0^2$.
# </details>
