r"""The (y, v) plane as finite elements: mesh, symmetry, and integrals over velocities.

The mesh is a tensor mesh of second-order quadrilaterals. It is uniform in the core of the
distribution, and outside its cells grow in proportion to the distance: nodes b sinh(t), with the
scale b of the core.

**Symmetry.** A stationary state obeys f(-y, -v) = f(y, v). Its mesh covers y >= 0 only. On the line
y = 0 the nodes at v and at -v are one unknown. Trial and test functions are then even along this
line, v f p is odd, and the boundary term there vanishes.

**Integrals over velocities.** The quadrature points form a tensor grid as well: an integral over u
at every y is a matrix product along its second axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import RectBivariateSpline
from scipy.sparse import csc_matrix, csr_matrix
from scipy.sparse.linalg import SuperLU, splu
from skfem import Basis, BilinearForm, ElementLineP2, ElementQuad2, LinearForm, MeshLine, MeshQuad
from threadpoolctl import threadpool_limits

from crazybilliards.model.arrays import Array

_MISFIT = 1.15  # factor that a box may be off

_PIVOT = 1e-5  # of the largest entry below it, the least a diagonal pivot may be; see factorised
_ORDER = 5  # of the quadrature: three Gauss points along each side of a cell


class Box(NamedTuple):
    """Extent of the mesh and scale of its core, along y and v, in the units of the solution."""

    length: float
    velocity: float
    core_length: float
    core_velocity: float

    def fits(self, other: Box) -> bool:
        """Return whether another box is about the same."""
        factors = np.array(self) / np.array(other)
        return bool(factors.max() < _MISFIT and factors.min() > 1 / _MISFIT)


def graded(cells: int, end: float, core: float) -> Array:
    """Return nodes from 0 to ``end``: uniform below ``core``, growing with the distance above."""
    return np.asarray(core * np.sinh(np.linspace(0, np.arcsinh(end / core), cells + 1)))


def factorised(matrix: csc_matrix) -> SuperLU:
    """Factorise a matrix of finite elements, whose pattern is symmetric.

    The ordering for symmetric patterns gives five times less fill-in than the default one. Pivots
    off the diagonal are allowed where the diagonal is small, as the matrices are not definite.
    """
    return splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=_PIVOT,
        options={"SymmetricMode": True},
    )


# A decorator for theories on this plane. Their matrix products are so small that threads in the
# linear algebra cost more than they save, up to ten times the computing time on a busy machine.
one_thread = threadpool_limits.wrap(limits=1, user_api="blas")


@dataclass(frozen=True)
class VelocitySpace:
    """Second-order elements over the plane, ``cells`` from 0 to the end in each direction."""

    box: Box
    cells: int
    symmetric: bool = True

    @cached_property
    def basis(self) -> Basis:
        """The elements with their quadrature points."""
        return Basis(MeshQuad.init_tensor(*self._vertices), ElementQuad2(), intorder=_ORDER)

    @cached_property
    def _vertices(self) -> tuple[Array, Array]:
        y = graded(self.cells, self.box.length, self.box.core_length)
        v = graded(self.cells, self.box.velocity, self.box.core_velocity)
        both = [np.concatenate([-half[:0:-1], half]) for half in (y, v)]
        return (y if self.symmetric else both[0]), both[1]

    @cached_property
    def axes(self) -> tuple[Array, Array]:
        """All y and all v of nodes: vertices and the middles of the cells between them."""
        y, v = (np.sort(np.append(x, (x[1:] + x[:-1]) / 2)) for x in self._vertices)
        return y, v

    # -- quadrature points as a table over (y, v) -------------------------------------------

    @cached_property
    def _lines(self) -> list[tuple[Array, Array]]:
        """Quadrature points and weights along y and along v, ascending."""
        bases = [Basis(MeshLine(x), ElementLineP2(), intorder=_ORDER) for x in self._vertices]
        points = [np.asarray(basis.global_coordinates())[0].ravel() for basis in bases]
        orders = [np.argsort(x) for x in points]
        weights = [basis.dx.ravel() for basis in bases]
        return [(x[k], w[k]) for x, w, k in zip(points, weights, orders, strict=True)]

    @property
    def y(self) -> Array:
        """Quadrature points along y."""
        return self._lines[0][0]

    @property
    def v(self) -> Array:
        """Quadrature points along v."""
        return self._lines[1][0]

    @property
    def y_weights(self) -> Array:
        """Weights of the points along y; both halves of a symmetric plane are counted."""
        return self._lines[0][1] * (2 if self.symmetric else 1)

    @property
    def v_weights(self) -> Array:
        """Weights of the points along v."""
        return self._lines[1][1]

    @cached_property
    def _places(self) -> NDArray[np.int64]:
        """Index into the flattened table of each quadrature point of the basis."""
        points = np.asarray(self.basis.global_coordinates()).reshape(2, -1)
        y, v = (
            np.searchsorted((x[1:] + x[:-1]) / 2, along)
            for x, along in zip((self.y, self.v), points, strict=True)
        )
        return y * self.v.size + v

    def table(self, field: ArrayLike) -> Array:
        """Return a field at the quadrature points as a table, shape (y, v)."""
        table = np.empty(self._places.size)
        table[self._places] = np.ravel(field)
        return table.reshape(self.y.size, self.v.size)

    def field(self, table: Array) -> Array:
        """Return a table (y, v) as a field at the quadrature points, for use in forms."""
        return np.asarray(table.ravel()[self._places].reshape(self.basis.dx.shape))

    # -- unknowns ----------------------------------------------------------------------------

    @cached_property
    def unknowns(self) -> csr_matrix:
        """Matrix from the unknowns to the nodal values; a symmetric pair shares one unknown."""
        nodes = self.basis.doflocs
        partner = np.arange(self.basis.N)
        if self.symmetric:
            line = np.flatnonzero(nodes[0] < 1e-9 * self.box.length)
            line = line[np.argsort(nodes[1, line])]
            partner[line] = np.minimum(line, line[::-1])
        _, unknown = np.unique(partner, return_inverse=True)
        one = np.ones(partner.size)
        return csr_matrix((one, (np.arange(partner.size), unknown)))

    @cached_property
    def _grid(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Place of every node on the axes."""
        y, v = (
            np.searchsorted((x[1:] + x[:-1]) / 2, along)
            for x, along in zip(self.axes, self.basis.doflocs, strict=True)
        )
        return y, v

    def nodal(self, values: Array) -> Array:
        """Return the unknowns of the function with the given values on the axes, (y, v)."""
        shares = self.unknowns.T
        return np.asarray(shares @ values[self._grid]) / np.asarray(shares.sum(axis=1)).ravel()

    def whole(self, f: Array) -> tuple[Array, Array, Array]:
        """Return y, v and the values of f on the whole plane, both halves."""
        y, v = self.axes
        values = np.empty((y.size, v.size))
        values[self._grid] = self.unknowns @ f
        if not self.symmetric:
            return y, v, values
        return (np.concatenate([-y[:0:-1], y]), v, np.concatenate([values[:0:-1, ::-1], values]))

    def sampled(self, f: Array) -> tuple[Array, Array, Array]:
        """Return y, v and the values of f at the quadrature points of the whole plane.

        There f is more accurate than at the nodes, where it alternates a little around v = 0.
        """
        table = self.table(self.interpolate(f)[0])
        if not self.symmetric:
            return self.y, self.v, table
        return (
            np.concatenate([-self.y[::-1], self.y]),
            self.v,
            np.concatenate([table[::-1, ::-1], table]),
        )

    def take_over(self, other: VelocitySpace, f: Array) -> Array:
        """Return the unknowns on this mesh of a function on another mesh; zero beyond it."""
        y, v = self.axes
        spline = RectBivariateSpline(*other.whole(f))
        inside = np.abs(y)[:, None] <= other.box.length
        inside = inside & (np.abs(v) <= other.box.velocity)
        return self.nodal(np.where(inside, spline(y, v), 0.0))

    def project(self, function: Callable[[Array, Array], Array]) -> Array:
        """Return the unknowns of the function nearest to one of (y, v), in the mean square."""
        table = function(self.y, self.v)
        right = self.assemble(LinearForm(lambda p, w: w.f * p), f=self.field(table))
        return np.asarray(factorised(self.unknowns.T @ self.gram @ self.unknowns).solve(right))

    def assemble(self, form: LinearForm, **fields: Any) -> Array:
        """Assemble a linear form on the unknowns."""
        return np.asarray(self.unknowns.T @ form.assemble(self.basis, **fields))

    def interpolate(self, f: Array) -> tuple[Array, Array]:
        """Return f and its derivative along v at the quadrature points."""
        value, slope = (matrix @ f for matrix in self._at_points)
        return value.reshape(self.basis.dx.shape), slope.reshape(self.basis.dx.shape)

    def against_slopes(self, field: Array) -> Array:
        """Return the integrals of a field times the derivative along v of each test function."""
        return np.asarray(self._at_points[1].T @ (field * self.basis.dx).ravel())

    @cached_property
    def _at_points(self) -> list[csr_matrix]:
        """Matrices from the unknowns to f and its derivative along v at the quadrature points.

        Newton's method interpolates thousands of times; scikit-fem needs ten times as long for it.
        """
        shape, nodes = self.basis.dx.shape, self.basis.element_dofs
        points = np.arange(self.basis.dx.size).reshape(shape)
        rows, columns = np.tile(points.ravel(), len(nodes)), np.repeat(nodes, shape[1])
        functions = [each[0] for each in self.basis.basis]
        return [
            csr_matrix((np.concatenate(values), (rows, columns))) @ self.unknowns
            for values in (
                [np.broadcast_to(np.asarray(each), shape).ravel() for each in functions],
                [np.broadcast_to(each.grad[1], shape).ravel() for each in functions],
            )
        ]

    # -- integrals ---------------------------------------------------------------------------

    @cached_property
    def kernels(self) -> tuple[Array, Array, Array]:
        """Matrices of int (.) f(u) du for |v-u|(v-u), |v-u|^3 and its derivative along v."""
        difference = self.v[:, None] - self.v
        signed = np.abs(difference) * difference
        weighted = (signed, signed * difference, 3 * signed)
        first, second, slope = (kernel * self.v_weights for kernel in weighted)
        return first, second, slope

    @cached_property
    def gram(self) -> csr_matrix:
        """Matrix of the scalar products of the elements."""
        return BilinearForm(lambda f, p, w: f * p).assemble(self.basis)

    @cached_property
    def whole_mass(self) -> Array:
        """Vector whose product with f is its integral over the whole plane."""
        return self.assemble(LinearForm(lambda p, w: (2 if self.symmetric else 1) * p))

    @cached_property
    def whole_energy(self) -> Array:
        """Vector whose product with f is the integral of v^2 f over the whole plane."""
        return self.assemble(
            LinearForm(lambda p, w: (2 if self.symmetric else 1) * w.x[1] ** 2 * p)
        )

    def cumulative(self, along_y: Array) -> Array:
        """Integrate a function of y, given at its points, from the centre to each of them.

        The integral starts at the lower end if the plane is not symmetric. It is exact for
        parabolas in each cell.
        """
        points, weights = self.y.reshape(-1, 3), self._lines[0][1].reshape(-1, 3)
        values = along_y.reshape(-1, 3)
        cells = (values * weights).sum(axis=1)
        before = np.cumsum(cells) - cells
        xi = (points[0] - self._vertices[0][0]) / np.diff(self._vertices[0])[0]
        # Integrals from 0 to xi of the parabolas through the three points of the unit cell.
        powers = np.vander(xi, 3, increasing=True)
        upto = np.vander(xi, 4, increasing=True)[:, 1:] / [1, 2, 3] @ np.linalg.inv(powers)
        widths = weights.sum(axis=1)[:, None]
        return np.asarray((before[:, None] + widths * (values @ upto.T)).ravel())
