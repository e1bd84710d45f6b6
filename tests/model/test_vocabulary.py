"""What is no result is refused in one line."""

import pytest
import xarray as xr

from crazybilliards.kinetic import hydrodynamics, relax_phase_space
from crazybilliards.model import Chain


@pytest.mark.parametrize("theory", [hydrodynamics, relax_phase_space])
@pytest.mark.parametrize("start", ["start", None, 3, {}, xr.Dataset()])
def test_a_start_that_is_no_result_is_refused(theory, start):
    with pytest.raises(ValueError, match=r"start must be a result .* displaced|has no .density."):
        theory(Chain(size=6), start, 1.0, progress=False)
