/* The page: it lets time run, obeys buttons, sliders, mouse, finger and keys, and asks the
   challenges whether they are done. */
"use strict";

const ChainControls = (() => {
  const P = ChainPhysics;
  const NAMES = ["size", "restitution", "amplitude", "damping", "gap"];
  const ROWS_A_SECOND = 60; // of the strip
  const BUDGET = 12; // milliseconds a frame that may be computed; slow machines show a slower chain
  const KICK = 8; // free velocity widths that a push adds
  const FASTEST_HAND = 16; // free velocity widths
  const RUN_AWAY = 1000; // times the energy after the last touch
  const SEEN = 3; // the largest speed [T/s] at which a push can be followed
  const TAP = 300; // milliseconds: a shorter touch of a rod is a push

  const root = document.getElementById("chain");
  const find = (name) => root.querySelector(`[data-chain="${name}"]`);
  const canvases = { stage: find("stage"), density: find("density"), widths: find("widths") };
  const picture = new ChainDrawing.Picture(canvases);
  const world = { pushes: [], ranAway: false, growth: 1 };
  let seed = 0, running = false, shown = false, speed = SEEN, challenge = ChainChallenges.list[0];
  let pushed = null, hand = null, exact = null, last = 0, plotted = 0, owed = 0, touched = 0;

  // The unit of velocities. Without noise it is that of the weakest usual noise.
  const unit = () => P.freeWidth(world.state.chain) || P.freeWidth({ ...world.state.chain, amplitude: 1 });
  const freeEnergy = () => world.state.y.length * P.MASS * unit() ** 2;

  // -- the chain -----------------------------------------------------------------------------------

  /* A new chain. Up to e = 1 it has settled before it is shown; above it might run away. */
  function begin(chain) {
    world.state = P.makeState(chain, ++seed);
    const settles = chain.restitution <= 1, step = P.timeStep(chain);
    if (settles) P.advance(world.state, step, Math.ceil((4 * P.relaxationTime(chain)) / step));
    world.measurement = new ChainMeasuring.Measurement(world.state, 1.5 * ChainDrawing.reach(chain));
    changed();
    if (settles) world.measurement.settling = 0;
    picture.restart(chain);
    // The strip is full from the beginning, unless this would take long or show nothing.
    if (settles && speed <= SEEN) for (let row = 0; row < ChainDrawing.ROWS; row++) goOn();
    draw();
  }

  /* The chain was touched or changed: averages, the push under way and the growth begin anew. */
  function changed() {
    pushed = null;
    exact = null;
    world.ranAway = false;
    world.measurement.restart(world.state);
    touched = Math.max(P.energy(world.state), freeEnergy());
    world.growth = P.energy(world.state) / freeEnergy();
  }

  /* Go on for one row of the strip. */
  function goOn() {
    const { state, measurement } = world, duration = speed / ROWS_A_SECOND;
    const steps = Math.ceil(duration / P.timeStep(state.chain) - 1e-9);
    if (hand) follow(duration);
    P.advance(state, duration / steps, steps);
    measurement.add(state, duration);
    picture.add(state, unit());
    const energy = P.energy(state);
    world.growth = energy / freeEnergy();
    if (state.diverged || (state.chain.restitution > 1 && energy > RUN_AWAY * touched)) {
      world.ranAway = true;
      pause();
    }
    if (!pushed) return;
    pushed.fastest = Math.max(pushed.fastest, state.v[state.v.length - 1] / unit());
    if (state.time < pushed.until) return;
    world.pushes.push(pushed);
    pushed = null;
  }

  /* Add a velocity to a rod, to the right. */
  function push(rod) {
    if (world.ranAway) return;
    const { state } = world, { chain } = state, speedUp = KICK * unit();
    state.v[rod] += speedUp;
    changed();
    // Twice the time in which a rod of this speed would cross the free space.
    const space = chain.gap * (chain.size - 1) + 4 * P.thermalLength(chain);
    const until = state.time + (2 * space) / speedUp;
    pushed = { rod, size: chain.size, restitution: chain.restitution, fastest: 0, until };
    if (speed > SEEN) setSpeed(SEEN);
  }

  // -- the hand ------------------------------------------------------------------------------------

  /* The place on the line below a pointer [R]. */
  function placeOf(event) {
    const box = canvases.stage.getBoundingClientRect();
    return (((event.clientX - box.left) / box.width) * 2 - 1) * picture.half;
  }

  function take(event) {
    const { state } = world, box = canvases.stage.getBoundingClientRect();
    if (event.clientY - box.top > ChainDrawing.BAND + 12 || world.ranAway) return;
    const x = placeOf(event), away = (i) => Math.abs(P.position(state, i) - x);
    let rod = 0;
    for (let i = 1; i < state.y.length; i++) if (away(i) < away(rod)) rod = i;
    const finger = (24 / box.width) * 2 * picture.half;
    if (away(rod) > Math.max(1.2 * P.RADIUS, finger)) return;
    hand = { rod, offset: P.position(state, rod) - x, x: P.position(state, rod), since: event.timeStamp };
    state.held = rod;
    canvases.stage.setPointerCapture(event.pointerId);
  }

  /* Let the held rod move towards the pointer, no faster than a hand may. */
  function follow(duration) {
    const { state } = world, most = FASTEST_HAND * unit();
    const speedUp = (hand.x - P.position(state, hand.rod)) / duration;
    state.v[hand.rod] = Math.min(Math.max(speedUp, -most), most);
  }

  function letGo(event) {
    if (!hand) return;
    const { rod, since } = hand;
    hand = null;
    world.state.held = -1;
    if (event.type === "pointerup" && event.timeStamp - since < TAP) push(rod);
    else changed();
  }

  // -- time ----------------------------------------------------------------------------------------

  function frame(now) {
    if (!running || document.hidden) return;
    requestAnimationFrame(frame);
    owed = Math.min(owed + ((now - last) * ROWS_A_SECOND) / 1000, 8);
    last = now;
    const begun = performance.now();
    while (running && owed >= 1 && performance.now() - begun < BUDGET) {
      owed--;
      goOn();
    }
    if (owed >= 1) owed = 0; // what a slow machine cannot compute is left out
    picture.drawStage(world.state, unit(), (ChainDrawing.ROWS * speed) / ROWS_A_SECOND);
    if (!running || now - plotted > 250) drawPlots(now); // also when it has just run away
  }

  function draw() {
    picture.drawStage(world.state, unit(), (ChainDrawing.ROWS * speed) / ROWS_A_SECOND);
    drawPlots(performance.now());
  }

  function drawPlots(now) {
    plotted = now;
    const { state, measurement } = world, { chain } = state, width = unit();
    const coverage = measurement.coverage(), elastic = chain.restitution === 1;
    if (!exact && elastic && chain.amplitude > 0) {
      const places = coverage.map(([x]) => x), covered = ChainMeasuring.exactCoverage(chain, places);
      exact = places.map((x, k) => [x, covered[k]]);
    }
    picture.drawDensity(coverage, exact, measurement.settled);
    const theory = elastic ? Array(chain.size).fill(1) : stored(chain);
    picture.drawWidths(measurement.widths().map((each) => each / width), theory, measurement.settled);
    find("status").textContent = `W = ${width.toPrecision(2)} R/T. ` + happening();
    ask();
  }

  function happening() {
    const { measurement } = world;
    if (world.ranAway)
      return `The chain has run away: its energy has grown ${RUN_AWAY} times. Start again, or change a slider.`;
    if (pushed) return "A push is under way.";
    return measurement.settled ? `Measured for ${Math.round(measurement.time)} T.`
      : `Pale until the chain has settled, in ${Math.ceil(measurement.settling)} T.`;
  }

  /* The theory's velocity widths in free widths, if they were computed for this chain. */
  function stored(chain) {
    const found = ChainCurves.widths.find((each) => NAMES.every((name) =>
      each[name] === chain[name] || (name === "amplitude" && chain.gap === 0)));
    return found ? [...found.half, ...found.half.slice(0, Math.floor(chain.size / 2)).reverse()] : null;
  }

  function play() {
    if (world.ranAway) begin(world.state.chain);
    running = true;
    last = performance.now();
    find("play").textContent = "Pause";
    requestAnimationFrame(frame);
  }

  function pause() {
    running = false;
    find("play").textContent = world.ranAway ? "Start again" : "Play";
  }

  function setSpeed(value) {
    speed = value;
    find("speed").value = String(value);
    if (world.state) picture.restart(world.state.chain); // its rows are apart by another time
  }

  // -- challenges and sliders ----------------------------------------------------------------------

  /* Let the challenge look, and say what it found; what is new is read aloud only when it is done. */
  function ask() {
    const { done, said } = challenge.watch(world), mark = find(`challenge-${challenge.title}`);
    find("said").textContent = said;
    if (!done || mark.classList.contains("done")) return;
    mark.classList.add("done");
    mark.textContent += " ✓";
    find("announced").textContent = `Challenge done: ${challenge.title}. ${said}`;
  }

  function choose(chosen) {
    challenge = chosen;
    for (const each of ChainChallenges.list)
      find(`challenge-${each.title}`).setAttribute("aria-pressed", String(each === chosen));
    find("ask").textContent = chosen.ask;
    const stopped = world.ranAway;
    world.pushes = [];
    setSpeed(chosen.speed);
    begin(chosen.chain);
    showValues();
    if (stopped) play();
  }

  function showValues() {
    for (const name of NAMES) {
      find(name).value = world.state.chain[name];
      find(`${name}-value`).textContent = world.state.chain[name];
    }
    find("rod").max = world.state.chain.size;
  }

  function slide(name) {
    const chain = { ...world.state.chain, [name]: Number(find(name).value) };
    const stopped = world.ranAway;
    if (name === "size" || stopped) begin(chain);
    else {
      P.setChain(world.state, chain);
      changed();
      picture.restart(chain);
    }
    showValues();
    if (stopped) play();
    else draw();
  }

  function listen() {
    const { stage } = canvases;
    stage.addEventListener("pointerdown", take);
    stage.addEventListener("pointermove", (event) => {
      if (hand) hand.x = placeOf(event) + hand.offset;
    });
    for (const type of ["pointerup", "pointercancel"]) stage.addEventListener(type, letGo);
    const pushChosen = () => {
      const rod = Math.round(Number(find("rod").value)) || 1;
      push(Math.min(Math.max(rod, 1), world.state.y.length) - 1);
      if (!running) draw();
    };
    find("play").addEventListener("click", () => (running ? pause() : play()));
    find("push").addEventListener("click", pushChosen);
    find("restart").addEventListener("click", () => choose(challenge));
    find("speed").addEventListener("change", (event) => setSpeed(Number(event.target.value)));
    for (const name of NAMES) find(name).addEventListener("input", () => slide(name));
    root.addEventListener("keydown", (event) => {
      if (event.key === "p" && !event.ctrlKey && !event.metaKey && !event.altKey) pushChosen();
    });
    document.addEventListener("visibilitychange", () => !document.hidden && running && play());
    const again = () => (picture.refresh(), draw());
    new ResizeObserver(again).observe(stage);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    new MutationObserver(again).observe(document.body, { attributeFilter: ["data-theme"] });
  }

  function addChallenges() {
    ChainChallenges.list.forEach((each, k) => {
      const button = document.createElement("button");
      button.type = "button";
      button.dataset.chain = `challenge-${each.title}`;
      button.textContent = `${k + 1} ${each.title}`;
      button.addEventListener("click", () => choose(each));
      find("challenges").append(button);
    });
  }

  addChallenges();
  choose(challenge);
  listen();
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play();

  return { world, goOn, push, choose, begin, play, pause, draw };
})();
