"""A verdict of the page's challenges is wrong in fewer than one of a hundred simulated classes."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "apps" / "explore" / "page"
pytestmark = [
    pytest.mark.validate,
    pytest.mark.skipif(not shutil.which("node"), reason="needs node"),
]

# At e = 1 all rods are as hot as each other, so that every clear verdict on the limit 1 is wrong.
EQUAL = """
const chain = {size: 4, restitution: 1, amplitude: 1, damping: 1, gap: 0, spring: "linear"};
let wrong = 0;
for (let run = 0; run < RUNS; run++) {
  const state = ChainPhysics.makeState(chain, run + 1);
  ChainPhysics.go(state, 5 * ChainPhysics.relaxationTime(chain));
  const measured = new ChainMeasuring.Measurement(state, 20);
  measured.settling = 0;
  while (measured.blocks.length < 640) { ChainPhysics.go(state, 4); measured.add(state, 4, 1); }
  const ratio = (n) => measured.ratio(measured.blocks.slice(0, n));
  wrong += ChainJudging.verdict(640, ratio, 1).above !== undefined;
}
found = wrong;
"""
# Two masses come to Maxwell's distribution, one mass never does. A gauge is wrong if it is more
# than 3.5 of its errors away from the law.
GASES = """
let wrong = 0;
for (let run = 0; run < RUNS; run++) {
  const mass_ratio = [1, 2, 3, 10][run % 4];
  const state = ChainGas.makeState({size: 20, box: 80, mass_ratio, spring: "none"}, run + 1);
  const measured = new ChainMeasuring.Measurement(state, 60);
  while (measured.settling > 0 || measured.blocks.length < 40) {
    ChainGas.go(state, 5);
    measured.add(state, 5, 1);
  }
  const kurtosis = (n) => measured.kurtosis(n), { value, error } = measured.force(10);
  wrong += ChainJudging.verdict(40, kurtosis, 2).above !== mass_ratio > 1;
  wrong += Math.abs(value - ChainGas.law(state)) > 3.5 * error;
}
found = wrong;
"""

# The error of a gas of one mass, whose force is periodic: of 11 or 22 rods blocks were periods.
PERIODIC = """
let wrong = 0;
for (const size of [2, 3, 11, 20, 22, 23, 40, 60]) {
  let deviations = 0, errors = 0;
  for (let run = 0; run < RUNS; run++) {
    const chain = {size, box: 3 * size + 40, mass_ratio: 1, spring: "none"};
    const state = ChainGas.makeState(chain, run + 1);
    const measured = new ChainMeasuring.Measurement(state, 60);
    while (measured.blocks.length < 10) {
      ChainGas.go(state, 5 / 3);
      measured.add(state, 5 / 3, 1);
    }
    const { value, error } = measured.force();
    deviations += (value - ChainGas.law(state)) ** 2;
    errors += error ** 2;
  }
  wrong += !(Math.abs(Math.sqrt(deviations / errors) - 1) < 0.2);
}
found = wrong;
"""

# Error bars of widths at e = 1, where all are 1. Blocks of four correlation times make them too
# small by an eighth, and 20 blocks by a twentieth.
BARS = """
const chain = {size: 3, restitution: 1, amplitude: 1, damping: 1, gap: 0.3, spring: "linear"};
let deviations = 0;
for (let run = 0; run < RUNS; run++) {
  const state = ChainPhysics.makeState(chain, run + 1), free = ChainPhysics.freeWidth(chain);
  const measured = new ChainMeasuring.Measurement(state, 20);
  while (measured.blocks.length < 20) { ChainPhysics.go(state, 2); measured.add(state, 2, free); }
  const errors = measured.errors("squares");
  measured.widths().forEach((width, i) => {
    deviations += ((width ** 2 - free ** 2) / errors[i]) ** 2;
  });
}
found = Math.abs(Math.sqrt(deviations / (3 * RUNS)) - 1.18) < 0.15 ? 0 : RUNS;
"""


@pytest.mark.parametrize(
    ("script", "runs"), [(EQUAL, 200), (GASES, 200), (PERIODIC, 100), (BARS, 200)]
)
def test_fewer_than_one_verdict_in_a_hundred_is_wrong(script, runs):
    """With the page's own files, without a browser.

    Were one in a hundred wrong, half of the runs' expected number would be rare.
    """
    order = ("scales", "physics", "gas", "measuring", "drawing", "judging")
    texts = [(PAGE / f"{name}.js").read_text(encoding="utf-8") for name in order]
    scripts = "".join(text.replace('"use strict";', "") for text in texts)
    whole = f"{scripts}\nlet found; const RUNS = {runs};{script}\n"
    whole += "console.log(JSON.stringify(found))"
    done = subprocess.run(
        ["node"], input=whole, capture_output=True, text=True, check=True, timeout=500
    )
    assert json.loads(done.stdout) <= 0.01 * runs
