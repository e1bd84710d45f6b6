"""The description of a sweep is read as it was meant, or refused before any work."""

from __future__ import annotations

import numpy as np
import pytest
from refusals import what_is_wrong

from crazybilliards.comparison.sweeps import read_sweep
from crazybilliards.model import Chain

CUTS, FLIPS = 50, 1000
CHAIN = Chain(size=3)
RUN = {"duration": 100.0, "warmup": 1.0, "progress": False}


SWEEP = """[grid]
size = [3, 4]
restitution = [0.5, 1.0]

[simulate]
duration = 200
observe = ["widths"]
"""


def cases_of(text, path):
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_sweep(path).cases()


@pytest.mark.parametrize(
    "text",
    [
        b"\xff\xfe",
        b"\x00",
        "grid",
        "grid = 3",
        "[grid]\nsize = 3",
        "[grid]\nsize = []",
        "[grid]\nsize = [1979-05-27]",
        "[grid]\nsize = [[3]]",
        "[grid]\nsize = [{a = 1}]",
        "[grid]\nsize = [3, 3]",
        "[grid]\nsize = ['3']",
        "[grid]\nsize = [true]",
        f"[grid]\nsize = [{10**400}]",
        "[grid]\nsize = [1000000000]",
        "[grid]\namplitude = [nan]",
        "[grid]\namplitude = [inf, 1e300]",
        f"[grid]\namplitude = [{10**400}]",
        "[grid]\nlength = [3]",
        "[grid]\nobserve = [5]",
        "[grid]\nparticles = [5]",
        "[grid]\nseed = [-1]",
        "[chain]\nsize = 'x'",
        "[chain]\nname = 1",
        "[chain]\nsize = [3]",
        "[simulate]\nduration = 'long'",
        "[simulate]\nobserve = 3",
        "[simulate]\nobserve = [[1]]",
        "[simulate]\nstart = 1",
        "[simulate]\nthreads = 1",
        "[simulate]\ncheckpoint = 'state'",
        "[simulate]\nduration = 1e300",
        "[simulate]\nreplicas = 1000000000000",
        "[simulate]\naverage = ['time']",
        "[phase_space]\ncells = 'x'",
        "[phase_space]\ntolerance = -1",
        "[phase_space]\norder = 3",
        "[grid]\nrestitution = [0.5]\n[equilibrium]",
        "[grid]\nrestitution = [0.5]\n[force_balance]",
        "[simulate]\n[phase_space]",
        "[grid]\nsize = " + "[" * 5000,
        "[grid]\n"
        + "\n".join(f"{name} = {list(range(1, 999))}" for name in ("seed", "gap", "size")),
    ],
    ids=lambda text: repr(text)[:40],
)
def test_a_wrong_sweep_is_refused_before_any_work(text, tmp_path):
    with pytest.raises(ValueError, match=r"\w") as caught:
        cases_of(text, tmp_path / "grid.toml")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 500


def test_a_sweep_with_flipped_bits_is_another_sweep_or_refused(tmp_path):
    """A text without checksum: what is still TOML and makes sense is a sweep."""
    generator = np.random.default_rng(4)
    whole, refusals = SWEEP.encode(), 0
    for number in range(FLIPS + CUTS):
        text = bytearray(whole)
        if number < FLIPS:
            text[generator.integers(len(text))] ^= 1 << int(generator.integers(8))
        else:
            text = text[: (number - FLIPS) * len(text) // CUTS]
        message = what_is_wrong(cases_of, bytes(text), tmp_path / "grid.toml")
        assert "\n" not in message
        refusals += bool(message)
    assert FLIPS / 2 < refusals < FLIPS + CUTS
