"""Comparisons of simulation and theory beyond single figures of the paper."""
