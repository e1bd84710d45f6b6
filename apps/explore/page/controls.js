/* The controls, what the page says, and the address. */
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
  const stage = new ChainDrawing.Stage(find("stage")), shown = find("stage").ariaLabel;
  const solved = new Set(history.state?.solved); // challenges that are done, presets whose answer was seen
  const SYMBOLS = { size: "L", restitution: "e", amplitude: "A", damping: "γ", gap: "g" };
  let chosen = OWN, judging = false, described = 0;
  let guess = null; // what is expected of the question: {values, at, shown}
  const hidden = () => guess !== null && !guess.shown, predicted = () => guess?.values.every((each) => each !== null);

  function drawPlots() {
    judge();
    const { state, measurement, history: energies } = world, theory = hidden() ? null : ChainTheory.of(state.chain);
    if (!hidden()) ChainTheory.follow(state.chain, root.dataset.theory);
    const exact = ChainTheory.exactDensity(state.chain, measurement.coverage().map(([x]) => x));
    if (!exact && state.chain.restitution === 1 && state.chain.amplitude > 0 && !state.masses && !ChainFrames.running())
      setTimeout(draw, 450);
    const right = state.v.filter((v) => v > 0).length, kicked = state.chain.amplitude > 0, unit = R.unit();
    const calm = !ChainFrames.running() || isDue();
    if (calm) stage.canvas.ariaLabel = `${shown} Now ${right} of ${state.v.length} rods move to the right.`;
    const units = kicked ? { unit, counted: 1, inUnits: "W" } : { unit: 1, counted: unit, inUnits: "R/t₀" };
    const { restitution } = state.chain, gas = state.masses ? gauged() : null;
    const seen = { half: stage.half, measurement, history: energies, restitution, ...units, exact, theory, gas };
    for (const [name, list] of Object.entries(pictures)) {
      const canvas = find(name), { predict } = chosen, own = guess && predict.picture === list.value;
      const on = own ? { guess, axes: predict, hidden: hidden() } : null;
      const closed = hidden() && (predict.picture || predict.closed) ? { hidden: true } : null;
      const sentence = ChainPlots.draw(list.value, canvas, stage.colour, seen, on ?? closed);
      if (calm || !canvas.ariaLabel || hidden()) canvas.ariaLabel = sentence;
      ChainPredicting.offer(canvas, own && hidden() ? guess : null);
      if (own && !hidden()) compare(canvas.plot);
    }
    const scale = kicked ? `W = ${unit.toPrecision(2)} R/t₀.` : "Without noise there is no W.";
    find("status").textContent = `${scale} ${R.happening()}`;
    if (world.ranAway && world.pushed) breakOff("The chain ran away");
    find("theory").textContent = theory?.said || (ChainTheory.asking() && !hidden() ? "The theory is being solved." : "");
    answer();
  }

  /* Say how far the prediction is from what is measured, once the chain is as the question asks. */
  function compare({ seen, drawn: [left, right] }) {
    const { then = {}, of, y } = chosen.predict, { chain } = world.state, { settled } = world.measurement;
    const other = Object.entries(then).filter(([name, value]) => chain[name] !== value);
    const points = (seen[of] ?? seen.measured ?? seen.middle ?? []).map(([x, value]) => [(x - left) / (right - left), value]);
    find("compared").textContent = !predicted() ? ""
      : other.length ? `Your curve is for ${other.map(([name, value]) => `${SYMBOLS[name]} = ${value}`).join(", ")}.`
        : settled || world.ranAway ? ChainPredicting.distance(guess, points, y[0] < 0) : "";
  }

  /* Show the gauge, the force on the walls, and return what the picture of the pressure needs. The law
     is not told before it is found. */
  function gauged() {
    const { state, measurement, forces } = world, { box } = state.chain, law = ChainGas.law(state);
    const known = !chosen.secret || solved.has(chosen.id), { value, error } = measurement.force();
    const few = measurement.blocks.length < 2, mean = few ? "not measured yet" : `${value.toPrecision(4)} ± ${error.toPrecision(1)}`;
    const told = known ? `, exact: L T/(X − 2RL) = ${law.toPrecision(4)}` : "", now = measurement.momentary().toFixed(2);
    find("gauge").textContent = hidden() ? "" : `Force on a wall [M R/t₀²]: now ${now}, mean ${mean}${told}.`;
    const free = P.freeLength(state.chain), exact = { start: box - free, slope: 1 / law / free, known };
    return { box, forces, found: ChainGas.line(forces), exact };
  }

  /* Whether to say anew what the pictures show: a screen reader should not be hurried. */
  function isDue() {
    const due = performance.now() - described > CALM;
    if (due) described = performance.now();
    return due;
  }

  /* One sentence about what was just done, until something else is done. */
  const note = (text) => { find("note").textContent = text; };

  /* Break off the push under way and what is judged, and say why. Pushes that a challenge counts stay
     until it `leaves` off. */
  function breakOff(why, leaves) {
    const judged = judging && (leaves || !chosen.calm);
    const broken = [world.pushed && "the push under way", judged && "the judging"].filter(Boolean);
    if (broken.length) note(`${why}, which broke off ${broken.join(" and ")}.`);
    world.pushed = null;
  }

  /* Let the challenge look, and say what it found; only that it is done is read aloud. */
  function judge() {
    judging = false;
    if (!chosen.watch || world.hand) return; // a rod in the hand does not move by itself
    const gas = P.isGas(chosen.chain);
    if (gas !== P.isGas(world.state.chain)) {
      find("said").textContent = `This question is about ${gas ? "a gas in a box" : "rods on springs"}.`;
      return;
    }
    if (hidden()) {
      find("said").textContent = "";
      return;
    }
    const { done, said, pending } = chosen.watch(world), mark = find(`challenge-${chosen.id}`);
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

  /* Show the answer once the challenge is done, or the preset's was asked for; before that what is
     measured, and before that nothing. */
  function answer() {
    const known = solved.has(chosen.id);
    find("answer").textContent = known ? chosen.answer : "";
    find("reveal").hidden = !hidden() && (known || chosen.kind !== "preset");
    find("reveal").textContent = !hidden() ? "Show the answer" : predicted() ? "Show" : "Skip the prediction";
    for (const input of find("guesses").querySelectorAll("input")) input.readOnly = !hidden();
  }

  function reveal() {
    if (hidden()) guess.shown = true;
    else if (chosen.kind === "preset") solved.add(chosen.id);
    draw();
  }

  /* A box for each number that is expected. */
  function askForNumbers() {
    find("guesses").replaceChildren(...(chosen.predict?.numbers ?? []).map((words, k) => {
      const label = document.createElement("label"), input = document.createElement("input");
      Object.assign(input, { type: "number", min: 0, step: "any", value: guess.values[k] ?? "" });
      input.addEventListener("input", () => {
        guess.values[k] = Number.isNaN(input.valueAsNumber) ? null : input.valueAsNumber;
        answer();
      });
      label.append(`${k ? "" : "My prediction: "}${words} `, input);
      return label;
    }));
  }

  /* Begin what was chosen, with some values changed, and what is expected of it. */
  function choose(what, values = {}, expected = null) {
    const begun = { ...ChainAddress.beginning(what), ...values }, stopped = world.ranAway;
    note("");
    breakOff("A chain was begun anew", true);
    chosen = what;
    guess = what.predict ? expected ?? { ...ChainPredicting.blank(what), shown: solved.has(what.id) } : null;
    if (guess && values.prediction) guess.values = values.prediction;
    askForNumbers();
    for (const each of CHALLENGES) find(`challenge-${each.id}`).setAttribute("aria-pressed", String(each === what));
    find("preset").value = what.kind === "preset" ? what.id : "";
    find("ask").textContent = what.ask;
    for (const name of ["said", "announced", "compared"]) find(name).textContent = "";
    for (const [name, list] of Object.entries(pictures)) list.value = begun[name];
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
    sliders.box.min = P.narrowest(chain);
    for (const name of NAMES) sliders[name].value = chain[name];
    for (const value of root.querySelectorAll("[data-value]")) {
      const name = value.dataset.value;
      sliders[name].ariaValueText = value.textContent = chain[name];
    }
    for (const list of Object.values(pictures)) {
      for (const option of list.options)
        if (option.dataset.of) option.disabled = option.hidden = gas !== (option.dataset.of === "gas");
      if (list.selectedOptions[0].disabled) list.value = gas ? "pressure" : "energy";
    }
  }

  function slide(name) {
    const control = sliders[name], chain = { ...world.state.chain }, stopped = world.ranAway;
    chain[name] = name === "spring" ? control.value : Number(control.value);
    const begins = name === "spring" && P.isGas(chain);
    chain.box = begins ? ChainAddress.roomy(chain).box : Math.max(chain.box, P.narrowest(chain));
    breakOff(`The ${control.labels[0].textContent.split(" [")[0]} changed`);
    if (begins) setSpeed(ChainAddress.roomy(chain).speed);
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

  /* Write all that is chosen into the address, after whatever was done. */
  function write() {
    const { first, second } = pictures, shown = { first: first.value, second: second.value, speed: world.speed };
    const prediction = predicted() && guess.values.join("_");
    ChainAddress.write(chosen, { ...world.state.chain, ...shown, prediction }, [...solved]);
  }

  /* Begin what the address asks for; say why it is refused. */
  function obeyAddress(otherwise = () => {}) {
    const options = (list) => ({ options: list.map(({ id }) => ({ value: id })) });
    const asked = ChainAddress.read({
      challenge: options(CHALLENGES), preset: options(PRESETS), ...sliders,
      ...pictures, speed: find("speed"),
      prediction: { numbers: true },
    });
    if (asked?.values) {
      const { challenge, preset, ...values } = asked.values;
      const what = [...CHALLENGES, ...PRESETS].find(({ id }) => id === (challenge || preset)) || OWN;
      const begun = { ...ChainAddress.beginning(what), ...values }, { box: room, speed } = ChainAddress.roomy(begun);
      if (P.isGas(begun) && begun.box < P.narrowest(begun)) values.box ??= room;
      if (P.isGas(begun) && what === OWN) values.speed ??= speed;
      const { size, box, ...chain } = { ...begun, ...values };
      const numbers = what.predict ? ChainPredicting.blank(what).values.length : 0;
      if (box < P.narrowest({ size, ...chain }))
        asked.refused = `${size} rods need a box of at least ${P.narrowest({ size, ...chain })} R, got ${box}`;
      else if (values.prediction && values.prediction.length !== numbers)
        asked.refused = numbers ? `prediction must be ${numbers} numbers here, got ${values.prediction.length}`
          : "a prediction belongs to a challenge or a question";
      else return choose(what, values);
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
      ? `Met at t = ${world.state.time.toFixed(2)} t₀: ${met.map((c) => `rods ${c + 1} and ${c + 2}`).join(", ")}.`
      : "No rods have met.";
  }

  function push() {
    if (world.state.masses) return; // the rods of a gas are not pushed
    note("");
    breakOff("The left end was pushed");
    R.push(0, chosen.calm);
    touched();
  }

  /* A rod was pushed or let go, which may have changed the speed. */
  function touched() {
    setSpeed(world.speed);
    if (!ChainFrames.running()) draw();
  }

  function listen() {
    const clicks = {
      step, push, reveal, restart: () => choose(chosen, chosen === OWN ? world.state.chain : {}, guess),
    };
    for (const [name, act] of Object.entries(clicks)) find(name).addEventListener("click", act);
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
    for (const name of Object.keys(pictures)) ChainPredicting.listen(find(name), () => guess, () => (draw(), write()));
    ChainHand.listen(stage, () => breakOff("A rod was held"), touched);
    for (const type of ["click", "input", "change"]) root.addEventListener(type, write); // after all others
    window.addEventListener("hashchange", () => obeyAddress());
    const again = () => (stage.refresh(), draw());
    new ResizeObserver(again).observe(stage.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    new MutationObserver(again).observe(document.body, { attributeFilter: ["data-theme"] });
  }

  /* Give a challenge or preset the words of its element. */
  function word(each, element) {
    const { dataset: { ask, answer }, textContent } = element;
    const [title, ...words] = [textContent, ask, answer].map((text) => text.replace(/\s+/g, " ").trim());
    Object.assign(each, { title: title.replace(/^\d /, ""), ask: words[0], answer: words[1] });
    element.textContent = title;
    return element;
  }

  function fill() {
    for (const each of CHALLENGES) {
      const button = word(each, find(`challenge-${each.id}`));
      button.addEventListener("click", () => choose(each));
      if (solved.has(each.id)) tick(button);
    }
    for (const each of PRESETS) word(each, find("preset").querySelector(`[value="${each.id}"]`));
    for (const name of NAMES) if (!sliders[name].options) ChainSliders.surround(sliders[name], name, slide);
    pictures.second.append(...pictures.first.cloneNode(true).children);
  }

  ChainFrames.show({ stage, plots: drawPlots, button: find("play") });
  fill();
  listen();
  obeyAddress(() => choose(CHALLENGES[0]));
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play();

})();
