"""Hydrodynamics: relaxation to the steady state in the label frame."""

from typing import Any

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from crazybilliards.kinetic import compressed, hydrodynamics
from crazybilliards.model import Chain


@pytest.mark.benchmark(group="relaxation over 100 time units, label frame")
@pytest.mark.parametrize("variance", [None, "evolving"], ids=["isothermal", "evolving"])
@pytest.mark.parametrize("gap", [0.0, 0.2, 1.0])
@pytest.mark.parametrize("size", [10, 100, 1000])
@pytest.mark.parametrize("amplitude", [1, 10, 100])
def test_relaxation(
    benchmark: BenchmarkFixture, amplitude: float, size: int, gap: float, variance: str | None
) -> None:
    chain = Chain(size=size, amplitude=amplitude, gap=gap)
    start = compressed(chain, 0.5)
    arguments: dict[str, Any] = {"every": 5, "velocity_variance": variance, "progress": False}
    hydrodynamics(chain, start, 10, **arguments)  # compiled
    benchmark.pedantic(hydrodynamics, (chain, start, 100), arguments, rounds=1)
