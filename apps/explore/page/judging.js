/* Verdicts on averages. Whoever looks all the time is misled in the end. So they fall at few fixed times,
   and by so many errors that fewer than one in a hundred is wrong. */
"use strict";

const ChainJudging = (() => {
  const LOOKS = [40, 80, 160, 320, 640]; // blocks of time, nearly independent, after which is decided
  const SURE = 3.5; // standard errors

  /* Is a mean above `limit`? `estimate(n)` is {value, error} of the first n blocks. Return {above, value,
     error} of the first clear look, or {next}, the blocks of the next look: infinity after the last. */
  function verdict(blocks, estimate, limit) {
    for (const look of LOOKS) {
      if (look > blocks) return { next: look };
      const { value, error } = estimate(look);
      if (Math.abs(value - limit) > SURE * error) return { above: value > limit, value, error };
    }
    return { next: Infinity };
  }

  /* A verdict on what is measured, in words; `blockTime` in t_0. */
  function told({ next, above, value, error }, limit, { time, blockTime }) {
    if (above !== undefined)
      return `${value.toFixed(2)} ± ${error.toFixed(2)}, clearly ${above ? "above" : "below"} ${limit}`;
    if (next === Infinity) return `too close to ${limit} to tell in this time: change the chain`;
    return `measured for ${Math.round(time)} t₀, and the next verdict falls at ${Math.round(next * blockTime)} t₀`;
  }

  return { verdict, told };
})();
