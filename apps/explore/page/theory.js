/* What theory knows of a chain: exactly at e = 1, from stored curves, or from the server. */
"use strict";

const ChainTheory = (() => {
  let solved = null, asking = null;
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

  /* {short, said, widths, density, other} of the chain, or null; widths in free widths. */
  function of(chain) {
    if (solved && ChainAddress.same(solved.chain, chain)) return solved;
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
    return { short: "theory", said: stated(found), widths: [...found.half, ...other] };
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

  /* Ask the server for the best theory of a chain, and `show(text)` of it meanwhile and in the end. */
  async function ask(chain, address, show) {
    const stop = new AbortController(), begun = performance.now();
    asking = { chain, stop };
    const clock = () => show(`Being solved, ${Math.round((performance.now() - begun) / 1000)} s.`);
    const ticking = setInterval(clock, 1000);
    clock();
    let said = "";
    try {
      const query = new URLSearchParams(ChainAddress.SPRUNG.map((name) => [name, chain[name]]));
      const wanted = { signal: stop.signal, headers: { "X-Requested-With": "chain" } };
      const answer = await (await fetch(`${address}?${query}`, wanted)).json();
      said = answer.refused ? `No theory: ${answer.refused}` : take(chain, answer);
    } catch (error) {
      said = error.name === "AbortError" ? "" : "The server does not answer.";
    }
    clearInterval(ticking);
    if (asking?.stop === stop) asking = null;
    show(said);
  }

  /* Stop asking; the server notices and stops too. */
  function abort() {
    asking?.stop.abort();
    asking = null;
  }

  /* Keep an answer of the server: the best theory and, at e = 1, the force balance beside it. */
  function take(chain, { best, other }) {
    const said = [best, other].filter(Boolean).map(stated).join(" ");
    solved = {
      chain: { ...chain }, said, widths: best.widths, density: best.density,
      short: best.error === 0 ? "exact" : "theory",
      other: other && { short: other.title, density: other.density },
    };
    return said;
  }

  return { of, exactDensity, ask, abort, asked: () => asking?.chain };
})();
