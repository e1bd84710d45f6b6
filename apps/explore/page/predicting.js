/* What somebody expects of a question before anything is shown: a curve drawn on the axes of a picture,
   or numbers. Words say how far the curve is from what is then measured. */
"use strict";

const ChainPredicting = (() => {
  const POINTS = 9; // of a curve, at equal distances across its picture
  const CLOSE = 5; // per cent at which a curve is right
  const PLACES = ["on the left", "in the middle", "on the right"];

  const blank = ({ predict }) => ({ values: Array(predict.numbers?.length ?? POINTS).fill(null), at: POINTS >> 1 });

  /* A number of a link, short and within the axes. */
  const short = (value) => Number(value.toPrecision(3));

  /* Move the curve to the value y at a share of the way across, and on the way there from another share.
     The first touch makes it a level line. */
  function move(guess, share, y, from = share) {
    const { values } = guess, place = (at) => Math.min(Math.max(at, 0), 1) * (POINTS - 1);
    const [one, two] = [place(from), place(share)].sort((a, b) => a - b);
    guess.at = Math.round(place(share));
    values.forEach((value, k) => {
      if (value === null || k === guess.at || (k > one && k < two)) values[k] = short(y);
    });
  }

  /* The curve at a share of the way across. */
  function height({ values }, share) {
    const at = share * (POINTS - 1), k = Math.min(Math.floor(at), POINTS - 2);
    return values[k] + (at - k) * (values[k + 1] - values[k]);
  }

  /* How far the curve is from measured [share, y], in each third of the picture; y may be a logarithm. */
  function distance(guess, measured, powers) {
    const thirds = PLACES.map((place, third) => {
      const points = measured.filter(([share]) => share >= third / 3 && share <= (third + 1) / 3);
      const mean = (of) => points.reduce((sum, point) => sum + of(point), 0) / points.length;
      const yours = mean(([share]) => height(guess, share)), theirs = mean(([, y]) => y);
      return [points.length ? off(powers ? 10 ** (yours - theirs) : yours / theirs) : "", place];
    }).filter(([text]) => text);
    const alike = thirds.every(([text]) => text === thirds[0][0]), [one, , three] = thirds;
    if (!alike && three && one[0] === three[0]) thirds.splice(0, 3, [one[0], "at both sides"], thirds[1]);
    const said = alike ? thirds.slice(0, 1).map(([text]) => text) : thirds.map((each) => each.join(" "));
    return said.length ? `Your curve is ${said.join(", ")}.` : "";
  }

  function off(ratio) {
    const times = ratio > 1 ? ratio : 1 / ratio, way = ratio > 1 ? "high" : "low", percent = 100 * Math.abs(ratio - 1);
    const round = percent < 20 ? 5 : 10;
    if (percent < CLOSE) return `right within ${CLOSE} %`;
    return times > 1.8 ? `${Number(times.toPrecision(1))} times too ${way}` : `${round * Math.round(percent / round)} % too ${way}`;
  }

  /* Let a canvas be drawn on, and say to a screen reader which point the keys move; null: no longer. */
  function offer(canvas, guess) {
    canvas.role = guess ? "slider" : "img";
    if (!guess) return canvas.removeAttribute("tabindex");
    canvas.tabIndex = 0;
    canvas.ariaValueNow = guess.values[guess.at] ?? 0;
    canvas.ariaValueText = `point ${guess.at + 1} of ${POINTS}: ${guess.values[guess.at] ?? "not drawn"}`;
  }

  /* Let a finger, the mouse or keys draw on a canvas that is offered; `guessed()` is changed, and then `drawn()`. */
  function listen(canvas, guessed, drawn) {
    let from = null;
    const draw = (event) => {
      const box = canvas.getBoundingClientRect();
      const [share, y] = canvas.plot.at(event.clientX - box.left, event.clientY - box.top);
      move(guessed(), share, y, from ?? share);
      from = share;
      drawn();
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (canvas.role !== "slider") return;
      canvas.setPointerCapture(event.pointerId);
      from = null;
      draw(event);
    });
    canvas.addEventListener("pointermove", (event) => canvas.hasPointerCapture(event.pointerId) && draw(event));
    canvas.addEventListener("keydown", (event) => {
      const across = { ArrowLeft: -1, ArrowRight: 1 }[event.key], up = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (canvas.role !== "slider" || !(across || up)) return;
      event.preventDefault();
      const guess = guessed(), at = Math.min(Math.max(guess.at + (across || 0), 0), POINTS - 1);
      const [low, high] = canvas.plot.yRange, y = guess.values[at] ?? (low + high) / 2;
      move(guess, at / (POINTS - 1), Math.min(Math.max(y + ((up || 0) * (high - low)) / 25, low), high));
      drawn();
    });
  }

  return { blank, offer, listen, distance };
})();
