/* What surrounds a slider: its value, and buttons for less and more. */
"use strict";

const ChainSliders = (() => {
  function button(text, act) {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    made.addEventListener("click", act);
    return made;
  }

  /* Show the value of a slider above it, and buttons beside it, after which it has `moved`. */
  function surround(control, name, moved) {
    const output = document.createElement("output");
    output.dataset.value = name;
    output.ariaHidden = "true"; // the slider itself says it
    const stepping = (sign, steps, word) => {
      const made = button(sign, () => (control.stepUp(steps), moved(name)));
      made.ariaLabel = `${control.labels[0].textContent}, ${word}`;
      return made;
    };
    control.before(output, stepping("−", -1, "less"));
    control.after(stepping("+", 1, "more"));
  }

  return { surround };
})();
