/* The address holds all that is chosen: #size=20&gap=0.5, ?size=20 or #challenge=ends&size=60. What it
   leaves out is as at the beginning of the challenge or preset, or usual. */
"use strict";

const ChainAddress = (() => {
  const SPRINGS = { size: 100, restitution: 1, amplitude: 1, damping: 1, gap: 0, spring: "linear" };
  const USUAL = { ...SPRINGS, box: 80, mass_ratio: 1 };
  const NAMES = Object.keys(USUAL), SPRUNG = Object.keys(SPRINGS); // of all chains, of those on springs
  const SHOWN = { first: "density", second: "widths", speed: 3 };

  /* Whatever was chosen, as it begins: the chain and what is shown of it, by name. */
  function beginning({ chain, pictures = [SHOWN.first, SHOWN.second], speed = SHOWN.speed }) {
    return { ...USUAL, ...chain, ...SHOWN, first: pictures[0], second: pictures[1], speed };
  }

  /* What a gas begins with where nothing else is asked for: room for its rods, and a speed at which it moves. */
  const roomy = ({ size }) => ({ box: Math.max(USUAL.box, 4 * size), speed: 100 });

  /* What the address asks for by name, or why it is refused, or null if it asks for nothing; `controls`
     has a slider or list for each name. */
  function read(controls, { search, hash } = location) {
    if (hash && !hash.includes("="))
      return document.getElementById(hash.slice(1)) ? null // a heading of the page around
        : { refused: `${hash.slice(1)} is not of the form name=value` };
    const given = [...new URLSearchParams((hash || search).slice(1))], values = {};
    if (!given.length) return null;
    for (const [name, text] of given) {
      if (!Object.hasOwn(controls, name)) return { refused: `${name} is none of ${Object.keys(controls).join(", ")}` };
      if (Object.hasOwn(values, name)) return { refused: `${name} is given twice` };
      const { value, wanted } = understood(controls[name], text);
      if (value === undefined) return { refused: `${name} must be ${wanted}, got ${text || "nothing"}` };
      values[name] = value;
    }
    if (values.challenge && values.preset) return { refused: "it names a challenge and a preset, and only one can be" };
    return { values };
  }

  /* The value of a text for a control, or what is wanted instead. */
  function understood({ options, numbers, min, max, step }, text) {
    if (numbers) {
      const values = text.split("_").map((each) => (each.trim() === "" ? NaN : Number(each)));
      return values.every(Number.isFinite) ? { value: values } : { wanted: "numbers with _ between them" };
    }
    if (options) {
      const list = Array.from(options, (option) => option.value).filter(Boolean);
      return list.includes(text) ? { value: isNaN(text) ? text : Number(text) } : { wanted: list.join(" or ") };
    }
    const value = text.trim() === "" ? NaN : Number(text), [kind, decimals] = step === "1" ? ["whole ", 0] : ["", 3];
    const wanted = `a ${kind}number from ${min} to ${max}${decimals ? ` with at most ${decimals} decimals` : ""}`;
    return value >= min && value <= max && value === Number(value.toFixed(decimals)) ? { value } : { wanted };
  }

  /* Write what was chosen and what of it is changed `now`, and keep for a reload what is `solved`. */
  function write({ kind, id, ...chosen }, now, solved) {
    const begun = beginning(kind ? chosen : {}), given = kind ? [[kind, id]] : [];
    if (now.prediction) given.push(["prediction", now.prediction]);
    for (const name of Object.keys(begun)) if (now[name] !== begun[name]) given.push([name, now[name]]);
    const setting = `#${new URLSearchParams(given.length ? given : [["size", now.size]])}`;
    history.replaceState({ solved }, "", location.pathname + setting);
  }

  const same = (one, other) => NAMES.every((name) => one[name] === other[name]);

  return { USUAL, NAMES, SPRUNG, beginning, roomy, read, write, same };
})();
