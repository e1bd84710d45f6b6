"""What would not fit into memory is refused, with both numbers."""

import pytest

from crazybilliards.kinetic import equilibrium_states, phase_space
from crazybilliards.model import Chain
from crazybilliards.model.memory import available_memory, require_memory
from crazybilliards.particles import simulate
from crazybilliards.particles.start import given_start


def test_available_memory_is_that_of_a_computer():
    assert 2**20 < available_memory() < 2**60


def test_the_error_has_both_numbers():
    require_memory("nothing", 0.0)
    with pytest.raises(ValueError, match=r"^size=3 would take 1e\+12 GiB of memory, .* available$"):
        require_memory("size=3", 1e12 * 2**30)


@pytest.mark.parametrize(
    "call",
    [
        lambda: simulate(Chain(size=10**9), replicas=10**9),
        lambda: simulate(Chain(), replicas=10**12),
        lambda: simulate(Chain(size=10**7), observe="avalanches"),
        lambda: given_start(Chain(), 0.0, replicas=10**12),
        lambda: equilibrium_states(Chain(size=3), 10**12),
    ],
)
def test_what_a_user_asks_for_is_checked_before_it_is_allocated(call):
    with pytest.raises(ValueError, match=r"would take .* GiB of memory"):
        call()


def test_the_mesh_is_checked(monkeypatch):
    monkeypatch.setattr("crazybilliards.model.memory.available_memory", lambda: 1e6)
    with pytest.raises(ValueError, match=r"cells=22 would take"):
        phase_space(Chain(size=3), cells=22)
