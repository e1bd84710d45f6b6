/* The chain goes on while it is played, and is drawn. */
"use strict";

const ChainFrames = (() => {
  const R = ChainRunning, { world } = R;
  const BUDGET = 12; // milliseconds a frame that may be computed; slow machines show a slower chain
  const PLOTTED = 250; // milliseconds between two drawings of the pictures
  let running = false, last = 0, plotted = 0, owed = 0, shown = null;

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
    if (world.ranAway || now - plotted > PLOTTED) draw();
    else drawStage();
  }

  const drawStage = () =>
    shown.stage.draw(world.state, R.unit(), (ChainDrawing.ROWS * world.speed) / R.ROWS_A_SECOND);

  function draw() {
    plotted = performance.now();
    if (world.ranAway) pause();
    drawStage();
    shown.plots();
  }

  function play() {
    if (world.ranAway) R.begin(world.state.chain);
    running = true;
    last = performance.now();
    shown.button.textContent = "Pause";
    requestAnimationFrame(frame);
  }

  function pause() {
    running = false;
    shown.button.textContent = world.ranAway ? "Start again" : "Play";
  }

  /* What is drawn: the `stage`, and by `plots()` all else; the `button` plays and pauses. */
  function show(given) {
    shown = given;
    R.showOn(given.stage);
    given.button.addEventListener("click", () => (running ? pause() : play()));
    document.addEventListener("visibilitychange", () => !document.hidden && running && play());
  }

  return { show, draw, play, pause, running: () => running };
})();
