# ---
# jupyter:
#   jupytext:
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
# # From the kinetic equation to the force balance
#
# **Question.** A gas of points with velocity variance $W^2$ has the pressure $\rho W^2$ (per mass).
# The rods of our chain are not points, and the force balance of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) says
#
# $$\text{pressure} = \frac{\rho W^2}{1-2R\rho}.$$
#
# Where does the denominator come from, and how good is each step on the way to it?
#
# We start from a kinetic equation, take moments, do the integrals and the Taylor expansion with
# SymPy, and check each step against the exact solution. At the end you know which steps are exact,
# which are not, and where one can go wrong without noticing.
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = \frac{4\pi}{3}M$), times in
# $\sqrt{M/k}$. Restitution is 1 until section 7.

# %%
import matplotlib.pyplot as plt
import numpy as np
import sympy as sp
from scipy.integrate import solve_bvp
from scipy.interpolate import CubicSpline
from scipy.special import gammaln, log_ndtr
from scipy.stats import norm

from crazybilliards.comparison import deviation, smooth
from crazybilliards.kinetic import equilibrium, force_balance
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

BLUE, ORANGE, GREEN, PINK = "#0072B2", "#E69F00", "#009E73", "#CC79A7"

chain = Chain(size=100, amplitude=30)
sigma = 2 * chain.radius  # length of a rod
print(f"free velocity width W = {chain.free_velocity_width:.2f} R/T")
print(f"thermal length s = {chain.thermal_length:.1f} R")


# %% [markdown]
# The pressure decides how the chain arranges itself: its gradient holds the springs. To see how
# much, here is a small solver that takes *any* pressure $W^2 q(\rho)$. It needs the slope
# $q'(\rho)$ and solves, on the right half of the chain,
#
# $$q'(\rho)\,\rho' = -\frac{k}{mW^2}\,\rho\,\langle\Delta x\rangle,\qquad N' = \rho,\qquad
# \langle\Delta x\rangle = x - 2R\,(N - L/2).$$
#
# (The last equation says: the $N$-th rod from the left belongs to the $N$-th anchor. More in
# section 6.)


# %%
def density_of_pressure(chain, slope):
    """Density rho(x), x >= 0, of a chain without gap whose pressure is W^2 q, slope = dq/drho."""
    guess = force_balance(chain).sel(x=slice(0, None))
    guess = guess.sel(x=guess.density > 1e-8)

    def equations(x, state):
        log_density, label = state
        packing = np.minimum(sigma * np.exp(log_density), 0.999)
        pull = (x - sigma * (label - chain.size / 2)) / chain.thermal_length**2
        return np.array([-pull / slope(packing), np.exp(log_density)])

    def ends(left, right):
        return np.array([left[1] - chain.size / 2, right[1] - chain.size])

    start = np.array([np.log(guess.density.values), guess.label.values])
    solution = solve_bvp(equations, ends, guess.x.values[::5], start[:, ::5], tol=1e-6)
    assert solution.status == 0
    return guess.x.values, np.exp(solution.sol(guess.x.values)[0])


exact = equilibrium(chain)
x_points, points = density_of_pressure(chain, lambda packing: 1.0 + 0 * packing)
x_rods, rods = density_of_pressure(chain, lambda packing: 1 / (1 - packing) ** 2)

fig, ax = plt.subplots(figsize=(7, 3.4), layout="constrained")
ax.plot(exact.x, exact.density, color=ORANGE, linewidth=3, label="exact")
ax.plot(x_rods, rods, "--", color=BLUE, label=r"pressure $\rho W^2/(1-2R\rho)$")
ax.plot(x_points, points, "-.", color=GREEN, label=r"pressure $\rho W^2$ (points)")
ax.axhline(chain.close_packed_density, color="0.6", linewidth=1)
ax.text(2, chain.close_packed_density + 0.005, "close packing", color="0.4")
ax.set(xlim=(0, 190), ylim=(0, 0.56), xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(loc="lower left")

# %% [markdown]
# **Predict.** Both lines know the anchors, the springs and the noise. One of them does not know
# that rods hit each other *a rod length apart*. Which effect is it that pushes the chain apart:
# more collisions, or the distance at which they happen?
#
# **Run.**

# %%
centre = exact.density.sel(x=0, method="nearest").item()
print(f"density in the centre: exact {centre:.4f}, rods {rods[0]:.4f}, points {points[0]:.4f}")
assert abs(rods[0] - centre) < 2e-3
assert points[0] - centre > 0.05

# %% [markdown]
# **Explain.** Points that collide elastically swap their velocities, which in a gas of equals
# changes nothing: collisions at a *point* never make a pressure. A rod hands its momentum to a
# place $2R$ further on, at once. That transport is what is missing, and what we now compute.
#
# ## 1. The kinetic equation and its moments
#
# Let $f(x, v, t)$ be the number of rods per length and velocity, $\int f\,dv = \rho$. Springs pull
# with $-F$ (for linear springs $F = k\langle\Delta x\rangle$), friction and noise act, and rods
# collide:
#
# $$f_t + v f_x - \frac{F}{m} f_v = \partial_v\!\left[\frac{\gamma}{m}\,v f
# + \frac{A^2}{2m^2} f_v\right] + J[f].$$
#
# The bracket is the Fokker-Planck term that belongs to $m\dot v = -\gamma v + A\,\xi(t)$. All that
# is special about rods is in the collision integral $J$.
#
# A *moment* is the integral over $v$ with a power of $v$. For these we need integrals over a
# Gaussian with mean $V$ and variance $W^2$; SymPy does them.

# %%
v, V = sp.symbols("v V", real=True)
rho, W, gamma, m, A, F = sp.symbols("rho W gamma m A F", positive=True)
f = rho * sp.exp(-((v - V) ** 2) / (2 * W**2)) / sp.sqrt(2 * sp.pi * W**2)


def moment(expression, n):
    return sp.simplify(sp.integrate(v**n * expression, (v, -sp.oo, sp.oo)))


noise = sp.diff(gamma / m * v * f + A**2 / (2 * m**2) * sp.diff(f, v), v)
spring = -F / m * sp.diff(f, v)
for n in (0, 1):
    print(f"moment {n}:  f: {moment(f, n)},  v f: {sp.factor(moment(v * f, n))},")
    print(f"    spring: {moment(spring, n)},  friction and noise: {moment(noise, n)}")

assert moment(v * f, 1).equals(rho * (V**2 + W**2))
assert moment(spring, 1).equals(F * rho / m)
assert moment(noise, 0) == 0
assert moment(noise, 1).equals(-gamma * rho * V / m)

# %% [markdown]
# So, as no collision creates a rod,
#
# $$\rho_t + (\rho V)_x = 0,\qquad
# (\rho V)_t + (\rho V^2 + \rho W^2)_x = -\frac{F}{m}\rho - \frac{\gamma}{m}\rho V
# + \int v\,J\,dv .$$
#
# The results for $f$, spring and noise hold for any $f$ (integrate by parts); the Gaussian only
# says that the variance is called $W^2$. Noise does not appear: it pushes to both sides alike.
#
# ## 2. What a collision hands over
#
# A rod with velocity $v$ is on the left, one with $u$ on the right, and $v > u$. Momentum is
# conserved, and the relative velocity is reversed and multiplied by the restitution $e$.

# %%
u, v_after, u_after = sp.symbols("u v' u'", real=True)
e = sp.symbols("e", positive=True)
after = sp.solve(
    [v_after + u_after - v - u, v_after - u_after + e * (v - u)], [v_after, u_after], dict=True
)[0]
handed_over = sp.factor(v - after[v_after])
print("v - v' =", handed_over)
assert handed_over.equals((1 + e) / 2 * (v - u))
assert sp.simplify(after[v_after].subs(e, 1) - u) == 0  # elastic rods swap their velocities

# %% [markdown]
# In a time $dt$ such a pair collides if it is closer than $(v-u)\,dt$. With the *pair density*
# $f_2(x, v;\, x+2R, u)$ of rods in contact, the momentum (over $m$) that rods at $x$ hand to their
# right neighbours per time and length is
#
# $$\Pi(x) = \frac{1+e}{2}\iint_{v>u} (v-u)^2\, f_2(x, v;\, x+2R, u)\;du\,dv .$$
#
# A rod at $x$ loses $\Pi(x)$ to the right and receives $\Pi(x-2R)$ from the left. Hence, with no
# approximation at all,
#
# $$\int v\,J\,dv = \Pi(x-2R) - \Pi(x). \tag{1}$$
#
# **The first approximation**, molecular chaos, is Boltzmann's and Enskog's: rods about to collide
# have independent velocities,
# $f_2 = f(x, v)\,f(x+2R, u)\,\chi$, where $\chi$ says how much more often rods are in contact than
# independent points would be.
#
# Two Gaussians with variances $W_1^2$ and $W_2^2$ give a relative velocity $w = v - u$ that is
# Gaussian with variance $W_1^2+W_2^2$. Only one half-line of $w$ collides: $w > 0$ with the right
# neighbour. For the left neighbour it is the other half-line.

# %%
w, W1, W2, delta = sp.symbols("w W1 W2 delta", real=True, positive=True)


def relative(variance, mean=0):
    return sp.exp(-((w - mean) ** 2) / (2 * variance)) / sp.sqrt(2 * sp.pi * variance)


right = sp.simplify(sp.integrate(w**2 * relative(W1**2 + W2**2), (w, 0, sp.oo)))
left = sp.simplify(sp.integrate(w**2 * relative(W1**2 + W2**2), (w, -sp.oo, 0)))
print("right neighbour:", right, "   left neighbour:", left)
print("equal temperatures:", sp.simplify((1 + e) / 2 * right.subs({W1: W, W2: W})))
assert sp.simplify(right - (W1**2 + W2**2) / 2) == 0
assert sp.simplify(right - left) == 0

# %% [markdown]
# **Explain.** Half of all pairs approach, and those carry half of $\langle w^2\rangle = 2W^2$:
#
# $$\Pi(x) = \frac{1+e}{2}\,W^2\,\chi\,\rho(x)\,\rho(x+2R). \tag{2}$$
#
# If the temperature varies in space, $W^2$ is the mean of the two places, which is the value
# half-way between them up to second derivatives.
#
# ## 3. How often are rods in contact?
#
# For rods in equilibrium that all feel the same potential this has an exact answer, in three lines
# (Percus 1976 derived the whole theory; the lines below are ours). Think of a long system in
# contact with a reservoir of rods, with fugacity $z(x)$. Let
# $\Xi_-(x)$ be the partition function of all rods that fit to the left of a rod at $x$ and
# $\Xi_+(x)$ that to the right. Then
#
# $$\rho(x) = \frac{z(x)\,\Xi_-(x)\,\Xi_+(x)}{\Xi},\qquad
# \rho_2(x, x+2R) = \frac{z(x)\,z(x+2R)\,\Xi_-(x)\,\Xi_+(x+2R)}{\Xi},$$
#
# $$\frac{\rho(x)\,\rho(x+2R)}{\rho_2(x, x+2R)} = \frac{\Xi_+(x)\,\Xi_-(x+2R)}{\Xi}
# = \text{probability of no centre between } x \text{ and } x+2R
# = 1 - \int_x^{x+2R}\!\rho .$$
#
# The last step holds because at most one centre fits in between. So
#
# $$\chi = \frac{1}{1 - \int_x^{x+2R}\rho\,dx'} , \tag{3}$$
#
# and where the density is uniform this is Tonks' $\chi = 1/(1-2R\rho)$: each rod takes its own
# length away from the room of the others.
#
# Our rods have anchors *of their own*, so (3) is not exact for them. Without gap their exact
# state is known, though: with the rods' length taken out, $y_i = x_i - 2R(i-\frac{L+1}{2})$, they
# are $L$ independent draws from one Gaussian, put in order. That gives the density, the mean
# displacement and the density of contacts without any approximation.


# %%
def ordered_draws(chain, nodes_per_rod):
    """Exact rho, rho <dx> and contact density rho_2(x, x + 2R) of a chain without gap."""
    L, s = chain.size, chain.thermal_length
    half = int((L + 7 * s) * nodes_per_rod / sigma)
    x = sigma / nodes_per_rod * np.arange(-half, half + 1)
    i = np.arange(1, L + 1)[:, np.newaxis]
    y = x - sigma * chain.rank[:, np.newaxis]
    z = y / s
    below, above, gauss = log_ndtr(z), log_ndtr(-z), norm.logpdf(z) - np.log(s)
    ways = gammaln(L + 1) - gammaln(i) - gammaln(L - i + 1)
    rod = np.exp(ways + (i - 1) * below + (L - i) * above + gauss)
    ways = ways[:-1] + np.log(L - i[:-1])
    contact = np.exp(
        ways + ((i - 1) * below)[:-1] + ((L - i - 1) * above)[:-1] + 2 * gauss[:-1]
    )  # rod i at y and rod i + 1 at y as well
    return x, rod.sum(0), (rod * y).sum(0), contact.sum(0)


n = 40  # nodes per rod length
x, density, density_dx, contact = ordered_draws(chain, n)
print(f"rods: {density.sum() * sigma / n:.10f}")

# %% [markdown]
# **Run.** First: equation (1) with the exact contacts. At rest the momentum equation says
# $(\rho W^2)' + \Pi(x) - \Pi(x-2R) = -\frac{k}{m}\,\rho\langle\Delta x\rangle$, and in equilibrium
# velocities *are* independent of positions, so $\Pi = W^2\rho_2$ is no approximation either.

# %%
W_free = chain.free_velocity_width
inside = slice(n, -n)
flow_of_heat = W_free**2 * CubicSpline(x, density)(x, 1)
collisions = W_free**2 * (contact - np.roll(contact, n))
springs = -chain.stiffness / chain.mass * density_dx
residual = np.abs(flow_of_heat + collisions - springs)[inside].max() / np.abs(springs).max()
print(f"largest residual of the exact momentum balance: {residual:.1e} of the largest force")
assert residual < 1e-6

# %% [markdown]
# The balance is exact, rod by rod. Now replace the exact contacts by (3), and by Tonks' formula
# with the density half-way between the two rods.

# %%
fig, panels = plt.subplots(1, 2, figsize=(10, 3.4), layout="constrained")
worst, highest, fullest = {}, {}, {}
for ax, amplitude, shown in zip(panels, (30, 8), ((0, 150), (-7, 7)), strict=True):
    x_c, density_c, _, contact_c = ordered_draws(chain.replace(amplitude=amplitude), n)
    cumulative = CubicSpline(x_c, density_c).antiderivative()(x_c)
    between = np.roll(cumulative, -n) - cumulative  # int rho from x to x + 2R
    chaos = density_c * np.roll(density_c, -n)
    closures = {
        "integral": chaos / (1 - between),
        "midpoint": chaos / (1 - sigma * np.roll(density_c, -n // 2)),
    }
    top = contact_c.max()
    worst[amplitude] = {
        name: np.abs(each - contact_c).max() / top for name, each in closures.items()
    }
    highest[amplitude], fullest[amplitude] = density_c.max(), between.max()
    part = (x_c > shown[0]) & (x_c < shown[1])
    ax.plot(x_c[part], contact_c[part], color=ORANGE, linewidth=3, label="exact contacts")
    for (name, each), colour, style in zip(
        closures.items(), (BLUE, GREEN), ("--", ":"), strict=True
    ):
        ax.plot(x_c[part], each[part], style, color=colour, label=rf"$\chi$ by the {name}")
    ax.set(title=f"A = {amplitude}", xlabel="position x of the left rod [R]", xlim=shown)
    ax.set_ylim(0, 1.6 * top)
    print(
        f"A = {amplitude}: largest error over largest value:",
        ", ".join(f"{name} {value:.4f}" for name, value in worst[amplitude].items()),
    )
    print(f"    highest density {highest[amplitude]:.3f}, most rods between {between.max():.3f}")
panels[0].set_ylabel(r"contact density $\rho_2(x, x+2R)$ [1/R$^2$]")
panels[0].legend()

assert all(abs(value - 1 / chain.size) < 1e-3 for value in worst[30].values())
assert worst[8]["integral"] < 0.02
assert worst[8]["midpoint"] > 1
assert highest[8] > chain.close_packed_density
assert fullest[8] < 1

# %% [markdown]
# **Explain.** Where a rod moves over more than its own length ($A = 30$) both closures are right
# but for 1 %, which is $1/L$: a chain of fixed size has $L(L-1)$ pairs and not $L^2$. At $A = 8$
# the rods begin to stand in a row, and the density is a row of hills. On top of a hill its *local*
# value exceeds close packing, so that $1-2R\rho$ is negative: nonsense. The integral over a rod
# length cannot exceed 1, and (3) is still right to 1.4 %, anchors of their own or not. A fluid's
# $\rho$ is the density *averaged over some rods*.
#
# ## 4. The Taylor expansion
#
# Let the density vary slowly: $\rho = \rho(\varepsilon x)$, and expand in $\varepsilon$. Note what
# is small. It is not $2R\rho$, which comes close to 1 in a dense chain, but the *change* of
# $\rho$ over a rod length. So expand the shift by $2R$, and keep $\chi$ whole.

# %%
eps, a = sp.symbols("epsilon a", positive=True)  # a = 2R
r = sp.symbols("rho rho' rho'' rho'''")
x_, x1 = sp.symbols("x x1", real=True)


def slow(place):
    return sum(r[j] * (eps * place) ** j / sp.factorial(j) for j in range(4))


def tonks(value):
    return 1 / (1 - a * value)


choices = {
    "integral (3)": lambda x: 1 / (1 - sp.integrate(slow(x1), (x1, x, x + a))),
    "midpoint": lambda x: tonks(slow(x + a / 2)),
    "mean of both": lambda x: tonks((slow(x) + slow(x + a)) / 2),
    "left rod": lambda x: tonks(slow(x)),
}


def orders(force):
    """Coefficients of eps, eps^2, eps^3 of a force at x = 0."""
    return [
        sp.factor(sp.diff(force, eps, j).subs(eps, 0) / sp.factorial(j)).subs(r[0], rho)
        for j in (1, 2, 3)
    ]


expansion = {}
for name, chi in choices.items():

    def transfer(x, chi=chi):
        return chi(x) * slow(x) * slow(x + a)  # Pi over W^2

    expansion[name] = orders(transfer(-a) - transfer(0))

tonks_pressure = rho / (1 - a * rho)
wanted = -sp.diff(tonks_pressure - rho, rho) * r[1]  # the collisional part
for name, (first, second, _) in expansion.items():
    print(f"{name:13} first: {sp.simplify(first - wanted) == 0},  second: {second}")

assert all(sp.simplify(each[0] - wanted) == 0 for each in expansion.values())
assert all(expansion[name][1] == 0 for name in list(choices)[:3])
assert expansion["left rod"][1] != 0

# %% [markdown]
# **Explain.** To first order the force of the collisions is
# $-W^2\,\frac{d}{dx}\,\frac{2R\rho^2}{1-2R\rho}$ for *every* choice, and with the $\rho W^2$ of the
# moments the pressure is
#
# $$\rho W^2 + W^2\,\frac{2R\rho^2}{1-2R\rho} = \frac{\rho W^2}{1-2R\rho},$$
#
# Tonks' exact equation of state. For a choice that treats both rods alike the next correction is
# of third order, as reflection demands.
#
# ## 5. The force balance
#
# At rest, pressure gradient and springs balance: $\big(\rho W^2/(1-2R\rho)\big)' =
# -\frac{k}{m}\rho\langle\Delta x\rangle$. Solve for $\rho'$:

# %%
place, k, dx = sp.symbols("x k dx", positive=True)
profile, heat = sp.Function("rho")(place), sp.Function("W2")(place)

balance = sp.Eq(sp.diff(profile * W**2 / (1 - a * profile), place), -k / m * profile * dx)
slope = sp.solve(balance, sp.diff(profile, place))[0]
print("constant W^2:  rho' =", sp.factor(slope))
paper = -k / (m * W**2) * dx * profile * (1 - a * profile) ** 2
assert sp.simplify(slope - paper) == 0

balance = sp.Eq(sp.diff(profile * heat / (1 - a * profile), place), -k / m * profile * dx)
slope_heat = sp.solve(balance, sp.diff(profile, place))[0]
extra = sp.simplify(slope_heat - paper.subs(W**2, heat))
print("with W^2(x) there is in addition:", sp.factor(extra))
warmer = -sp.diff(heat, place) / heat * profile * (1 - a * profile)
assert sp.simplify(extra - warmer) == 0

# %% [markdown]
# The first line, $\rho' = -\frac{k}{mW^2}\langle\Delta x\rangle\,\rho\,(1-2R\rho)^2$, is the last
# numbered equation of the paper's analytics section. With a temperature that varies, rods are also
# driven away from where it is hot.
#
# ## 6. Closure, reduced coordinate, closed form
#
# One equation, two unknowns: $\rho$ and $\langle\Delta x\rangle$. The paper measures
# $\langle\Delta x\rangle$. One can also say where the anchors are: with
# $N(x)=\int_{-\infty}^x\rho$, the rod at $x$ has the anchor $(2R+g)(N-L/2)$, so
# $\langle\Delta x\rangle = x-(2R+g)(N-L/2)$ and $N' = \rho$.
#
# Now take the rods' length out here, too: $y = x - 2R(N-L/2)$, thus $dy/dx = 1-2R\rho$, and the
# density in $y$ is $\rho_y = \rho/(1-2R\rho)$.
#
# **Predict** what becomes of the factor $(1-2R\rho)^2$. **Run.**

# %%
g = sp.symbols("g", nonnegative=True)
reduced = profile / (1 - a * profile)
in_y = sp.diff(sp.log(reduced), place).subs(sp.diff(profile, place), paper) / (1 - a * profile)
print("(ln rho_y)' =", sp.simplify(in_y))
assert sp.simplify(in_y + k / (m * W**2) * dx) == 0

density_y, s_ = sp.symbols("rho_y s", positive=True)
# d<dx>/dy with <dx> = y - g (N - L/2) and dN/dy = rho_y:
poisson_boltzmann = -k / (m * W**2) * (1 - g * density_y)
y, L_ = sp.symbols("y L", positive=True)
gaussian = L_ / (s_ * sp.sqrt(2 * sp.pi)) * sp.exp(-(y**2) / (2 * s_**2))
left_side = sp.diff(sp.log(gaussian), y, 2)
right_side = poisson_boltzmann.subs({g: 0, W: s_ * sp.sqrt(k / m)})
print("g = 0:", left_side, "=", sp.simplify(right_side))
assert sp.simplify(left_side - right_side) == 0

# %% [markdown]
# **Explain.** It disappears. In $y$ the rods are an ideal gas, and the force balance is a
# Poisson-Boltzmann equation,
#
# $$(\ln\rho_y)'' = -\frac{k}{mW^2}\,(1 - g\,\rho_y).$$
#
# For $g = 0$ all anchors coincide, and it is solved by a Gaussian with $s^2 = mW^2/k$:
# $\rho_y = L\,\mathcal N(y;0,s^2)$, $N = L\,\Phi(y/s)$, and then
# $x = y+2R(N-L/2)$, $\rho = \rho_y/(1+2R\rho_y)$. Does the solver of the package find it?

# %%
theory = force_balance(chain)
y_grid = np.linspace(-7, 7, 20_001) * chain.thermal_length
label = chain.size * norm.cdf(y_grid / chain.thermal_length)
rho_y = chain.size * norm.pdf(y_grid, scale=chain.thermal_length)
closed = CubicSpline(y_grid + sigma * (label - chain.size / 2), rho_y / (1 + sigma * rho_y))

inside = theory.sel(x=slice(-300, 300))
error = np.abs(inside.density - closed(inside.x)).max().item()
own = np.abs(np.interp(x_rods, inside.x, inside.density) - rods).max()
print(f"force_balance against the closed form: {error:.1e} /R")
print(f"the small solver of the beginning against force_balance: {own:.1e} /R")
assert error < 1e-6
assert own < 1e-4

# %% [markdown]
# And against the truth? Smooth both as the paper does (a running average of the covered fraction).

# %%
fig, ax = plt.subplots(figsize=(7, 3.2), layout="constrained")
table = {}
for amplitude, colour in zip((1, 3, 10, 30), (GREEN, PINK, BLUE, ORANGE), strict=True):
    case = chain.replace(amplitude=amplitude)
    truth, fluid = smooth(equilibrium(case)), smooth(force_balance(case))
    third_last = equilibrium(case).mean_position.values[-3]
    off = sigma * np.abs(fluid.density - truth.density)
    table[amplitude] = (
        deviation(fluid, truth).maximum,
        off.where(np.abs(off.x) < third_last).max().item(),
    )
    ax.plot(off.x - case.anchors[-1], off, color=colour, label=f"A = {amplitude}")
    print(
        f"A = {amplitude:2}: largest difference {table[amplitude][0]:.4f} of close packing,"
        f" further in than the two outermost rods {table[amplitude][1]:.4f}"
    )
ax.set(xlim=(-60, 60), xlabel="position x, from the last anchor [R]")
ax.set_ylabel(r"|difference| $\times 2R$")
ax.legend()
assert table[1][0] > 0.1
assert table[1][1] < 0.014
assert table[30][0] < 0.01

# %% [markdown]
# **Explain.** At $A = 30$ the fluid is right to better than a per cent. At $A = 1$ the chain ends
# in a step, which the fluid smears out; further in than the two outermost rods it is good to 1.3 %
# even there, after the smoothing.
#
# ## 7. What a careful reader should question
#
# **(a) "Take $\chi$ at the local density."** For a rod at $x$ one is tempted to write
# $\chi(\rho(x))$ in front of the whole collision integral, for the contact on its right *and* for
# the one on its left. Every choice of section 4 gave the same pressure. Does this one?

# %%
own_place = tonks(slow(0)) * slow(0) * (slow(-a) - slow(a))
first = orders(own_place)[0]
effective_slope = sp.factor(1 - first / r[1])
correct_slope = sp.factor(sp.diff(tonks_pressure, rho))
print("q' with chi at the rod's own place:", effective_slope)
print("q' of Tonks' gas:                  ", correct_slope)
own_pressure = -rho - 2 / a * sp.log(1 - a * rho)
assert sp.simplify(sp.diff(own_pressure, rho) - effective_slope) == 0
print("pressure over W^2:", own_pressure)
print("in powers of the density:", sp.series(effective_slope, rho, 0, 3))
print("Tonks:                   ", sp.series(correct_slope, rho, 0, 3))
assert sp.simplify(effective_slope - (1 + a * rho) / (1 - a * rho)) == 0

# %% [markdown]
# It does not. At one and the same contact the two rods would use two different $\chi$, so that one
# gives what the other does not receive: momentum is not conserved. The error is of *first*
# order in the gradient; only at low density, up to the first power of $2R\rho$, is the slope
# right. And the pressure rises towards close packing like a logarithm instead of
# $1/(1-2R\rho)$. What is needed is not an exact argument but a *shared* one.

# %%
packing = np.linspace(0, 0.99, 400)
fig, (left_panel, right_panel) = plt.subplots(1, 2, figsize=(10, 3.4), layout="constrained")
pressures = {
    "Tonks": (1 / (1 - packing), BLUE, "-"),
    r"$\chi$ at own place": (-1 - 2 * np.log1p(-packing[1:]) / packing[1:], PINK, "--"),
    r"first order in $2R\rho$": (1 + packing, GREEN, ":"),
}
for name, (values, colour, style) in pressures.items():
    left_panel.plot(packing[-values.size :], values, style, color=colour, label=name)
left_panel.set(xlabel=r"packing $2R\rho$", ylabel=r"pressure / $\rho W^2$", ylim=(0, 12))
left_panel.legend()

dense = chain.replace(amplitude=10)
x_exact = equilibrium(dense)
slopes = {
    "Tonks": (lambda q: 1 / (1 - q) ** 2, BLUE, "-"),
    r"$\chi$ at own place": (lambda q: (1 + q) / (1 - q), PINK, "--"),
    r"first order in $2R\rho$": (lambda q: 1 + 2 * q, GREEN, ":"),
}
centres = {}
right_panel.plot(x_exact.x, smooth(x_exact).density, color=ORANGE, linewidth=3, label="exact")
for name, (slope, colour, style) in slopes.items():
    x_here, here = density_of_pressure(dense, slope)
    centres[name] = here[0]
    right_panel.plot(x_here, here, style, color=colour, label=name)
right_panel.set(
    xlim=(0, 130), xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]", ylim=(0, 0.55)
)
right_panel.legend(loc="lower left")
true_centre = smooth(x_exact).density.sel(x=0, method="nearest").item()
print(f"A = 10, density in the centre, exact: {true_centre:.4f};", end=" ")
print(", ".join(f"{name}: {value:.4f}" for name, value in centres.items()))
assert abs(centres["Tonks"] - true_centre) < 2e-3
assert centres[r"$\chi$ at own place"] - true_centre > 0.01

# %% [markdown]
# **(b) "Expand in $2R$."** Strictly to first order in $2R$ the pressure would be
# $\rho W^2(1+2R\rho)$, the dotted line. The expansion of section 4 is one in the *shift*.
#
# **(c) "Below $e = 1$, put in the factor $(1+e)/2$."** Equation (2) has it, so one is tempted to
# take the collisional part of the pressure times $\alpha = (1+e)/2$, with Tonks' $\chi$. In the
# reduced coordinate that pressure is $W^2\rho_y\,(1+2R\rho_y\alpha)/(1+2R\rho_y)$: in a dense chain
# simply $\alpha$ times too small against $W^2\rho_y$.
#
# But in $y$ rods collide *at a point*, and momentum is conserved there, whatever $e$ is. The
# collisions therefore drop out of the momentum balance in $y$:
# $(\rho_y\langle v^2\rangle)' = -\frac{k}{m}\,y\,\rho_y$ without gap. Multiply by $y$ and
# integrate: the virial theorem, exact at any restitution,
#
# $$k\sum_i\langle y_i^2\rangle = m\sum_i\langle v_i^2\rangle .$$
#
# **Predict** the ratio of the two sides at $e = 0.5$: 1, or near $\alpha = 0.75$? **Run.**

# %%
cold = Chain(size=30, restitution=0.5)
alpha = (1 + cold.restitution) / 2
ratios, enskog = [], []
for seed in range(8):
    run = simulate(cold, duration=600, seed=seed, observe=("widths",), progress=False)
    squares_y = (run.displacement_width**2 + run.mean_displacement**2).values
    squares_v = (run.velocity_width**2).values
    ratios.append(cold.stiffness * squares_y.sum() / (cold.mass * squares_v.sum()))
    crowd = sigma * np.gradient(cold.rank, run.mean_displacement.values)  # 2R rho_y
    enskog.append((squares_v * (1 + alpha * crowd) / (1 + crowd)).sum() / squares_v.sum())
ratio, ratio_error = np.mean(ratios), np.std(ratios, ddof=1) / np.sqrt(8)
step_error = run.attrs["time_step_error"]
print(f"measured ratio {ratio:.4f} +- {ratio_error:.4f}, with the factor {np.mean(enskog):.3f}")
print(f"estimated error of the smallest width from the time step: {step_error:.4f}")
assert abs(ratio - 1) < 5 * ratio_error + 2 * step_error  # W^2: twice the error of W
assert ratio - np.mean(enskog) > 0.1

# %% [markdown]
# **Explain.** The ratio is 1. The factor is not wrong in (2), but Tonks' $\chi$ must be wrong
# beside it: below $e = 1$ rods that have met leave each other slowly, stay near and meet again, so
# that pairs *about to* collide are not distributed as in equilibrium. What the factor takes away,
# the contacts give back. Without the factor, the pressure $\rho W^2/(1-2R\rho)$ is $\rho_y W^2$ in
# $y$, which agrees with the exact balance at any $e$, if $W^2$ is the variance the rods really
# have.
#
# ## Exercises
#
# **1.** Let the flow vary in space: the two rods of a contact have mean velocities $V(x)$ and
# $V(x+2R)$. What does the half-line integral give to first order in their difference $\delta$, and
# which term is therefore missing in a velocity equation that has only the pressure?
#
# <details><summary>Solution</summary>
#
# ```python
# shifted = sp.integrate(w**2 * relative(2 * W**2, delta), (w, 0, sp.oo))
# sp.simplify(sp.diff(shifted, delta).subs(delta, 0))  # 2 W/sqrt(pi)
# ```
#
# With $\delta = -2R\,V_x$ the transfer is $\rho^2\chi\,(W^2 - \frac{2W}{\sqrt\pi}\,2R\,V_x)$: a
# viscous pressure $-\zeta V_x$ with $\zeta = \frac{2}{\sqrt\pi}\,W(2R)^2\rho^2\chi$ (per mass), if
# molecular chaos holds. At rest it is zero, so that the force balance does not care.
# </details>
#
# **2.** Show for any spring potential $U$ that without gap $\rho_y\propto e^{-U(y)/T}$, and check
# `force_balance` for `spring="quadratic"` in the centre.
#
# <details><summary>Solution</summary>
#
# $(\ln\rho_y)' = -F(y)/T$ with $F = U'$. For $U = k|y|^3/3$ the integral of $e^{-U/T}$ is
# $2\,\Gamma(4/3)\,(3T/k)^{1/3}$, so $\rho_y(0) = L/\big(2\,\Gamma(4/3)\,(3T/k)^{1/3}\big)$.
#
# ```python
# from math import gamma
# soft = Chain(size=100, amplitude=30, spring="quadratic")
# top = soft.size / (2 * gamma(4 / 3) * (3 * soft.temperature / soft.stiffness) ** (1 / 3))
# top / (1 + sigma * top), force_balance(soft).density.max().item()
# ```
#
# Both are 0.4551.
# </details>
#
# **3.** By how much do "midpoint" and "integral (3)" differ at third order, for the term with
# $\rho'''$?
#
# <details><summary>Solution</summary>
#
# ```python
# difference = expansion["midpoint"][2] - expansion["integral (3)"][2]
# sp.factor(sp.diff(difference, r[3]))
# ```
#
# $W^2\,(2R)^4\rho^2\chi^2\rho'''/24$ in the force. The integral contains the mean of $\rho$ over a
# rod length, which exceeds the value in the middle by $(2R)^2\rho''/24$.
# </details>
