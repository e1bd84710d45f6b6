/* Questions that figures of arXiv:1404.7460 answer: a chain, what to predict, and the answer.
   Chains of 300 and 1000 rods have 100 here, which settle sooner. */
"use strict";

const ChainPresets = (() => {
  const question = (id, title, ask, answer, second, chain, { first = "density", speed = 100 } = {}) => ({
    kind: "preset", id, title, ask, answer, pictures: [first, second], speed,
    chain: { ...ChainAddress.USUAL, ...chain },
  });
  const list = [
    question("middle", "Which rods move least?",
      "At e = 1 all rods move alike. At e = 0 each collision takes energy. Which rods move least then, those at " +
      "the ends or in the middle? Predict, then set e = 0.",
      "Those in the middle, which meet more often: W_v falls from 0.64 W at the ends to 0.22 W.",
      "widths", {}, { first: "velocities" }),
    question("length", "Is a longer chain colder?",
      "Note the velocity width in the middle of 30 rods. What is that of 120? Predict, then change L.",
      "It is: about 0.34 W in the middle of 30 rods and 0.2 W of 120. In the paper it goes as L to the power −0.38.",
      "widths", { size: 30, restitution: 0 }),
    question("loss", "How much does a small loss cool?",
      "At e = 0.95 a collision takes a tenth of the energy of approach. How slow are the rods in the middle, " +
      "and at e = 0.8? Predict, then set e.",
      "A lot, because rods meet often: in the middle W_v is 0.43 W at e = 0.95 and 0.26 W at e = 0.8.",
      "widths", {}),
    question("elastic", "Do elastic collisions leave a trace?",
      "At e = 1 collisions keep the energy. Will the density show them, and will the velocities? Predict both, " +
      "then set e = 1.",
      "The velocities keep the Gaussian of a free rod. The density is flat, with edges, because rods cannot " +
      "overlap. Theory is exact for both.",
      "velocities", { restitution: 0.9, amplitude: 10 }),
    question("tails", "Who is fast above e = 1?",
      "Collisions add energy at e = 1.05. Are large velocities likelier at the ends or in the middle? Predict " +
      "for γ = 4 and for γ = 10, then set e = 1.05.",
      "At γ = 4 at the ends, with an exponential tail, here a straight line. At γ = 10 in the middle, whose rods " +
      "are fed by more collisions.",
      "velocities", { damping: 4 }, { first: "widths" }),
    question("hottest", "Where is it hottest above e = 1?",
      "At e = 1.05 each collision adds energy. Are the ends or the middle hottest? Predict for γ = 5 and for " +
      "γ = 2.5, then set e = 1.05.",
      "At γ = 5 the middle, 1.36 W against 1.15 W, because its rods have more neighbours. At γ = 2.5, where the " +
      "chain nearly runs away, the ends, 2.3 W against 2.1 W. By theory it turns at γ = " +
      `${ChainCurves.turning.damping}.`,
      "widths", { size: 60, damping: 5 }),
    question("growth", "How fast does the energy grow?",
      "At e = 1.01 this chain runs away. Is its energy then a straight line on a logarithmic axis, with linear " +
      "and with quadratic springs? Predict, then set e = 1.01, and change the springs.",
      "With linear springs it is. With quadratic ones fast rods meet more often: the line curves upwards, and " +
      "the energy becomes infinite after a finite time.",
      "energy", { damping: 0.4 }, { speed: 30 }),
    question("noise", "What does stronger noise change?",
      "What happens to the velocity widths in units of W, and to the density, at A = 6? Predict, then change A.",
      "Velocities, displacements and W grow like A. In units of W the widths stay. The density spreads, " +
      "because the rods do not grow.",
      "widths", { restitution: 0.95, amplitude: 3 }),
    question("gap", "What does a gap change?",
      "Without a gap the middle is coldest. How will the velocity widths look with anchors 0.2 R further apart?" +
      " Predict, then set g = 0.2.",
      "Each rod has few neighbours within reach. So the widths have a plateau, at 0.65 W, and rise at the " +
      "ends only. A wider gap gives a higher plateau.",
      "widths", { restitution: 0.5 }),
  ];
  return { list };
})();
