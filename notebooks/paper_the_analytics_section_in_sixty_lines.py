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
# # The analytics section in sixty lines
#
# **Question.** How much code does it take to repeat the section *Comparison to analytical
# calculations* of [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460)?
#
# Sixty lines: those that you see in sections 1 to 6, without the folded cells that draw. They use
# numpy, scipy and py-pde, and the drawing uses matplotlib. Only the simulation comes from this
# package. Section 7 then repeats each result with the functions of the package, and shows with
# numbers why they are written differently.
#
# The labels such as `diff_gl` are those of the LaTeX source of the paper. The unit of length is the
# rod radius $R$. The unit of time is $t_0 = \sqrt{M/k}$, where a rod has the mass
# $m = \frac{4\pi}{3}M$.
#
# *Level: for readers of the paper. You need: numpy and scipy. Time: 30 minutes. The lessons 1 to 10
# explain everything that is only used here. To predict before you see the results, type
# `make lessons` in the folder of the project, and open the copy of this notebook in
# `build/lessons/`, which has neither outputs nor solutions.*
#
# **What you may change.** The amplitude of section 1, from 1 to 10. Section 6 sets its own.
# After a change run all cells below it again.

# %%
import matplotlib.pyplot as plt
import numpy as np
import pde
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, curve_fit
from scipy.stats import norm

import crazybilliards as cb

# %% tags=["hide-input"]
from solutions import analytics as solutions
from teaching import check, safe

# %% [markdown]
# ## 1. The simulation
#
# The chain is that of the paper's figure with the arctanh (`fig:atan`): $e = 1$, $A = 10$,
# $\gamma = k = 1$, $L = 100$. `positions` has one row for each moment that is kept, and one column
# for each rod.

# %%
chain = cb.Chain(size=100, amplitude=10)
L, R, k, m = chain.size, chain.radius, chain.stiffness, chain.mass
W2 = chain.free_velocity_width**2  # W_v^2 = A^2/(2 m gamma), the free value, exact at e = 1
kept = ("snapshots", "widths", "density")
run = cb.simulate(chain, duration=5e4, every=10, replicas=2, observe=kept, progress=False)
positions = run.position.values.reshape(-1, L)

# %% tags=["hide-input"]
_ = safe(
    1 <= chain.amplitude <= 10,
    f"This notebook is for an amplitude from 1 to 10, not {chain.amplitude}: the bins of section 2 "
    "end where the rods of a warmer chain go on. Set it back before you go on.",
)

# %% [markdown]
# ## 2. The density
#
# The paper counts which fraction of each bin is covered by rods, and then takes a running average
# over $2R$. Both steps are convolutions of the histogram of the rods' centres with a rectangle of
# length $2R$. (The text of the paper names one rectangle, its recipe has two.)

# %%
h = 2 * R / 21
edges = h * np.arange(-1500.5, 1501)
x = (edges[1:] + edges[:-1]) / 2
box = np.full(21, 1 / 21)


def smooth(density):
    return np.convolve(np.convolve(density, box, "same"), box, "same")


simulated = smooth(np.histogram(positions, edges)[0] / (len(positions) * h))

# %% [markdown]
# ## 3. The mean displacement
#
# The mean position of rod $i$ is $x = \{2i-(L+1)\}R + \langle\Delta x_i\rangle$. The paper fits
# $\langle\Delta x\rangle = B\,\mathrm{arctanh}(Cx)$ to the points.

# %%
anchors = R * (2 * np.arange(1, L + 1) - (L + 1))
mean = positions.mean(axis=0)


def arctanh(x, B, C):
    return B * np.arctanh(C * x)


most = 1 / abs(mean).max()  # the arctanh ends at x = 1/C, beyond all mean positions
guess, bounds = (10, 0.9 * most), ([0, 0], [100, most])
(B, C), _ = curve_fit(arctanh, mean, mean - anchors, p0=guess, bounds=bounds)
print(f"B = {B:.2f} R, 1/C = {1 / C:.1f} R")

# %% tags=["hide-input"]
plt.figure(figsize=(6, 3))
plt.plot(mean, mean - anchors, "o", markersize=3, label="simulation")
plt.plot(mean, arctanh(mean, B, C), label="B arctanh(Cx)")
plt.gca().set(xlabel="mean position x [R]", ylabel=r"$\langle\Delta x\rangle$ [R]")
plt.legend()
plt.show()

# %% [markdown]
# ## 4. The force balance
#
# At rest, $V=0$, the velocity equation of the fluid (`modeleq`) says that the gradient of the
# pressure balances the springs. With a constant $W_v$ this is the paper's equation (19), `diff_gl`,
# and the fit closes it. For a rod of the mass $m$ it reads
#
# $$\frac{\partial\rho}{\partial x} = -\frac{k}{mW_v^2}\,\langle\Delta x\rangle\,\rho\,(1-2\rho R)^2 .$$
#
# The paper integrates it numerically. One substitution makes this easy. Let $\rho_y$ be the number
# of rods per *free* length, $\rho_y = \rho/(1-2R\rho)$. Then $\rho_y'=\rho'/(1-2R\rho)^2$, and
#
# $$\frac{d\ln\rho_y}{dx} = -\frac{k}{mW_v^2}\,\frac{\langle\Delta x\rangle}{1+2R\rho_y},$$
#
# so that neither $\rho<0$ nor $\rho$ above close packing can occur.
#
# We start in the middle of the chain and integrate $\ln\rho_y$ to the right. The density in the
# middle is not known, but the number of rods is: a root finder chooses $\rho(0)$ such that there
# are $L$ rods. The fit ends at $x=1/C$. The density there is small but not zero, and no rods are
# beyond.

# %%
half = x[(x >= 0) & (x < 1 / C)]


def slope(x, log_free):
    return -k / (m * W2) * arctanh(x, B, C) / (1 + 2 * R * np.exp(log_free))


def integrate(start):
    free = np.exp(solve_ivp(slope, (0, half[-1]), [start], t_eval=half, rtol=1e-8).y[0])
    return free / (1 + 2 * R * free)


start = brentq(lambda start: 2 * np.trapezoid(integrate(start), half) - L, -5, 10)
balance = np.interp(abs(x), half, integrate(start), right=0)

# %% [markdown]
# ## 5. Theory and simulation
#
# **Predict.** The paper says that the results of the force balance match the simulated densities
# perfectly. Where do you expect the largest difference? (The theory is smoothed like the
# simulation, which the paper leaves open.)
#
# **Run.**

# %% tags=["hide-input"]
plt.figure(figsize=(6, 3))
plt.plot(x, simulated, label="simulation")
plt.plot(x, smooth(balance), "--", label="force balance")
plt.gca().set(xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]", ylim=(0, 0.55))
plt.legend(loc="lower center")
plt.show()

# %%
apart = 2 * R * abs(simulated - smooth(balance))
print(f"at most {apart.max():.3f} of close packing apart, at |x| = {abs(x[apart.argmax()]):.0f} R")

# %% tags=["remove-cell"]
assert 0.025 < apart.max() < 0.04
assert 110 < abs(x[apart.argmax()]) < 130
inside = abs(x) < 100
assert apart[inside].max() < 0.01

# %% [markdown]
# <details><summary>Explain</summary>
#
# The densities agree to better than 1 % of close packing where $|x|<100$ R. The largest difference,
# 4 %, is at the two ends, where the density falls to zero over a few rods. The statistical error is
# smaller than 1 %. Section 7 gives the main reason, and [lesson
# 5](05_from_the_kinetic_equation_to_the_force_balance.ipynb), section 6, tells what the fit adds.
# </details>
#
# ## 6. The fluid in time: three strings
#
# The appendix derives a continuity equation, (31) `eq9`, and a velocity equation, (16) `modeleq`:
#
# $$\frac{\partial\rho}{\partial t} + \frac{\partial(\rho V)}{\partial x} = 0, \qquad
# \frac{\partial V}{\partial t} + V\frac{\partial V}{\partial x} =
# -\frac1\rho\frac{\partial}{\partial x}\frac{\rho W_v^2}{1-2\rho R}
# - k\langle\Delta x\rangle - \gamma V .$$
#
# For a rod of the mass $m$, divide $k$ and $\gamma$ by $m$. The paper uses these equations at rest
# only. py-pde solves equations that are given as text, so we can write down what the paper has. One
# equation must be added, because a moving fluid has no fitted $\langle\Delta x\rangle(x)$. Let
# $N(x,t)$ be the number of rods to the left of $x$. The rods take it along, $N_t + VN_x=0$, and
# $\langle\Delta x\rangle = x - 2R\,(N - L/2)$.
#
# The last term of the velocity equation is not in the paper. It is a small viscosity, which
# py-pde's central differences need. Its value 4 $R^2/t_0$ is small against $sW_v = 220\,R^2/t_0$.

# %%
warm = chain.replace(amplitude=30)
s, gamma = warm.thermal_length, warm.damping
equations = {
    "rho": "-d_dx(rho * V)",
    "V": "-V * d_dx(V) - W2 / rho * d_dx(rho / (1 - 2 * R * rho))"
    "- k / m * (x - 2 * R * (N - L / 2)) - gamma / m * V + 4 * d2_dx2(V)",
    "N": "-V * d_dx(N)",
}
constants = {"W2": warm.free_velocity_width**2, "R": R, "L": L, "k": k, "m": m, "gamma": gamma}
fluid = pde.PDE(equations, consts=constants, bc={"curvature": 0})

# %% [markdown]
# We release a chain that is squeezed to 0.6 of its width at rest. At rest the $\rho_y$ of an
# elastic chain is $L$ times a Gaussian of width $s=W_v\sqrt{m/k}$, in the coordinate
# $y = x - 2R\,(N - L/2)$ ([lesson 4](04_the_elastic_chain_is_exactly_solvable.ipynb)). The squeezed
# chain has the width $0.6\,s$ instead.

# %%
SQUEEZE, END = 0.6, 12.0
grid = pde.CartesianGrid([[-L * R - 5 * s, L * R + 5 * s]], 400)
X = grid.axes_coords[0]


def released(squeeze):
    y = np.linspace(-30 * s, 30 * s, 100_001)
    y = np.interp(X, y + 2 * R * L * (norm.cdf(y, scale=squeeze * s) - 0.5), y)
    free, N = L * norm.pdf(y, scale=squeeze * s), L * norm.cdf(y, scale=squeeze * s)
    fields = {"rho": free / (1 + 2 * R * free), "V": 0 * X, "N": N}
    return pde.FieldCollection([pde.ScalarField(grid, fields[f], label=f) for f in fields])


solver = {"dt": 0.02, "solver": "runge-kutta", "backend": "numpy"}
storage = pde.MemoryStorage()
fluid.solve(released(SQUEEZE), t_range=END, tracker=storage.tracker(0.4), **solver)

# %% [markdown]
# py-pde draws its own results:

# %% tags=["hide-input"]
pde.plot_kymograph(
    storage,
    field_index=0,
    title=r"density $\rho$ [1/R]",
    ax_style={"xlabel": "position x [R]", "ylabel": "time $t$ [$t_0$]"},
)
plt.show()

# %% [markdown]
# ## 7. Why the package does it otherwise
#
# First we check that it does the *same*. `smooth`, `fit_arctanh` and `force_balance` repeat
# sections 2 to 4. `hydrodynamics` repeats section 6, by an independent method: its unknown is the
# position of the rods of each label $N$.

# %%
binned = cb.smooth(run)
paper = cb.force_balance(chain, displacement=cb.comparison.fit_arctanh(run))
flow = cb.hydrodynamics(warm, cb.compressed(warm, SQUEEZE), END, every=0.4, progress=False)
in_time = np.array([fields[0] for fields in storage.data])
theirs = np.array([np.interp(X, flow.x, row) for row in flow.density])
differences = {
    "binned density": np.interp(x, binned.x, binned.density) - simulated,
    "force balance": np.interp(x, paper.x, paper.density) - balance,
    "fluid in time": theirs - in_time,
}
for name, difference in differences.items():
    print(f"{name}: {2 * R * abs(difference).max():.1e} of close packing")

# %% tags=["remove-cell"]
largest = [2 * R * abs(difference).max() for difference in differences.values()]
assert largest[0] < 1e-3
assert largest[1] < 1e-3
assert largest[2] < 1e-2
assert theirs.shape == in_time.shape == (31, X.size)

# %% tags=["hide-input"]
plt.figure(figsize=(6, 3))
for moment in (0, 5, 15):
    colour = plt.plot(X, in_time[moment], label=f"t = {flow.time[moment]:.0f} $t_0$")[0].get_color()
    plt.plot(X[::10], theirs[moment][::10], "o", color=colour, markersize=3)
plt.gca().set(xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
plt.legend(title="lines: three strings\npoints: hydrodynamics", fontsize=8, title_fontsize=8)
plt.show()

# %% [markdown]
# Where the sixty lines work, they are right. The package's functions also work elsewhere.
#
# **A strong compression.** A time step of fixed length must be shorter than about three times the
# time that sound takes through a cell. The speed of sound $c$ is given by
# $c^2 = \frac{d}{d\rho}\frac{\rho W_v^2}{1-2R\rho}$.
#
# **Your turn.** Write $c/W_v$ as a function of $\rho_y$. The number `R` is known.


# %%
def my_speed_of_sound(free):
    return ...  # your code here


places = [(0.1,), (1.0,), (50.0,)]
hint = "The derivative is W_v^2/(1 - 2 R rho)^2. Then write 1 - 2 R rho with the density rho_y."
check(my_speed_of_sound, lambda free: solutions.speed_of_sound(free, R), at=places, hint=hint)

# %% [markdown]
# <details><summary>Solution</summary>
#
# $1-2R\rho = 1/(1+2R\rho_y)$, so $c = W_v/(1-2R\rho) = W_v\,(1+2R\rho_y)$.
#
# ```python
# def my_speed_of_sound(free):
#     return 1 + 2 * R * free
# ```
# </details>
#
# **Predict.** We squeeze the chain of section 6 to 0.2 instead of 0.6. Does the time step of 0.02 $t_0$
# still do?
#
# **Run.**

# %%
tight = pde.MemoryStorage()
with np.errstate(all="ignore"):
    fluid.solve(released(0.2), t_range=1.0, tracker=tight.tracker(0.1), **solver)
broken = [not (np.isfinite(fields).all() and (fields[0] >= 0).all()) for fields in tight.data]
first = tight.times[np.argmax(broken)]
print(f"three strings: a density is negative or not a number at t = {first:.1f} t_0")
flow = cb.hydrodynamics(warm, cb.compressed(warm, 0.2), END, every=0.4, progress=False)
print(f"hydrodynamics: {flow.rods[-1].item():.4f} rods at t = {END:.0f} t_0")

# %% tags=["remove-cell"]
assert any(broken)
assert abs(flow.rods - L).max() < 1e-3

# %% [markdown]
# <details><summary>Explain</summary>
#
# It does not. The speed of sound grows without bound near close packing, and the solution breaks
# down.
# </details>
#
# `hydrodynamics` chooses its steps, and has neither a vacuum nor a viscosity in a smooth flow. It
# also solves a temperature equation, which the paper does not have and a moving chain needs
# ([lesson 7](07_the_fluid_in_time.ipynb)).
#
# **A force balance without a simulation.** The labels $N$ of section 6 close the force balance,
# too. Then it needs no fit. But the root finder of section 4 does not always find its solution.
# With gaps between the anchors, a small error of $\rho(0)$ grows along the chain like $\exp(y/s)$,
# where $y$ is the free length from the middle. With the gap $g=1$ R the free length is $gL/2 = 50$
# R, so the error grows by a factor $e^7$ at $A=10$, where $s=7.1$ R, and by $e^{71}$ at $A=1$:


# %%
def number_of_rods(start, chain):
    k, m, W2 = chain.stiffness, chain.mass, chain.free_velocity_width**2
    spacing = 2 * R + chain.lattice_gap

    def rates(x, state):  # of the number of rods from the middle on, and of ln rho_y
        free = np.exp(min(state[1], 50.0))
        rho = free / (1 + 2 * R * free)
        return rho, -k / (m * W2) * (x - spacing * state[0]) / (1 + 2 * R * free)

    end = spacing * L / 2 + 6 * chain.thermal_length
    return 2 * solve_ivp(rates, (0, end), (0, start), "LSODA", rtol=1e-10, atol=1e-12).y[0, -1]


# %%
for A in (10, 1):
    gapped = cb.Chain(size=L, amplitude=A, gap=1.0)
    start = brentq(lambda start, chain=gapped: number_of_rods(start, chain) - L, -1, 1)
    labels = cb.force_balance(gapped)
    theirs = np.trapezoid(labels.density, labels.x)
    print(f"A = {A}: {number_of_rods(start, gapped):.3f} rods, force_balance {theirs:.3f}")

# %% tags=["remove-cell"]
assert abs(number_of_rods(start, gapped) - L) > 1
assert abs(theirs - L) < 1e-3

# %% [markdown]
# At $A = 1$ no floating-point number is close enough to $\ln\rho_y(0)$. `force_balance` therefore
# solves a boundary-value problem. With a fit it needs no differential equation at all, because the
# force balance then has a solution in closed form.
#
# **Rods in place of a fluid.** At $e = 1$ without a gap the force balance is exact for the
# *points*, whose density is $\rho_y$. What is approximate is to read rods off a fluid, by
# $\rho = \rho_y/(1+2R\rho_y)$. `rod_by_rod` reads them off the points ([lesson
# 5](05_from_the_kinetic_equation_to_the_force_balance.ipynb), section 5):

# %%
labels = cb.force_balance(chain)
for name, theory in {"fluid": labels, "rod by rod": cb.rod_by_rod(labels)}.items():
    largest = cb.deviation(binned, cb.smooth(theory)).maximum
    print(f"{name}: at most {largest:.3f} of close packing from the simulation")

# %% tags=["remove-cell"]
assert largest < 0.01

# %% [markdown]
# ## Exercises
#
# **1.** Repeat sections 1 to 5 with $A = 1$. How large is the largest difference, and where is it?
#
# <details><summary>Solution</summary>
#
# Some 15 % of close packing, at the outermost rods. The chain is then nearly a crystal. Nearly all
# of the error comes from reading rods off a fluid: `cb.rod_by_rod(cb.force_balance(chain))` agrees
# with the simulation.
# </details>
#
# **2.** Remove the viscosity from the second string. When does the solution of section 6 end?
#
# <details><summary>Solution</summary>
#
# Remove `+ 4 * d2_dx2(V)`. At $t=4.8\,t_0$ the densities are not numbers any more. Central
# differences do not damp waves that are two cells long, and the equations are not linear, so these
# waves grow.
# </details>
