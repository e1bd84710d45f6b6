/* The chain in time: it is begun, changed, pushed, held, and goes on row by row of its strip. */
"use strict";

const ChainRunning = (() => {
  const P = ChainPhysics;
  const ROWS_A_SECOND = 60; // of the strip
  const PATIENCE = 250; // milliseconds in which a new chain may settle before it is shown
  const KICK = 8; // free velocity widths that a push adds
  const FASTEST_HAND = 16; // free velocity widths
  const RUN_AWAY = 1000; // times the energy after the last touch
  const SEEN = 3; // the largest speed [t_0/s] at which a push and single collisions can be followed
  const SLOW = 0.3; // t_0/s
  const KEPT = 800; // energies of the history
  const GAUGED = 10; // blocks after which the force on the walls is kept
  const GROWN = 10; // times the energy of free rods: beyond, noise hardly counts

  // `touched`: the energy after the last touch, `since` when it was. `met`: the contacts that have closed in the last row.
  // `forces`: {chain, value, error} of the force on the walls of the gas in several boxes.
  const world = {
    state: null, measurement: null, speed: SEEN, pushes: [], pushed: null, ranAway: false, growth: 1, touched: 0,
    since: 0, history: [], met: [], forces: [],
  };
  let stage = null, seed = 0, stride = 1, skipped = 0, before = new Set();

  // The unit of velocities. Without noise it is that of the weakest usual noise.
  const unit = () => P.freeWidth(world.state.chain) || P.freeWidth({ ...world.state.chain, amplitude: 1 });
  const freeEnergy = () => {
    const { chain } = world.state; // <k |d|^n/n> of a free rod is T/n
    return chain.size * P.MASS * unit() ** 2 * (1 / 2 + 1 / P.exponent(chain));
  };

  const laws = () => (world.state.masses ? ChainGas : P);

  /* A new chain. Up to e = 1 it has settled before it is shown; above it might run away. A gas shows
     how it begins. */
  function begin(chain) {
    const gas = P.isGas(chain), reach = ChainDrawing.reach(chain);
    world.state = (gas ? ChainGas : P).makeState(chain, ++seed);
    world.hand = null; // it held a rod of the chain before
    world.measurement = new ChainMeasuring.Measurement(world.state, gas ? reach : 1.5 * reach);
    const [same] = world.forces, alike = ["size", "spring", "mass_ratio"];
    if (same && alike.some((name) => same.chain[name] !== chain[name])) world.forces = [];
    if (chain.restitution <= 1 && !gas) settle(4 * P.relaxationTime(chain));
    else changed();
  }

  /* Let the chain settle before it is shown; what takes too long to compute is left over. */
  function settle(due) {
    const quarter = P.relaxationTime(world.state.chain) / 4, begun = performance.now();
    for (; due > 0 && performance.now() - begun < PATIENCE; due -= quarter) laws().go(world.state, quarter);
    changed();
    world.measurement.settling = due;
    // The strip is full from the beginning, unless this would show nothing.
    if (world.speed <= SEEN) for (let row = 0; row < ChainDrawing.ROWS; row++) goOn();
  }

  /* Go on with other parameters, but as many rods. */
  function change(chain) {
    P.setChain(world.state, chain);
    changed();
  }

  /* The chain was touched or changed: averages, the push under way and the growth begin anew. */
  function changed(sameChain = false) {
    world.pushed = null;
    world.ranAway = false;
    world.measurement.restart(world.state);
    const energy = laws().energy(world.state);
    world.touched = Math.max(energy, freeEnergy());
    world.growth = energy / freeEnergy();
    world.since = world.state.time;
    world.history = [[0, world.growth, 0]];
    stride = 1;
    if (!sameChain) stage.restart(world.state.chain);
  }

  /* Go on for one row of the strip. */
  function goOn() {
    const { state, measurement, pushed } = world, duration = world.speed / ROWS_A_SECOND;
    if (world.hand) follow(duration);
    state.met.fill(0);
    laws().go(state, duration);
    measurement.add(state, duration, unit());
    if (state.masses && measurement.blocks.length === GAUGED) gauge();
    const met = new Set();
    state.met.forEach((closed, contact) => closed && met.add(contact));
    world.met = [...met].filter((contact) => !before.has(contact)); // others are still in contact
    before = met;
    stage.add(state, unit(), world.speed <= SEEN ? world.met : null);
    const energy = laws().energy(state);
    world.growth = energy / freeEnergy();
    remember();
    if (state.diverged || (state.chain.restitution > 1 && energy > RUN_AWAY * world.touched)) world.ranAway = true;
    if (!pushed) return;
    pushed.fastest = Math.max(pushed.fastest, state.v.at(-1) / unit());
    if (state.time < pushed.until) return;
    world.pushes.push(pushed);
    world.pushed = null;
  }

  /* Keep the force on the walls of this box, once for each box of a gas. */
  function gauge() {
    const { chain } = world.state, others = world.forces.filter((each) => each.chain.box !== chain.box);
    world.forces = [...others, { chain, ...world.measurement.force() }].sort((a, b) => a.chain.box - b.chain.box);
  }

  /* Keep the energy; of a long time every second, fourth, ... one. */
  function remember() {
    if (++skipped < stride) return;
    skipped = 0;
    const { time, collisions, hits } = world.state;
    world.history.push([time - world.since, world.growth, collisions + (hits?.[0] ?? 0)]);
    if (world.history.length <= KEPT) return;
    world.history = world.history.filter((_, k) => k % 2 === 0);
    stride *= 2;
  }

  /* Go on in slow motion until rods meet, and return where. */
  function step() {
    setSpeed(SLOW);
    for (let row = 0; row < 4000 && !world.ranAway; row++) {
      goOn();
      if (world.met.length) return world.met;
    }
    return [];
  }

  /* Add a velocity to a rod, to the right. Calmly: the chain settles before, if it has a steady state. */
  function push(rod, calmly = false) {
    if (world.ranAway) return;
    const { state, measurement } = world, { chain } = state, speedUp = KICK * unit();
    if (calmly && !measurement.settled && chain.restitution <= 1) settle(measurement.settling);
    const { settled } = measurement;
    state.v[rod] += speedUp;
    changed(true);
    // Twice the time in which a rod of this speed would cross the free space.
    const space = chain.gap * (chain.size - 1) + 4 * P.thermalLength(chain);
    const until = state.time + (2 * space) / speedUp;
    world.pushed = { rod, chain: { ...chain }, settled, fastest: 0, until };
    if (world.speed > SEEN) setSpeed(SEEN);
  }

  function setSpeed(value) {
    if (value === world.speed) return;
    world.speed = value;
    if (world.state) stage.restart(world.state.chain); // its rows are apart by another time
  }

  /* Hold the rod nearest to a place, at most so far from it; time: of the event [ms]. */
  function take(x, away, time) {
    const { state } = world, distance = (i) => Math.abs(P.position(state, i) - x);
    let rod = 0;
    for (let i = 1; i < state.y.length; i++) if (distance(i) < distance(rod)) rod = i;
    if (world.ranAway || state.masses || distance(rod) > away) return false;
    world.hand = { rod, offset: P.position(state, rod) - x, x: P.position(state, rod), since: time };
    state.held = rod;
    return true;
  }

  /* Let the held rod move towards the hand. */
  function follow(duration) {
    const { state, hand } = world, most = FASTEST_HAND * unit();
    const speedUp = (hand.x - P.position(state, hand.rod)) / duration;
    state.v[hand.rod] = Math.min(Math.max(speedUp, -most), most);
  }

  /* Let the rod go; a short touch of it was a push. */
  function letGo(short) {
    const { rod } = world.hand;
    world.hand = null;
    world.state.held = -1;
    if (short) push(rod);
    else changed(true);
  }

  /* Above e = 1: the rate at which the energy has grown, by least squares. */
  function growthRate() {
    const points = world.history.filter(([, growth]) => growth > GROWN), n = points.length;
    if (n < 5 || world.state.chain.spring !== "linear") return null;
    const mean = (of) => points.reduce((sum, point) => sum + of(point), 0) / n;
    const t = mean(([time]) => time), log = mean(([, growth]) => Math.log(growth));
    return mean(([time, growth]) => (time - t) * (Math.log(growth) - log)) / mean(([time]) => (time - t) ** 2);
  }

  /* The longest weakly damped chain that does not run away, to first order in e - 1. */
  const criticalSize = ({ restitution, damping }) =>
    (Math.PI * damping) / (Math.sqrt(P.STIFFNESS * P.MASS) * (restitution - 1));

  /* What the chain does, in words. */
  function happening() {
    const { measurement: { settled, settling, time, blocks, blockTime } } = world;
    if (world.ranAway) return `The chain has run away: its energy has grown ${RUN_AWAY} times${growth()}.`;
    if (world.pushed) return "A push is under way.";
    if (!settled) return `Settling for another ${Math.ceil(settling)} t₀, drawn pale.`;
    const bars = blocks.length < 2 ? `, drawn pale until error bars are known at ${Math.ceil(2 * blockTime)} t₀` : "";
    return `Measured for ${Math.round(time)} t₀${bars}.`;
  }

  function growth() {
    const rate = growthRate();
    return rate ? `, like exp(${rate.toPrecision(2)} t/t₀)` : "";
  }

  return {
    world, unit, begin, change, goOn, step, push, setSpeed, take, letGo, growthRate, criticalSize, happening,
    ROWS_A_SECOND, GAUGED, showOn: (shown) => { stage = shown; },
  };
})();
