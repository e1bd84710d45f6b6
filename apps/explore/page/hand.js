/* The hand, a mouse or a finger: it holds a rod, moves it, and lets it go; a short touch is a push. */
"use strict";

const ChainHand = (() => {
  const R = ChainRunning, { world } = R;
  const TAP = 300; // milliseconds: a shorter touch of a rod is a push

  /* Let the hand hold the rods of a stage; `taken` and `released` are called when it does so. */
  function listen(stage, taken, released) {
    const { canvas } = stage;

    /* The place on the line below a pointer [R]. */
    function placeOf(event) {
      const box = canvas.getBoundingClientRect();
      return (((event.clientX - box.left) / box.width) * 2 - 1) * stage.half;
    }

    canvas.addEventListener("pointerdown", (event) => {
      const box = canvas.getBoundingClientRect(), finger = (24 / box.width) * 2 * stage.half;
      if (event.clientY - box.top > ChainDrawing.BAND + 12) return;
      if (!R.take(placeOf(event), Math.max(1.2 * ChainPhysics.RADIUS, finger), event.timeStamp)) return;
      canvas.setPointerCapture(event.pointerId);
      taken();
    });
    canvas.addEventListener("pointermove", (event) => {
      if (world.hand) world.hand.x = placeOf(event) + world.hand.offset;
    });
    const letGo = (event) => {
      if (!world.hand) return;
      R.letGo(event.type === "pointerup" && event.timeStamp - world.hand.since < TAP);
      released();
    };
    for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, letGo);
  }

  return { listen };
})();
