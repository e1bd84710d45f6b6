"""What random numbers begin with: a seed, in the forms that numpy's users know.

Each form means one whole number. Unlike the state of a Generator, it can be written into the
provenance and divided into streams of replicas.
"""

from typing import SupportsIndex

import numpy as np

from crazybilliards.model.checks import check_integer, shown

_END = 2**4096  # the provenance holds the digits, of which Python writes 4300 at most

Seed = SupportsIndex | np.random.SeedSequence | np.random.Generator


def seed_of(seed: Seed) -> int:
    """Return the number that the argument ``seed`` of a function stands for.

    An integer is the number, and ``SeedSequence(5)`` means 5. Of another SeedSequence, e.g. a
    spawned one, 128 bits of its state are the number. From a Generator 63 bits are drawn, so the
    next call with the same Generator gets another number. Anything else is a ValueError.
    """
    if isinstance(seed, np.random.SeedSequence):
        if isinstance(seed.entropy, int) and not seed.spawn_key and seed.entropy < _END:
            return seed.entropy
        return sum(int(word) << 32 * i for i, word in enumerate(seed.generate_state(4)))
    if isinstance(seed, np.random.Generator):
        return int(seed.integers(2**63))
    try:
        return check_integer("seed", seed, least=0, most=_END - 1)
    except ValueError as error:
        raise ValueError(
            "seed must be an integer >= 0 of up to 4096 bits, a SeedSequence, or a Generator of "
            f"numpy, got {shown(seed)}"
        ) from error
