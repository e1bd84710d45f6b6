r"""How fast neighbours are when they meet: K(e) of the theory with pair correlations.

    python -m studies.contact_speeds [--restitution E ...]

Prints K^2 beside the table of kinetic/gas/closure.py, which explains it. Two
neighbours have the distance r > 0 and the relative velocity w,

    r' = w,      w' = -a w - 1 + sqrt(2) noise,      w -> -e w where r = 0,

in units of the force that presses them together and of the noise. a is such that
a sqrt(<w^2>) = sqrt(2/pi). The stationary density p(r, w) obeys

    w d_r p = d_w [(a w + 1) p + d_w p],

which is solved by finite volumes: upwind in r, exponentially fitted in w, graded towards contact
and rest. Their errors are of first order in the size of the cells; two meshes are extrapolated.
Then, with means over what arrives at r = 0,

    K^2 = 2 Theta_c/<w^2>,      sqrt(Theta_c) = (sqrt(pi)/4) <w^2>/<|w|>.

Takes 14 seconds for each e.
"""

from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.optimize import root_scalar
from scipy.sparse.linalg import spsolve

from crazybilliards.kinetic.gas.closure import SQUARES
from studies.common import options

DAMPING = np.sqrt(2 / np.pi)  # a sqrt(<w^2>)
SLOWEST = 1e-2  # width of the cells at w = 0, about
FASTEST, FURTHEST = 10.0, 40.0  # largest w and r
MESHES = (200, 320), (300, 480)  # cells in each direction of w, and in r
Array = np.ndarray


class Mesh(NamedTuple):
    """Cells of w, symmetric about 0, and of r."""

    w: Array
    widths: Array
    lengths: Array


class Solution(NamedTuple):
    """Moments of the stationary density, which has the integral 1."""

    square: float  # <w^2>
    impulse: float  # int |w| what arrives at r = 0 per time
    energy: float  # int w^2 of it

    @property
    def ratio(self) -> float:
        return float(np.pi / 8 * (self.energy / self.impulse) ** 2 / self.square)


def make_mesh(velocities: int, distances: int) -> Mesh:
    half = SLOWEST * np.sinh(np.linspace(0, np.arcsinh(FASTEST / SLOWEST), velocities + 1))
    faces = np.concatenate([-half[:0:-1], half])
    # Noise spreads w over sqrt(t), and r over t^(3/2).
    places = np.append(0.0, np.geomspace(SLOWEST**3, FURTHEST, distances))
    return Mesh((faces[1:] + faces[:-1]) / 2, np.diff(faces), np.diff(places))


def friction_and_noise(mesh: Mesh, a: float) -> sparse.csr_array:
    """Return what leaves each cell of w, by the fluxes of Scharfetter and Gummel."""
    apart, faces = np.diff(mesh.w), (mesh.w[1:] + mesh.w[:-1]) / 2
    drift = (a * faces + 1) * apart
    inner = np.arange(faces.size)
    from_left, from_right = drift / np.expm1(drift), -drift / np.expm1(-drift)
    flux = sparse.csr_array(
        (
            np.concatenate([from_left / apart, -from_right / apart]),
            (np.tile(inner, 2), np.concatenate([inner, inner + 1])),
        ),
        shape=(faces.size, mesh.w.size),
    )
    return (sparse.eye_array(*flux.T.shape) - sparse.eye_array(*flux.T.shape, k=-1)) @ flux


def collision(mesh: Mesh, e: float) -> sparse.csr_array:
    """Return where those go that arrive: to -e w, shared by the two cells next to it."""
    half = mesh.w.size // 2
    after = np.maximum(-e * mesh.w[:half], mesh.w[half])
    left = np.searchsorted(mesh.w[half:], after, side="right") - 1
    left = half + np.minimum(left, half - 2)
    share = (after - mesh.w[left]) / (mesh.w[left + 1] - mesh.w[left])
    places = np.concatenate([left, left + 1]), np.tile(np.arange(half), 2)
    shape = mesh.w.size, mesh.w.size
    return sparse.csr_array((np.concatenate([1 - share, share]), places), shape=shape)


def stationary(mesh: Mesh, e: float, a: float) -> Array:
    """Return the density over (r, w), up to a factor."""
    rows, count = mesh.lengths.size, mesh.w.size
    away, towards = (
        sparse.diags_array(np.maximum(sign * mesh.w, 0) * mesh.widths) for sign in (1, -1)
    )
    first, last = (
        sparse.csr_array(([1.0], ([at], [at])), shape=(rows, rows)) for at in (0, rows - 1)
    )
    reflected = sparse.csr_array(np.eye(count)[::-1])
    balance = (
        sparse.kron(sparse.diags_array(mesh.lengths), friction_and_noise(mesh, a))
        + sparse.kron(sparse.eye_array(rows), away + towards)
        - sparse.kron(sparse.eye_array(rows, k=-1), away)
        - sparse.kron(sparse.eye_array(rows, k=1), towards)
        - sparse.kron(first, collision(mesh, e) @ towards)
        - sparse.kron(last, reflected @ away)
    ).tocsc()
    # The balances add up to 0. One density is set to 1 in place of its balance.
    known = rows // 2 * count + count // 2
    others = np.delete(np.arange(rows * count), known)
    density = np.ones(rows * count)
    given = -balance[:, [known]].toarray().ravel()
    density[others] = spsolve(balance[others][:, others], given[others])
    return density.reshape(rows, count)


def solve(mesh: Mesh, e: float, a: float) -> Solution:
    density = stationary(mesh, e, a)
    shares = mesh.lengths @ density * mesh.widths
    arriving = density[0] * np.maximum(-mesh.w, 0) * mesh.widths
    moments = shares @ mesh.w**2, arriving @ np.abs(mesh.w), arriving @ mesh.w**2
    return Solution(*(float(each / shares.sum()) for each in moments))


def square_on(mesh: Mesh, e: float) -> float:
    found: dict[float, Solution] = {}

    def excess(a: float) -> float:
        found[a] = solve(mesh, e, a)
        return a * found[a].square ** 0.5 - DAMPING

    # K^2 changes by a tenth of what a changes by.
    root = root_scalar(excess, x0=0.65, x1=1.0, xtol=1e-3).root
    return found[min(found, key=lambda a: abs(a - root))].ratio


def contact_square(e: float, meshes: tuple[tuple[int, int], ...] = MESHES) -> float:
    """Return K^2, extrapolated from two meshes whose cells are in one proportion."""
    coarse, fine = (square_on(make_mesh(*cells), e) for cells in meshes)
    return fine + (fine - coarse) / (meshes[1][0] / meshes[0][0] - 1)


def main() -> None:
    print("e,K^2,of the package")
    for e in options(__doc__, restitution=list(SQUARES)).restitution:
        print(f"{e:g},{contact_square(e):.4f},{SQUARES.get(e, np.nan):.3f}", flush=True)


if __name__ == "__main__":
    main()
