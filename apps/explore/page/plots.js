/* The pictures of what is measured, each on axes with numbers, beside theory. */
"use strict";

const ChainPlots = (() => {
  const LEFT = 44, BELOW = 34, ABOVE = 20, RIGHT = 12; // pixels around a plot for its numbers and words
  const GAUSS = Array.from({ length: 121 }, (_, k) => (k - 60) / 10); // where a free rod's p(v) is drawn

  /* A canvas at the screen's own resolution. */
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

  /* Round limits around values that are seen, at least so far apart. */
  function around(values, apart) {
    const low = Math.min(...values), high = Math.max(...values), room = Math.max(apart - (high - low), 0) / 2;
    const from = Math.max(low - room, 0), [one, two] = ticks(from, high + room, 5), step = two - one;
    return [Math.floor(from / step) * step, Math.ceil((high + room) / step) * step];
  }

  // A prediction on the picture that is drawn: {guess, axes, hidden}, `hidden` before anything is shown.
  let predicted = null;
  const joined = (one, other) => (other ? [Math.min(one[0], other[0]), Math.max(one[1], other[1])] : one);

  const number = (value) => String(value).replace("-", "−");
  const powerOfTen = (k) => (k >= -2 && k <= 3 ? number(Number((10 ** k).toFixed(2)))
    : `10${String(k).replace(/./g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"["0123456789-".indexOf(digit)])}`);

  /* Axes for points (x, y) within two ranges; y may be a power of ten. */
  class Plot {
    constructor(canvas, colour, { x, y, xTitle, yTitle, apart, powers }) {
      const { axes = {}, hidden } = predicted ?? {}, range = (own, wanted) => (hidden && wanted) || joined(own, wanted);
      Object.assign(this, fit(canvas), { colour, hidden, xRange: range(x, axes.x), yRange: range(y, axes.y), seen: {} });
      this.drawn = axes.x ?? this.xRange; // where a prediction lies
      this.above = this.width < 420 ? ABOVE + 14 : ABOVE; // names of curves need two lines on a phone
      this.pen.clearRect(0, 0, this.width, this.height);
      this.pen.font = `12px ${colour.sans}`;
      const xs = ticks(...this.xRange, this.width / 70, apart), ys = ticks(...this.yRange, 4, powers && 1);
      this.frame(xs, ys, powers ? powerOfTen : number);
      this.words(xTitle, (LEFT + this.width - RIGHT) / 2, this.height - 5, "center");
      this.words(yTitle, 2, 12, "left");
      Object.assign(this, { legendEnd: this.width - 2, base: 12, free: 10 + this.pen.measureText(yTitle).width });
      canvas.plot = this;
    }

    across(x) {
      const [from, to] = this.xRange;
      return LEFT + ((x - from) / (to - from)) * (this.width - LEFT - RIGHT);
    }

    up(y) {
      const [from, to] = this.yRange;
      return this.above + (this.height - this.above - BELOW) * (1 - (y - from) / (to - from));
    }

    /* The share of the way across a prediction, and the value, of a place on the canvas. */
    at(x, y) {
      const [from, to] = this.xRange, [low, high] = this.yRange, [left, right] = this.drawn;
      const place = from + ((x - LEFT) / (this.width - LEFT - RIGHT)) * (to - from);
      const value = low + (high - low) * (1 - (y - this.above) / (this.height - this.above - BELOW));
      return [(place - left) / (right - left), Math.min(Math.max(value, low), high)];
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

    /* Only what lies within the axes is seen, and nothing before a prediction. */
    within(draw) {
      const { pen } = this;
      if (this.hidden) return;
      pen.save();
      pen.beginPath();
      pen.rect(LEFT, this.above - 3, this.width - LEFT - RIGHT + 3, this.height - this.above - BELOW + 4);
      pen.clip();
      draw();
      pen.restore();
    }

    /* Name what `sample(x, y)` draws, from the right to the left, and on the next line beside a long title. */
    name(text, sample) {
      if (this.hidden) return;
      const width = this.pen.measureText(text).width;
      if (this.legendEnd - width - 16 < this.free) {
        Object.assign(this, { legendEnd: this.width - 2, base: this.base + 14, free: LEFT });
      }
      this.words(text, this.legendEnd, this.base, "right");
      sample(this.legendEnd - width - 16, this.base - 4);
      this.legendEnd -= width + 32;
    }

    area(points, strength, text) {
      this.seen[text] = points;
      const { pen, colour } = this, fill = (draw) => {
        pen.fillStyle = colour.grey;
        pen.globalAlpha = 0.55 * strength;
        draw();
        pen.globalAlpha = 1;
      };
      this.within(() => {
        this.path([[points[0][0], 0], ...points, [points.at(-1)[0], 0]]);
        fill(() => pen.fill());
      });
      this.name(text, (x, y) => fill(() => pen.fillRect(x, y - 5, 12, 10)));
    }

    line(points, text, dash = []) {
      this.seen[text] = points;
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

    /* Squares or rings, of [x, y] or, with an error bar, of [x, y, low, high]. */
    dots(points, strength, text, rings = false) {
      this.seen[text] = points;
      const { pen, colour } = this, dot = (x, y) => {
        pen.globalAlpha = strength;
        pen.fillStyle = colour.grey;
        pen.strokeStyle = colour.ink;
        pen.lineWidth = 1.5;
        pen.beginPath();
        pen.arc(x, y, 3, 0, 7);
        if (rings) pen.stroke();
        else pen.fillRect(x - 2.5, y - 2.5, 5, 5);
        pen.globalAlpha = 1;
      };
      this.bars(points);
      this.within(() => points.forEach(([x, y]) => dot(this.across(x), this.up(y))));
      this.name(text, (x, y) => dot(x + 6, y));
    }

    bars(points) {
      const { pen } = this;
      pen.fillStyle = this.colour.ink;
      this.within(() => points.forEach(([x, , low, high]) => {
        if (high > low) pen.fillRect(this.across(x) - 0.6, this.up(high), 1.2, this.up(low) - this.up(high));
      }));
    }

    /* The curve that somebody drew, and before it is shown the point that keys move. */
    prediction({ values, at }) {
      const { hidden, drawn: [left, right] } = this, place = (k) => left + (k / (values.length - 1)) * (right - left);
      if (values[0] === null) {
        if (hidden) this.words("draw here what you expect", this.width / 2, this.height / 2, "center");
        return;
      }
      this.hidden = false;
      this.line(values.map((y, k) => [place(k), y]), "yours", [2, 3]);
      this.hidden = hidden;
      if (hidden) this.pen.fillRect(this.across(place(at)) - 4, this.up(values[at]) - 4, 8, 8);
    }
  }

  const strength = ({ settled, blocks }) => (settled && blocks.length > 1 ? 1 : 0.45);

  /* [x, y] with an error bar, where the error is known; of logarithms, too. */
  const barred = (x, y, error, log = (each) => each) =>
    (error > 0 ? [x, log(y), log(Math.max(y - error, 1e-9)), log(y + error)] : [x, log(y)]);

  const measuredIn = ({ settled, samples }) =>
    (settled ? "measured" : samples ? "not settled yet" : "not measured yet");

  /* Pictures by name, of {half, measurement, history, restitution, unit, counted, inUnits, exact, theory,
     gas}: velocities are divided by the `unit`, those of the distributions counted in `counted` units, the
     `theory` is {short, widths, density, other}, and `gas` {box, forces, found, exact}. Each returns what is
     seen on it as a sentence. */
  const pictures = {
    density(canvas, colour, { half, measurement, exact, theory }) {
      // Stated errors are those of densities averaged as in the paper.
      const averaged = theory?.density, alike = averaged ? ChainMeasuring.averaged : (points) => points;
      const measured = alike(measurement.coverage()), most = Math.max(0.1, ...measured.map(([, share]) => share));
      const plot = new Plot(canvas, colour, {
        x: [-half, half], y: [0, Math.min(1.05, 1.15 * most)], xTitle: "position x [R]",
        yTitle: averaged ? "share covered, averaged over 2R" : "share of time covered",
      });
      plot.area(measured, strength(measurement), "measured");
      const errors = averaged ? [] : measurement.errors("covered"), every = Math.ceil(measured.length / 30);
      plot.bars(measured.map(([x, y], k) => (k % every ? [x, y] : barred(x, y, errors[k]))));
      if (exact) plot.line(alike(exact), "exact");
      else if (averaged) plot.line(averaged, theory.short);
      if (averaged && theory.other) plot.line(theory.other.density, theory.other.short, [6, 3]);
      const covered = measured.filter(([, share]) => share > 0.01).map(([x]) => x), percent = Math.round(100 * most);
      return `Density, ${measuredIn(measurement)}: rods cover a place for up to ${percent} % of the time, from x = ` +
        `${Math.round(covered[0])} to ${Math.round(covered.at(-1))} R.`;
    },

    widths(canvas, colour, { measurement, unit, inUnits, theory }) {
      const widths = measurement.widths().map((each) => each / unit), known = theory?.widths;
      const errors = measurement.errors("squares").map((error, i) => error / (2 * unit ** 2 * widths[i]));
      const plot = new Plot(canvas, colour, {
        x: [0, widths.length + 1], y: around([...widths, ...(known || [])], 0.2), xTitle: "rod i", apart: 1,
        yTitle: `velocity width [${inUnits}]`,
      });
      plot.dots(widths.map((width, i) => barred(i + 1, width, errors[i])), strength(measurement), "measured");
      if (known) plot.line(known.map((width, i) => [i + 1, width]), theory.short);
      const last = widths.length - 1, said = (all) => [0, last >> 1, last].map((i) => all[i].toFixed(2)).join(", ");
      return `Velocity widths of the first, the middle and the last rod, ${measuredIn(measurement)}: ${said(widths)} ` +
        `${inUnits}${known ? `; ${theory.short}: ${said(known)} ${inUnits}` : ""}.`;
    },

    velocities(canvas, colour, { measurement, restitution, counted, inUnits, gas }) {
      const log = ([v, p]) => [v, Math.log10(p)], [middle, ends] = ["middle", "ends"].map((where) =>
        measurement.velocities(where).map(([v, p, error]) =>
          barred(v * counted, p / counted, error / counted, Math.log10)));
      const [slow, fast] = [middle, ends].map((points) => Math.max(0, ...points.map(([v]) => Math.abs(v))));
      const fastest = Math.max(inUnits === "W" ? 4 : 0.1, slow, fast);
      const plot = new Plot(canvas, colour, {
        x: [-fastest, fastest], y: [-4.2, 0.4],
        xTitle: gas ? "velocity v √(mᵢ/m) of a rod of mass mᵢ [W]"
          : `velocity v [${inUnits}], at the ends outward`,
        yTitle: `p(v) [${inUnits === "W" ? "1/W" : "t₀/R"}]`, powers: true,
      });
      const gauss = GAUSS.map((v) => log([v, Math.exp((-v * v) / 2) / Math.sqrt(2 * Math.PI)]));
      if (inUnits === "W") plot.line(gauss, gas ? "Maxwell" : restitution === 1 ? "exact" : "free rod");
      if (!gas) plot.dots(ends, strength(measurement), "ends", true);
      plot.dots(middle, strength(measurement), gas ? "all rods" : "middle");
      if (gas) return `Velocities, ${measuredIn(measurement)}: seen up to ${slow.toFixed(1)} W.`;
      return `Velocities, ${measuredIn(measurement)}: seen up to ${slow.toFixed(1)} ${inUnits} in the middle and ` +
        `${fast.toFixed(1)} ${inUnits} at the ends.`;
    },

    /* Of a gas in several boxes, with the line through them and the exact one. */
    pressure(canvas, colour, { gas: { box, forces, found, exact } }) {
      const points = forces.map(({ chain, value, error }) => barred(chain.box, 1 / value, error / value ** 2));
      const last = 1.1 * Math.max(box, ...points.map(([x]) => x));
      const at = ({ start, slope }, x) => [x, slope * (x - start)];
      const plot = new Plot(canvas, colour, {
        x: [0, last], y: [0, 1.1 * Math.max(at(exact, last)[1], ...points.map(([, y]) => y))],
        xTitle: "length of the box X [R]", yTitle: "1/force on a wall [t₀²/(M R)]",
      });
      const draw = (line, ...how) => plot.line([at(line, line.start), at(line, last)], ...how);
      if (exact.known) draw(exact, "exact");
      if (found) draw(found, "straight line", [6, 3]);
      plot.dots(points, 1, "measured");
      return `1/force on a wall: measured in ${forces.length} boxes` +
        `${found ? `; the line through them begins at ${found.start.toFixed(1)} R` : ""}.`;
    },

    /* Of a gas, from its beginning. */
    collisions(canvas, colour, { history }) {
      const points = history.map(([t, , met]) => [t, met]), [last, most] = points.at(-1);
      const plot = new Plot(canvas, colour, {
        x: [0, Math.max(last, 1)], y: [0, Math.max(1.1 * most, 4)], xTitle: "time t [t₀]",
        yTitle: "collisions of rods and with the left wall",
      });
      plot.line(points, "counted", [1, 0]);
      return `Collisions of rods and with the left wall: ${most} in ${Math.round(last)} t₀.`;
    },

    energy(canvas, colour, { history, inUnits }) {
      const points = history.filter(([, energy]) => energy > 0).map(([t, energy]) => [t, Math.log10(energy)]);
      const ys = points.map(([, y]) => y), last = points.length - 1;
      const of = inUnits === "W" ? "that of free rods" : "that of free rods at A = 1";
      const plot = new Plot(canvas, colour, {
        x: last > 0 ? [points[0][0], points[last][0]] : [0, 1], y: [Math.min(-1, ...ys), Math.max(1, ...ys) + 0.2],
        xTitle: "time since the last change [t₀]", yTitle: `energy / ${of}`, powers: true,
      });
      plot.line(points, "measured", [1, 0]);
      if (last < 1) return "Energy: not measured yet.";
      const [from, to] = [ys[0], ys[last]].map((y) => Number((10 ** y).toPrecision(2)));
      return `Energy: from ${from} to ${to} times ${of} within ${Math.round(points[last][0] - points[0][0])} t₀.`;
    },
  };

  /* Draw a picture, with the prediction on it if there is one, and return what is seen as a sentence. A
     picture without a prediction of its own is closed until then. */
  function draw(name, canvas, colour, seen, prediction) {
    predicted = prediction;
    if (prediction?.hidden && !prediction.guess) {
      const { pen, width, height } = fit(canvas);
      pen.clearRect(0, 0, width, height);
      pen.font = `12px ${colour.sans}`;
      pen.fillStyle = colour.ink;
      pen.textAlign = "center";
      pen.fillText("shown after your prediction", width / 2, height / 2);
      return "Shown after your prediction.";
    }
    const sentence = pictures[name](canvas, colour, seen);
    if (prediction) canvas.plot.prediction(prediction.guess);
    return prediction?.hidden ? "Draw what you expect: the keys left and right choose a point, up and down move it." : sentence;
  }

  return { fit, number, ticks, draw };
})();
