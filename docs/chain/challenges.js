/* Four challenges. The page checks them on the running chain, and says what it has measured. */
"use strict";

const ChainChallenges = (() => {
  const P = ChainPhysics;
  const ARRIVED = 4; // free velocity widths that noise alone hardly ever gives to a rod
  const SURE = 3; // standard errors
  const BLOCKS = 20; // independent stretches of time that an average needs
  const FEW = 15; // rods
  const HOTTER = 3; // times the kinetic energy in the centre
  const CLOSE = 1; // damping between a convex and a concave profile

  const rounded = (value, digits = 2) => Number(value.toPrecision(digits)).toString();

  /* What is known of the ratio of kinetic energies, in words. */
  function told(world) {
    const { measurement } = world, ratio = measurement.ratio();
    if (!measurement.settled) return `settling for another ${Math.ceil(measurement.settling)} T`;
    if (!ratio || ratio.blocks < BLOCKS)
      return `measuring: ${ratio ? ratio.blocks : 0} of ${BLOCKS} stretches of ` +
        `${Math.round(measurement.blockTime)} T`;
    return `border over centre: ${ratio.value.toFixed(2)} ± ${ratio.error.toFixed(2)}, ` +
      `measured for ${Math.round(measurement.time)} T`;
  }

  /* The ratio, if it was measured for long enough to be believed. */
  function measured(world) {
    const ratio = world.measurement.settled ? world.measurement.ratio() : null;
    return ratio && ratio.blocks >= BLOCKS ? ratio : null;
  }

  const push = {
    title: "A push",
    chain: { size: 20, restitution: 1, amplitude: 1, damping: 0.3, gap: 0.5 },
    speed: 3,
    ask: "Push the left end, once at e = 1 and once at e = 0.9. Does the push arrive at the right end?",
    pushes: { 1: [], 0.9: [] },
    watch(world) {
      const done = world.pushes.splice(0).filter((each) => each.size >= 20 && each.rod === 0);
      for (const each of done) this.pushes[each.restitution]?.push(each.fastest);
      const say = (e) => {
        const all = this.pushes[e], arrived = all.filter((fastest) => fastest >= ARRIVED).length;
        if (!all.length) return `e = ${e}: no push has ended yet.`;
        return `e = ${e}: ${arrived} of ${all.length} arrived; the last rod reached ` +
          `${all[all.length - 1].toFixed(1)}\u00a0W.`;
      };
      const ends = this.pushes[1].some((fastest) => fastest >= ARRIVED) &&
        this.pushes[0.9].some((fastest) => fastest < ARRIVED);
      return {
        done: ends,
        said: `${say(1)} ${say(0.9)} A push has arrived if the last rod reaches ${ARRIVED}\u00a0W.` +
          (ends ? " Elastic rods hand on all of a push. At e = 0.9 each collision keeps a part back." : ""),
      };
    },
  };

  const runaway = {
    title: "Run away",
    chain: { size: 40, restitution: 1.02, amplitude: 1, damping: 1, gap: 0 },
    speed: 30,
    ask: `Above e = 1 each collision adds energy. Make the chain run away with ${FEW} rods or fewer.`,
    fewest: Infinity,
    watch(world) {
      const { chain } = world.state;
      if (world.ranAway && chain.size < this.fewest) this.fewest = chain.size;
      const growth = `the energy is ${rounded(world.growth)} times that of free rods`;
      const now = world.ranAway ? `${chain.size} rods have run away` : growth;
      const done = this.fewest <= FEW;
      const critical = (Math.PI * chain.damping) /
        (Math.sqrt(P.STIFFNESS * P.MASS) * (chain.restitution - 1));
      const theory = done && chain.restitution > 1
        ? ` Theory, for weak damping: more than π γ/((e − 1)√(km)) = ${rounded(critical)} rods run away.`
        : "";
      const fewest = Number.isFinite(this.fewest) ? ` Fewest so far: ${this.fewest}.` : "";
      return { done, said: `Now ${now}.${fewest}${theory}` };
    },
  };

  const border = {
    title: "Hot ends",
    chain: { size: 20, restitution: 0.9, amplitude: 1, damping: 1, gap: 0 },
    speed: 100,
    ask: `Make the two outermost rods hotter than the centre: ${HOTTER} times the kinetic energy.`,
    best: null,
    watch(world) {
      const ratio = measured(world);
      if (ratio && ratio.value - SURE * ratio.error > HOTTER) this.best = ratio;
      return {
        done: this.best !== null,
        said: `Now ${told(world)}.` + (this.best
          ? ` Done: ${this.best.value.toFixed(1)} ± ${this.best.error.toFixed(1)}. Rods in the ` +
            "middle meet more neighbours, and each collision takes energy."
          : ` It counts when it is above ${HOTTER} by ${SURE} standard errors.`),
      };
    },
  };

  const turning = {
    title: "Convex or concave",
    chain: { size: 60, restitution: 1.05, amplitude: 1, damping: 5, gap: 0 },
    speed: 100,
    ask: "With this damping the middle is hottest: a concave profile of velocity widths. Find two " +
      `dampings, at most ${CLOSE} apart, between which it turns convex, with hotter ends.`,
    convex: -Infinity, // the largest damping that was found convex
    concave: Infinity, // the smallest that was found concave
    watch(world) {
      const ratio = measured(world), { chain } = world.state;
      const same = ["size", "restitution", "gap"].every((name) => chain[name] === this.chain[name]);
      if (same && ratio) {
        const off = (ratio.value - 1) / ratio.error;
        if (off > SURE) this.convex = Math.max(this.convex, chain.damping);
        if (off < -SURE) this.concave = Math.min(this.concave, chain.damping);
      }
      const found = (name) => (Number.isFinite(this[name]) ? `${name} at γ = ${this[name]}` : "");
      const both = [found("convex"), found("concave")].filter(Boolean).join(", ");
      const apart = this.concave - this.convex;
      const done = apart > 0 && apart <= CLOSE + 1e-9;
      return {
        done,
        said: (same ? `Now ${told(world)}.` : "Another chain than that of the challenge.") +
          ` Found: ${both || "nothing yet"}.` +
          (done ? ` Theory: it turns at γ = ${ChainCurves.turning.damping}.` : ""),
      };
    },
  };

  return { list: [push, runaway, border, turning], ARRIVED };
})();
