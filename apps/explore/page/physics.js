/* The chain: hard rods on springs, kicked by noise, that collide. One step is that of the package
   (particles/stepping.py): half a kick, free flight with collisions, half a kick. Elastic rods on
   linear springs with one anchor are flown exactly (particles/laws/exact_flight.py). In the reduced
   coordinate y_i = x_i - 2R (i - (L+1)/2) rods are points that may touch but not pass. */
"use strict";

const ChainPhysics = (() => {
  const { RADIUS, MASS, STIFFNESS, exponent, pull, freeWidth, timeStep, propagator } = ChainScales;
  // Stronger kicks of rods in contact make up for having one kick a step only, up to the restitution
  // at which contacts still collapse (docs/particles.md).
  const CLOSED_KICK = 1.224, CRITICAL_RESTITUTION = Math.exp(-Math.PI / Math.sqrt(3));
  const FIRST = 0, WHOLE = 1, LAST = 2; // parts of a kick

  /* Normal random numbers by Box and Muller, from the uniform ones of Chris Doty-Humphrey's sfc32. */
  function makeNoise(seed) {
    let a = 0x9e3779b9, b = 0x243f6a88, c = seed | 0, counter = 1, spare = null;
    function uniform() {
      const mixed = (((a + b) | 0) + counter) | 0;
      counter = (counter + 1) | 0;
      a = b ^ (b >>> 9);
      b = (c + (c << 3)) | 0;
      c = (((c << 21) | (c >>> 11)) + mixed) | 0;
      return ((mixed >>> 0) + 0.5) / 4294967296;
    }
    for (let k = 0; k < 20; k++) uniform(); // until every bit depends on the seed
    return function normal() {
      if (spare !== null) {
        const kept = spare;
        spare = null;
        return kept;
      }
      const radius = Math.sqrt(-2 * Math.log(uniform())), angle = 2 * Math.PI * uniform();
      spare = radius * Math.sin(angle);
      return radius * Math.cos(angle);
    };
  }

  /* Rods at rest at their anchors. `held`: the rod in a hand, or -1. `met`: where rods have met,
     until the reader clears it. */
  function makeState(chain, seed) {
    const size = chain.size;
    const state = {
      y: new Float64Array(size), v: new Float64Array(size), anchors: new Float64Array(size),
      kicks: new Float64Array(size), due: new Float64Array(size), joined: new Uint8Array(size),
      met: new Uint8Array(size),
      held: -1, time: 0, collisions: 0, diverged: false, normal: makeNoise(seed),
    };
    setChain(state, chain);
    state.y.set(state.anchors);
    return state;
  }

  /* Go on with other parameters: rods keep their places and velocities. */
  function setChain(state, chain) {
    state.chain = { ...chain };
    const middle = (chain.size - 1) / 2;
    for (let i = 0; i < chain.size; i++) state.anchors[i] = chain.gap * (i - middle);
  }

  /* Whether the rods are independent oscillators that swap names when they meet. */
  const independent = ({ chain, held }) =>
    chain.restitution === 1 && chain.gap === 0 && exponent(chain) === 2 && held < 0;

  const position = (state, i) => state.y[i] + 2 * RADIUS * (i - (state.y.length - 1) / 2);

  /* The exact decay and noise of a velocity under damping and noise alone. */
  function ornsteinUhlenbeck(chain, duration) {
    const rate = (2 * chain.damping * duration) / MASS;
    const variance = (chain.amplitude / MASS) ** 2 * duration * (-Math.expm1(-rate) / rate);
    return { decay: Math.exp(-rate / 2), noise: Math.sqrt(variance) };
  }

  /* The numbers of one step. A kick is done by halves only before and after what is looked at. */
  function makeStep(chain, duration) {
    const whole = ornsteinUhlenbeck(chain, duration), half = ornsteinUhlenbeck(chain, duration / 2);
    const sticking = chain.restitution < CRITICAL_RESTITUTION;
    const closed = sticking ? CLOSED_KICK : 1, speed = freeWidth(chain) || 1;
    const kick = (chain.amplitude / MASS) * Math.sqrt(duration);
    return {
      duration, whole, half, closed,
      // The last half kick was as strong as all others. This one makes up for that.
      closedHalf: Math.sqrt(closed ** 2 + half.decay ** 2 * (closed ** 2 - 1)),
      pull: (STIFFNESS * duration) / (2 * MASS),
      // Rods that would separate more slowly than this stay together until the end of the step.
      mergeSpeed: chain.restitution < 1 ? Math.max((sticking ? 0.03 : 0.1) * kick, 1e-9 * speed) : 0,
    };
  }

  function kick(state, step, part) {
    const { y, v, anchors, kicks } = state;
    const { decay, noise } = part === WHOLE ? step.whole : step.half;
    const before = part === FIRST ? 0 : step.pull, after = part === LAST ? 0 : step.pull;
    const n = exponent(state.chain);
    for (let i = 0; i < y.length; i++) kicks[i] = state.normal();
    if (part !== LAST && step.closed > 1)
      strengthen(y, kicks, part === FIRST ? step.closedHalf : step.closed);
    for (let i = 0; i < y.length; i++) {
      if (i === state.held) continue;
      const force = pull(y[i] - anchors[i], n);
      v[i] = decay * (v[i] - before * force) - after * force + noise * kicks[i];
    }
  }

  /* Multiply the deviations of the kicks from the mean of the rods in contact; momentum stays. */
  function strengthen(y, kicks, strength) {
    for (let first = 0, last = 1; first < y.length; first = last++) {
      let total = kicks[first];
      while (last < y.length && y[last] === y[first]) total += kicks[last++];
      const mean = total / (last - first);
      if (last - first > 1)
        for (let i = first; i < last; i++) kicks[i] = mean + strength * (kicks[i] - mean);
    }
  }

  /* e = 1: points exchange their velocities, as if they passed each other and exchanged names. */
  function sort(state) {
    const { y, v, met } = state;
    for (let i = 1; i < y.length; i++) {
      const here = y[i], speed = v[i];
      let j = i;
      for (; j > 0 && y[j - 1] > here; j--) {
        y[j] = y[j - 1];
        v[j] = v[j - 1];
        met[j - 1] = 1;
        state.collisions++;
      }
      y[j] = here;
      v[j] = speed;
    }
  }

  /* Fly independent rods over any time, exactly. */
  function flyExactly(state, { yy, yv, vy, vv, noise, shared, own }) {
    const { y, v, normal } = state;
    for (let i = 0; i < y.length; i++) {
      const kick = normal(), here = y[i], speed = v[i];
      y[i] = yy * here + yv * speed + shared * kick + own * normal();
      v[i] = vy * here + vv * speed + noise * kick;
    }
    sort(state);
  }

  /* Any e: the contact that closes first, then the next. y holds where a point with its velocity
     would have been at the beginning: none moves before the end. */
  function driftInOrder(state, step) {
    const { y, v, due, joined } = state, contacts = y.length - 1;
    const most = 1000 * y.length; // with more collisions in one step the chain has run away
    joined.fill(0);
    for (let c = 0; c < contacts; c++) due[c] = meeting(y, v, c, 0, step.duration);
    for (let met = 0; ; met++) {
      const contact = first(due, v, contacts), now = due[contact];
      if (!(now < Infinity)) break;
      if (met > most) {
        state.diverged = true;
        break;
      }
      const [a, b] = collide(state, contact, now, step);
      due[contact] = Infinity; // the two now separate or move as one
      if (a > 0) due[a - 1] = meeting(y, v, a - 1, now, step.duration);
      if (b < contacts) due[b] = meeting(y, v, b, now, step.duration);
      state.collisions++;
    }
    for (let i = 0; i < y.length; i++) {
      y[i] += step.duration * v[i];
      // Rods that stick lie at the same place to the last bit, and rounding lets none pass.
      if (i > 0 && (joined[i - 1] || y[i] < y[i - 1])) y[i] = y[i - 1];
    }
  }

  /* When rod c and its right neighbour meet, at least `now`; infinity if not within the step. */
  function meeting(y, v, c, now, duration) {
    const closing = v[c] - v[c + 1], distance = y[c + 1] - y[c];
    if (!(closing > 0 && distance < duration * closing)) return Infinity;
    return Math.max(distance / closing, now);
  }

  /* The contact that closes first; of several the one that closes fastest. */
  function first(due, v, contacts) {
    let found = 0;
    for (let c = 1; c < contacts; c++) {
      const faster = due[c] === due[found] && v[c] - v[c + 1] > v[found] - v[found + 1];
      if (due[c] < due[found] || faster) found = c;
    }
    return found;
  }

  /* Let the rods left and right of a contact collide, with all that stick to them. Return the
     outermost rods of the two clusters. */
  function collide(state, contact, now, step) {
    const { y, v, joined, met, held, chain } = state;
    met[contact] = 1;
    let a = contact, b = contact + 1;
    while (a > 0 && joined[a - 1]) a--;
    while (joined[b]) b++;
    const vLeft = v[contact], vRight = v[contact + 1];
    const left = contact - a + 1, right = b - contact;
    // The share of the left side in the change. A hand holds its rod as if it had no end of mass.
    let share = right / (left + right);
    if (held >= a && held <= contact) share = 0;
    if (held > contact && held <= b) share = 1;
    const common = vLeft + (vRight - vLeft) * share;
    // Flippers (e > 1) act when rods meet, not on rods that touch at the beginning of the step.
    const e = now === 0 ? Math.min(chain.restitution, 1) : chain.restitution;
    // With a gap the springs pull differently: this much more by now than the half kick at the
    // beginning, which the one at the end takes back. So the true relative velocity rebounds.
    const alone = a === contact && b === contact + 1 && held !== a && held !== b;
    const ahead = alone && chain.gap > 0
      ? springsAhead(state, contact, y[contact] + vLeft * now, now - step.duration / 2) : 0;
    const rebound = e * (vLeft - vRight - ahead);
    const merges = rebound <= step.mergeSpeed || (rebound <= ahead && e < 1);
    const apart = merges ? 0 : Math.max(rebound - ahead, 0);
    setVelocities(state, a, contact, common - apart * share, now);
    setVelocities(state, contact + 1, b, common + apart * (1 - share), now);
    if (merges) {
      joined[contact] = 1;
      for (let i = a; i <= b; i++) y[i] = y[contact];
    }
    return [a, b];
  }

  /* How much more the springs of two rods that meet `here` give one of them in this time. */
  function springsAhead({ anchors, chain }, contact, here, time) {
    const n = exponent(chain), force = (i) => pull(here - anchors[i], n);
    return (STIFFNESS / MASS) * (force(contact) - force(contact + 1)) * time;
  }

  /* From `now` on the rods `from` to `to` have this velocity. */
  function setVelocities(state, from, to, velocity, now) {
    for (let i = from; i <= to; i++) {
      state.y[i] += (state.v[i] - velocity) * now;
      state.v[i] = velocity;
    }
  }

  /* Take so many steps of this duration. The state is that in the middle of a kick. */
  function advance(state, duration, steps) {
    state.time += duration * steps;
    if (independent(state)) {
      const step = propagator(state.chain, duration);
      for (let taken = 0; taken < steps; taken++) flyExactly(state, step);
      return;
    }
    const step = makeStep(state.chain, duration);
    for (let taken = 0; taken < steps && !state.diverged; taken++) {
      kick(state, step, taken === 0 ? FIRST : WHOLE);
      driftInOrder(state, step);
    }
    kick(state, step, LAST);
  }

  /* Go on for a time, in as few steps as are good. */
  function go(state, duration) {
    const steps = independent(state) ? 1 : Math.ceil(duration / timeStep(state.chain) - 1e-9);
    advance(state, duration / steps, steps);
  }

  /* Kinetic and spring energy of all rods [M R^2/t_0^2]. */
  function energy(state) {
    const n = exponent(state.chain);
    let total = 0;
    for (let i = 0; i < state.y.length; i++)
      total += (MASS * state.v[i] ** 2) / 2 + (STIFFNESS * Math.abs(state.y[i] - state.anchors[i]) ** n) / n;
    return total;
  }

  return {
    ...ChainScales, makeNoise, makeState, setChain, position, makeStep, advance, go, energy,
  };
})();
