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
# The rods of our chain are no points. The force balance of
# [Mani, Böttcher, Herrmann and Helbing](https://arxiv.org/abs/1404.7460) says
#
# $$\text{pressure} = \frac{\rho W^2}{1-2R\rho}.$$
#
# Where does the denominator come from, and how good is each step on the way to it?
#
# This lesson takes the shortest way to the answer and tests each step against the exact solution.
# The paper derives the same result in its appendix.
# [*The appendix, equation by equation*](paper_the_appendix_equation_by_equation.ipynb) follows that appendix from its first to its
# last equation.
#
# Lengths are in rod radii $R$, masses in $M$ (a rod has $m = \frac{4\pi}{3}M$), times in
# $\sqrt{M/k}$. The restitution is 1 until section 6.
#
# *Level: fourth year. You need: lessons 1, 2 and 4, the pressure of a gas as a flux of momentum.
# Time: 120 minutes. To predict before you see the results, type `make lessons` in the folder of the
# project, and open the copy of this lesson without outputs in `build/lessons/`.*

# %% tags=["hide-input"]
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_bvp
from scipy.interpolate import CubicSpline
from scipy.special import gammaln, log_ndtr
from scipy.stats import norm
from teaching import BLUE, GREEN, ORANGE, PINK, check, mean_and_error, panels, right

# %%
import crazybilliards as cb

chain = cb.Chain(size=100, amplitude=30)
W, s, d = chain.free_velocity_width, chain.thermal_length, 2 * chain.radius  # d: length of a rod
print(f"free velocity width W = {W:.2f} R/T, thermal length s = {s:.1f} R")

# %% [markdown]
# ## 1. What pushes the chain apart?
#
# Collisions could widen the chain because they are many, or because they act *a rod length apart*:
# the centres of two rods in contact are $2R$ apart.
#
# **Predict.** Make the rods ten times shorter, and put the anchors closer together so that rods at
# rest still touch. Do the rods collide more often, less often, or equally often? And how much
# shorter does the chain become?
#
# **Run.** Both simulations use the same random numbers.

# %%
lengths = {}
for radius in (1, 0.1):
    one = cb.Chain(size=20, amplitude=30, radius=radius)
    run = cb.simulate(one, duration=2000, observe=["widths", "collisions"], seed=1, progress=False)
    lengths[radius] = run.mean_position.values[-1] - run.mean_position.values[0]
    print(f"radius {radius}: {run.collision_rate.sum().item():.3f} collisions per time,", end=" ")
    print(f"length {lengths[radius]:.2f} R, of which rods {19 * 2 * radius:.2f} R")

# %% tags=["remove-cell"]
assert np.isclose(lengths[1] - lengths[0.1], 19 * 1.8)

# %% [markdown]
# <details><summary>Explain</summary>
#
# They collide equally often, and the chain becomes shorter by exactly what the rods lost,
# $38.0 - 3.8 = 34.2$ R. Points that collide elastically swap their velocities, and in a gas of equal
# points this changes nothing. Collisions *at a point* therefore make no pressure. A rod, however,
# hands its momentum at once to a place that is $2R$ further on. This transport is what the pressure
# $\rho W^2$ lacks.
#
# </details>
#
# The pressure decides how the chain arranges itself, because its gradient holds the springs. For any
# pressure $W^2q(\rho)$ the balance on the right half of the chain is
#
# $$q'(\rho)\,\rho' = -\frac{k}{mW^2}\,\rho\,\langle\Delta x\rangle,\qquad N' = \rho,\qquad
# \langle\Delta x\rangle = x - 2R\,(N - L/2).$$
#
# The label $N$ counts the rods to the left of $x$, so the middle of rod $i$ has $N = i - \frac12$.
# The last equation measures the displacement of this rod from its own anchor,
# $2R(i-\frac{L+1}2) = 2R(N-\frac L2)$. The hidden function `density_of_pressure(chain, slope)` solves
# this for a given slope $q'$, which is a function of the packing $2R\rho$.


# %% tags=["hide-input"]
def density_of_pressure(chain, slope):
    """Density rho(x), x >= 0, of a chain without gap whose pressure is W^2 q, slope = dq/drho."""
    guess = cb.force_balance(chain).sel(x=slice(0, None))
    guess = guess.sel(x=guess.density > 1e-8)

    def equations(x, state):
        log_density, label = state
        packing = np.minimum(d * np.exp(log_density), 0.999)
        pull = (x - d * (label - chain.size / 2)) / chain.thermal_length**2
        return np.array([-pull / slope(packing), np.exp(log_density)])

    def ends(left, right):
        return np.array([left[1] - chain.size / 2, right[1] - chain.size])

    start = np.array([np.log(guess.density.values), guess.label.values])
    solution = solve_bvp(equations, ends, guess.x.values[::5], start[:, ::5], tol=1e-6)
    assert solution.status == 0
    return guess.x.values, np.exp(solution.sol(guess.x.values)[0])


# %%
exact = cb.equilibrium(chain)
x_points, points = density_of_pressure(chain, lambda packing: 1.0 + 0 * packing)
x_rods, rods = density_of_pressure(chain, lambda packing: 1 / (1 - packing) ** 2)

# %% tags=["hide-input"]
ax = panels(width=7, height=3.4)
ax.plot(exact.x, exact.density, color=ORANGE, linewidth=3, label="exact")
ax.plot(x_rods, rods, "--", color=BLUE, label=r"pressure $\rho W^2/(1-2R\rho)$")
ax.plot(x_points, points, "-.", color=GREEN, label=r"pressure $\rho W^2$ (points)")
ax.axhline(chain.close_packed_density, color="0.6", linewidth=1)
ax.text(2, chain.close_packed_density + 0.005, "close packing", color="0.4")
ax.set(xlim=(0, 190), ylim=(0, 0.56), xlabel="position x [R]", ylabel=r"density $\rho$ [1/R]")
ax.legend(loc="lower left")
plt.show()
centre = exact.density.sel(x=0, method="nearest").item()
print(f"density in the centre: exact {centre:.4f}, rods {rods[0]:.4f}, points {points[0]:.4f}")
assert abs(rods[0] - centre) < 2e-3
assert points[0] - centre > 0.05

# %% [markdown]
# With the pressure of points the chain would be shorter and denser than it is.
#
# ## 2. The momentum that collisions transport
#
# **Your turn.** The left rod has the velocity $v$, the right rod $w<v$. How much momentum, divided by
# $m$, does the left rod hand over at the restitution $e$? ([Lesson
# 3](03_collisions_and_restitution.ipynb), section 1, has the velocities after the collision.)


# %% tags=["remove-cell"]
def handed_over(v, w, e):
    return (1 + e) / 2 * (v - w)


pairs = [(1.0, 0.0, 1.0), (2.0, -1.0, 0.0), (1.0, 0.5, 0.5)]
assert right(handed_over, lambda v, w, e: v - ((v + w) / 2 - e / 2 * (v - w)), at=pairs)


# %%
def my_momentum(v, w, e):
    return ...  # your code here


check(
    my_momentum, handed_over, at=pairs, hint="At e = 1 the rods swap: v - w. At e = 0 half of it."
)

# %% [markdown]
# <details><summary>Solution</summary>
#
# The velocity $v$ changes to $\frac{v+w}2-\frac e2(v-w)$, so the rod hands over
# $\frac{1+e}2(v-w)$.
#
# </details>
#
# Let $\tilde\rho_2(r, v;\,r+2R, w)$ be the density of pairs in contact. Pairs with the velocities $v$
# and $w$ collide at the rate $(v-w)\,\tilde\rho_2$ if $v>w$, and not at all otherwise. The momentum
# (over $m$) that rods at $r$ hand to their right neighbours per time and length is therefore
#
# $$\Pi(r) = \frac{1+e}{2}\iint_{v>w} (v-w)^2\,\tilde\rho_2(r, v;\,r+2R, w)\;dv\,dw . \tag{1}$$
#
# Rods at $r$ gain $\Pi(r-2R)$ from their left neighbours and lose $\Pi(r)$ to their right ones. At
# rest this difference and the pressure of points hold the springs:
#
# $$(\rho W^2)' = \Pi(r-2R) - \Pi(r) - \frac km\,\rho\,\langle\Delta x\rangle .$$
#
# This balance is the first moment of the kinetic equation, which *The appendix, equation by equation*, section 1, writes down.
# Up to here nothing is approximated. Now let the velocities of a pair be independent and Gaussian.
# Then $v-w$ has the variance $2W^2$, and half of all pairs approach, so the integral is $W^2$ times
# the contact density $\rho_2(r, r+2R)$. At $e=1$, $\Pi = W^2\rho_2$. In equilibrium this is exact,
# because velocities do not depend on positions.
#
# The exact contacts of a chain without a gap are known: the rods are ordered draws ([lesson
# 4](04_the_elastic_chain_is_exactly_solvable.ipynb)), and rod $i$ touches rod $i+1$ where two
# successive draws coincide. The hidden function `ordered_draws` computes $\rho$,
# $\rho\langle\Delta x\rangle$ and $\rho_2$ from this.


# %% tags=["hide-input"]
def ordered_draws(chain, nodes_per_rod):
    """Exact rho, rho <dx> and contact density rho_2(x, x + 2R) of a chain without gap."""
    L, s = chain.size, chain.thermal_length
    half = int((L + 7 * s) * nodes_per_rod / d)
    x = d / nodes_per_rod * np.arange(-half, half + 1)
    i = np.arange(1, L + 1)[:, np.newaxis]
    y = x - d * chain.rank[:, np.newaxis]
    z = y / s
    below, above, gauss = log_ndtr(z), log_ndtr(-z), norm.logpdf(z) - np.log(s)
    ways = gammaln(L + 1) - gammaln(i) - gammaln(L - i + 1)
    rod = np.exp(ways + (i - 1) * below + (L - i) * above + gauss)
    ways = ways[:-1] + np.log(L - i[:-1])
    contact = np.exp(
        ways + ((i - 1) * below)[:-1] + ((L - i - 1) * above)[:-1] + 2 * gauss[:-1]
    )  # rod i at y and rod i + 1 at y as well
    return x, rod.sum(0), (rod * y).sum(0), contact.sum(0)


# %% [markdown]
# **Predict.** With the exact contacts, by how much is the balance violated?
#
# **Run.**

# %%
n = 40  # nodes per rod length
x, density, density_dx, contact = ordered_draws(chain, n)
points_push = W**2 * CubicSpline(x, density)(x, 1)
collisions_push = W**2 * (contact - np.roll(contact, n))
springs = -chain.stiffness / chain.mass * density_dx
residual = abs(points_push + collisions_push - springs)[n:-n].max() / abs(springs).max()
print(f"{density.sum() * d / n:.8f} rods; largest residual {residual:.0e} of the largest force")

# %% tags=["remove-cell"]
assert residual < 1e-6

# %% [markdown]
# <details><summary>Explain</summary>
#
# By nothing: the balance holds to numerical accuracy at every place. Three approximations follow:
# a formula for the contact density (section 3), a derivative in place of the difference of $\Pi$
# (section 4), and one label for all rods that are found at a place (section 5).
#
# </details>
#
# ## 3. How often are rods in contact?
#
# Rods in contact are more frequent than independent points would be, by a factor $\chi$:
#
# $$\rho_2(x, x+2R) = \chi\,\rho(x)\,\rho(x+2R) .$$
#
# **In a uniform gas** $\chi$ is known. $N$ rods in a box of length $\ell$ have the partition function
# $Z\propto(\ell-2RN)^N/N!$, because each rod takes its own length away from the room of the others.
# The pressure (over $mW^2$) is $\partial_\ell\ln Z = \rho/(1-2R\rho)$, found by Tonks in 1936. The
# pressure is also $\rho$, carried by the rods, plus $2R\chi\rho^2$, handed over a rod length further.
# Therefore
#
# $$\chi = \frac{1}{1-2R\rho} .$$
#
# **Where the density varies** and all rods feel the same potential $U(x)$ there is an exact answer
# too (Percus, 1976). Let the chain exchange rods with a reservoir. A rod at $x$ then has the fugacity
# $z(x)\propto e^{-U(x)/T}$. Let $\Xi$ be the partition function of all rods, $\Xi_-(x)$ that of the
# rods that fit to the left of a rod at $x$, and $\Xi_+(x)$ that to the right. Then
#
# $$\rho(x) = \frac{z(x)\,\Xi_-(x)\,\Xi_+(x)}{\Xi},\qquad
# \rho_2(x, x+2R) = \frac{z(x)\,z(x+2R)\,\Xi_-(x)\,\Xi_+(x+2R)}{\Xi},$$
#
# $$\frac{\rho(x)\,\rho(x+2R)}{\rho_2(x, x+2R)} = \frac{\Xi_+(x)\,\Xi_-(x+2R)}{\Xi}
# = \text{probability of no centre between } x \text{ and } x+2R
# = 1 - \int_x^{x+2R}\!\rho .$$
#
# $\Xi_+(x)$ has no centre to the left of $x+2R$, and $\Xi_-(x+2R)$ none to the right of $x$. Their
# product is therefore the weight of all states without a centre in between. The last step holds
# because at most one centre fits there. So
#
# $$\chi = \frac{1}{1 - \int_x^{x+2R}\rho\,dx'} . \tag{2}$$
#
# The paper takes $\chi = 1/(1-2R\rho)$ with the density half-way between the two rods. This is (2)
# with the integral replaced by $2R$ times its integrand in the middle. Our rods have anchors *of
# their own*, so neither of the two is exact for them.
#
# **Predict.** At $A=30$ the position of a central rod, which is 2 R long, has the standard deviation
# 2.7 R, and that of an end rod 9.1 R. At $A=8$ the two are 0.7 R and 2.4 R, and the density in the
# centre is a row of hills. What happens to the two closures there?
#
# **Run.**

# %%
closures = {}
for amplitude in (30, 8):
    x_c, rho, _, rho_2 = ordered_draws(chain.replace(amplitude=amplitude), n)
    label = CubicSpline(x_c, rho).antiderivative()(x_c)
    between = np.roll(label, -n) - label  # the integral of rho from x to x + 2R
    middle = np.roll(rho, -n // 2)
    pair = rho * np.roll(rho, -n)
    closures[amplitude] = x_c, rho_2, pair / (1 - between), pair / (1 - d * middle)
    off = [abs(each - rho_2).max() / rho_2.max() for each in closures[amplitude][2:]]
    print(f"A = {amplitude}: error by the integral {off[0]:.3f}, by the midpoint {off[1]:.3f}")
    print(f"    highest packing 2R rho {d * rho.max():.2f}, most rods in 2R {between.max():.3f}")

# %% tags=["hide-input"]
axes = panels(2, height=3.4)
for ax, (amplitude, each), shown in zip(axes, closures.items(), ((0, 150), (-7, 7)), strict=True):
    x_c, rho_2, by_integral, by_midpoint = each
    part = (x_c > shown[0]) & (x_c < shown[1])
    ax.plot(x_c[part], rho_2[part], color=ORANGE, linewidth=3, label="exact contacts")
    ax.plot(x_c[part], by_integral[part], "--", color=BLUE, label=r"$\chi$ by the integral")
    ax.plot(x_c[part], by_midpoint[part], ":", color=GREEN, label=r"$\chi$ by the midpoint")
    ax.set(title=f"A = {amplitude}", xlabel="position x of the left rod [R]", xlim=shown)
    ax.set_ylim(0, 1.6 * rho_2.max())
axes[0].set_ylabel(r"contact density $\rho_2(x, x+2R)$ [1/R$^2$]")
axes[0].legend()
plt.show()

# %% tags=["remove-cell"]
worst = {
    amplitude: [abs(each - exact_one).max() / exact_one.max() for each in both]
    for amplitude, (_, exact_one, *both) in closures.items()
}
assert all(abs(value - 1 / chain.size) < 1e-3 for value in worst[30])
assert worst[8][0] < 0.02
assert worst[8][1] > 1
assert rho.max() > chain.close_packed_density
assert between.max() < 1
spread = exact.displacement_width.values[[chain.size // 2, -1]]  # proportional to A
assert np.allclose(spread, [2.65, 9.11], atol=0.01)

# %% [markdown]
# <details><summary>Explain</summary>
#
# At $A = 30$ both closures are right to 1 %, which is $1/L$: a chain of fixed size has $L(L-1)$ pairs
# and not $L^2$. At $A = 8$ the *local* density on top of a hill exceeds close packing, so $1-2R\rho$
# is negative, and the midpoint makes no sense. The integral over a rod length cannot exceed 1.
# Closure (2) is still right to 1.4 %, although the rods have anchors of their own. The density of a
# fluid is therefore a density *averaged over some rods*.
#
# </details>
#
# ## 4. From the difference to a derivative
#
# In a dense chain $2R\rho$ is close to 1, so it is no small number. But the *change* of $\rho$ over a
# rod length is small. So the shift by $2R$ is expanded, and $\chi$ is kept as it is:
#
# $$\Pi(r-2R) - \Pi(r) \approx -\frac{d}{dr}\big(2R\,\Pi\big),\qquad
# 2R\,\Pi = W^2\,\frac{2R\rho^2}{1-2R\rho} .$$
#
# Together with the pressure of points this gives
#
# $$\rho W^2 + W^2\,\frac{2R\rho^2}{1-2R\rho} = \frac{\rho W^2}{1-2R\rho}.$$
#
# Two things have been neglected: the second derivative of $\Pi$, and the derivatives in $\Pi$ itself,
# where $\rho(r)\,\rho(r+2R)$ was replaced by $\rho^2$. *The appendix, equation by equation*, section 6, expands both. They
# cancel at second order, because each pair is symmetric about its contact, and the two contacts of a
# rod are symmetric about the rod. The force is therefore right up to terms of third order in the
# gradient.
#
# ## 5. The force balance, and its solution
#
# At rest the balance is, for a constant $W^2$ (the paper's `diff_gl`, with the factor $1/m$),
#
# $$\rho' = -\frac{k}{mW^2}\,\langle\Delta x\rangle\,\rho\,(1-2R\rho)^2 .$$
#
# Now take the rods' length out: $y = x - 2R(N-L/2)$, so $dy/dx = 1-2R\rho$, and the density in $y$ is
# $\rho_y = \rho/(1-2R\rho)$. Differentiate: $d\rho_y/dx = \rho'/(1-2R\rho)^2$. The factor
# $(1-2R\rho)^2$ disappears, and with one more $1-2R\rho$ from $dy/dx$
#
# $$\frac{d\ln\rho_y}{dy} = -\frac{k}{mW^2}\,\langle\Delta x\rangle .$$
#
# In $y$ the rods are an ideal gas in the potential of the springs. Assume that all rods found at $x$
# have the mean label $N(x)$. Without a gap $\langle\Delta x\rangle$ is then $y$, so the solution is a
# Gaussian, $\rho_y = L\,\mathcal N(y;0,s^2)$ with $s^2 = mW^2/k$.
#
# **Your turn.** Write this solution in the positions of rods. From $y$ compute $x$ and $\rho(x)$. Use
# `norm.pdf(y, scale=s)` for $\mathcal N$, and $N = L\,\Phi(y/s)$ with `norm.cdf(y / s)`.


# %% tags=["remove-cell"]
def closed_form(y):
    rho_y = chain.size * norm.pdf(y, scale=s)
    return y + d * (chain.size * norm.cdf(y / s) - chain.size / 2), rho_y / (1 + d * rho_y)


some = np.array([-20.0, 0.0, 10.0])
assert right(closed_form(some)[0][1], 0.0, tolerance=1.0)
packing = d * closed_form(some)[1]
assert right(packing / d / (1 - packing), chain.size * norm.pdf(some, scale=s))


# %%
def my_density(y):
    return ...  # your code here: x, rho


check(
    my_density, closed_form, at=[(some,)], hint="x = y + 2R (N - L/2), rho = rho_y / (1 + 2R rho_y)"
)

# %% [markdown]
# <details><summary>Solution</summary>
#
# ```python
# def my_density(y):
#     rho_y = chain.size * norm.pdf(y, scale=s)
#     x = y + d * (chain.size * norm.cdf(y / s) - chain.size / 2)
#     return x, rho_y / (1 + d * rho_y)
# ```
#
# </details>
#
# **Predict.** The solver of the package does not know this formula. Does it find the same density?
# And how far is this density from the exact one at small and large driving amplitudes? Both are
# smoothed as in the paper.
#
# **Run.**

# %%
theory = cb.force_balance(chain).sel(x=slice(-300, 300))
closed = CubicSpline(*closed_form(np.linspace(-7, 7, 20_001) * s))
print(f"package and formula differ by {abs(theory.density - closed(theory.x)).max().item():.0e} /R")
errors = {}
for amplitude in (1, 3, 10, 30):
    case = chain.replace(amplitude=amplitude)
    fluid, truth = cb.force_balance(case), cb.smooth(cb.equilibrium(case)).density
    errors[amplitude] = d * abs(cb.smooth(fluid).density - truth)
    print(f"A = {amplitude:2}: error {errors[amplitude].max().item():.4f} of close packing")

# %%
mean_label = CubicSpline(x, density).antiderivative()(x)
by_labels = density * (x - d * (mean_label - chain.size / 2))  # rho <dx> of the assumption
wrong = abs(by_labels - density_dx).max() / abs(density_dx).max()
print(f"A = 30: the labels alone make an error of {wrong:.4f} of the largest force")

# %% tags=["hide-input"]
ax = panels(width=7, height=3.2)
for (amplitude, off), colour in zip(errors.items(), (GREEN, PINK, BLUE, ORANGE), strict=True):
    ax.plot(off.x - chain.anchors[-1], off, color=colour, label=f"A = {amplitude}")
ax.set(xlim=(-60, 60), xlabel="position x, from the last anchor [R]")
ax.set_ylabel(r"|difference| $\times 2R$")
ax.legend()
plt.show()

# %% tags=["remove-cell"]
assert abs(theory.density - closed(theory.x)).max() < 1e-6
assert abs(np.interp(x_rods, theory.x, theory.density) - rods).max() < 1e-4
assert errors[1].max() > 0.1
assert errors[30].max() < 0.01
by_rod = cb.smooth(cb.rod_by_rod(fluid)).density
assert d * abs(by_rod - truth).max() < 1e-5
assert wrong < 0.006

# %% [markdown]
# <details><summary>Explain</summary>
#
# The package finds the closed form. At $A = 30$ the fluid is right to better than 1 %, and the labels
# alone make an error of 0.5 % of the largest force. At $A = 1$ the fluid is wrong by 14 %. But for
# the points the force balance is exact: $\rho_y$ is the Gaussian of lesson 4. The three
# approximations together are therefore one step, from points to rods by $\rho = \rho_y/(1+2R\rho_y)$.
# [Lesson 5](05_from_the_kinetic_equation_to_the_force_balance.ipynb), section 5, does this step rod by rod instead, and then
# nothing is left of the error.
#
# </details>
#
# ## 6. What a careful reader should question
#
# **(a) "Take $\chi$ at the rod."** For a rod at $x$ one is tempted to write $\chi(\rho(x))$ in front
# of the whole collision integral, for the contact on its right *and* for the one on its left. The
# paper does not do this: its $\chi$ belongs to the contact, not to the rod. With $\chi$ at the rod
# the force of the collisions would be $W^2\chi\rho\,[\rho(x-2R)-\rho(x+2R)] \approx
# -W^2\chi\rho\;4R\rho'$, and the slope of the pressure
#
# $$q' = 1 + \frac{4R\rho}{1-2R\rho} = \frac{1+2R\rho}{1-2R\rho}\qquad\text{instead of}\qquad
# \frac{1}{(1-2R\rho)^2} .$$
#
# **(b) "Expand in $2R$."** Strictly to first order in $2R$ the pressure would be $\rho
# W^2(1+2R\rho)$.
#
# **Predict.** Which of the two mistakes matters more in a dense chain ($A=10$)?
#
# **Run.**

# %%
dense = chain.replace(amplitude=10)
slopes = {
    "Tonks": lambda packing: 1 / (1 - packing) ** 2,
    "chi at the rod": lambda packing: (1 + packing) / (1 - packing),
    "first order in 2R rho": lambda packing: 1 + 2 * packing,
}
profiles = {name: density_of_pressure(dense, slope) for name, slope in slopes.items()}
true_centre = cb.smooth(cb.equilibrium(dense)).density.sel(x=0, method="nearest").item()
print(f"density in the centre, exact: {true_centre:.4f} /R")
for name, (_, rho) in profiles.items():
    print(f"    {name}: {rho[0]:.4f} /R")

# %% tags=["hide-input"]
packing = np.linspace(1e-3, 0.99, 400)
left, right_panel = panels(2, height=3.4)
truth = cb.smooth(cb.equilibrium(dense))
right_panel.plot(truth.x, truth.density, color=ORANGE, linewidth=3, label="exact")
pressures = (1 / (1 - packing), -1 - 2 * np.log1p(-packing) / packing, 1 + packing)
for (name, (x_here, rho)), values, colour, style in zip(
    profiles.items(), pressures, (BLUE, PINK, GREEN), ("-", "--", ":"), strict=True
):
    left.plot(packing, values, style, color=colour, label=name)
    right_panel.plot(x_here, rho, style, color=colour, label=name)
left.set(xlabel=r"packing $2R\rho$", ylabel=r"pressure / $\rho W^2$", ylim=(0, 12))
left.legend()
right_panel.set(xlim=(0, 130), xlabel="position x [R]", ylim=(0, 0.55))
right_panel.set_ylabel(r"density $\rho$ [1/R]")
right_panel.legend(loc="lower left")
plt.show()
assert abs(profiles["Tonks"][1][0] - true_centre) < 2e-3
assert profiles["chi at the rod"][1][0] - true_centre > 0.01

# %% [markdown]
# <details><summary>Explain</summary>
#
# Both chains are too dense, and (b) is the larger mistake. In (a) the two rods of one contact use two
# different $\chi$, so one gives what the other does not receive: momentum is not conserved. The
# error is of *first* order in the gradient. The pressure (its formula is $-\rho -
# \frac1R\ln(1-2R\rho)$) rises towards close packing like a logarithm instead of $1/(1-2R\rho)$. The
# argument of $\chi$ need not be exact, but both rods must use the same one. In (b) the pressure does
# not diverge at close packing at all. The expansion of section 4 is one in the *shift*, not in
# $2R\rho$.
#
# </details>
#
# **(c) "For $e < 1$, put in the factor $(1+e)/2$."** Equation (1) has this factor, so one is tempted
# to multiply the collisional part of the pressure by $\alpha = (1+e)/2$ and to keep Tonks' $\chi$. In
# the reduced coordinate this pressure is $W^2\rho_y\,(1+2R\rho_y\alpha)/(1+2R\rho_y)$. In a dense
# chain it is $\alpha$ times $W^2\rho_y$.
#
# But in $y$ rods collide *at a point*, and momentum is conserved there for every $e$. The collisions
# therefore drop out of the momentum balance in $y$: $\frac{d}{dy}(\rho_y\langle v^2\rangle) =
# -\frac{k}{m}\,y\,\rho_y$ without a gap. Multiply by $y$ and integrate. The result is the virial
# theorem, exact at any restitution:
#
# $$k\sum_i\langle y_i^2\rangle = m\sum_i\langle v_i^2\rangle .$$
#
# **Predict.** Is the ratio of the two sides at $e = 0.5$ equal to 1, or close to $\alpha = 0.75$?
#
# **Run.**

# %%
cold = cb.Chain(size=30, restitution=0.5)
ratios, with_factor = [], []
for seed in range(8):
    run = cb.simulate(cold, duration=600, seed=seed, observe=("widths",), progress=False)
    y2 = (run.displacement_width**2 + run.mean_displacement**2).values
    v2 = (run.velocity_width**2).values
    ratios.append(cold.stiffness * y2.sum() / (cold.mass * v2.sum()))
    crowd = d * np.gradient(cold.rank, run.mean_displacement.values)  # 2R rho_y
    with_factor.append((v2 * (1 + 0.75 * crowd) / (1 + crowd)).sum() / v2.sum())
ratio, error = mean_and_error(ratios)
print(f"measured ratio {ratio:.4f} ± {error:.4f}; with the factor {np.mean(with_factor):.3f}")
print(f"estimated error of the width from the time step: {run.attrs['time_step_error']:.4f}")

# %% tags=["remove-cell"]
step_error = run.attrs["time_step_error"]
assert abs(ratio - 1) < 5 * error + 2 * step_error  # W^2: twice the error of W
assert ratio - np.mean(with_factor) > 0.1

# %% [markdown]
# <details><summary>Explain</summary>
#
# The ratio is 1. The factor is right in (1), so Tonks' $\chi$, or the independence of the two
# velocities, must be wrong. Both are. For $e < 1$ rods that have met separate slowly, stay near each
# other, and meet again. Pairs that are *about to* collide therefore have smaller relative velocities
# than independent ones (*Neighbours remember*, section 3). There are also more contacts, which compensate both
# the smaller velocities and the factor. Without the factor the pressure $\rho W^2/(1-2R\rho)$ is
# $\rho_y W^2$ in $y$. This agrees with the exact balance at any $e$, if $W^2$ is the variance that
# the rods really have.
#
# </details>
#
# ## Exercises
#
# **1.** Let the flow vary in space: the two rods of a contact have mean velocities $V(x)$ and
# $V(x+2R)$. What does the integral (1) give to first order in their difference, and which term is
# therefore missing in a velocity equation that has only the pressure?
#
# <details><summary>Solution</summary>
#
# Let $u=v-w$ have the mean $\delta = -2R\,V_x$ and the variance $2W^2$. To first order in $\delta$
# the half-line integral of $u^2$ is $W^2 + \frac{2W}{\sqrt\pi}\,\delta$. The transfer is
# $\rho^2\chi\,(W^2 - \frac{2W}{\sqrt\pi}\,2R\,V_x)$. The second term is a viscous pressure $-\zeta
# V_x$ with $\zeta = \frac{2}{\sqrt\pi}\,W(2R)^2\rho^2\chi$ (per mass), if the velocities of a pair
# are independent. At rest it is zero, so the force balance does not contain it.
#
# </details>
#
# **2.** Show for any spring potential $U$ that without a gap $\rho_y\propto e^{-U(y)/T}$, and check
# `force_balance` for `spring="quadratic"` in the centre.
#
# <details><summary>Solution</summary>
#
# $d\ln\rho_y/dy = -F(y)/T$ with $F = dU/dy$. For $U = k|y|^3/3$ the integral of $e^{-U/T}$ is
# $2\,\Gamma(4/3)\,(3T/k)^{1/3}$, so $\rho_y(0) = L/\big(2\,\Gamma(4/3)\,(3T/k)^{1/3}\big)$.
#
# ```python
# from math import gamma
# soft = cb.Chain(size=100, amplitude=30, spring="quadratic")
# top = soft.size / (2 * gamma(4 / 3) * (3 * soft.temperature / soft.stiffness) ** (1 / 3))
# top / (1 + d * top), cb.force_balance(soft).density.max().item()
# ```
#
# Both are 0.4551.
#
# </details>
