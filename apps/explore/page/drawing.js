/* What moves: rods on their springs, and a strip of where they were. */
"use strict";

const ChainDrawing = (() => {
  const P = ChainPhysics;
  const ROWS = 220; // of the strip
  const BAND = 62; // height of the rods above the strip, in pixels
  const AXIS = 30; // height of the axis below it
  const LEAST = 12; // length of a rod in pixels at which bars mark collisions
  const FAST = 3; // free velocity widths at which a colour is full

  /* The colours of the page, light or dark. */
  function colours(place) {
    const style = getComputedStyle(place), read = (name) => {
      place.style.color = `var(--${name})`;
      return style.color;
    };
    const [ink, faint, grey, exact] = ["ink", "faint", "grey", "exact"].map(read);
    const [left, rest, right] = ["left", "rest", "right"].map((name) => read(name).match(/\d+/g).map(Number));
    return { ink, faint, grey, exact, left, rest, right, sans: style.fontFamily };
  }

  /* Blue for a rod that moves left, orange to the right, pale at rest; v in free widths. */
  function shade(v, colour) {
    const share = Math.min(Math.abs(v) / FAST, 1), full = v < 0 ? colour.left : colour.right;
    return `rgb(${colour.rest.map((rest, k) => Math.round(rest + share * (full[k] - rest)))})`;
  }

  /* The velocity of a rod; that of a heavier one as of a light one of the same energy. */
  const pace = ({ v, masses }, i) => (masses ? v[i] * Math.sqrt(masses[i] / P.MASS) : v[i]);

  /* Half of the line that is shown [R]; of smaller boxes it is that of a larger one. */
  function reach(chain) {
    if (P.isGas(chain)) return Math.max(chain.box / 2, 2.5 * P.RADIUS * chain.size) + 1;
    const anchors = ((2 * P.RADIUS + chain.gap) * (chain.size - 1)) / 2;
    return anchors + 3 * P.RADIUS + 3.5 * P.thermalLength(chain);
  }

  class Stage {
    constructor(canvas) {
      this.canvas = canvas;
      this.strip = document.createElement("canvas");
      this.rows = []; // the last ones, newest first: [positions, velocities in free widths, contacts or null]
      this.half = 1;
    }

    /* Draw all anew. */
    refresh() {
      this.colour = colours(this.canvas);
      const { width } = ChainPlots.fit(this.canvas);
      this.ratio = devicePixelRatio;
      this.strip.width = Math.round(width * this.ratio);
      this.strip.height = ROWS;
      this.rows.forEach((row, age) => this.drawRow(row, age));
    }

    /* Another chain, or other units: the strip begins anew. */
    restart(chain) {
      this.half = reach(chain);
      this.rows = [];
      this.refresh();
    }

    /* Add the state to the strip, and where rods have met. */
    add(state, unit, met) {
      const x = Float32Array.from(state.y, (_, i) => P.position(state, i));
      const row = [x, Float32Array.from(state.v, (_, i) => pace(state, i) / unit), met];
      this.rows.unshift(row);
      this.rows.length = Math.min(this.rows.length, ROWS);
      const outermost = Math.max(-x[0], x.at(-1)) + P.RADIUS;
      if (outermost > this.half && Number.isFinite(outermost)) {
        this.half = 1.3 * outermost;
        this.refresh();
        return;
      }
      const pen = this.strip.getContext("2d");
      pen.globalCompositeOperation = "copy";
      pen.drawImage(this.strip, 0, 1);
      pen.globalCompositeOperation = "source-over";
      this.drawRow(row, 0);
    }

    drawRow([x, v, met], age) {
      const pen = this.strip.getContext("2d"), scale = this.strip.width / (2 * this.half);
      const length = Math.max(2 * P.RADIUS * scale - this.ratio, 1);
      for (let i = 0; i < x.length; i++) {
        pen.fillStyle = shade(v[i], this.colour);
        pen.fillRect((x[i] + this.half) * scale - length / 2, age, length, 1);
      }
      if (!met) this.drawTrail(x, age, scale);
      if (!met || length < LEAST * this.ratio) return; // bars would hide the rods
      pen.fillStyle = this.colour.ink;
      const bar = Math.min(length, 8 * this.ratio);
      for (const c of met) pen.fillRect(((x[c] + x[c + 1]) / 2 + this.half) * scale - bar / 2, age, bar, 1);
    }

    /* The trail of the rod in the middle, where the others are a texture. */
    drawTrail(x, age, scale) {
      const pen = this.strip.getContext("2d"), rod = x.length >> 1, before = this.rows[age + 1]?.[0][rod] ?? x[rod];
      pen.fillStyle = this.colour.ink;
      const from = (Math.min(before, x[rod]) + this.half) * scale, across = Math.abs(before - x[rod]) * scale;
      pen.fillRect(from - this.ratio, age, across + 2 * this.ratio, 1);
    }

    /* Draw rods, springs and strip. `age`: the time that the strip spans [t_0]. */
    draw(state, unit, age) {
      const { pen, width, height } = ChainPlots.fit(this.canvas), { colour } = this;
      const scale = width / (2 * this.half), place = (x) => (x + this.half) * scale;
      pen.clearRect(0, 0, width, height);
      pen.imageSmoothingEnabled = false;
      pen.drawImage(this.strip, 0, BAND, width, height - BAND - AXIS);
      const length = Math.max(2 * P.RADIUS * scale - 1, 1), rank = (state.y.length - 1) / 2;
      for (let i = 0; i < state.y.length; i++) {
        const x = place(P.position(state, i));
        const anchor = place((2 * P.RADIUS + state.chain.gap) * (i - rank));
        if (!state.masses) drawSpring(pen, anchor, x, length, colour);
        const high = state.masses?.[i] > P.MASS ? 32 : 24;
        pen.fillStyle = shade(pace(state, i) / unit, colour);
        pen.fillRect(x - length / 2, 52 - high, length, high);
        if (length < 3) continue;
        pen.strokeStyle = i === state.held ? colour.exact : colour.ink;
        pen.lineWidth = i === state.held || (i === state.y.length >> 1 && this.rows[0]?.[2] === null) ? 3 : 1;
        pen.strokeRect(x - length / 2, 52 - high, length, high);
      }
      if (state.masses) {
        const wall = place(-state.chain.box / 2);
        pen.fillStyle = colour.grey;
        for (const left of [0, width - wall]) pen.fillRect(left, 0, wall, height - AXIS);
      }
      pen.font = `12px ${colour.sans}`;
      this.drawAxis(pen, place, width, height);
      pen.textAlign = "left";
      for (const ago of ChainPlots.ticks(0, age, 3)) {
        const at = BAND + (ago / age) * (height - BAND - AXIS);
        label(pen, ago ? `${ago} t₀ ago` : "now", 7, at + 4, colour);
        pen.fillRect(0, at, 4, 1);
      }
    }

    drawAxis(pen, place, width, height) {
      pen.fillStyle = this.colour.ink;
      pen.textAlign = "center";
      for (const x of ChainPlots.ticks(-this.half, this.half, width / 70)) {
        const at = place(x);
        if (at < 12 || at > width - 12) continue;
        pen.fillRect(at - 0.5, height - AXIS, 1, 4);
        pen.fillText(ChainPlots.number(x), at, height - AXIS + 15);
      }
      pen.fillText("position x [R]", width / 2, height - 3);
    }
  }

  /* A spring from its anchor, a tick at the top, to the middle of its rod. */
  function drawSpring(pen, anchor, x, length, colour) {
    pen.strokeStyle = colour.grey;
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(anchor - Math.min(length / 3, 5), 3);
    pen.lineTo(anchor + Math.min(length / 3, 5), 3);
    pen.moveTo(anchor, 3);
    const coils = 6, across = length > 8 ? 3 : 0; // narrow springs are straight lines
    for (let k = 1; k < coils; k++)
      pen.lineTo(anchor + ((x - anchor) * k) / coils + (k % 2 ? across : -across), 3 + (25 * k) / coils);
    pen.lineTo(x, 28);
    pen.stroke();
  }

  /* Text to be read on top of the strip. */
  function label(pen, text, x, y, colour) {
    pen.lineWidth = 4;
    pen.lineJoin = "round";
    pen.strokeStyle = colour.faint;
    pen.strokeText(text, x, y);
    pen.fillStyle = colour.ink;
    pen.fillText(text, x, y);
  }

  return { Stage, reach, pace, BAND, ROWS };
})();
