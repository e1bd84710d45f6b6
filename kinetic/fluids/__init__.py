"""Hydrodynamics in time, on labels and on positions."""
