"""Figure 17: density of the elastic chain, simulation and theory, for several amplitudes."""

from __future__ import annotations

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim, Estimate, same_claim, small_claim
from crazybilliards.comparison.studies.elastic_chain import THEORIES, deviations, elastic_theories
from crazybilliards.comparison.studies.elastic_figures import draw_density
from crazybilliards.comparison.studies.parameter_series import SIMULATION
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain, chain_of

_AMPLITUDES = (1.0, 3.0, 10.0, 30.0)
_DURATION = {"quick": 50_000.0, "full": 1_000_000.0}
_LIMIT = 0.05  # of close packing: what one sees in the picture


def simulation(amplitude: float, quality: Quality) -> Case:
    """L = 100, e = 1."""
    settings = {"duration": _DURATION[quality], "observe": ["widths", "density"]}
    return Case("simulate", Chain(size=100, amplitude=amplitude), settings)


def cases(quality: Quality) -> Cases:
    """Four amplitudes."""
    return {f"amplitude_{a:g}": simulation(a, quality) for a in _AMPLITUDES}


def _tree(results: Results) -> xr.DataTree:
    every: dict[str, xr.Dataset] = {}
    for name, run in results.items():
        every[f"{name}/{SIMULATION}"] = run
        theories = elastic_theories(chain_of(run), run)
        every |= {f"{name}/{key}": theory for key, theory in theories.items()}
    return xr.DataTree.from_dict(every)


def claims(results: Results) -> list[Claim]:
    """Check: simulation and theory agree."""
    claims = []
    for name, by_theory in deviations(_tree(results)).items():
        amplitude = name.removeprefix("amplitude_")
        error = by_theory["exact"].maximum / (by_theory["exact"].maximum_in_errors or 1)
        closed = by_theory["labels"].maximum
        claims.append(
            small_claim(
                f"theory (fed with the fitted displacement) agrees at A = {amplitude}",
                "largest difference in units of close packing",
                Estimate(by_theory["arctanh"].maximum, error),
                _LIMIT,
                theory=f"closed by labels, nothing fitted: {closed:.3f}",
                reason="only the outermost rods or two differ: a step in the exact density, which "
                "a fluid smears out",
            )
        )
        claims.append(
            same_claim(
                f"(beyond the paper) the exact density is the simulated one, A = {amplitude}",
                f"off by at most {by_theory['exact'].maximum:.4f} of close packing",
                by_theory["exact"].maximum_in_errors or 0.0,
                theory="exact",
            )
        )
    return claims


def draw(results: Results) -> Figure:
    """Draw rho(x) and the differences from the exact density."""
    return draw_density(_tree(results))


FIGURE = PaperFigure(
    number=17,
    name="density",
    title="Density at e = 1: simulation and theory",
    caption="L = 100, e = 1, four driving amplitudes. Circles: simulation, smoothed as in the "
    f"paper. Lines: {', '.join(THEORIES.values())}. Below each: the difference from the exact "
    "density in units of close packing.",
    cases=cases,
    draw=draw,
    claims=claims,
)
