"""What would not fit into memory is refused, with both numbers."""

from types import SimpleNamespace

import psutil
import pytest

from crazybilliards.kinetic import phase_space
from crazybilliards.model import Chain
from crazybilliards.model.memory import require_memory


def test_the_error_has_both_numbers():
    require_memory("nothing", 0.0)
    with pytest.raises(ValueError, match=r"^size=3 would take 1e\+12 GiB of memory, .* available$"):
        require_memory("size=3", 1e12 * 2**30)


def test_only_the_meshes_that_are_used_are_checked(monkeypatch):
    """22 and 33 cells are enough for a small chain: 44 MB; the next mesh takes 100 MB."""
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=5e7))
    assert phase_space(Chain(size=3)).attrs["cells"] == 33
    with pytest.raises(ValueError, match=r"cells=50 would take"):
        phase_space(Chain(size=3), tolerance=1e-12)
