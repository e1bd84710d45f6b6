/* The chains of the questions that figures of arXiv:1404.7460 answer, which chain.html asks. Chains of
   300 and 1000 rods have 100 or 200 here, which settle sooner. */
"use strict";

const ChainPresets = (() => {
  const WIDTHS = { picture: "widths", y: [0, 1.5] }, SPEEDS = { picture: "velocities", x: [-6, 6], y: [-4.2, 0.4] };
  const question = (id, predict, chain, then, { first = "density", speed = 100 } = {}) => ({
    kind: "preset", id, predict: { ...predict, then }, pictures: [first, predict.picture], speed,
    chain: { ...ChainAddress.USUAL, ...chain },
  });
  const list = [
    question("middle", WIDTHS, {}, { restitution: 0 }, { first: "velocities" }),
    question("length", WIDTHS, { size: 30, restitution: 0 }, { size: 120 }),
    question("loss", WIDTHS, {}, { restitution: 0.95 }),
    question("elastic", SPEEDS, { restitution: 0.9, amplitude: 10 }, { restitution: 1 }),
    question("tails", { ...SPEEDS, of: "ends" }, { damping: 4 }, { restitution: 1.05 }, { first: "widths" }),
    question("hottest", { picture: "widths", y: [0, 3] }, { size: 60, damping: 5 }, { restitution: 1.05 }),
    question("growth", { picture: "energy", x: [0, 150], y: [-1, 3] }, { damping: 0.4 }, { restitution: 1.01 },
      { speed: 30 }),
    question("noise", WIDTHS, { restitution: 0.95, amplitude: 3 }, { amplitude: 6 }),
    question("gap", WIDTHS, { restitution: 0.5 }, { gap: 0.2 }),
  ];
  return { list };
})();
