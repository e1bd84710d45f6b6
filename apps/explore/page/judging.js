/* Verdicts on averages. Whoever looks all the time is misled in the end. So a verdict falls at a few
   fixed times only, and by so many errors that fewer than one in a hundred is wrong. */
"use strict";

const ChainJudging = (() => {
  const LOOKS = [40, 80, 160, 320, 640]; // blocks of time, nearly independent, after which is decided
  const SURE = 3.5; // standard errors

  /* Is a mean above `limit`? `estimate(n)` is {value, error} of the first n of so many blocks. Return
     {above, value, error} of the first look that was clear, or {next} of the look that is waited for,
     in blocks: infinity if the last one was not clear either. */
  function verdict(blocks, estimate, limit) {
    for (const look of LOOKS) {
      if (look > blocks) return { next: look };
      const { value, error } = estimate(look);
      if (Math.abs(value - limit) > SURE * error) return { above: value > limit, value, error };
    }
    return { next: Infinity };
  }

  /* A verdict on what is measured, in words; `blockTime` in T. */
  function told({ next, above, value, error }, limit, { time, blockTime }) {
    if (above !== undefined)
      return `${value.toFixed(2)} ± ${error.toFixed(2)}, clearly ${above ? "above" : "below"} ${limit}`;
    if (next === Infinity) return `too close to ${limit} to tell in this time: change the chain`;
    return `measured for ${Math.round(time)} T, and the next verdict falls at ${Math.round(next * blockTime)} T`;
  }

  return { verdict, told };
})();
