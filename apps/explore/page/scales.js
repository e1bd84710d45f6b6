/* The scales of a chain {size, restitution, amplitude, damping, gap, spring}: those of the package
   (particles/scales.py), in units of R half a rod's length, M mass, t_0 time. Without springs it is a
   gas {size, box, mass_ratio} between two walls: every second rod is so many times as heavy. */
"use strict";

const ChainScales = (() => {
  const RADIUS = 1, MASS = (4 * Math.PI) / 3, STIFFNESS = 1;
  const SLOWEST_MODE = 1.241; // rate of a strongly damped rod on a quadratic spring, in k s/gamma

  const isGas = (chain) => chain.spring === "none";

  /* What the rods of a gas leave free of their box, and the masses of the rods. */
  const freeLength = ({ box, size }) => box - 2 * RADIUS * size;
  const masses = ({ size, mass_ratio: ratio }) => Array.from({ length: size }, (_, i) => MASS * (i % 2 ? ratio : 1));

  /* The smallest box of a gas. */
  const narrowest = (chain) => (isGas(chain) ? 2 * RADIUS * chain.size + 2 : 0);

  /* The exponent n of the springs' potential k |d|^n/n, and their force over k. */
  const exponent = (chain) => (chain.spring === "quadratic" ? 3 : 2);
  const pull = (d, n) => (n === 2 ? d : d * Math.abs(d));

  /* W = A/sqrt(2 m gamma), the velocity width of a rod that meets no other. In a gas, where all rods
     begin with the speed 1 R/t_0, sqrt(T/m) of the light rods once all have the mean energy T/2. */
  function freeWidth(chain) {
    if (isGas(chain)) return Math.sqrt(masses(chain).reduce((sum, m) => sum + m / MASS, 0) / chain.size);
    return chain.amplitude / Math.sqrt(2 * MASS * chain.damping);
  }

  /* s = (T/k)^(1/n); of linear springs the standard deviation of a free rod's displacement. */
  const thermalLength = (chain) => ((MASS * freeWidth(chain) ** 2) / STIFFNESS) ** (1 / exponent(chain));

  /* w0; of a quadratic spring at ten times the temperature. */
  function springRate(chain) {
    const stiffness = exponent(chain) === 2 ? STIFFNESS : 2 * STIFFNESS * 30 ** (1 / 3) * thermalLength(chain);
    return Math.sqrt(stiffness / MASS);
  }

  /* The stiffness of the linear spring that relaxes as slowly as the chain's own. */
  function relaxingStiffness(chain) {
    if (exponent(chain) === 2) return STIFFNESS;
    const s = thermalLength(chain);
    if (s === 0) return 0;
    const fluctuation = ((0.54 * chain.gap) / s) ** 0.4, pushed = 1 / (1 + (chain.gap * chain.size) / (2 * s));
    return SLOWEST_MODE * STIFFNESS * s * Math.min(1, Math.hypot(fluctuation, pushed));
  }

  /* The time in which a rod that meets no other forgets where it was and how fast; in a gas that in
     which a rod of the speed 1 R/t_0 meets 22 others. */
  function relaxationTime(chain) {
    if (isGas(chain)) return (7 * Math.PI * freeLength(chain)) / chain.size;
    const half = chain.damping / (2 * MASS), stiff = relaxingStiffness(chain) / MASS;
    if (stiff === 0 || half * half <= stiff) return 1 / (stiff === 0 ? 2 * half : half);
    return (half + Math.sqrt(half * half - stiff)) / stiff;
  }

  /* The package's default step: it resolves spring and damping and, for e != 1, the noise. */
  function timeStep(chain) {
    const e = chain.restitution;
    // A rod on a quadratic spring without noise still swings when it is pushed.
    if (chain.amplitude === 0 && exponent(chain) === 3) return timeStep({ ...chain, amplitude: 1 });
    const rate = springRate(chain), step = 0.05 / Math.max(rate, chain.damping / MASS);
    if (e === 1 || chain.amplitude === 0) return step;
    let cooling = 0; // an estimate of how much collisions cool the centre
    if (e < 1) {
      const span = (chain.gap * chain.size) / (2.5 * thermalLength(chain));
      const neighbours = chain.size / (1 + span);
      cooling = (0.1 + 0.14 * e ** 4) * (1 - e * e) * neighbours * ((rate * MASS) / chain.damping);
    }
    return Math.min(step, (0.09 * MASS) / (2 * chain.damping * (1 + cooling)));
  }

  /* The exact motion of a rod on a linear spring, as in laws/exact_flight.py, and the triangular root of
     the covariance of its noise. */
  function propagator(chain, duration) {
    const b = chain.damping / (2 * MASS), square = STIFFNESS / MASS, excess = (square - b * b) * duration ** 2;
    const fade = Math.exp(-b * duration), turn = Math.sqrt(Math.abs(excess));
    let c = 1 - excess / 2, s = duration * (1 - excess / 6); // near the critical damping
    if (turn > 1e-3) {
      c = excess > 0 ? Math.cos(turn) : Math.cosh(turn);
      s = (duration * (excess > 0 ? Math.sin(turn) : Math.sinh(turn))) / turn;
    }
    const yy = fade * (c + b * s), yv = fade * s, vy = -fade * square * s, vv = fade * (c - b * s);
    // What is forgotten of the equilibrium, of <y^2> = T/k and <v^2> = T/m, is what noise has added.
    const v2 = freeWidth(chain) ** 2, y2 = v2 / square;
    const noise = Math.sqrt(v2 * (1 - vv * vv) - y2 * vy * vy);
    const shared = noise > 0 ? -(y2 * yy * vy + v2 * yv * vv) / noise : 0;
    const own = Math.sqrt(Math.max(y2 * (1 - yy * yy) - v2 * yv * yv - shared ** 2, 0));
    return { yy, yv, vy, vv, noise, shared, own };
  }

  return {
    RADIUS, MASS, STIFFNESS, isGas, freeLength, masses, narrowest, exponent, pull, freeWidth, thermalLength,
    relaxationTime, timeStep, propagator,
  };
})();
