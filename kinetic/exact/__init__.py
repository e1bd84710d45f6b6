"""Exact solutions at e = 1: the Gibbs measure, the rods' places, the breathing cloud."""
