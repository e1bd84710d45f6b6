"""White noise: normal random numbers, a thousand at a time, for vector instructions.

Drawn one by one they would cost as much as the rest of a step. Here sixteen xoshiro256++ generators
(Blackman and Vigna, ACM Trans. Math. Softw. 47, 36, 2021) run side by side, and the Box-Muller
transform

    sqrt(-2 ln u) (cos a, sin a),    u uniform in (0, 1), a uniform in (0, 2 pi),

turns their bits into normal numbers, of 8.6 standard deviations at most. Its functions are computed
by polynomials with errors of some units in the last place, which the compiler can vectorise.
Multiplications and additions may be fused into one instruction where the machine has one, so the
last bits may differ between machines.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.kernels import inlined, kernel

LANES = 16  # generators side by side: two or four vector registers
BLOCK = 1024  # normal numbers drawn together: all arrays stay in the first-level cache

_WORD = 0xFFFFFFFFFFFFFFFF  # for Python's integers; the compiler drops this mask of its own
# Exponents written onto 52 bits make a double of them without a conversion: 2^52 + bits.
_TWO_52 = np.int64(0x4330000000000000)
_SHIFT = 4503599627370496.0
# The double sqrt(1/2); the exponent of x/sqrt(1/2) is the rounded log2 of x.
_HALF_ROOT = np.int64(0x3FE6A09E667F3BCD)
_LN_2 = 0.6931471805599453

# Near-minimax polynomials, in z^2 for ln((1 + z)/(1 - z))/z up to sqrt(2), in a^2 for sin(a)/a and
# cos(a) up to pi/4; they are off by less than 1e-16.
_LOG = (
    *(2.0, 0.6666666666666666, 0.40000000000007496, 0.2857142856881913, 0.2222222267692954),
    *(0.18181773738016305, 0.1538716092613408, 0.13248763083460116, 0.13262103674021808),
)
_SIN = (
    *(1.0, -0.16666666666666616, 0.008333333333320363, -0.000198412698286503),
    *(2.755731337640013e-06, -2.5050716974102745e-08, 1.5894736651849094e-10),
)
_COS = (
    *(1.0, -0.4999999999999925, 0.041666666666472306, -0.0013888888869978658),
    *(2.4801578538562985e-05, -2.755523388484742e-07, 2.0630454379662294e-09),
)


class Noise(NamedTuple):
    """A stream of normal numbers: the state of its generators and the block in use."""

    lanes: NDArray[np.uint64]  # states of the generators, (4, LANES)
    normals: NDArray[np.float64]  # the present block, (BLOCK,)
    taken: NDArray[np.int64]  # how many of them are used up, (1,)
    bits: NDArray[np.uint64]  # scratch space, (BLOCK,)
    numbers: NDArray[np.int64]  # the first half of the bits as integers, (BLOCK/2,)
    reals: NDArray[np.float64]  # the same as floats
    radii: NDArray[np.float64]  # scratch space, (BLOCK/2,)


STATE = ("lanes", "normals", "taken")  # what the next numbers depend on


def make_noise(stream: np.random.SeedSequence) -> Noise:
    """Return the noise of a stream: streams spawned from one seed are independent."""
    bits = np.zeros(BLOCK, dtype=np.uint64)
    half = bits[: BLOCK // 2]
    return Noise(
        np.asarray(stream.generate_state(4 * LANES, np.uint64), np.uint64).reshape(4, LANES),
        np.zeros(BLOCK),
        np.array([BLOCK]),
        bits,
        half.view(np.int64),
        half.view(np.float64),
        np.zeros(BLOCK // 2),
    )


@kernel
def _draw_bits(lanes, bits):  # type: ignore[no-untyped-def]
    """Fill ``bits`` with random bits, one number of each generator in turn."""
    a, b, c, d = lanes[0], lanes[1], lanes[2], lanes[3]
    for begin in range(0, bits.size, LANES):
        row = bits[begin : begin + LANES]
        for i in range(LANES):
            s0, s1, s2, s3 = int(a[i]), int(b[i]), int(c[i]), int(d[i])
            mixed = (s0 + s3) & _WORD
            row[i] = ((mixed << 23 | mixed >> 41) + s0) & _WORD
            shifted = s1 << 17 & _WORD
            s2 ^= s0
            s3 ^= s1
            b[i] = s1 ^ s2
            a[i] = s0 ^ s3
            c[i] = s2 ^ shifted
            d[i] = (s3 << 45 | s3 >> 19) & _WORD


@inlined(fused=True)
def _polynomial(coefficients, x):  # type: ignore[no-untyped-def]
    """Return sum_k coefficients[k] x^k, by Horner's scheme."""
    value = coefficients[-1]
    for k in range(len(coefficients) - 2, -1, -1):
        value = coefficients[k] + x * value
    return value


@kernel(fused=True)
def _radii(numbers, reals, radii):  # type: ignore[no-untyped-def]
    """sqrt(-2 ln u) with u = (b + 1/2)/2^52, b the upper 52 bits; changes ``numbers``."""
    for i in range(radii.size):
        numbers[i] = _TWO_52 | np.int64(np.uint64(numbers[i]) >> np.uint64(12))
    for i in range(radii.size):
        reals[i] = (reals[i] - _SHIFT) + 0.5
    # x = 2^n m with m between sqrt(1/2) and sqrt(2).
    for i in range(radii.size):
        exponent = (numbers[i] - _HALF_ROOT) >> np.int64(52)
        numbers[i] -= exponent << np.int64(52)
        radii[i] = exponent
    for i in range(radii.size):
        z = (reals[i] - 1.0) / (reals[i] + 1.0)
        radii[i] = np.sqrt(-2.0 * ((radii[i] - 52.0) * _LN_2 + z * _polynomial(_LOG, z * z)))


@kernel(fused=True)
def _rotate(bits, radii, first, second):  # type: ignore[no-untyped-def]
    """Project radii onto two axes: 50 bits give the angle in a quarter turn, two the quarter."""
    for i in range(radii.size):
        b = bits[i]
        fraction = np.float64(np.int64((b >> np.uint64(12)) & np.uint64(0x3FFFFFFFFFFFF)))
        angle = (fraction * 2.0**-50 - (0.5 - 2.0**-51)) * (np.pi / 2)
        square = angle * angle
        sine, cosine = angle * _polynomial(_SIN, square), _polynomial(_COS, square)
        radius = radii[i] if (b >> np.uint64(62)) & np.uint64(1) else -radii[i]
        along, across = cosine * radius, sine * radius
        turned = (b >> np.uint64(63)) != np.uint64(0)
        first[i] = along if turned else across
        second[i] = -across if turned else along


@kernel
def fill(noise, values):  # type: ignore[no-untyped-def]
    """Fill a float array with the next normal numbers of mean 0 and variance 1."""
    done, taken, half = 0, noise.taken[0], noise.radii.size
    while done < values.size:
        if taken == BLOCK:
            _draw_bits(noise.lanes, noise.bits)
            _radii(noise.numbers, noise.reals, noise.radii)
            _rotate(noise.bits[half:], noise.radii, noise.normals[:half], noise.normals[half:])
            taken = 0
        number = min(values.size - done, BLOCK - taken)
        # Two slices and a loop: copied as a vector, with indices that begin at 0.
        target, source = values[done : done + number], noise.normals[taken : taken + number]
        for i in range(number):
            target[i] = source[i]
        done += number
        taken += number
    noise.taken[0] = taken
