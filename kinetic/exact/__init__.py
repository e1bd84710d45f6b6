"""Exact solutions at e = 1: the Gibbs measure, and the breathing cloud."""
