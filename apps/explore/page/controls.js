/* The controls: buttons, sliders, lists and keys; what the page says; and the address, which holds
   what is chosen. */
"use strict";

(() => {
  const { NAMES } = ChainAddress, P = ChainScales, R = ChainRunning, { world } = R, { draw, play, pause } = ChainFrames;
  const CHALLENGES = ChainChallenges.list, PRESETS = ChainPresets.list;
  const CALM = 5000; // milliseconds between two sentences about a moving picture
  const OWN = { ask: "A chain of your own. Push it, change it, or choose a challenge." };

  const root = document.getElementById("chain");
  const find = (name) => root.querySelector(`[data-chain="${name}"]`);
  const sliders = Object.fromEntries(NAMES.map((name) => [name, find(name)]));
  const pictures = { first: find("first-picture"), second: find("second-picture") };
  const stage = new ChainDrawing.Stage(find("stage"));
  const solved = new Set(history.state?.solved); // challenges that are done, presets whose answer was seen
  let chosen = OWN, rod = 1, judging = false, told = {}, described = 0; // `told`: of the theory of a chain

  // -- what is seen and said --------------

  function drawPlots() {
    judge();
    const { state, measurement, history: energies } = world, theory = ChainTheory.of(state.chain);
    const exact = ChainTheory.exactDensity(state.chain, measurement.coverage().map(([x]) => x));
    if (!exact && state.chain.restitution === 1 && state.chain.amplitude > 0 && !state.masses && !ChainFrames.running())
      setTimeout(draw, 450);
    const kicked = state.chain.amplitude > 0, unit = R.unit(), calm = !ChainFrames.running() || isDue();
    const units = kicked ? { unit, counted: 1, inUnits: "W" } : { unit: 1, counted: unit, inUnits: "R/T" };
    const { restitution } = state.chain, gas = state.masses ? gauged() : null;
    const seen = { half: stage.half, measurement, history: energies, restitution, ...units, exact, theory, gas };
    for (const [name, list] of Object.entries(pictures)) {
      const sentence = ChainPlots.pictures[list.value](find(name), stage.colour, seen);
      if (calm || !find(name).ariaLabel) find(name).ariaLabel = sentence;
    }
    const scale = kicked ? `W = ${unit.toPrecision(2)} R/T.` : "Without noise there is no W.";
    find("status").textContent = `${scale} ${happening()}`;
    if (world.ranAway && world.pushed) breakOff("The chain ran away");
    find("solve").textContent = ChainTheory.asked() ? "Stop" : "Solve the theory";
    find("theory").textContent = (told.chain === state.chain && told.said) || theory?.said || "";
  }

  /* Show the gauge, the force on the walls, and return what the picture of the pressure needs. The law
     is not told before it is found. */
  function gauged() {
    const { state, measurement, forces } = world, { box } = state.chain, law = ChainGas.law(state);
    const known = !chosen.secret || solved.has(chosen.id), { value, error } = measurement.force();
    const now = measurement.blocks.length > 1 ? `${value.toPrecision(4)} ± ${error.toPrecision(1)}` : "not measured yet";
    const told = known ? `, exact: L T/(X − 2RL) = ${law.toPrecision(4)}` : "";
    find("gauge").textContent = `Force on a wall [M R/T²]: ${now}${told}.`;
    const free = P.freeLength(state.chain), exact = { start: box - free, slope: 1 / law / free, known };
    return { box, forces, found: ChainGas.line(forces), exact };
  }

  /* Whether it is time to say anew what the pictures show: a screen reader should not be hurried. */
  function isDue() {
    const due = performance.now() - described > CALM;
    if (due) described = performance.now();
    return due;
  }

  function happening() {
    const { measurement } = world;
    if (world.ranAway) return `The chain has run away: its energy has grown ${R.RUN_AWAY} times${growth()}.`;
    if (world.pushed) return "A push is under way.";
    if (!measurement.settled) return `Settling for another ${Math.ceil(measurement.settling)} T, drawn pale.`;
    return `Measured for ${Math.round(measurement.time)} T.`;
  }

  function growth() {
    const rates = R.growthRates();
    if (!rates) return "";
    const exponential = (rate) => `exp(${rate.toPrecision(2)} t/T)`;
    return `, like ${exponential(rates.found)}` +
      (rates.theory ? `; theory for weak damping: ${exponential(rates.theory)}` : "");
  }

  /* One sentence about what was just done, until something else is done. */
  const note = (text) => {
    find("note").textContent = text;
  };

  /* Break off what the rods do and what is judged of it, and say why. Another chain, or another setting of
     it, also breaks off its theory. What a challenge counts stays until it is left. */
  function breakOff(why, changes = false, leaves = false) {
    const theory = changes && ChainTheory.asked(), broken = [
      world.pushed && "the push under way", judging && (leaves || !chosen.counts) && "the judging",
      theory && "the computation of the theory",
    ].filter(Boolean);
    if (broken.length) note(`${why}, which broke off ${broken.join(" and ")}.`);
    if (theory) ChainTheory.abort();
    world.pushed = null;
    judging = false;
  }

  /* Let the challenge look, and say what it found; what is new is read aloud only when it is done. */
  function judge() {
    if (!chosen.watch || world.hand) return; // a rod in the hand does not move by itself
    const { done, said, pending } = chosen.watch(world), mark = find(`challenge-${chosen.title}`);
    find("said").textContent = said;
    judging = pending && !solved.has(chosen.id);
    if (!done || solved.has(chosen.id)) return;
    solved.add(chosen.id);
    tick(mark);
    answer();
    write();
    find("announced").textContent = `Challenge done: ${chosen.title}. ${said} ${chosen.answer}`;
  }

  const tick = (mark) => {
    mark.classList.add("done");
    mark.textContent += " ✓";
  };

  /* Show the answer once the challenge is done, or the preset's was asked for. */
  function answer() {
    const known = solved.has(chosen.id);
    find("answer").textContent = known ? chosen.answer : "";
    find("reveal").hidden = known || chosen.kind !== "preset";
  }

  // -- what is chosen ---------------------

  /* Begin what was chosen, a challenge, a preset or a chain of one's own, with some values changed. */
  function choose(what, values = {}) {
    const begun = { ...ChainAddress.beginning(what), ...values }, stopped = world.ranAway;
    note("");
    breakOff("A chain was begun anew", true, true);
    chosen = what;
    for (const each of CHALLENGES) find(`challenge-${each.title}`).setAttribute("aria-pressed", String(each === what));
    find("preset").value = what.kind === "preset" ? what.id : "";
    find("ask").textContent = what.ask;
    find("said").textContent = find("announced").textContent = "";
    answer();
    for (const [name, list] of Object.entries(pictures)) list.value = begun[name];
    rod = begun.rod;
    world.pushes = [];
    world.forces = [];
    what.begin?.();
    setSpeed(Number(begun.speed));
    R.begin(Object.fromEntries(NAMES.map((name) => [name, begun[name]])));
    showValues();
    if (stopped) play();
    draw();
  }

  function showValues() {
    const { chain } = world.state, gas = P.isGas(chain);
    root.classList.toggle("gas", gas);
    sliders.box.min = narrowest(chain);
    for (const name of NAMES) sliders[name].ariaValueText = sliders[name].value = chain[name];
    for (const value of root.querySelectorAll("[data-value]")) value.textContent = chain[value.dataset.value];
    find("rod").max = chain.size;
    find("rod").value = rod = Math.min(rod, chain.size);
    for (const list of Object.values(pictures)) {
      for (const option of list.options)
        if (option.dataset.of) option.disabled = option.hidden = gas !== (option.dataset.of === "gas");
      if (list.selectedOptions[0].disabled) list.value = gas ? "pressure" : "energy";
    }
  }

  /* The smallest box of a gas. */
  const narrowest = (chain) => (P.isGas(chain) ? 2 * P.RADIUS * chain.size + 2 : 0);

  function slide(name) {
    const control = sliders[name], chain = { ...world.state.chain }, stopped = world.ranAway;
    chain[name] = name === "spring" ? control.value : Number(control.value);
    chain.box = Math.max(chain.box, narrowest(chain));
    breakOff(`The ${control.labels[0].textContent.split(" [")[0]} changed`, true);
    if (name === "size" || name === "spring" || stopped || P.isGas(chain)) R.begin(chain);
    else R.change(chain);
    showValues();
    if (stopped) play();
    draw();
  }

  function setSpeed(value) {
    R.setSpeed(value);
    find("speed").value = String(world.speed);
  }

  /* Write into the address all that is chosen: after whatever was done, and nowhere else. */
  function write() {
    const now = { ...world.state.chain, rod, speed: world.speed };
    for (const [name, list] of Object.entries(pictures)) now[name] = list.value;
    ChainAddress.write(chosen, now, [...solved]);
  }

  /* Begin what the address asks for; say why it is refused. */
  function obeyAddress(otherwise = () => {}) {
    const options = (list) => ({ options: list.map(({ id }) => ({ value: id })) });
    const asked = ChainAddress.read({
      challenge: options(CHALLENGES), preset: options(PRESETS), ...sliders,
      rod: { min: 1, max: sliders.size.max, step: "1" }, ...pictures, speed: find("speed"),
    });
    if (asked?.values) {
      const { challenge, preset, ...values } = asked.values;
      const what = [...CHALLENGES, ...PRESETS].find(({ id }) => id === (challenge || preset)) || OWN;
      const { rod: named, ...chain } = { ...ChainAddress.beginning(what), ...values }, { size, box } = chain;
      if (named > size) asked.refused = `rod must be a whole number from 1 to ${size}, got ${named}`;
      else if (box < narrowest(chain))
        asked.refused = `${size} rods need a box of at least ${narrowest(chain)} R, got ${box}`;
      else return choose(what, values);
    }
    otherwise();
    if (asked) note(`The address is not understood: ${asked.refused}.`);
  }

  // -- what is done -----------------------

  function step() {
    pause();
    const met = R.step();
    draw();
    find("speed").value = String(world.speed);
    find("status").textContent = met.length
      ? `Met at t = ${world.state.time.toFixed(2)} T: ${met.map((c) => `rods ${c + 1} and ${c + 2}`).join(", ")}.`
      : "No rods have met.";
  }

  /* Take the rod of the box, and return whether there is one; otherwise say which there are. */
  function takeRod() {
    const box = find("rod"), valid = box.checkValidity();
    if (valid) rod = box.valueAsNumber;
    else note(`There is no rod ${box.value || "without a number"}: the rods have the numbers 1 to ${box.max}.`);
    box.value = rod;
    return valid;
  }

  function push() {
    note("");
    if (!takeRod()) return;
    breakOff(`Rod ${rod} was pushed`);
    R.push(rod - 1, chosen.calm);
    touched();
  }

  /* A rod was pushed or let go, which may have changed the speed. */
  function touched() {
    setSpeed(world.speed);
    if (!ChainFrames.running()) draw();
  }

  /* Solve the theory of the chain, or stop solving it. What is said of one chain is not seen with another. */
  function solve() {
    const { chain } = world.state;
    const said = (text) => {
      told = { chain, said: text };
      if (chain === world.state.chain) draw();
    };
    if (ChainTheory.asked()) ChainTheory.abort();
    else ChainTheory.ask(chain, root.dataset.theory, said);
  }

  function listen() {
    const clicks = {
      step, push, solve,
      restart: () => choose(chosen),
      reveal: () => (solved.add(chosen.id), answer()),
    };
    for (const [name, act] of Object.entries(clicks)) find(name).addEventListener("click", act);
    // Whoever presses the button is told by it, and pushes no other rod.
    find("rod").addEventListener("change", () => find("push").matches(":active") || takeRod());
    find("speed").addEventListener("change", ({ target }) => setSpeed(Number(target.value)));
    find("preset").addEventListener("change", ({ target }) => choose(PRESETS.find(({ id }) => id === target.value)));
    for (const name of NAMES) sliders[name].addEventListener("input", () => slide(name));
    for (const list of Object.values(pictures)) list.addEventListener("change", draw);
    document.addEventListener("keydown", (event) => {
      const typing = !root.contains(event.target) && event.target.closest("input, select, textarea, [contenteditable]");
      if (event.key !== "p" || event.ctrlKey || event.metaKey || event.altKey || typing) return;
      push();
      write();
    });
    ChainHand.listen(stage, () => breakOff("A rod was held"), touched);
    for (const type of ["click", "input", "change"]) root.addEventListener(type, write); // after all others
    window.addEventListener("hashchange", () => obeyAddress());
    const again = () => (stage.refresh(), draw());
    new ResizeObserver(again).observe(stage.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    new MutationObserver(again).observe(document.body, { attributeFilter: ["data-theme"] });
  }

  // -- what is built --------------------

  function fill() {
    CHALLENGES.forEach((each, k) => {
      const made = ChainSliders.button(`${k + 1} ${each.title}`, () => choose(each));
      made.dataset.chain = `challenge-${each.title}`;
      if (solved.has(each.id)) tick(made);
      find("challenges").append(made);
    });
    for (const name of NAMES) if (!sliders[name].options) ChainSliders.surround(sliders[name], name, slide);
    const questions = PRESETS.map(({ id, title }) => new Option(title, id));
    find("preset").append(new Option("Questions to predict", ""), ...questions);
    pictures.second.append(...pictures.first.cloneNode(true).children);
    find("solve").hidden = !root.dataset.theory; // only a server can
  }

  ChainFrames.show({ stage, plots: drawPlots, button: find("play") });
  fill();
  listen();
  obeyAddress(() => choose(CHALLENGES[0]));
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play();

})();
