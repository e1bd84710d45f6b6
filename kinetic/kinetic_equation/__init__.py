"""The kinetic equation for f(y, v) at restitutions other than 1."""
