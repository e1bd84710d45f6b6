/* What figures of arXiv:1404.7460 show: a chain, and what to look for. Chains of 300 and 1000 rods
   have 100 or 200 here, which settle sooner. */
"use strict";

const ChainPresets = (() => {
  const preset = (figure, title, ask, picture, chain, speed = 30) => ({
    title: `${title} (figure ${figure})`, ask, picture, speed, chain: { ...ChainAddress.USUAL, ...chain },
  });
  const list = [
    preset(2, "The middle rods are slower", "The middle rods have a narrower distribution than the outermost " +
      "ones, and both are narrower than a free rod's.", "velocities", { restitution: 0 }),
    preset(3, "Collisions cool the middle", "The velocity width is largest at the ends and falls off towards " +
      "the middle.", "widths", { size: 200, restitution: 0 }),
    preset(4, "Longer chains are colder", "Note the velocity width in the middle, then change L: the longer the " +
      "chain, the colder its middle. The paper sees a power law, L to the power −0.38.", "widths",
      { size: 30, restitution: 0 }),
    preset(7, "A small loss cools a lot", "Lower e from 0.95 and the velocity widths in the middle fall: each " +
      "collision then takes more energy.", "widths", { restitution: 0.95 }),
    preset(8, "A Gaussian at e = 1", "Elastic collisions leave no trace in the velocities: all symbols lie on " +
      "the Gaussian of a free rod.", "velocities", {}),
    preset(10, "The ends have heavy tails", "Every collision adds energy: all rods are faster than a free rod, " +
      "and the tail of the outermost ones is a straight line, an exponential.", "velocities",
      { restitution: 1.05, damping: 4 }),
    preset(11, "The middle is faster", "With strong damping the large velocities are likelier in the middle, " +
      "where more collisions feed the rods.", "velocities", { restitution: 1.05, damping: 10 }),
    preset(14, "A short chain: hot middle", "In this short chain the middle is fastest; raise L to 100 and the " +
      "ends are.", "widths", { size: 25, restitution: 1.05, damping: 4 }),
    preset(15, "Energy grows exponentially", "The energy is a straight line on its logarithmic axis until the " +
      "chain has run away.", "energy", { restitution: 1.01, damping: 0.4 }, 3),
    preset(15, "Energy becomes infinite", "The energy curves upwards on its logarithmic axis: it becomes " +
      "infinite after a finite time.", "energy", { restitution: 1.01, damping: 0.4, spring: "quadratic" }, 3),
    preset(17, "Theory meets simulation", "The simulation lies on the exact density. Solve the theory to see that " +
      "the force balance misses it at the edges only.", "density", { amplitude: 10 }),
    preset(18, "Noise only sets the scale", "Change A: velocities and displacements grow like A, and the " +
      "velocity widths keep their shape.", "widths", { restitution: 0.95, amplitude: 3 }),
    preset(19, "A gap makes a plateau", "With a gap the velocity widths have a plateau in the middle; the wider " +
      "the gap, the wider the plateau.", "widths", { size: 200, restitution: 0.95, gap: 0.2 }),
  ];
  return { list };
})();
