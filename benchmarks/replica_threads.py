"""Two replicas in one thread and in two: the kernels hold no lock, so two should take half."""

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from crazybilliards.model import Chain
from crazybilliards.particles import simulate

CASES = {
    "exact, L=100": (Chain(size=100), 200_000.0),
    "exact, L=1000": (Chain(size=1000), 20_000.0),
    "events, e=0.5, L=100": (Chain(size=100, restitution=0.5), 2000.0),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("threads", [1, 2])
def test_replicas(benchmark: BenchmarkFixture, case: str, threads: int) -> None:
    chain, duration = CASES[case]
    benchmark.group = f"two replicas, {case}"
    benchmark.pedantic(
        simulate,
        args=(chain,),
        kwargs={
            "duration": duration,
            "replicas": 2,
            "threads": threads,
            "observe": "widths",
            "progress": False,
        },
        rounds=3,
        warmup_rounds=1,
    )
