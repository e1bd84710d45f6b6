"""The kinetic equation for f(y, v): restitutions other than 1."""
