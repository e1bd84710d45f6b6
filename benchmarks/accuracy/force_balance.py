"""The error of the force balance closed by labels, against the exact equilibrium.

    python benchmarks/accuracy/force_balance.py

Prints the largest error of the smoothed density, relative to close packing, by gap over the thermal
length s, size, and thermal length over the radius: what ``expected_force_balance`` states.
"""

import numpy as np

from crazybilliards import Chain, equilibrium, force_balance, smooth

GAPS = (0.0, 0.1, 0.3, 1.0, 3.0, 10.0)
SIZES = (2, 10, 100, 1000)
AMPLITUDES = (1.0, 3.0, 10.0, 30.0)


def error(chain: Chain) -> float:
    exact, found = (smooth(theory(chain)).density for theory in (equilibrium, force_balance))
    off = np.abs(found.interp(x=exact.x, kwargs={"fill_value": 0.0}) - exact)
    return float(off.max()) / chain.close_packed_density


def main() -> None:
    print(f"| g/s | L | {' | '.join(f's = {0.7071 * each:.3g} R' for each in AMPLITUDES)} |")
    print("|---" * (2 + len(AMPLITUDES)) + "|")
    for gap in GAPS:
        for size in SIZES:
            chains = [Chain(size=size, amplitude=amplitude) for amplitude in AMPLITUDES]
            errors = [error(chain.replace(gap=gap * chain.thermal_length)) for chain in chains]
            print(f"| {gap:g} | {size} | {' | '.join(f'{each:.4f}' for each in errors)} |")


if __name__ == "__main__":
    main()
