"""What would not fit into memory is refused, with both numbers."""

import pytest

from crazybilliards.model.memory import require_memory


def test_the_error_has_both_numbers():
    require_memory("nothing", 0.0)
    with pytest.raises(ValueError, match=r"^size=3 would take 1e\+12 GiB of memory, .* available$"):
        require_memory("size=3", 1e12 * 2**30)
