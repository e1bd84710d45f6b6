/* What is measured of the running chain, and the exact density at e = 1 to compare with. */
"use strict";

const ChainMeasuring = (() => {
  const P = ChainPhysics;
  const BINS = 8; // bins of the density per R
  const SETTLING = 3; // relaxation times before a measurement begins
  const CELL = 0.25, FASTEST = 15; // of the velocity distributions, in free widths
  const REACH = { 2: 7, 3: 4.5 }; // thermal lengths that a rod is followed in the exact density

  /* Averages over time: of v^2 of every rod, of the share of time that a place is covered, and of
     the velocities in the middle and, outward, at the ends. */
  class Measurement {
    constructor(state, half) {
      this.half = Math.ceil(half); // places from -half to half [R]
      this.counts = new Float64Array(2 * this.half * BINS);
      this.squares = new Float64Array(state.y.length);
      this.middle = new Float64Array((2 * FASTEST) / CELL + 1);
      this.ends = new Float64Array(this.middle.length);
      this.restart(state);
    }

    /* Begin again: the chain was changed or touched, and has to settle. */
    restart(state) {
      this.settling = SETTLING * P.relaxationTime(state.chain);
      this.oneMass = state.chain.mass_ratio === 1;
      // Energies are forgotten in m/(2 gamma), so that the averages of such blocks are independent.
      const relaxation = P.relaxationTime(state.chain);
      this.record = [[0, 0]]; // of a gas since then: the time, and the time integral of the force
      // In a gas 7 pi are nearly 22, and ten blocks of two rods would be a whole number of periods.
      this.blockTime = state.masses ? 1.005 * relaxation : Math.max((4 * P.MASS) / state.chain.damping, relaxation);
      this.clear();
    }

    clear() {
      for (const each of [this.counts, this.squares, this.middle, this.ends]) each.fill(0);
      this.samples = this.time = 0;
      this.begun = this.record.length - 1; // where the first block does
      this.stops = []; // of the blocks in the record
      this.marks = {}; // of each sum at the end of the last block, and the squares of what blocks added
      this.blocks = []; // of mean [v^2 at the border, v^2 in the centre], of a gas [force, kurtosis]
      this.block = [0, 0, 0]; // sums of both, and the time of the present block
    }

    /* Take the present state into the averages; it was `elapsed` ago that one was taken. Velocities
       are counted in the `unit`. */
    add(state, elapsed, unit) {
      if (this.settling > 0 && (this.settling -= elapsed) <= 0) this.clear();
      for (let i = 0; i < state.y.length; i++) {
        this.squares[i] += state.v[i] ** 2;
        const bin = Math.floor((P.position(state, i) + this.half) * BINS);
        if (bin >= 0 && bin < this.counts.length) this.counts[bin]++;
      }
      const size = state.v.length, count = (cells, v) => cells[Math.round((v / unit + FASTEST) / CELL)]++;
      if (state.masses) state.v.forEach((_, i) => count(this.middle, ChainDrawing.pace(state, i)));
      else {
        for (const i of centreOf(size)) count(this.middle, state.v[i]);
        count(this.ends, -state.v[0]);
        count(this.ends, state.v[size - 1]);
      }
      this.samples++;
      this.time += elapsed;
      const block = this.block;
      const means = state.masses ? ChainGas.seen(state, elapsed)
        : [borderOf(size), centreOf(size)].map((rods) => meanSquare(state.v, rods));
      means.forEach((mean, k) => { block[k] += elapsed * mean; });
      const [time, sum] = this.record.at(-1);
      if (state.masses) this.record.push([time + elapsed, sum + elapsed * means[0]]);
      block[2] += elapsed;
      if (block[2] < this.blockTime) return;
      this.blocks.push([block[0] / block[2], block[1] / block[2]]);
      this.stops.push(this.record.length - 1);
      this.block = [0, 0, 0];
      this.mark();
    }

    /* Keep how much the block that has ended added to each sum. */
    mark() {
      const { squares, middle, ends } = this;
      for (const [name, sums] of Object.entries({ squares, middle, ends, covered: covered(this.counts) })) {
        const { last, added } = this.marks[name] ?? {};
        const more = sums.map((sum, k) => (added?.[k] ?? 0) + (sum - (last?.[k] ?? 0)) ** 2);
        this.marks[name] = { last: sums.slice(), added: more, samples: this.samples };
      }
    }

    /* Standard errors of averages over the samples, from blocks; none before the second one. */
    errors(name) {
      const n = this.blocks.length, { last, added, samples } = this.marks[name] ?? {};
      if (n < 2) return [];
      return Array.from(last, (sum, k) => Math.sqrt(Math.max(added[k] - sum ** 2 / n, 0) * (n / (n - 1))) / samples);
    }

    /* The force on a wall of a gas in the last samples. */
    momentary() {
      const [time, sum] = this.record.at(-1), [before, less] = this.record.at(-30) ?? this.record[0];
      return time > before ? (sum - less) / (time - before) : 0;
    }

    get settled() {
      return this.settling <= 0;
    }

    /* The velocity widths sqrt(<v^2>) of all rods. */
    widths() {
      return Array.from(this.squares, (sum) => Math.sqrt(sum / Math.max(this.samples, 1)));
    }

    /* [[velocity, its probability density, its error], ...] in the middle or at the "ends", where any
       was seen. */
    velocities(where) {
      const total = this[where].reduce((sum, n) => sum + n, 0) * CELL, errors = this.errors(where);
      const share = this.samples / total;
      return Array.from(this[where], (n, k) => [k * CELL - FASTEST, n / total, errors[k] * share]).filter(([, p]) => p > 0);
    }

    /* [[place, share of time that a rod covers it], ...], at the edges of the bins. */
    coverage() {
      return Array.from(covered(this.counts), (sum, k) =>
        [(k + 1) / BINS - this.half - P.RADIUS, sum / Math.max(this.samples, 1)]);
    }

    /* Kinetic energy at the border over that in the centre in some blocks, with its standard error. */
    ratio(blocks = this.blocks) {
      const n = blocks.length;
      if (n < 2) return null;
      const mean = (k) => blocks.reduce((sum, block) => sum + block[k], 0) / n;
      const border = mean(0), centre = mean(1);
      let scatter = 0;
      for (const block of blocks) scatter += (block[0] / border - block[1] / centre) ** 2;
      const value = border / centre;
      return { value, error: value * Math.sqrt(scatter / (n * (n - 1))) };
    }

    /* The mean force on the two walls in the first blocks, with its standard error. With the virial
       G = sum of m y v this is P l = L T - dG/dt. The deviations of two blocks in turn cancel, but for
       G at the first and at the last moment, and the error falls like 1/n. Rods of one mass pass on
       their speed, G is periodic, and blocks near a period of it would hardly differ. The error is
       then the scatter of averages over an equal time that begin earlier, while the gas settles. */
    force(n = this.blocks.length) {
      const { value, scatter } = mean(this.blocks.slice(0, n).map(([force]) => force));
      if (!this.oneMass || n === 0) return { value, error: scatter / n };
      const average = (from, to) => (to[1] - from[1]) / (to[0] - from[0]), { record, begun } = this;
      const length = this.stops[n - 1] - begun;
      const earlier = Array.from({ length: begun + 1 }, (_, k) => average(record[k], record[k + length]));
      return { value, error: mean(earlier).scatter };
    }

    /* The kurtosis of the velocities of a gas in the first blocks, with its standard error. */
    kurtosis(n = this.blocks.length) {
      const { value, scatter } = mean(this.blocks.slice(0, n).map(([, kurtosis]) => kurtosis));
      return { value, error: scatter / Math.sqrt(n) };
    }
  }

  /* How often a rod covered the edges of the bins, of the `counts` of its centre. */
  function covered(counts) {
    const width = 2 * P.RADIUS * BINS, found = new Float64Array(counts.length + width);
    for (let k = 0, sum = 0; k < found.length; k++)
      found[k] = sum += (counts[k] || 0) - (counts[k - width] || 0);
    return found;
  }

  /* The running average of points over a rod's length, as the paper draws it. */
  function averaged(points) {
    const half = P.RADIUS * BINS, share = (k) => (points[k] ? points[k][1] : 0);
    return points.map(([x], k) => {
      let sum = (share(k - half) + share(k + half)) / 2; // trapezoids
      for (let j = k - half + 1; j < k + half; j++) sum += share(j);
      return [x, sum / (2 * half)];
    });
  }

  /* The first and the last rod; the middle tenth, at least the one or two in the middle. */
  const borderOf = (size) => [0, size - 1];
  function centreOf(size) {
    const from = Math.min(Math.floor((9 * size + 9) / 20), Math.floor((size - 1) / 2));
    return Array.from({ length: size - 2 * from }, (_, k) => from + k);
  }

  /* The mean of numbers and their standard deviation. */
  function mean(numbers) {
    const n = numbers.length, value = numbers.reduce((sum, each) => sum + each, 0) / n;
    return { value, scatter: Math.sqrt(numbers.reduce((sum, each) => sum + (each - value) ** 2, 0) / (n - 1)) };
  }

  const meanSquare = (v, rods) => rods.reduce((sum, i) => sum + v[i] ** 2, 0) / rods.length;

  /* The exact equilibrium at e = 1, by the recursion F_i of kinetic/exact/gibbs_measure.py, there Z_i. Return
     the integrals of each rod's density on grids of spacing `h` that begin at `starts` times h. */
  function exactDistributions(chain) {
    const s = P.thermalLength(chain), size = chain.size, n = P.exponent(chain);
    // Points per thermal length: without a gap F_i grows by its own size within s/i.
    const points = Math.max(40, 2 * size), h = s / points, reach = Math.round(REACH[n] * points);
    const starts = [], weights = [], sums = [];
    for (let i = 0; i < size; i++) {
      const anchor = chain.gap * (i - (size - 1) / 2);
      starts.push(Math.round(anchor / h) - reach);
      weights.push(
        Float64Array.from({ length: 2 * reach + 1 }, (_, k) =>
          Math.exp(-(Math.abs(((starts[i] + k) * h - anchor) / s) ** n) / n)),
      );
    }
    // F_i at place j h: 0 left of its grid, its last value right of it; 1 without points.
    function left(i, j) {
      if (i < 0) return 1;
      const k = j - starts[i];
      return k < 0 ? 0 : sums[i][Math.min(k, 2 * reach)];
    }
    for (let i = 0; i < size; i++)
      sums.push(integral(weights[i].map((w, k) => w * left(i - 1, starts[i] + k))));
    const distributions = weights.map((weight, i) =>
      integral(weight.map((w, k) => {
        const j = starts[i] + k;
        return w * left(i - 1, j) * left(size - 2 - i, -j);
      })));
    return { h, starts, distributions };
  }

  /* The integral from the first point on, by cubics through four points, over the last value.
     Trapezoids would be wrong by 1e-3. */
  function integral(values) {
    const sums = new Float64Array(values.length), at = (k) => values[k] || 0;
    for (let k = 1; k < values.length; k++)
      sums[k] = sums[k - 1] + 13 * (values[k] + values[k - 1]) - at(k - 2) - at(k + 1);
    return sums.map((sum) => sum / sums.at(-1));
  }

  /* The exact share of time that a rod covers each of the places, at e = 1. */
  function exactCoverage(chain, places) {
    const { h, starts, distributions } = exactDistributions(chain), covered = places.map(() => 0);
    distributions.forEach((distribution, i) => {
      const shift = 2 * P.RADIUS * (i - (chain.size - 1) / 2), last = distribution.length - 1;
      const below = (x) => {
        const k = Math.min(Math.max((x - shift) / h - starts[i], 0), last), low = Math.floor(k);
        const high = Math.min(low + 1, last);
        return distribution[low] + (k - low) * (distribution[high] - distribution[low]);
      };
      places.forEach((x, at) => {
        covered[at] += below(x + P.RADIUS) - below(x - P.RADIUS);
      });
    });
    return covered;
  }

  return { Measurement, averaged, exactCoverage };
})();
