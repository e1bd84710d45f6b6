/* Velocity widths by the best theory, of the rods of the left half, in free widths.
   Written by docs/figures/chain_curves.py. */
"use strict";

const ChainCurves = {
  widths: [
    {"size":60,"restitution":1.05,"damping":2.5,"gap":0.0,"title":"kinetic equation","error":null,"border":null,"half":[2.372,2.313,2.282,2.262,2.248,2.238,2.23,2.224,2.22,2.217,2.214,2.212,2.211,2.209,2.209,2.208,2.208,2.207,2.207,2.207,2.207,2.207,2.207,2.207,2.208,2.208,2.208,2.208,2.208,2.208]},
    {"size":60,"restitution":1.05,"damping":5.0,"gap":0.0,"title":"kinetic equation","error":0.049,"border":0.0277,"half":[1.148,1.171,1.19,1.207,1.222,1.236,1.248,1.259,1.269,1.279,1.287,1.295,1.303,1.309,1.316,1.322,1.327,1.332,1.336,1.34,1.344,1.347,1.35,1.352,1.355,1.356,1.358,1.359,1.359,1.36]},
    {"size":20,"restitution":0.9,"damping":0.3,"gap":0.5,"title":"kinetic equation","error":null,"border":null,"half":[0.736,0.725,0.717,0.711,0.706,0.702,0.699,0.697,0.696,0.696]},
    {"size":20,"restitution":0.9,"damping":1.0,"gap":0.0,"title":"kinetic equation with pair correlations","error":0.0196,"border":0.013,"half":[0.777,0.74,0.714,0.696,0.682,0.671,0.663,0.657,0.653,0.652]},
  ],
  turning: { damping: 3.0 },
};
