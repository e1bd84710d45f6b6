"""The paper's analytics section in plain numpy, scipy and py-pde; only the simulation is ours."""

import matplotlib.pyplot as plt
import numpy as np
import pde
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, curve_fit
from scipy.stats import norm

import crazybilliards as cb

# The simulation: e = 1, A = 10, gamma = k = 1, 100 rods.
chain = cb.Chain(size=100, amplitude=10)
L, R, k, m, gamma = chain.size, chain.radius, chain.stiffness, chain.mass, chain.damping
W2 = chain.free_velocity_width**2  # W_v^2 = A^2/(2 m gamma), exact at e = 1
run = cb.simulate(chain, duration=2e4, every=10, replicas=2, observe="snapshots", progress=False)
positions = run.position.values.reshape(-1, L)  # a row for each moment

# The density: the fraction of a bin that rods cover, averaged over 2R. Both are rectangles.
h = 2 * R / 21
edges = h * np.arange(-1500.5, 1501)
x, box = (edges[1:] + edges[:-1]) / 2, np.full(21, 1 / 21)


def smooth(density):
    return np.convolve(np.convolve(density, box, "same"), box, "same")


simulated = smooth(np.histogram(positions, edges)[0] / (len(positions) * h))

# The mean displacement, and its fit B arctanh(C x), which ends at 1/C beyond all rods.
anchors = R * (2 * np.arange(1, L + 1) - (L + 1))
mean = positions.mean(axis=0)
most = 1 / abs(mean).max()
start, bounds = (10, 0.9 * most), ([0, 0], [100, most])
(B, C), _ = curve_fit(
    lambda x, B, C: B * np.arctanh(C * x), mean, mean - anchors, start, bounds=bounds
)

# The force balance (19), from the middle to the right. Its unknown is ln of rods per free length.
half = x[(x >= 0) & (x < 1 / C)]


def slope(x, log_free):
    return -k / (m * W2) * B * np.arctanh(C * x) / (1 + 2 * R * np.exp(log_free))


def integrate(middle):
    free = np.exp(solve_ivp(slope, (0, half[-1]), [middle], t_eval=half, rtol=1e-8).y[0])
    return free / (1 + 2 * R * free)


middle = brentq(lambda middle: 2 * np.trapezoid(integrate(middle), half) - L, -5, 10)
balance = np.interp(abs(x), half, integrate(middle), right=0)
apart = 2 * R * abs(simulated - smooth(balance))
print(f"at most {apart.max():.3f} of close packing apart, at |x| = {abs(x[apart.argmax()]):.0f} R")

# Continuity and velocity equation in time, and the labels N, for a warmer chain that is squeezed.
warm = chain.replace(amplitude=30)
s = warm.thermal_length
equations = {
    "rho": "-d_dx(rho * V)",
    "V": "-V * d_dx(V) - W2 / rho * d_dx(rho / (1 - 2 * R * rho))"
    "- k / m * (x - 2 * R * (N - L / 2)) - gamma / m * V + 4 * d2_dx2(V)",  # a small viscosity
    "N": "-V * d_dx(N)",
}
known = {"W2": warm.free_velocity_width**2, "R": R, "L": L, "k": k, "m": m, "gamma": gamma}
grid = pde.CartesianGrid([[-L * R - 5 * s, L * R + 5 * s]], 400)
X, y = grid.axes_coords[0], np.linspace(-30 * s, 30 * s, 100_001)
y = np.interp(X, y + 2 * R * L * (norm.cdf(y, scale=0.6 * s) - 0.5), y)
free, N = L * norm.pdf(y, scale=0.6 * s), L * norm.cdf(y, scale=0.6 * s)
fields = {"rho": free / (1 + 2 * R * free), "V": 0 * X, "N": N}
fields = [pde.ScalarField(grid, fields[name], label=name) for name in equations]
fluid, storage = pde.PDE(equations, consts=known, bc={"curvature": 0}), pde.MemoryStorage()
how = {"dt": 0.02, "solver": "runge-kutta", "backend": "numpy"}
fluid.solve(pde.FieldCollection(fields), t_range=12, tracker=storage.tracker(0.4), **how)

plt.plot(x, simulated, label="simulation, A = 10")
plt.plot(x, smooth(balance), "--", label="force balance, A = 10")
for moment in (0, 5, 15):
    plt.plot(X, storage.data[moment][0], label=f"fluid, A = 30, t = {0.4 * moment:.0f} $t_0$")
plt.gca().set(xlabel="position x [R]", ylabel="density [1/R]", xlim=(0, 250))
plt.legend()
plt.savefig("sixty_lines.png")
