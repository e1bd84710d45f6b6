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
# The paper answers in its appendix: a kinetic equation, two of its moments, a Taylor expansion. We
# follow it equation by equation, do every integral with SymPy, and check each step against the
# exact solution. At the end you know which steps are exact, which are not, where the paper does not
# print what it means, and where one can go wrong without noticing.
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = \frac{4\pi}{3}M$), times in
# $\sqrt{M/k}$. Restitution is 1 until section 9.

# %%
import matplotlib.pyplot as plt
import numpy as np
import sympy as sp
from scipy.integrate import solve_bvp
from scipy.interpolate import CubicSpline
from scipy.special import gammaln, log_ndtr
from scipy.stats import norm

from crazybilliards.comparison import deviation, fit_arctanh, smooth
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
# section 8.)


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
# The paper computes it in its appendix. Sections 1 to 7 follow that appendix from its first to its
# last equation. Section 7 then takes up the section "Comparison to analytical calculations", where
# the result is used.
# `eq4` is the name of an equation in the LaTeX source of the paper, and (24) its number, counted
# from the beginning of the paper. Where a formula of the paper is not what its result needs, we
# compute what it gives as it is printed, and what was meant. Section 10 lists these places. None
# of them changes the final equation: it is right.
#
# ## 1. The transport equation: `eq1`, `eq2`, `eq3`, and the identities
#
# Let $\tilde\rho(r, v, t)$ be the number of rods per length and velocity,
# $\int\tilde\rho\,dv = \rho$. The paper starts from (`eq1`, 21)
#
# $$\partial_t\tilde\rho + v\,\partial_r\tilde\rho
# + \partial_v\!\left(\tilde\rho\,\frac{dv}{dt}\right)
# = \frac{A^2}{2m^2}\,\partial_v^2\tilde\rho
# + \left(\frac{\partial\tilde\rho}{\partial t}\right)_{int}.$$
#
# The velocities are Gaussian with the mean $V$ and the variance $W_v^2$ (`eq2`, 22), here written
# $W^2$, and between collisions a rod is accelerated by (`eq3`, 23)
# $dv/dt = -\gamma v - k\langle\Delta x\rangle$, which the paper writes for unit mass.
#
# $\langle\Delta x\rangle$ is the mean displacement from their anchors of the rods *found at* $r$.
# The force is linear in the displacement, so that only this mean enters: up to here nothing is
# approximated.
#
# **Run.** The section "Definitions and Identities" (41 to 52) lists derivatives of the Gaussian and
# integrals over it. With $P = \tilde\rho/\rho$, SymPy confirms each of them.

# %%
v, w, V, dx = sp.symbols("v w V dx", real=True)  # dx stands for <Delta x>
rho, W, gamma, m, A, k = sp.symbols("rho W gamma m A k", positive=True)
P = sp.exp(-((v - V) ** 2) / (2 * W**2)) / sp.sqrt(2 * sp.pi * W**2)
phase = rho * P  # rho tilde


def mean(expression):
    """Integral over v of the expression times P."""
    return sp.simplify(sp.integrate(expression * P, (v, -sp.oo, sp.oo)))


integrals = {
    sp.Integer(1): 1,
    v: V,
    (v - V) ** 2: W**2,
    v**2: V**2 + W**2,
    v * (v - V): W**2,
    v**2 * (v - V): 2 * W**2 * V,
    v * (v - V) ** 2: W**2 * V,
}
for integrand, value in integrals.items():
    print(f"<{integrand}> = {sp.expand(mean(integrand))}")
    assert sp.expand(mean(integrand) - value) == 0

acceleration = -gamma * v - k * dx
driven = sp.diff(phase * acceleration, v)
assert sp.simplify(driven - phase * ((v - V) / W**2 * (gamma * v + k * dx) - gamma)) == 0
noise = A**2 / (2 * m**2) * sp.diff(phase, v, 2)
assert sp.simplify(noise - A**2 / (2 * m**2) * phase * (((v - V) / W**2) ** 2 - 1 / W**2)) == 0
print("the derivatives (44) and (45) are right as well")

# %% [markdown]
# All twelve are right. Two things are to be said about the three equations themselves.
#
# **The Gaussian of the main text** (15, below `eq:helbing`) has the prefactor $\rho/\sqrt{2\pi}$,
# without the $1/W_v$ that `eq2` has. **Predict** what its integral over $v$ is then.
#
# **The mass.** The diffusion term of `eq1` has an $m$ in it, the acceleration `eq3` has none.
# **Predict:** which velocity width would a rod without neighbours have? Compare with
# $W_v = A/\sqrt{2m\gamma}$ (`free`, 9). **Run.**

# %%
main_text = rho / sp.sqrt(2 * sp.pi) * sp.exp(-((v - V) ** 2) / (2 * W**2))
print(
    "integral of (15):", sp.simplify(sp.integrate(main_text, (v, -sp.oo, sp.oo))), "instead of rho"
)
assert sp.simplify(sp.integrate(main_text, (v, -sp.oo, sp.oo)) - rho * W) == 0


def free_width(acceleration):
    """W of a rod at rest on average, from d<v^2>/dt = 0 in eq1 without collisions."""
    change = v**2 * (noise - sp.diff(phase * acceleration, v)) / rho
    rate = sp.integrate(sp.expand(sp.simplify(change.subs({V: 0, dx: 0}))), (v, -sp.oo, sp.oo))
    [width] = sp.solve(sp.simplify(rate), W)
    return width


with_mass = -(gamma * v + k * dx) / m
print("eq3 as printed:       W =", free_width(acceleration))
print("eq3 divided by m:     W =", free_width(with_mass), "  (this is eq. free)")
assert sp.simplify(free_width(with_mass) - A / sp.sqrt(2 * m * gamma)) == 0
ratio = sp.simplify(free_width(acceleration) / free_width(with_mass))
assert sp.simplify(ratio - 1 / sp.sqrt(m)) == 0
print("ratio of the two:", ratio, "=", f"{1 / np.sqrt(chain.mass):.3f} for a rod of this model")

# %% [markdown]
# **Explain.** (15) lacks a factor $1/W_v$ and `eq2` has it. `eq1` with `eq3` is consistent for
# $m = 1$ only. With $dv/dt = -(\gamma v + k\langle\Delta x\rangle)/m$ it is consistent for any mass,
# and we use that from here on. The diffusion constant of the main text is $D = A^2/m^2$: (14) has
# $\frac12\partial_v^2(D\tilde\rho)$ where `eq1` has $\frac{A^2}{2m^2}\partial_v^2\tilde\rho$.
#
# ## 2. Moments: `eq6`, `eq7`, `eq9`, `eq10`
#
# Multiply `eq1` by $\psi(v) = 1$ or $v$ and integrate over $v$. Let $\mathcal I(\psi)$ be what the
# collisions contribute. SymPy computes everything else, first the moments of the Gaussian and then
# the derivatives of the fields.

# %%
r, t = sp.symbols("r t", real=True)
Rho, Vel, Var, Pull = (sp.Function(name)(r, t) for name in ("rho", "V", "W2", "dx"))
collisions_of_v = sp.Function("I")(r, t)  # I(v)
fields = {rho: Rho, V: Vel, W: sp.sqrt(Var), dx: Pull}


def moment_equation(psi):
    """Left minus right side of eq1, times psi, integrated over v, without collisions."""
    stored = sp.expand(mean(psi) * rho).subs(fields)
    carried = sp.expand(mean(psi * v) * rho).subs(fields)
    # by parts: the integral of psi d(f a)/dv is -rho <psi' a>, that of psi f'' is rho <psi''>
    pushed = -mean(sp.diff(psi, v) * with_mass) * rho
    shaken = A**2 / (2 * m**2) * mean(sp.diff(psi, v, 2)) * rho
    return sp.diff(stored, t) + sp.diff(carried, r) + sp.expand(pushed - shaken).subs(fields)


number = moment_equation(sp.Integer(1))
momentum = moment_equation(v)
eq6 = sp.diff(Rho, t) + sp.diff(Rho * Vel, r)
eq7 = sp.diff(Rho * Vel, t) + sp.diff(Rho * (Vel**2 + Var), r) + Rho * (gamma * Vel + k * Pull) / m
assert sp.expand(number - eq6) == 0
assert sp.expand((momentum - eq7).doit()) == 0
print("eq6 and eq7 are right, with gamma/m and k/m")

# eq10 is eq7 with eq9 (the continuity equation) put in, divided by rho
eq10 = (
    sp.diff(Vel, t)
    + Vel * sp.diff(Vel, r)
    + sp.diff(Rho * Var, r) / Rho
    + (gamma * Vel + k * Pull) / m
    - collisions_of_v / Rho
)
assert sp.simplify(((eq7 - collisions_of_v - Vel * eq6) / Rho - eq10).doit()) == 0
print("eq10 follows from eq7 and eq9")

# %% [markdown]
# So, as no collision creates a rod (`eq9`, 31; we check $\mathcal I(1) = 0$ in section 4),
#
# $$\rho_t + (\rho V)_r = 0,\qquad
# V_t + V V_r = -\frac1\rho(\rho W^2)_r - \frac{\gamma V + k\langle\Delta x\rangle}{m}
# + \frac{\mathcal I(v)}{\rho}.$$
#
# The noise does not appear: it pushes to both sides alike. The Gaussian only says that the variance
# is called $W^2$. Any other distribution with this variance gives the same two equations.
#
# ## 3. The collisions: `eq4` and the cross section
#
# At $e = 1$ two rods swap their velocities. With the velocities $(v', w')$ of the left and the right
# rod before and $(v, w)$ after, that is the cross section (25)
#
# $$\sigma(v', w'\,|\,v, w) = \delta(v' - w)\,\delta(w' - v).$$

# %%
v_after, w_after = sp.symbols("v_after w_after", real=True)
e = sp.symbols("e", positive=True)
[after] = sp.solve(
    [v_after + w_after - v - w, v_after - w_after + e * (v - w)], [v_after, w_after], dict=True
)
handed_over = sp.factor(v - after[v_after])
print("v - v' =", handed_over)
assert handed_over.equals((1 + e) / 2 * (v - w))
assert sp.simplify(after[v_after].subs(e, 1) - w) == 0  # elastic rods swap their velocities
assert sp.simplify(after[w_after].subs(e, 1) - v) == 0

# %% [markdown]
# `eq4` (24) has four terms: rods at $r$ gain the velocity $v$ in a collision with the right
# neighbour at $r+2R$, or lose it there, and the same with the left neighbour at $r-2R$. Pairs with
# the velocities $v$ and $w$ meet at the rate $|v-w|\,\tilde\rho_2$, where
# $\tilde\rho_2(r, v;\,r+2R, w;\,t)$ is the density of pairs in contact.
#
# The integrals run over *all* velocities. **Predict:** the flux of momentum will need
# $\iint |v-w|\,(w-v)\,P(v)\,P(w)\,dv\,dw$, since the left rod changes its velocity from $v$ to $w$.
# What is this integral over all velocities, and what is it over $v > w$ only? **Run.**

# %%
c, u = sp.symbols("c u", real=True)  # half the sum of both velocities, less V; their difference


def pairs(expression, lowest=0):
    """Integral of the expression times P(v) P(w) over the pairs with v - w > lowest."""
    both = sp.simplify(
        (expression * P * P.subs(v, w)).subs(
            {v: V + c + u / 2, w: V + c - u / 2}, simultaneous=True
        )
    )
    inner = sp.simplify(sp.integrate(both, (c, -sp.oo, sp.oo)))
    return sp.simplify(sp.integrate(inner, (u, lowest, sp.oo)))


printed = pairs(sp.Abs(v - w) * (w - v), lowest=-sp.oo)
approaching = pairs((v - w) * (w - v))
print("all pairs:", printed, "    approaching pairs, v > w:", approaching)
assert printed == 0
assert approaching == -(W**2)

# %% [markdown]
# **Explain.** Over all velocities the integral vanishes. Half of all pairs of neighbours move
# *apart*. They have no collision, but `eq4` as it is printed lets them swap their velocities too,
# and what they hand over is exactly the opposite. In a gas at rest collisions would transport no
# momentum, the pressure would be $\rho W^2$, and the chain would look like the green line in the first picture.
#
# What is missing in print is a step function in each term: $\Theta(v-w)$ for the neighbour on the
# right and $\Theta(w-v)$ for the one on the left, where $v$ belongs to the rod at $r$. The authors
# mean it, since their result (`eq17`) needs it. With it, the integral is $-W^2$. From here on
# "$|v-w|$" is the speed of approach, which is zero for rods that move apart.
#
# In words, and with no approximation at all: the momentum (over $m$) that rods at $r$ hand to their
# right neighbours per time and length is
#
# $$\Pi(r) = \frac{1+e}{2}\iint_{v>w} (v-w)^2\,\tilde\rho_2(r, v;\,r+2R, w)\;dv\,dw,\qquad
# \mathcal I(v) = \Pi(r-2R) - \Pi(r). \tag{1}$$
#
# ## 4. From `eq4` to $\mathcal I(\psi)$: `eq8`, `eq9`, `eq11`, `eq14`
#
# The paper now renames variables: $v\leftrightarrow v'$ and $w\leftrightarrow w'$ in the gains
# (`eq8`, 30), and $v\leftrightarrow w$ in the collisions with the left neighbour (`eq11`, 33).
# That must hold for *any* pair density. We check it for a gas with four velocities whose pair
# density has 16 values, all of them symbols. Integrals are then sums, and the delta functions are
# ones and zeros.

# %%
speeds = np.array([-2, -1, 1, 3], dtype=object)
n = speeds.size
here = np.array(sp.symbols(f"h:{n * n}"), dtype=object).reshape(n, n)  # rods at r and r + 2R
there = np.array(sp.symbols(f"t:{n * n}"), dtype=object).reshape(n, n)  # rods at r - 2R and r
left = there.T  # the same pairs, with the rod at r named first

same = np.eye(n, dtype=int).astype(object)
swap = np.einsum("ad,bc->abcd", same, same)  # sigma(v', w' | v, w), indices in this order
closing = np.maximum(np.subtract.outer(speeds, speeds), 0)  # left rod, right rod

# eq4, the change of the number of rods with velocity v (index c); v', w', w are a, b, d
change = (
    np.einsum("abcd,ab,ab->c", swap, closing, here)
    - np.einsum("cdab,cd,cd->c", swap, closing, here)
    + np.einsum("badc,ba,ab->c", swap, closing, left)
    - np.einsum("dcba,dc,cd->c", swap, closing, left)
)


def interaction(psi):
    """I(psi) by eq4, eq8 and eq11, and the source term I_s by eq14."""
    step, total = np.subtract.outer(psi, psi), np.add.outer(psi, psi)
    eq4 = (psi * change).sum()
    eq8 = np.einsum("cdab,cd,ac,cd->", swap, closing, step, here)
    eq8 += np.einsum("dcba,dc,ac,cd->", swap, closing, step, left)
    eq11 = np.einsum("cdab,cd,ac,cd->", swap, closing, step, here)
    eq11 += np.einsum("cdab,cd,bd,cd->", swap, closing, step, there)
    source = np.einsum("cdab,cd,ab,cd->", swap, closing, total, there)
    source -= np.einsum("cdab,cd,cd,cd->", swap, closing, total, there)
    return [sp.expand(each) for each in (eq4, eq8, eq11, source)]


for name, psi in {"1": speeds**0, "v": speeds, "v^2": speeds**2}.items():
    eq4, eq8, eq11, source = interaction(psi)
    print(f"psi = {name:3}  eq4 = eq8: {eq4 == eq8},  eq8 = eq11: {eq8 == eq11},  I_s = {source}")
    assert eq4 == eq8 == eq11
    assert source == 0
assert interaction(speeds**0)[0] == 0  # eq9: no rods are made

handed = [(closing**2 * pair).sum() for pair in (there, here)]  # Pi(r - 2R), Pi(r)
assert sp.expand(interaction(speeds)[0] - handed[0] + handed[1]) == 0
print("and I(v) is Pi(r - 2R) - Pi(r), equation (1)")

# %% [markdown]
# **Explain.** The renamings are exact, $\mathcal I(1) = 0$, and so `eq6` is the continuity equation
# `eq9`. The source term $\mathcal I_s$ (`eq14`, 36) vanishes for $\psi = v$ because a collision
# conserves momentum. At $e = 1$ it vanishes for $\psi = v^2$ as well. The paper does not use this;
# exercise 4 does.
#
# ## 5. The pair density: `eq5` and `chi`
#
# Now the first approximation: rods about to collide have independent velocities. The paper writes
# (`eq5`, 26 and `chi`, 27)
#
# $$\tilde\rho_2(r, v;\,r\pm2R, w) = \chi(r\pm R)\,\tilde\rho(r, v)\,\tilde\rho(r\pm2R, w),\qquad
# \chi(r\pm R) = \frac{1}{1-2R\,\rho(r\pm R)}.$$
#
# $\chi$ says how much more often rods are in contact than independent points would be. The density
# is taken at the point of contact, half-way between the two rods. Is this the right factor?
#
# *In a uniform gas it is exact.* $N$ rods in a box of length $\ell$ have the partition function
# $Z\propto(\ell-2RN)^N/N!$, as each rod takes its own length away from the room of the others. The
# pressure follows from it, and also from (1): the momentum carried by the rods plus the momentum
# that collisions hand over a rod length further.

# %%
length, rods_in_box, a, chi_ = sp.symbols("l N a chi", positive=True)  # a = 2R
log_z = rods_in_box * sp.log(length - a * rods_in_box)
gas_pressure = sp.diff(log_z, length).subs(length, rods_in_box / rho)  # over m W^2
[chi_exact] = sp.solve(rho + a * chi_ * rho**2 - gas_pressure, chi_)
print("pressure:", sp.simplify(gas_pressure), "   chi at contact:", sp.simplify(chi_exact))
assert sp.simplify(gas_pressure - rho / (1 - a * rho)) == 0
assert sp.simplify(chi_exact - 1 / (1 - a * rho)) == 0

# %% [markdown]
# *Where the density varies*, and all rods feel the same potential, there is an exact answer too, in
# three lines
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
# $$\chi = \frac{1}{1 - \int_x^{x+2R}\rho\,dx'} . \tag{2}$$
#
# The paper's $\chi$ is (2) with the integral replaced by $2R$ times its integrand in the middle.
#
# Our rods have anchors *of their own*, so (2) is not exact for them. Without gap their exact
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
# The balance is exact, rod by rod. Now replace the exact contacts by (2), and by Tonks' formula
# with the density half-way between the two rods, which is the paper's $\chi$.

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
# length cannot exceed 1, and (2) is still right to 1.4 %, anchors of their own or not. A fluid's
# $\rho$ is the density *averaged over some rods*.
#
# ## 6. The Taylor expansion: `eq12` to `eq17`
#
# Note what is small. It is not $2R\rho$, which comes close to 1 in a dense chain, but the *change*
# of $\rho$ over a rod length. So the shift by $2R$ is expanded, and $\chi$ is kept whole.
#
# **`eq12` to `eq15` (34 to 37).** With $h(r) = \tilde\rho_2(r, v;\,r+2R, w)$ the pair to the left
# has $h(r-2R)$. To first order $h(r) = h(r-2R) + 2R\,h'(r)$. Put into `eq11` this gives
# $\mathcal I = \mathcal I_s - \partial_r\mathcal I_f$ with the flux
#
# $$\mathcal I_f(\psi) = -2R\int\!\cdots\,|v-w|\,[\psi(v')-\psi(v)]\;h(r).$$
#
# We found $\mathcal I_s(v) = 0$. For $\psi = v$ and $v' = w$ the flux is $2R\,\Pi(r)$.

# %%
h = sp.Function("h")
shift = sp.symbols("R", positive=True)
earlier = h(r - 2 * shift)
rest = h(r) - earlier - 2 * shift * sp.diff(h(r), r)  # what eq12 leaves out
leading = [sp.diff(rest, shift, j).subs(shift, 0).doit() / sp.factorial(j) for j in range(3)]
print("eq12 leaves out, by powers of R:", leading)
assert leading[:2] == [0, 0]
assert sp.simplify(leading[2] + 2 * sp.diff(h(r), r, 2)) == 0

# eq11 with its two terms, psi = v: (w - v) h(r) + (v - w) h(r - 2R)
in_eq11 = (w - v) * h(r) + (v - w) * (h(r) - 2 * shift * sp.diff(h(r), r))
minus_flux_slope = sp.diff(2 * shift * (w - v) * h(r), r)  # -dI_f/dr
assert sp.expand(in_eq11 - minus_flux_slope) == 0
print("eq13 and eq15 follow, signs included; the source term is zero")

# %% [markdown]
# **`eq16` (38)** expands $\tilde\rho_2$ itself, to first order in derivatives. **Predict:** the rod
# with the velocity $w$ sits at $r+2R$. Which velocity stands in the terms with $\partial V$ and
# $\partial W^2$: $v$, as in the paper, or $w$? **Run.**

# %%
rise = sp.symbols("rho_r V_r W2_r")  # derivatives of rho, V and W^2
Chi = sp.Function("chi")
distance = sp.symbols("d")  # d = 2R, the expansion parameter


def gaussian(velocity, place):
    """Density rho P(velocity) at a distance from r, with fields that vary linearly."""
    variance = W**2 + rise[2] * place
    return (
        (rho + rise[0] * place)
        * sp.exp(-((velocity - V - rise[1] * place) ** 2) / (2 * variance))
        / sp.sqrt(2 * sp.pi * variance)
    )


chi_r = sp.symbols("chi_r")
pair = (chi_ + chi_r * distance / 2) * gaussian(v, 0) * gaussian(w, distance)
relative = sp.simplify((sp.diff(pair, distance) / pair).subs(distance, 0))


def bracket(velocity):
    """The terms of eq16 that stand beside 1, over 2R."""
    squared = (velocity - V) ** 2 / W**2
    return (
        chi_r / (2 * chi_)
        + rise[0] / rho
        + (velocity - V) / W**2 * rise[1]
        + (squared - 1) / (2 * W**2) * rise[2]
    )


print("with w:", sp.simplify(relative - bracket(w)) == 0, "   with v:", end=" ")
print(sp.simplify(relative - bracket(v)) == 0)
assert sp.simplify(relative - bracket(w)) == 0
assert sp.simplify(relative - bracket(v)) != 0

# %% [markdown]
# **Explain.** It is $w$: the rod that is displaced is the one at $r+2R$. All else in `eq16` is
# right. The paper neglects these terms in the next step, so that the letter has no consequence.
#
# **`eq17` (39)** keeps the 1 of `eq16` only. What would the four other terms have given?

# %%
flux = sp.simplify(-a * chi_ * rho**2 * approaching)
print("I_f(v) =", flux, " with a = 2R")
assert sp.simplify(flux - a * chi_ * rho**2 * W**2) == 0  # eq17

weights = {
    "chi_r and rho_r": sp.Integer(1),
    "V_r, with w": (w - V) / W**2,
    "V_r, with v": (v - V) / W**2,
    "W2_r": ((w - V) ** 2 / W**2 - 1) / (2 * W**2),
}
share = {name: pairs((v - w) ** 2 * weight) for name, weight in weights.items()}
for name, value in share.items():
    print(f"    {name:15} is multiplied by {value}")
assert share["V_r, with w"] == -2 * W / sp.sqrt(sp.pi)
assert share["V_r, with v"] == -share["V_r, with w"]
assert share["W2_r"] == sp.Rational(1, 2)

# %% [markdown]
# **Explain.** `eq17` is right, with the step function of section 3. The neglected term with
# $\partial_r V$ is a viscosity (exercise 1). With the $v$ of the printed `eq16` it would be a
# negative one. At rest it is zero either way.
#
# The other neglected terms are first derivatives in the flux, thus second derivatives in the force.
# `eq12` has left out a second derivative as well. Are these errors of second order? Let the density
# vary slowly, $\rho = \rho(\varepsilon r)$ at constant $W^2$, and expand the force
# $\Pi(r-2R)-\Pi(r)$ in powers of $\varepsilon$. We compare several choices of $\chi$ and, with the
# paper's $\chi$, its two approximations.

# %%
eps = sp.symbols("epsilon", positive=True)
slopes_of_rho = sp.symbols("rho rho' rho'' rho'''")
place, place_1 = sp.symbols("x x1", real=True)


def slow(x):
    return sum(slopes_of_rho[j] * (eps * x) ** j / sp.factorial(j) for j in range(4))


def tonks(value):
    return 1 / (1 - a * value)  # change this line and see which assertions fail


choices = {
    "eq. (2)": lambda x: 1 / (1 - sp.integrate(slow(place_1), (place_1, x, x + a))),
    "midpoint (paper)": lambda x: tonks(slow(x + a / 2)),
    "mean of both": lambda x: tonks((slow(x) + slow(x + a)) / 2),
    "left rod": lambda x: tonks(slow(x)),
}


def orders(force):
    """Coefficients of eps, eps^2, eps^3 of a force at x = 0."""
    return [
        sp.factor(sp.diff(force, eps, j).subs(eps, 0) / sp.factorial(j)).subs(slopes_of_rho[0], rho)
        for j in (1, 2, 3)
    ]


expansion = {}
for name, chi in choices.items():

    def transfer(x, chi=chi):
        return chi(x) * slow(x) * slow(x + a)  # Pi over W^2

    expansion[name] = orders(transfer(-a) - transfer(0))


def paper_transfer(x):
    return choices["midpoint (paper)"](x) * slow(x) * slow(x + a)


def paper_eq17(x):
    return tonks(slow(x)) * slow(x) ** 2


for name, each in {"eq12 only": paper_transfer, "eq12 and eq17": paper_eq17}.items():
    expansion[name] = orders(-a * sp.diff(each(place), place).subs(place, 0))

tonks_pressure = rho / (1 - a * rho)
wanted = -sp.diff(tonks_pressure - rho, rho) * slopes_of_rho[1]  # the collisional part
for name, (first, second, _) in expansion.items():
    print(f"{name:16} first: {sp.simplify(first - wanted) == 0},  second: {second == 0}")

assert all(sp.simplify(each[0] - wanted) == 0 for each in expansion.values())
exact_to_second = [name for name, each in expansion.items() if each[1] == 0]
assert exact_to_second == ["eq. (2)", "midpoint (paper)", "mean of both", "eq12 and eq17"]

# %% [markdown]
# Replace the contact factor in `tonks` by another one, say `1 + a * value`, and the first assertion
# stops the notebook.
#
# **Explain.** To first order the force of the collisions is
# $-W^2\,\frac{d}{dx}\,\frac{2R\rho^2}{1-2R\rho}$ for *every* row. For a choice of $\chi$ that
# treats both rods alike the next correction is of third order, as reflection demands.
#
# `eq12` alone ("eq12 only") is wrong at second order. `eq17` then leaves out first derivatives of
# $\rho$ and $\chi$ in the flux, and with that it removes just this error. So the two
# approximations *together* are better than either of them: the paper's force is right up to terms
# of third order.
#
# With the $\rho W^2$ of the moments the pressure is
#
# $$\rho W^2 + W^2\,\frac{2R\rho^2}{1-2R\rho} = \frac{\rho W^2}{1-2R\rho},$$
#
# Tonks' exact equation of state.
#
# ## 7. The force balance: `continuity_helbing`, `modeleq`, `diff_gl`, and the position
#
# `eq17` in `eq10` gives the velocity equation `continuity_helbing` (40), which is `modeleq` (16) of
# the main text. In the steady state nothing flows, $V = 0$, and (17)
#
# $$\frac1\rho\,\frac{\partial}{\partial x}\,\frac{\rho W^2}{1-2R\rho}
# = -\frac km\,\langle\Delta x\rangle .$$

# %%
pressure = Rho * Var + (flux / rho**2 / W**2 * Rho**2 * Var).subs(chi_, 1 / (1 - a * Rho))
assert sp.simplify(pressure - Rho * Var / (1 - a * Rho)) == 0

eq40 = (
    sp.diff(Vel, t)
    + Vel * sp.diff(Vel, r)
    + sp.diff(Rho * Var / (1 - a * Rho), r) / Rho
    + (gamma * Vel + k * Pull) / m
)
collisional = pressure - Rho * Var
assert sp.simplify((eq10.subs(collisions_of_v, -sp.diff(collisional, r)) - eq40).doit()) == 0
print("eq17 in eq10 gives continuity_helbing and modeleq")

profile, heat = sp.Function("rho")(place), sp.Function("W2")(place)
at_rest = eq40.subs({Vel: 0, Pull: dx, Rho: profile, Var: heat}).doit().subs(r, place).doit()
print("derivative of (17) by the damping:", sp.diff(at_rest, gamma))
assert sp.diff(at_rest, gamma) == 0

balance = sp.diff(profile * W**2 / (1 - a * profile), place) + k / m * profile * dx
(slope,) = sp.solve(balance, sp.diff(profile, place))
print("constant W^2:  rho' =", sp.factor(slope))
diff_gl = -k / W**2 * dx * profile * (1 - a * profile) ** 2
assert sp.simplify(slope - diff_gl / m) == 0
derivative = sp.diff(profile * W**2 / (1 - a * profile), place)  # equation (18)
assert sp.simplify(derivative - W**2 * sp.diff(profile, place) / (1 - a * profile) ** 2) == 0

in_the_model = sp.simplify((k / (m * W**2)).subs(W, A / sp.sqrt(2 * m * gamma)))
print("k/(m W^2) with W of eq. free:", in_the_model)
assert in_the_model == 2 * gamma * k / A**2

balance = sp.diff(profile * heat / (1 - a * profile), place) + k / m * profile * dx
(slope_heat,) = sp.solve(balance, sp.diff(profile, place))
extra = sp.simplify(slope_heat - slope.subs(W**2, heat))
print("with W^2(x) there is in addition:", sp.factor(extra))
warmer = -sp.diff(heat, place) / heat * profile * (1 - a * profile)
assert sp.simplify(extra - warmer) == 0

# %% [markdown]
# **Explain.** The paper calls the right side of (17) the frictional and spring forces. At $V = 0$
# friction is zero: the springs alone hold the pressure. For constant $W^2$, which the paper takes
# from its simulations at $e = 1$ and which is exact there, the balance is `diff_gl` (19),
#
# $$\rho' = -\frac{k}{mW^2}\,\langle\Delta x\rangle\,\rho\,(1-2R\rho)^2 .$$
#
# The factor $1/m$ is in words below it. It is right, and needed: (23) and the friction of `modeleq`
# need it as well. With $W^2 = A^2/2m\gamma$ the mass then drops out: the density depends on
# $A^2/2\gamma k$ only. Without the factor but with this $W^2$, the springs would be four times too
# hard, as $m = 4\pi/3$ here. With a temperature that varies, rods are also driven away from where it
# is hot.
#
# **The position** (20) closes the section: $x_i = \{2i-(L+1)\}R + \langle\Delta x_i\rangle$. It is
# the average position of rod $i$. In this form it holds for $g = 0$; in general $2R$ becomes
# $2R+g$. The paper plots the mean displacement of rod $i$ against it (its figure with the arctanh)
# and puts the fitted curve into `diff_gl`. But in `diff_gl` $\langle\Delta x\rangle$ is the mean over
# the rods *found at* $x$, whichever they are. Is that the same? Both are known exactly.

# %%
for amplitude in (10, 30):
    case = chain.replace(amplitude=amplitude)
    rods_of = equilibrium(case)
    i = np.arange(1, case.size + 1)
    by_rod = (2 * i - (case.size + 1)) * case.radius + rods_of.mean_displacement.values  # (20)
    assert np.abs(by_rod - rods_of.mean_position.values).max() < 1e-9
    x, density, density_dx, _ = ordered_draws(case, n)
    by_place = np.interp(by_rod, x, density_dx / np.maximum(density, 1e-300))
    apart = np.abs(by_place - rods_of.mean_displacement.values)
    print(
        f"A = {amplitude}: mean displacements by rod and by place differ by {apart.max():.3f} R"
        f" at most, by {apart[5:-5].max():.3f} R further in than five rods"
    )
    assert 0.2 < apart.max() < 0.8
    assert apart[5:-5].max() < 0.05

truth = smooth(rods_of)
found = density > 1e-6
for name, displacement in {
    "by place": (x[found], density_dx[found] / density[found]),
    "by rod": rods_of,
    "by rod, arctanh fitted": fit_arctanh(rods_of),
}.items():
    off = deviation(smooth(force_balance(case, displacement=displacement)), truth).maximum
    print(f"    density from the displacement {name}: off by {off:.4f} of close packing")
assert 0.01 < off < 0.02

# %% [markdown]
# **Explain.** They differ at the outermost rods, by one or two per cent of the displacement there,
# and agree in the interior. In the density at $A = 30$ that makes 0.001 of close packing. The
# arctanh, which is not the law of the displacement, costs more
# ([notebook 6](06_theory_meets_particles.ipynb)).
#
# ## 8. Closure, reduced coordinate, closed form
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
in_y = sp.diff(sp.log(reduced), place).subs(sp.diff(profile, place), slope) / (1 - a * profile)
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
# ## 9. What a careful reader should question
#
# **(a) "Take $\chi$ at the local density."** For a rod at $x$ one is tempted to write
# $\chi(\rho(x))$ in front of the whole collision integral, for the contact on its right *and* for
# the one on its left. Every choice of section 6 gave the same pressure. Does this
# one? (The paper does not do this. Its $\chi$ belongs to the contact, not to the rod.)

# %%
own_place = tonks(slow(0)) * slow(0) * (slow(-a) - slow(a))
first = orders(own_place)[0]
effective_slope = sp.factor(1 - first / slopes_of_rho[1])
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
# $\rho W^2(1+2R\rho)$, the dotted line. The expansion of section 6 is one in the *shift*.
#
# **(c) "Below $e = 1$, put in the factor $(1+e)/2$."** Equation (1) has it, so one is tempted to
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
# **Explain.** The ratio is 1. The factor is not wrong in (1), but Tonks' $\chi$ must be wrong
# beside it: below $e = 1$ rods that have met leave each other slowly, stay near and meet again, so
# that pairs *about to* collide are not distributed as in equilibrium. What the factor takes away,
# the contacts give back. Without the factor, the pressure $\rho W^2/(1-2R\rho)$ is $\rho_y W^2$ in
# $y$, which agrees with the exact balance at any $e$, if $W^2$ is the variance the rods really
# have.
#
# ## 10. The places in the paper that are not as printed
#
# | equation | as printed | what is meant | shown in |
# |---|---|---|---|
# | (15), below `eq:helbing` | prefactor $\rho/\sqrt{2\pi}$ | $\rho/\sqrt{2\pi W_v^2}$, as in `eq2` | 1 |
# | `eq1` with `eq3` | $m$ in the noise, none in the acceleration | $m = 1$ throughout, or divide `eq3` by $m$ | 1 |
# | `eq4`, `eq8`, `eq11`, `eq14`, `eq15` | $\lvert v-w\rvert$ over all velocities | approaching rods only | 3 |
# | `eq16` | $v$ in two terms | $w$ | 6 |
# | `eq12`, `eq17` | two approximations, no error given | together right up to third order | 6 |
# | (17), text | frictional and spring forces | springs only, as $V = 0$ | 7 |
# | (20) with `diff_gl` | $\langle\Delta x\rangle$ of rod $i$ at its mean position | mean over the rods found at $x$ | 7 |
# | `chi`, `eq16`, `eq17`, (41) on | $x$ beside $r$ | the same coordinate | |
# | `eq:energy`, text | $e\le 0<1$ | $0\le e<1$ | |
# | the binned density, text | $\Theta(x-2R)-\Theta(x)$ | its negative, best shifted by $R$ to the middle | below |
#
# The last row concerns the box with which the paper smooths densities. The box as printed has the
# integral $-2R$, and it moves a profile by $R$. It is also used twice: once by counting the covered
# fraction of a bin, once by the running average.
#
# What the appendix has right is more: all integrals, the renamings, all signs, the factor $\chi$
# with a density that both rods share, and the pressure.

# %%
box = (sp.Heaviside(place - 2) - sp.Heaviside(place)).rewrite(sp.Piecewise)  # R = 1
area = sp.integrate(box, (place, -5, 5))
centre_of_box = sp.integrate(place * box, (place, -5, 5)) / area
print("R = 1: integral", area, "  centre", centre_of_box)
assert (area, centre_of_box) == (-2, 1)

# %% [markdown]
# ## Exercises
#
# **1.** Let the flow vary in space: the two rods of a contact have mean velocities $V(x)$ and
# $V(x+2R)$. What does the half-line integral give to first order in their difference $\delta$, and
# which term is therefore missing in a velocity equation that has only the pressure? Compare with
# the share of $V_r$ in section 6.
#
# <details><summary>Solution</summary>
#
# ```python
# delta = sp.symbols("delta")  # the mean of v - w
# difference = sp.exp(-((u - delta) ** 2) / (4 * W**2)) / sp.sqrt(4 * sp.pi * W**2)
# shifted = sp.integrate(u**2 * sp.diff(difference, delta).subs(delta, 0), (u, 0, sp.oo))
# sp.simplify(shifted)  # 2 W/sqrt(pi)
# ```
#
# With $\delta = -2R\,V_x$ the transfer is $\rho^2\chi\,(W^2 - \frac{2W}{\sqrt\pi}\,2R\,V_x)$, as
# `share["V_r, with w"]` says. It is a
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
# **3.** By how much do "midpoint (paper)" and "eq. (2)" differ at third order, for the term with
# $\rho'''$?
#
# <details><summary>Solution</summary>
#
# ```python
# difference = expansion["midpoint (paper)"][2] - expansion["eq. (2)"][2]
# sp.factor(sp.diff(difference, slopes_of_rho[3]))
# ```
#
# $W^2\,(2R)^4\rho^2\chi^2\rho'''/24$ in the force. The integral contains the mean of $\rho$ over a
# rod length, which exceeds the value in the middle by $(2R)^2\rho''/24$.
# </details>
#
# **4.** The paper stops at $\psi = v$. At $e = 1$ energy is conserved too: section 4 found
# $\mathcal I_s(v^2) = 0$. Take $\psi = v^2$ and keep, as `eq17` does, the lowest order of
# $\mathcal I_f(v^2)$. Which equation does $W^2$ obey?
#
# <details><summary>Solution</summary>
#
# ```python
# flux_2 = -a * chi_ * rho**2 * pairs((v - w) * (w**2 - v**2))  # 2 V times I_f(v)
# flux_2 = flux_2.subs(fields).subs(chi_, 1 / (1 - a * Rho))
# energy = moment_equation(v**2) + sp.diff(flux_2, r)
# found = {
#     sp.diff(Rho, t): -sp.diff(Rho * Vel, r),
#     sp.diff(Vel, t): sp.diff(Vel, t) - eq40,
# }
# rate = sp.solve(sp.expand(energy.doit()).subs(found).doit(), sp.diff(Var, t))[0]
# expected = (
#     -Vel * sp.diff(Var, r)
#     - 2 * Var * sp.diff(Vel, r) / (1 - a * Rho)
#     - 2 * gamma / m * (Var - A**2 / (2 * m * gamma))
# )
# sp.simplify(rate - expected.doit())  # 0
# ```
#
# $W^2_t + V W^2_r = -\frac{2W^2V_r}{1-2R\rho} - \frac{2\gamma}{m}\big(W^2-\frac{A^2}{2m\gamma}\big)$:
# the temperature equation of `hydrodynamics`, which
# [notebook 7](07_the_fluid_in_time.ipynb) solves. In the steady state $V = 0$ it gives the free width
# of eq. `free`, the same for all rods.
# </details>
