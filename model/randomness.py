"""What random numbers begin with: a seed, in the forms that numpy's users know.

Functions that draw random numbers take ``seed=`` or, as the scientific Python packages agreed
(https://scientific-python.org/specs/spec-0007/), ``rng=``. Both mean one whole number. A run that
is resumed must have the same bits, and its replicas have streams of their own, spawned from the
number: a Generator's state could be neither written into the provenance nor divided reproducibly.
"""

from __future__ import annotations

import numpy as np

from crazybilliards.model.checks import check_integer, shown

Randomness = int | np.random.SeedSequence | np.random.Generator


def seed_of(seed: int, rng: Randomness | None) -> int:
    """Return the seed that the arguments ``seed`` and ``rng`` of a function stand for.

    Parameters
    ----------
    seed
        Integer >= 0; 0 also if it is not given.
    rng
        None: ``seed`` counts. An integer is the seed, and ``SeedSequence(5)`` means 5. Of another
        SeedSequence, e.g. a spawned one, 128 bits of its state are the seed. From a Generator a
        seed of 63 bits is drawn, so the next call with the same Generator gets another one.

    Raises
    ------
    ValueError
        If both are given, a seed other than 0, or if one of them is not of these kinds.
    """
    seed = check_integer("seed", seed, least=0)
    if rng is None:
        return seed
    if seed != 0:
        raise ValueError(f"give seed or rng, not both, got seed={seed} and rng={shown(rng)}")
    if isinstance(rng, np.random.SeedSequence):
        if isinstance(rng.entropy, int) and not rng.spawn_key:
            return rng.entropy
        return sum(int(word) << 32 * i for i, word in enumerate(rng.generate_state(4)))
    if isinstance(rng, np.random.Generator):
        return int(rng.integers(2**63))
    if isinstance(rng, int | np.integer):
        return check_integer("rng", rng, least=0)
    raise ValueError(
        "rng must be an integer >= 0, a SeedSequence or a Generator of numpy, such as "
        f"numpy.random.default_rng(1), got {shown(rng)}"
    )
