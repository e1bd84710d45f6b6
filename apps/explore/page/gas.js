/* A gas: rods of one or two masses between two walls, without springs, damping and noise. All
   collisions keep the energy, and the rods are flown exactly from one to the next.

   As in physics.js the rods are points that may touch but not pass, here between walls at -l/2 and
   l/2, where l = X - 2RL is what the rods leave free of the box X. */
"use strict";

const ChainGas = (() => {
  const { freeLength, masses, makeNoise } = ChainPhysics;

  /* All rods with the speed 1 R/t_0, to the left or right at random. Of two rods the light one rests,
     and the heavy one comes towards it. `impulse`: the momentum that both walls got; `series`: how
     often two rods met or met the walls until the second one first reached the right wall. */
  function makeState(chain, seed) {
    const { size } = chain, free = freeLength(chain), normal = makeNoise(seed);
    const state = {
      chain: { ...chain }, y: new Float64Array(size), v: new Float64Array(size).fill(-1), masses: masses(chain),
      due: new Float64Array(size + 1), met: new Uint8Array(size), held: -1, time: 0, collisions: 0,
      impulse: 0, hits: [0, 0], series: null, diverged: false,
    };
    if (size === 2) {
      state.y.set([free / 28 - free / 2, free / 18 - free / 2]);
      state.v[0] = 0;
      return state;
    }
    // The spaces between points at random are as exponential random numbers.
    const spaces = Array.from({ length: size + 1 }, () => normal() ** 2 + normal() ** 2);
    const scale = free / spaces.reduce((sum, space) => sum + space);
    for (let i = 0, y = -free / 2; i < size; i++) {
      state.y[i] = y += scale * spaces[i];
      if (normal() > 0) state.v[i] = 1;
    }
    return state;
  }

  /* When the neighbours of contact c meet, at least `now`; infinity if never. Contact 0 is that of the
     first rod with the left wall, contact L that of the last rod with the right wall. y holds where a
     point with its present velocity would have been at the beginning. */
  function meeting({ y, v }, c, now, half) {
    const from = c > 0 ? y[c - 1] : -half, to = c < y.length ? y[c] : half;
    const closing = (c > 0 ? v[c - 1] : 0) - (c < y.length ? v[c] : 0);
    return closing > 0 ? Math.max((to - from) / closing, now) : Infinity;
  }

  /* Let two rods collide, or a rod with a wall, which has no end of mass. */
  function collide(state, c, now) {
    const { v, masses: m, hits } = state, last = v.length;
    if (c > 0 && c < last) {
      const common = (m[c - 1] * v[c - 1] + m[c] * v[c]) / (m[c - 1] + m[c]);
      turn(state, c - 1, 2 * common - v[c - 1], now);
      turn(state, c, 2 * common - v[c], now);
      state.met[c - 1] = 1;
      state.collisions++;
      return;
    }
    const rod = c ? last - 1 : 0;
    state.impulse += 2 * m[rod] * Math.abs(v[rod]);
    turn(state, rod, -v[rod], now);
    hits[c ? 1 : 0]++;
    if (c && state.series === null) state.series = state.collisions + hits[0];
  }

  function turn({ y, v }, i, velocity, now) {
    y[i] += (v[i] - velocity) * now;
    v[i] = velocity;
  }

  /* Fly over a time from collision to collision. */
  function go(state, duration) {
    const { y, v, due } = state, half = freeLength(state.chain) / 2;
    for (let c = 0; c <= y.length; c++) due[c] = meeting(state, c, 0, half);
    for (;;) {
      let next = 0;
      for (let c = 1; c <= y.length; c++) if (due[c] < due[next]) next = c;
      const now = due[next];
      if (!(now <= duration)) break;
      collide(state, next, now);
      due[next] = Infinity; // the two now separate
      if (next > 0) due[next - 1] = meeting(state, next - 1, now, half);
      if (next < y.length) due[next + 1] = meeting(state, next + 1, now, half);
    }
    for (let i = 0; i < y.length; i++) // rounding lets none pass
      y[i] = Math.min(Math.max(y[i] + duration * v[i], i > 0 ? y[i - 1] : -half), half);
    state.time += duration;
  }

  /* The mean force on a wall since one looked last, `elapsed` ago, and the kurtosis of the velocities
     in units of each mass's own width: 1 if all energies are equal, 3 of Maxwell's distribution. */
  function seen(state, elapsed) {
    const force = state.impulse / (2 * elapsed), energies = state.masses.map((m, i) => m * state.v[i] ** 2);
    state.impulse = 0;
    const sum = (of) => energies.reduce((total, each) => total + of(each), 0);
    return [force, (energies.length * sum((each) => each ** 2)) / sum((each) => each) ** 2];
  }

  const energy = ({ masses: m, v }) => v.reduce((sum, each, i) => sum + (m[i] * each ** 2) / 2, 0);

  /* The force on a wall by the exact law, L T/(X - 2RL), with the mean energy T/2 of a rod. */
  const law = (state) => (2 * energy(state)) / freeLength(state.chain);

  /* The line of 1/force against the box, by weighted least squares: where it begins, its slope, and
     of the length of a rod, which is that place over L, the value and error. Null if there is none. */
  function line(forces) {
    if (forces.length < 2) return null;
    const points = forces.map(({ chain, value, error }) =>
      ({ x: chain.box, y: 1 / value, weight: (value ** 2 / Math.max(error, 1e-9 * value)) ** 2 }));
    const sum = (of) => points.reduce((total, each) => total + each.weight * of(each), 0);
    const all = sum(() => 1), x = sum((each) => each.x) / all, y = sum((each) => each.y) / all;
    const spread = sum((each) => (each.x - x) ** 2), slope = sum((each) => (each.x - x) * each.y) / spread;
    const start = x - y / slope, { size } = forces[0].chain;
    const error = Math.sqrt(1 / all + (start - x) ** 2 / spread) / slope;
    return { start, slope, value: start / size, error: error / size };
  }

  return { makeState, go, seen, energy, law, line };
})();
