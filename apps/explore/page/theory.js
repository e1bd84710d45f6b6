/* What theory knows of a chain: exactly at e = 1, from stored curves, or from the server. */
"use strict";

const ChainTheory = (() => {
  const STILL = 300; // milliseconds that a chain must not change before its theory is asked for
  let solved = null, asking = null, wanted = {}; // `wanted`: the chain that is shown, and since when
  const exact = { chain: null, due: 0, density: null };

  /* How good a theory says that it is; an error that was not measured is null. */
  function stated({ title, error, border, density_error: ofDensity }) {
    const within = (bound) => (bound === 0 ? "exact" : `within ${Number((100 * bound).toPrecision(2))} %`);
    const known = [];
    if (error >= 0 && error !== null) known.push(`velocity widths ${within(error)}`);
    if (error > 0 && border > 0) known.push(`at the ends ${within(border)}`);
    if (ofDensity === 0) known.push("density exact");
    if (ofDensity > 0) known.push(`density ${within(ofDensity)} of close packing`);
    if (known.length && ofDensity === null) known.push("error of the density not measured");
    const exactly = error === 0 && ofDensity === 0;
    return `${title}: ${exactly ? "exact" : known.join(", ") || "its errors were not measured for such chains"}.`;
  }

  const isSolved = (chain) => solved !== null && ChainAddress.same(solved.chain, chain);

  /* {short, said, widths, density, other} of the chain, or null; widths in free widths. */
  function of(chain) {
    if (isSolved(chain)) return solved;
    if (ChainScales.isGas(chain)) // of two rods the energies depend on how they begin
      return chain.size < 3 ? null : { short: "equal energies", said: "", widths: lightest(chain) };
    if (chain.restitution === 1 && chain.amplitude > 0)
      return { short: "exact", widths: Array(chain.size).fill(1), said: "" };
    // The curves are those of A = 1; without a gap A only sets the scale.
    const stored = chain.spring === "linear" && (chain.amplitude === 1 || (chain.gap === 0 && chain.amplitude > 0));
    const found = ChainCurves.widths.find((each) =>
      ["size", "restitution", "damping", "gap"].every((name) => each[name] === chain[name]));
    if (!stored || !found) return null;
    const other = found.half.slice(0, Math.floor(chain.size / 2)).reverse();
    return { short: found.title, said: stated(found), widths: [...found.half, ...other] };
  }

  /* The velocity widths of the rods of a gas, in those of the light ones, if all have the same energy. */
  const lightest = (chain) => ChainScales.masses(chain).map((m) => Math.sqrt(ChainScales.MASS / m));

  /* The exact density of a chain at e = 1 as points, once it has not changed for a moment. */
  function exactDensity(chain, places) {
    if (chain.restitution !== 1 || chain.amplitude === 0 || ChainScales.isGas(chain)) return null;
    const now = performance.now();
    if (exact.chain !== chain) Object.assign(exact, { chain, due: now + (chain.size > 60 ? 400 : 0), density: null });
    if (!exact.density && now >= exact.due) {
      const covered = ChainMeasuring.exactCoverage(chain, places);
      exact.density = places.map((x, k) => [x, covered[k]]);
    }
    return exact.density;
  }

  /* Ask the server for the best theory of a chain once it has not changed for a moment, one at a time. */
  async function follow(chain, address) {
    const now = performance.now();
    if (wanted.chain !== chain) wanted = { chain, since: now };
    if (!address || asking || now - wanted.since < STILL || ChainScales.isGas(chain) || isSolved(chain)) return;
    asking = { ...chain };
    try {
      const query = new URLSearchParams(ChainAddress.SPRUNG.map((name) => [name, asking[name]]));
      take(asking, await (await fetch(`${address}?${query}`, { headers: { "X-Requested-With": "chain" } })).json());
    } catch {
      solved = { chain: asking, said: "The server does not answer." };
    }
    asking = null;
  }

  /* Keep an answer of the server: the best theory and, at e = 1, the force balance beside it. */
  function take(chain, { refused, best, other }) {
    solved = refused ? { chain, said: `No theory: ${refused}.` } : {
      chain, said: [best, other].filter(Boolean).map(stated).join(" "), widths: best.widths, density: best.density,
      short: best.error === 0 ? "exact" : best.title, other: other && { short: other.title, density: other.density },
    };
  }

  return { of, exactDensity, follow, asking: () => asking !== null };
})();
