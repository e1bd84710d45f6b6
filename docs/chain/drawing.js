/* What is seen: rods on their springs, a strip of where they were, density and velocity widths. */
"use strict";

const ChainDrawing = (() => {
  const P = ChainPhysics;
  const ROWS = 220; // of the strip, a pixel each
  const BAND = 64; // height of the rods above the strip, in pixels
  const FAST = 3; // free velocity widths at which a colour is full
  const AXIS = 26; // pixels left and below a plot for its numbers

  /* A canvas as wide as its place, drawn at the screen's own resolution. */
  function fit(canvas) {
    const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
    const width = Math.round(box.width * ratio), height = Math.round(box.height * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    return { pen, width: box.width, height: box.height };
  }

  /* The colours of the page as it is now, light or dark. */
  function colours(place) {
    const style = getComputedStyle(place), read = (name) => style.getPropertyValue(name).trim();
    const rgb = (name) => read(name).split(" ").map(Number);
    return {
      ink: read("--ink"), faint: read("--faint"), grey: read("--grey"), exact: read("--exact"),
      left: rgb("--left"), rest: rgb("--rest"), right: rgb("--right"), sans: style.fontFamily,
    };
  }

  /* Blue for a rod that moves left, orange to the right, pale at rest; v in free widths. */
  function shade(v, colour) {
    const share = Math.min(Math.abs(v) / FAST, 1), full = v < 0 ? colour.left : colour.right;
    return `rgb(${colour.rest.map((rest, k) => Math.round(rest + share * (full[k] - rest)))})`;
  }

  /* Half of the line that is shown [R]: the anchors and room for some thermal lengths. */
  function reach(chain) {
    const anchors = ((2 * P.RADIUS + chain.gap) * (chain.size - 1)) / 2;
    return anchors + 3 * P.RADIUS + 3.5 * P.thermalLength(chain);
  }

  class Picture {
    constructor(canvases) {
      this.canvases = canvases; // {stage, density, widths}
      this.strip = document.createElement("canvas");
      this.rows = []; // the last ones, newest first: [positions, velocities in free widths]
      this.half = 1;
    }

    /* Colours or sizes have changed: everything is drawn again. */
    refresh() {
      this.colour = colours(this.canvases.stage);
      const { width } = fit(this.canvases.stage);
      this.ratio = window.devicePixelRatio || 1;
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

    /* Add the present state to the strip. */
    add(state, unit) {
      const x = Float32Array.from(state.y, (_, i) => P.position(state, i));
      const row = [x, Float32Array.from(state.v, (v) => v / unit)];
      this.rows.unshift(row);
      this.rows.length = Math.min(this.rows.length, ROWS);
      const outermost = Math.max(-x[0], x[x.length - 1]) + P.RADIUS;
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

    drawRow([x, v], age) {
      const pen = this.strip.getContext("2d"), scale = this.strip.width / (2 * this.half);
      const length = Math.max(2 * P.RADIUS * scale - this.ratio, 1);
      for (let i = 0; i < x.length; i++) {
        pen.fillStyle = shade(v[i], this.colour);
        pen.fillRect((x[i] + this.half) * scale - length / 2, age, length, 1);
      }
    }

    /* Draw rods, springs and strip. `age`: the time that the strip spans [T]. */
    drawStage(state, unit, age) {
      const { pen, width, height } = fit(this.canvases.stage), { colour } = this;
      const scale = width / (2 * this.half), place = (x) => (x + this.half) * scale;
      pen.clearRect(0, 0, width, height);
      pen.imageSmoothingEnabled = false;
      pen.drawImage(this.strip, 0, BAND, width, height - BAND);
      const length = Math.max(2 * P.RADIUS * scale - 1, 1), rank = (state.y.length - 1) / 2;
      for (let i = 0; i < state.y.length; i++) {
        const x = place(P.position(state, i));
        const anchor = place((2 * P.RADIUS + state.chain.gap) * (i - rank));
        drawSpring(pen, anchor, x, length, colour);
        pen.fillStyle = shade(state.v[i] / unit, colour);
        pen.fillRect(x - length / 2, 30, length, 24);
        pen.strokeStyle = i === state.held ? colour.exact : colour.ink;
        pen.lineWidth = i === state.held ? 3 : 1;
        pen.strokeRect(x - length / 2, 30, length, 24);
      }
      pen.fillStyle = colour.ink;
      pen.font = `12px ${colour.sans}`;
      pen.textAlign = "left";
      label(pen, "now", 4, BAND + 13, colour);
      label(pen, `${Number(age.toPrecision(2))} T ago`, 4, height - 5, colour);
    }

    /* Draw the share of time that rods cover a place, and the exact one if there is one. */
    drawDensity(coverage, exact, settled) {
      const plot = new Plot(this.canvases.density, [-this.half, this.half], [0, 1.05], this.colour);
      plot.frame([0, 0.5, 1], "position x [R]");
      plot.area(coverage.filter(([x]) => Math.abs(x) <= this.half), settled ? 1 : 0.5);
      if (exact) plot.line(exact.filter(([x]) => Math.abs(x) <= this.half));
    }

    /* Draw the velocity width of each rod in free widths, and that of the theory if there is one. */
    drawWidths(widths, theory, settled) {
      const size = widths.length, most = 1.15 * Math.max(1, ...widths, ...(theory || []));
      const plot = new Plot(this.canvases.widths, [0, size + 1], [0, most], this.colour);
      plot.frame([0, ...(most < 8 ? [1] : []), ...(most > 2 ? [Math.floor(most)] : [])], "rod i");
      plot.dots(widths.map((width, i) => [i + 1, width]), settled ? 1 : 0.5);
      if (theory) plot.line(theory.map((width, i) => [i + 1, width]));
    }
  }

  /* A spring from its anchor, a tick at the top, to the middle of its rod. */
  function drawSpring(pen, anchor, x, length, colour) {
    pen.strokeStyle = colour.grey;
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(anchor - Math.min(length / 3, 5), 4);
    pen.lineTo(anchor + Math.min(length / 3, 5), 4);
    pen.moveTo(anchor, 4);
    const coils = 6, across = length > 8 ? 3 : 0; // narrow springs are straight lines
    for (let k = 1; k < coils; k++)
      pen.lineTo(anchor + ((x - anchor) * k) / coils + (k % 2 ? across : -across), 4 + (26 * k) / coils);
    pen.lineTo(x, 30);
    pen.stroke();
  }

  /* Text with the page's colour behind, to be read on top of the strip. */
  function label(pen, text, x, y, colour) {
    pen.lineWidth = 4;
    pen.strokeStyle = colour.faint;
    pen.strokeText(text, x, y);
    pen.fillText(text, x, y);
  }

  /* A plot of points (x, y) within two ranges, on a canvas. */
  class Plot {
    constructor(canvas, xRange, yRange, colour) {
      Object.assign(this, fit(canvas), { xRange, yRange, colour });
      this.pen.clearRect(0, 0, this.width, this.height);
    }

    across(x) {
      const [from, to] = this.xRange;
      return AXIS + ((x - from) / (to - from)) * (this.width - AXIS);
    }

    up(y) {
      const [from, to] = this.yRange;
      return (this.height - AXIS) * (1 - (y - from) / (to - from));
    }

    path(points) {
      this.pen.beginPath();
      for (const [x, y] of points) this.pen.lineTo(this.across(x), this.up(y));
    }

    /* Lines across at the numbers of the vertical axis, and the title of the other one. */
    frame(ticks, title) {
      const { pen, colour } = this;
      pen.font = `12px ${colour.sans}`;
      pen.fillStyle = colour.ink;
      pen.strokeStyle = colour.grey;
      pen.lineWidth = 1;
      pen.textAlign = "right";
      for (const y of ticks) {
        pen.fillText(String(y), AXIS - 6, this.up(y) + 4);
        this.path(this.xRange.map((x) => [x, y]));
        pen.globalAlpha = y === 0 ? 1 : 0.35;
        pen.stroke();
        pen.globalAlpha = 1;
      }
      pen.textAlign = "center";
      pen.fillText(title, (this.width + AXIS) / 2, this.height - 7);
    }

    area(points, strength) {
      this.path([[points[0][0], 0], ...points, [points[points.length - 1][0], 0]]);
      this.pen.fillStyle = this.colour.grey;
      this.pen.globalAlpha = 0.6 * strength;
      this.pen.fill();
      this.pen.globalAlpha = 1;
    }

    line(points) {
      this.path(points);
      this.pen.strokeStyle = this.colour.exact;
      this.pen.lineWidth = 1.5;
      this.pen.stroke();
    }

    dots(points, strength) {
      this.pen.fillStyle = this.colour.grey;
      this.pen.globalAlpha = strength;
      for (const [x, y] of points) this.pen.fillRect(this.across(x) - 2.5, this.up(y) - 2.5, 5, 5);
      this.pen.globalAlpha = 1;
    }
  }

  return { Picture, reach, BAND, ROWS };
})();
