/* The chains of the questions that figures of arXiv:1404.7460 answer, which chain.html asks. Chains of
   300 and 1000 rods have 100 or 200 here, which settle sooner. */
"use strict";

const ChainPresets = (() => {
  const question = (id, second, chain, { first = "density", speed = 100 } = {}) => ({
    kind: "preset", id, pictures: [first, second], speed, chain: { ...ChainAddress.USUAL, ...chain },
  });
  const list = [
    question("middle", "widths", {}, { first: "velocities" }),
    question("length", "widths", { size: 30, restitution: 0 }),
    question("loss", "widths", {}),
    question("elastic", "velocities", { restitution: 0.9, amplitude: 10 }),
    question("tails", "velocities", { damping: 4 }, { first: "widths" }),
    question("hottest", "widths", { size: 60, damping: 5 }),
    question("growth", "energy", { damping: 0.4 }, { speed: 30 }),
    question("noise", "widths", { restitution: 0.95, amplitude: 3 }),
    question("gap", "widths", { restitution: 0.5 }),
  ];
  return { list };
})();
