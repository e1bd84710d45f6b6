/* The controls: buttons, sliders, lists, mouse, finger and keys; what the page says; and the frames. */
"use strict";

(() => {
  const { NAMES, told } = ChainAddress, R = ChainRunning, { world } = R;
  const BUDGET = 12; // milliseconds a frame that may be computed; slow machines show a slower chain
  const TAP = 300; // milliseconds: a shorter touch of a rod is a push
  const PLOTTED = 250; // milliseconds between two drawings of the pictures
  const NARROW = matchMedia("(max-width: 46em)");
  const OWN = { ask: "A chain of your own. Push it, change it, or choose a challenge." };

  const root = document.getElementById("chain");
  const find = (name) => root.querySelector(`[data-chain="${name}"]`);
  const sliders = Object.fromEntries(NAMES.map((name) => [name, find(name)]));
  const stage = new ChainDrawing.Stage(find("stage"));
  let running = false, chosen = OWN, last = 0, plotted = 0, owed = 0, refusal = "";
  R.showOn(stage);

  // -- time -----------------------------

  function frame(now) {
    if (!running || document.hidden) return;
    requestAnimationFrame(frame);
    owed = Math.min(owed + ((now - last) * R.ROWS_A_SECOND) / 1000, 8);
    last = now;
    const begun = performance.now();
    while (owed >= 1 && !world.ranAway && performance.now() - begun < BUDGET) {
      owed--;
      R.goOn();
    }
    if (owed >= 1) owed = 0; // what a slow machine cannot compute is left out
    if (world.ranAway) pause();
    drawStage();
    if (!running || now - plotted > PLOTTED) drawPlots(now);
  }

  const drawStage = () => stage.draw(world.state, R.unit(), (ChainDrawing.ROWS * world.speed) / R.ROWS_A_SECOND);

  function draw() {
    if (world.ranAway) pause();
    drawStage();
    drawPlots(performance.now());
  }

  function drawPlots(now) {
    plotted = now;
    const { state, measurement, history } = world, theory = ChainTheory.of(state.chain);
    const exact = ChainTheory.exactDensity(state.chain, measurement.coverage().map(([x]) => x));
    if (!exact && state.chain.restitution === 1 && state.chain.amplitude > 0 && !running) setTimeout(draw, 450);
    const seen = { half: stage.half, measurement, history, unit: R.unit(), exact, theory };
    for (const name of ["first", "second"])
      ChainPlots.pictures[find(`${name}-picture`).value](find(name), stage.colour, seen);
    find("status").textContent = `W = ${R.unit().toPrecision(2)} R/T. ${happening()}`;
    if (!ChainTheory.asked()) find("theory").textContent = theory ? theory.said : refusal;
    judge();
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

  function play() {
    if (world.ranAway) R.begin(world.state.chain);
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
    R.setSpeed(value);
    find("speed").value = String(world.speed);
  }

  function step() {
    pause();
    const met = R.step();
    draw();
    find("speed").value = String(world.speed);
    find("status").textContent = met.length
      ? `Met at t = ${world.state.time.toFixed(2)} T: ${met.map((c) => `rods ${c + 1} and ${c + 2}`).join(", ")}.`
      : "No rods have met.";
  }

  // -- challenges, presets, sliders -------

  /* Let the challenge look, and say what it found; what is new is read aloud only when it is done. */
  function judge() {
    if (!chosen.watch) return;
    const { done, said } = chosen.watch(world), mark = find(`challenge-${chosen.title}`);
    const next = ChainChallenges.list[ChainChallenges.list.indexOf(chosen) + 1];
    find("said").textContent = said;
    find("answer").textContent = done ? chosen.answer : "";
    find("next").hidden = !done || !next;
    if (next) find("next").textContent = `Next: ${next.title}`;
    if (!done || mark.classList.contains("done")) return;
    mark.classList.add("done");
    mark.textContent += " ✓";
    find("announced").textContent = `Challenge done: ${chosen.title}. ${said} ${chosen.answer}`;
  }

  /* Begin what was chosen: a challenge, a preset or a chain of one's own. */
  function choose(what) {
    chosen = what;
    for (const each of ChainChallenges.list)
      find(`challenge-${each.title}`).setAttribute("aria-pressed", String(each === what));
    find("preset").value = ChainPresets.list.indexOf(what);
    find("ask").textContent = what.ask;
    for (const name of ["said", "answer"]) find(name).textContent = "";
    find("next").hidden = true;
    const picture = what.picture || "widths"; // a narrow page shows the second one only
    find("second-picture").value = picture === "density" && !NARROW.matches ? "widths" : picture;
    world.pushes = [];
    setSpeed(what.speed || 3);
    const stopped = world.ranAway;
    R.begin(what.chain);
    showValues();
    if (stopped) play();
    draw();
  }

  function showValues() {
    const { chain } = world.state;
    for (const name of NAMES) sliders[name].value = chain[name];
    for (const value of root.querySelectorAll("[data-value]")) value.textContent = chain[value.dataset.value];
    find("rod").max = chain.size;
    refusal = "";
  }

  function slide(name) {
    const control = sliders[name], chain = { ...world.state.chain };
    chain[name] = control.options ? control.value : Number(control.value);
    const stopped = world.ranAway;
    if (name === "size" || name === "spring" || stopped) R.begin(chain);
    else R.change(chain);
    showValues();
    ChainAddress.write(chain);
    if (stopped) play();
    draw();
  }

  /* Take the setting of the address, if there is one; say why it is refused. */
  function obeyAddress() {
    const asked = ChainAddress.read(sliders);
    if (!asked || (asked.chain && world.state && ChainAddress.same(asked.chain, world.state.chain))) return;
    if (asked.chain) choose({ ...OWN, chain: asked.chain });
    else find("ask").textContent = `The address is not a setting: ${asked.refused}.`;
  }

  // -- the hand -------------------------

  /* The place on the line below a pointer [R]. */
  function placeOf(event) {
    const box = stage.canvas.getBoundingClientRect();
    return (((event.clientX - box.left) / box.width) * 2 - 1) * stage.half;
  }

  function take(event) {
    const box = stage.canvas.getBoundingClientRect(), finger = (24 / box.width) * 2 * stage.half;
    if (event.clientY - box.top > ChainDrawing.BAND + 12) return;
    if (R.take(placeOf(event), Math.max(1.2 * ChainPhysics.RADIUS, finger), event.timeStamp))
      stage.canvas.setPointerCapture(event.pointerId);
  }

  function letGo(event) {
    if (!world.hand) return;
    R.letGo(event.type === "pointerup" && event.timeStamp - world.hand.since < TAP);
    setSpeed(world.speed);
    if (!running) draw();
  }

  // -- what listens ---------------------

  function push() {
    const rod = Math.round(Number(find("rod").value)) || 1;
    R.push(Math.min(Math.max(rod, 1), world.state.y.length) - 1);
    setSpeed(world.speed);
    if (!running) draw();
  }

  function save() {
    stage.save(told(world.state.chain), (picture) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(picture);
      link.download = "chain.png";
      link.click();
      URL.revokeObjectURL(link.href);
    });
  }

  function solve() {
    const { chain } = world.state;
    ChainTheory.ask(chain, root.dataset.theory, (said) => {
      find("theory").textContent = said;
      refusal = said;
      find("solve").textContent = ChainTheory.asked() ? "Stop" : "Solve the theory";
      if (!ChainTheory.asked()) draw();
    });
  }

  function listen() {
    const { canvas } = stage;
    canvas.addEventListener("pointerdown", take);
    canvas.addEventListener("pointermove", (event) => {
      if (world.hand) world.hand.x = placeOf(event) + world.hand.offset;
    });
    for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, letGo);
    const clicks = {
      play: () => (running ? pause() : play()), step, push, save, solve,
      restart: () => choose(chosen),
      next: () => choose(ChainChallenges.list[ChainChallenges.list.indexOf(chosen) + 1]),
    };
    for (const [name, act] of Object.entries(clicks)) find(name).addEventListener("click", act);
    find("speed").addEventListener("change", (event) => setSpeed(Number(event.target.value)));
    find("preset").addEventListener("change", ({ target }) => {
      choose(ChainPresets.list[target.value]);
      ChainAddress.write(world.state.chain);
    });
    for (const name of NAMES) sliders[name].addEventListener("input", () => slide(name));
    for (const name of ["first", "second"]) find(`${name}-picture`).addEventListener("change", draw);
    root.addEventListener("keydown", (event) => {
      if (event.key === "p" && !event.ctrlKey && !event.metaKey && !event.altKey) push();
    });
    document.addEventListener("visibilitychange", () => !document.hidden && running && play());
    window.addEventListener("hashchange", obeyAddress);
    const again = () => (stage.refresh(), draw());
    new ResizeObserver(again).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    new MutationObserver(again).observe(document.body, { attributeFilter: ["data-theme"] });
  }

  // -- what is built --------------------

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
    ChainChallenges.list.forEach((each, k) => {
      const made = button(`${k + 1} ${each.title}`, () => choose(each));
      made.dataset.chain = `challenge-${each.title}`;
      find("challenges").append(made);
    });
    NAMES.filter((name) => name !== "spring").forEach(surround);
    find("preset").append(new Option("The paper's figures", -1));
    ChainPresets.list.forEach(({ title }, k) => find("preset").append(new Option(title, k)));
    find("second-picture").append(...find("first-picture").cloneNode(true).children);
    find("solve").hidden = !root.dataset.theory; // only a server can
  }

  fill();
  choose(ChainChallenges.list[0]);
  listen();
  obeyAddress();
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play();

})();
