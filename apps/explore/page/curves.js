/* Velocity widths by the theory, of the rods of the left half, in free widths.
   Written by docs/figures/chain_curves.py. */
"use strict";

const ChainCurves = {
  widths: [
    {"size":20,"restitution":0.9,"damping":0.3,"gap":0.5,"title":"gas","error":null,"border":null,"half":[0.781,0.762,0.752,0.742,0.734,0.729,0.725,0.722,0.72,0.72]},
    {"size":20,"restitution":0.9,"damping":1.0,"gap":0.0,"title":"gas","error":0.0258,"border":0.0285,"half":[0.786,0.748,0.72,0.699,0.683,0.671,0.661,0.654,0.649,0.647]},
  ],
};
