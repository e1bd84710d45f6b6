/* The address of the page holds a setting: #size=20&gap=0.5. So does a query: ?size=20&gap=0.5. */
"use strict";

const ChainAddress = (() => {
  const USUAL = { size: 100, restitution: 1, amplitude: 1, damping: 1, gap: 0, spring: "linear" };
  const NAMES = Object.keys(USUAL);

  /* Return the chain that the address asks for, with the usual values for what it leaves out, or why
     it is refused, or null if it asks for none. `controls` has the slider or list of each name. */
  function read(controls, { search, hash } = location) {
    const text = hash.includes("=") ? hash : search, given = [...new URLSearchParams(text.slice(1))];
    if (!given.length) return null;
    const chain = { ...USUAL };
    for (const [name, value] of given) {
      if (!NAMES.includes(name)) return { refused: `${name} is none of ${NAMES.join(", ")}` };
      const control = controls[name], list = control.options && [...control.options].map((option) => option.value);
      const wanted = list ? list.join(" or ") : `a number from ${control.min} to ${control.max}`;
      const number = value.trim() === "" ? NaN : Number(value);
      const right = list ? list.includes(value)
        : number >= control.min && number <= control.max && (name !== "size" || Number.isInteger(number));
      if (!right) return { refused: `${name} must be ${wanted}, got ${value}` };
      chain[name] = list ? value : number;
    }
    return { chain };
  }

  function write(chain) {
    const setting = `#${new URLSearchParams(NAMES.map((name) => [name, chain[name]]))}`;
    // A page that was opened as a file may change only what follows the #.
    history.replaceState(null, "", location.protocol === "file:" ? setting : location.pathname + setting);
  }

  const same = (one, other) => NAMES.every((name) => one[name] === other[name]);

  /* The setting in the symbols of the paper. */
  const told = (chain) => `L = ${chain.size}, e = ${chain.restitution}, A = ${chain.amplitude}, ` +
    `γ = ${chain.damping}, g = ${chain.gap}, ${chain.spring} springs`;

  return { USUAL, NAMES, read, write, same, told };
})();
