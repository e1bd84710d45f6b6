/* The pictures of what is measured: density, velocity widths, velocities and energy, each on axes
   with numbers, beside theory. */
"use strict";

const ChainPlots = (() => {
  const LEFT = 44, BELOW = 34, ABOVE = 20, RIGHT = 12; // pixels around a plot for its numbers and words
  const GAUSS = Array.from({ length: 121 }, (_, k) => (k - 60) / 10); // where a free rod's p(v) is drawn

  /* A canvas as wide as its place, drawn at the screen's own resolution. */
  function fit(canvas) {
    const ratio = devicePixelRatio, box = canvas.getBoundingClientRect();
    const width = Math.round(box.width * ratio), height = Math.round(box.height * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    return { pen, width: box.width, height: box.height };
  }

  /* Round numbers from one to another, about so many, at least so far apart. */
  function ticks(from, to, about, apart = 0) {
    const rough = Math.max((to - from) / about, apart), power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((each) => each * power >= 0.999 * rough);
    const first = Math.ceil(from / step - 1e-9), last = Math.floor(to / step + 1e-9);
    return Array.from({ length: last - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(12)));
  }

  const number = (value) => String(value).replace("-", "−");
  const powerOfTen = (k) => (k >= -2 && k <= 3 ? number(Number((10 ** k).toFixed(2)))
    : `10${String(k).replace(/./g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"["0123456789-".indexOf(digit)])}`);

  /* Axes for points (x, y) within two ranges; y may be a power of ten. */
  class Plot {
    constructor(canvas, colour, { x, y, xTitle, yTitle, apart, powers }) {
      Object.assign(this, fit(canvas), { colour, xRange: x, yRange: y });
      this.pen.clearRect(0, 0, this.width, this.height);
      this.pen.font = `12px ${colour.sans}`;
      this.frame(ticks(...x, this.width / 70, apart), ticks(...y, 4, powers && 1), powers ? powerOfTen : number);
      this.words(xTitle, (LEFT + this.width - RIGHT) / 2, this.height - 5, "center");
      this.words(yTitle, 2, 12, "left");
      this.legendEnd = this.width - 2;
    }

    across(x) {
      const [from, to] = this.xRange;
      return LEFT + ((x - from) / (to - from)) * (this.width - LEFT - RIGHT);
    }

    up(y) {
      const [from, to] = this.yRange;
      return ABOVE + (this.height - ABOVE - BELOW) * (1 - (y - from) / (to - from));
    }

    words(text, x, y, align) {
      this.pen.fillStyle = this.colour.ink;
      this.pen.textAlign = align;
      this.pen.fillText(text, x, y);
    }

    path(points) {
      this.pen.beginPath();
      for (const [x, y] of points) this.pen.lineTo(this.across(x), this.up(y));
    }

    frame(xs, ys, written) {
      const { pen } = this, [left, right] = this.xRange, [low, high] = this.yRange;
      pen.strokeStyle = this.colour.grey;
      pen.lineWidth = 1;
      for (const y of ys) {
        this.words(written(y), LEFT - 6, this.up(y) + 4, "right");
        this.path([[left, y], [right, y]]);
        pen.globalAlpha = 0.3;
        pen.stroke();
        pen.globalAlpha = 1;
      }
      this.path([[left, high], [left, low], [right, low]]);
      pen.stroke();
      for (const x of xs) {
        this.words(number(x), this.across(x), this.up(low) + 15, "center");
        pen.fillRect(this.across(x) - 0.5, this.up(low), 1, 3);
      }
    }

    /* Only what lies within the axes is seen. */
    within(draw) {
      const { pen } = this;
      pen.save();
      pen.beginPath();
      pen.rect(LEFT, ABOVE - 3, this.width - LEFT - RIGHT + 3, this.height - ABOVE - BELOW + 4);
      pen.clip();
      draw();
      pen.restore();
    }

    /* Name what `sample(x, y)` draws, from the right to the left. */
    name(text, sample) {
      const width = this.pen.measureText(text).width;
      this.words(text, this.legendEnd, 12, "right");
      sample(this.legendEnd - width - 16, 8);
      this.legendEnd -= width + 32;
    }

    area(points, strength, text) {
      const { pen, colour } = this, fill = (draw) => {
        pen.fillStyle = colour.grey;
        pen.globalAlpha = 0.55 * strength;
        draw();
        pen.globalAlpha = 1;
      };
      this.within(() => {
        this.path([[points[0][0], 0], ...points, [points[points.length - 1][0], 0]]);
        fill(() => pen.fill());
      });
      this.name(text, (x, y) => fill(() => pen.fillRect(x, y - 5, 12, 10)));
    }

    line(points, text, dash = []) {
      const { pen } = this, stroke = () => {
        pen.strokeStyle = dash.length ? this.colour.ink : this.colour.exact;
        pen.lineWidth = 1.8;
        pen.setLineDash(dash);
        pen.stroke();
        pen.setLineDash([]);
      };
      this.within(() => (this.path(points), stroke()));
      if (text) this.name(text, (x, y) => (pen.beginPath(), pen.moveTo(x - 4, y), pen.lineTo(x + 12, y), stroke()));
    }

    /* Squares, or rings in the colour of theory. */
    dots(points, strength, text, rings = false) {
      const { pen, colour } = this, dot = (x, y) => {
        pen.globalAlpha = strength;
        pen.fillStyle = colour.grey;
        pen.strokeStyle = colour.dots;
        pen.lineWidth = 1.5;
        pen.beginPath();
        pen.arc(x, y, 3, 0, 7);
        if (rings) pen.stroke();
        else pen.fillRect(x - 2.5, y - 2.5, 5, 5);
        pen.globalAlpha = 1;
      };
      this.within(() => points.forEach(([x, y]) => dot(this.across(x), this.up(y))));
      this.name(text, (x, y) => dot(x + 6, y));
    }
  }

  const strength = (measurement) => (measurement.settled ? 1 : 0.45);

  /* Pictures by name; `seen` has {half, measurement, unit, history, exact, theory}, where `theory` is
     what is known of the chain: {short, widths, density, other: {short, density}}. */
  const pictures = {
    density(canvas, colour, { half, measurement, exact, theory }) {
      // Stated errors are those of densities averaged as in the paper.
      const averaged = theory && theory.density, alike = averaged ? ChainMeasuring.averaged : (points) => points;
      const plot = new Plot(canvas, colour, {
        x: [-half, half], y: [0, 1.05], xTitle: "position x [R]",
        yTitle: averaged ? "share covered, averaged over 2R" : "share of time covered",
      });
      plot.area(alike(measurement.coverage()), strength(measurement), "measured");
      if (exact) plot.line(alike(exact), "exact");
      if (averaged && !exact) plot.line(theory.density, "theory");
      if (averaged && theory.other) plot.line(theory.other.density, theory.other.short, [6, 3]);
    },

    widths(canvas, colour, { measurement, unit, theory }) {
      const widths = measurement.widths().map((each) => each / unit), known = theory && theory.widths;
      const most = 1.12 * Math.max(1, ...widths, ...(known || []));
      const plot = new Plot(canvas, colour, {
        x: [0, widths.length + 1], y: [0, most], xTitle: "rod i", apart: 1, yTitle: "velocity width [W]",
      });
      plot.dots(widths.map((width, i) => [i + 1, width]), strength(measurement), "measured");
      if (known) plot.line(known.map((width, i) => [i + 1, width]), theory.short);
    },

    velocities(canvas, colour, { measurement }) {
      const log = ([v, p]) => [v, Math.log10(p)], [middle, ends] = ["middle", "ends"].map((where) =>
        measurement.velocities(where).map(log));
      const fastest = Math.max(4, ...[...middle, ...ends].map(([v]) => Math.abs(v)));
      const plot = new Plot(canvas, colour, {
        x: [-fastest, fastest], y: [-4.2, 0.4], xTitle: "velocity v [W], at the ends outward", yTitle: "p(v) [1/W]",
        powers: true,
      });
      plot.line(GAUSS.map((v) => log([v, Math.exp((-v * v) / 2) / Math.sqrt(2 * Math.PI)])), "free rod");
      plot.dots(ends, strength(measurement), "ends", true);
      plot.dots(middle, strength(measurement), "middle");
    },

    energy(canvas, colour, { history }) {
      const points = history.filter(([, energy]) => energy > 0).map(([t, energy]) => [t, Math.log10(energy)]);
      const ys = points.map(([, y]) => y), last = points.length - 1;
      const plot = new Plot(canvas, colour, {
        x: last > 0 ? [points[0][0], points[last][0]] : [0, 1], y: [Math.min(-1, ...ys), Math.max(1, ...ys) + 0.2], xTitle: "time t [T]",
        yTitle: "energy / that of free rods", powers: true,
      });
      plot.line(points, "measured", [1, 0]);
    },
  };

  return { fit, number, ticks, pictures };
})();
