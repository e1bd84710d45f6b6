"""The check that a theory holds all rods of its chain, symmetrically."""

import numpy as np
from scipy.integrate import trapezoid


def require_all_rods(theory, size, alike=1e-6):
    """Check for all rods, none at the ends of the grid, ``alike`` on both sides of x = 0."""
    label, density = theory.label.values, theory.density.values
    np.testing.assert_allclose(label[..., 0], 0, atol=1e-9 * size)
    np.testing.assert_allclose(label[..., -1], size, rtol=1e-9)
    assert (density[..., [0, -1]] <= 1e-9 * density.max()).all()
    np.testing.assert_allclose(label + label[..., ::-1], size, rtol=alike)
    np.testing.assert_allclose(density, density[..., ::-1], atol=alike * density.max())
    # The centre of mass: int x dN = [x N] - int N dx. A mirrored label leaves rounding only.
    extent = theory.x.values[-1]
    centre = extent - trapezoid(label, theory.x.values) / size
    np.testing.assert_allclose(centre, 0, atol=alike * extent)
