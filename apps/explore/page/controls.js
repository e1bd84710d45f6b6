/* The controls, what the page says, and the address. */
"use strict";

(() => {
  const { NAMES } = ChainAddress, R = ChainRunning, { world } = R, { draw, play, pause } = ChainFrames;
  const CHALLENGES = ChainChallenges.list, PRESETS = ChainPresets.list;
  const CALM = 5000; // milliseconds between two sentences about a moving picture
  const OWN = { ask: "A chain of your own. Push it, change it, or choose a challenge." };

  const root = document.getElementById("chain");
  const find = (name) => root.querySelector(`[data-chain="${name}"]`);
  const sliders = Object.fromEntries(NAMES.map((name) => [name, find(name)]));
  const pictures = { first: find("first-picture"), second: find("second-picture") };
  const stage = new ChainDrawing.Stage(find("stage")), shown = find("stage").ariaLabel;
  const solved = new Set(history.state?.solved); // challenges that are done, presets whose answer was seen
  let chosen = OWN, rod = 1, judging = false, told = {}, described = 0; // `told`: of the theory of a chain

  function drawPlots() {
    const { state, measurement, history: energies } = world, theory = ChainTheory.of(state.chain);
    const exact = ChainTheory.exactDensity(state.chain, measurement.coverage().map(([x]) => x));
    if (!exact && state.chain.restitution === 1 && state.chain.amplitude > 0 && !ChainFrames.running())
      setTimeout(draw, 450);
    const right = state.v.filter((v) => v > 0).length, kicked = state.chain.amplitude > 0, unit = R.unit();
    const calm = !ChainFrames.running() || isDue();
    if (calm) stage.canvas.ariaLabel = `${shown} Now ${right} of ${state.v.length} rods move to the right.`;
    const units = kicked ? { unit, counted: 1, inUnits: "W" } : { unit: 1, counted: unit, inUnits: "R/T" };
    const { restitution } = state.chain;
    const seen = { half: stage.half, measurement, history: energies, restitution, ...units, exact, theory };
    for (const [name, list] of Object.entries(pictures)) {
      const sentence = ChainPlots.pictures[list.value](find(name), stage.colour, seen);
      if (calm || !find(name).ariaLabel) find(name).ariaLabel = sentence;
    }
    const scale = kicked ? `W = ${unit.toPrecision(2)} R/T.` : "Without noise there is no W.";
    find("status").textContent = `${scale} ${happening()}`;
    if (world.ranAway && world.pushed) breakOff("The chain ran away");
    find("solve").textContent = ChainTheory.asked() ? "Stop" : "Solve the theory";
    find("theory").textContent = (told.chain === state.chain && told.said) || theory?.said || "";
    judge();
  }

  /* Whether to say anew what the pictures show: a screen reader should not be hurried. */
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
  const note = (text) => { find("note").textContent = text; };

  /* Break off the push under way, what is judged and, where the chain `changes`, its theory, and say why.
     Pushes that a challenge counts stay until it `leaves` off. */
  function breakOff(why, { changes, leaves } = {}) {
    const broken = [
      world.pushed && "the push under way", judging && (leaves || !chosen.calm) && "the judging",
      changes && ChainTheory.asked() && "the computation of the theory",
    ].filter(Boolean);
    if (broken.length) note(`${why}, which broke off ${broken.join(" and ")}.`);
    if (changes) ChainTheory.abort();
    world.pushed = null;
  }

  /* Let the challenge look, and say what it found; only that it is done is read aloud. */
  function judge() {
    judging = false;
    if (!chosen.watch || world.hand) return; // a rod in the hand does not move by itself
    const { done, said, pending } = chosen.watch(world), mark = find(`challenge-${chosen.title}`);
    find("said").textContent = said;
    const known = solved.has(chosen.id);
    judging = pending && !known;
    if (!done || known) return;
    solved.add(chosen.id);
    tick(mark);
    answer();
    write();
    find("announced").textContent = `Challenge done: ${chosen.title}. ${said} ${chosen.answer}`;
  }

  const tick = (mark) => { mark.textContent += " ✓"; };

  /* Show the answer once the challenge is done, or the preset's was asked for. */
  function answer() {
    const known = solved.has(chosen.id);
    find("answer").textContent = known ? chosen.answer : "";
    find("reveal").hidden = known || chosen.kind !== "preset";
  }

  /* Begin what was chosen, with some values changed. */
  function choose(what, values = {}) {
    const begun = { ...ChainAddress.beginning(what), ...values }, stopped = world.ranAway;
    note("");
    breakOff("A chain was begun anew", { changes: true, leaves: true });
    chosen = what;
    for (const each of CHALLENGES) find(`challenge-${each.title}`).setAttribute("aria-pressed", String(each === what));
    find("preset").value = what.kind === "preset" ? what.id : "";
    find("ask").textContent = what.ask;
    find("said").textContent = find("announced").textContent = "";
    answer();
    for (const [name, list] of Object.entries(pictures)) list.value = begun[name];
    rod = begun.rod;
    world.pushes = [];
    what.begin?.();
    setSpeed(Number(begun.speed));
    R.begin(Object.fromEntries(NAMES.map((name) => [name, begun[name]])));
    showValues();
    if (stopped) play();
    draw();
  }

  function showValues() {
    const { chain } = world.state;
    for (const name of NAMES) sliders[name].value = chain[name];
    for (const value of root.querySelectorAll("[data-value]")) {
      const name = value.dataset.value;
      sliders[name].ariaValueText = value.textContent = chain[name];
    }
    find("rod").max = chain.size;
    find("rod").value = rod = Math.min(rod, chain.size);
  }

  function slide(name) {
    const control = sliders[name], chain = { ...world.state.chain }, stopped = world.ranAway;
    chain[name] = control.options ? control.value : Number(control.value);
    breakOff(`The ${control.labels[0].textContent.split(" [")[0]} changed`, { changes: true });
    if (name === "size" || name === "spring" || stopped) R.begin(chain);
    else R.change(chain);
    showValues();
    if (stopped) play();
    draw();
  }

  function setSpeed(value) {
    R.setSpeed(value);
    find("speed").value = String(world.speed);
  }

  /* Write all that is chosen into the address, after whatever was done. */
  function write() {
    const { first, second } = pictures, shown = { first: first.value, second: second.value, speed: world.speed };
    ChainAddress.write(chosen, { ...world.state.chain, rod, ...shown }, [...solved]);
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
      const { size, rod: named } = { ...ChainAddress.beginning(what), ...values };
      if (named <= size) return choose(what, values);
      asked.refused = `rod must be a whole number from 1 to ${size}, got ${named}`;
    }
    otherwise();
    if (asked) note(`The address is not understood: ${asked.refused}.`);
  }

  function step() {
    pause();
    const met = R.step();
    draw();
    setSpeed(world.speed);
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

  function save() {
    const link = document.createElement("a");
    link.href = stage.save(ChainAddress.told(world.state.chain));
    link.download = "chain.png";
    link.click();
  }

  /* Solve the theory of the chain, or stop. What is said of one chain is not seen with another. */
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
      step, push, save, solve,
      restart: () => choose(chosen, chosen === OWN ? world.state.chain : {}),
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

  function button(text, act) {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    made.addEventListener("click", act);
    return made;
  }

  /* Show the value of a slider above it, and buttons for less and more beside it. */
  function surround(name) {
    const control = sliders[name], output = document.createElement("output");
    output.dataset.value = name;
    output.ariaHidden = "true"; // the slider itself says it
    const stepping = (sign, steps, word) => {
      const made = button(sign, () => (control.stepUp(steps), slide(name)));
      made.ariaLabel = `${control.labels[0].textContent}, ${word}`;
      return made;
    };
    control.before(output, stepping("−", -1, "less"));
    control.after(stepping("+", 1, "more"));
  }

  function fill() {
    CHALLENGES.forEach((each, k) => {
      const made = button(`${k + 1} ${each.title}`, () => choose(each));
      made.dataset.chain = `challenge-${each.title}`;
      if (solved.has(each.id)) tick(made);
      find("challenges").append(made);
    });
    NAMES.filter((name) => name !== "spring").forEach(surround);
    const questions = PRESETS.map(({ id, title }) => new Option(title, id));
    find("preset").append(new Option("Questions to predict", ""), ...questions);
    find("preset")[0].disabled = true;
    pictures.second.append(...pictures.first.cloneNode(true).children);
    find("solve").hidden = !root.dataset.theory; // only a server can
  }

  ChainFrames.show({ stage, plots: drawPlots, button: find("play") });
  fill();
  listen();
  obeyAddress(() => choose(CHALLENGES[0]));
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play();

})();
