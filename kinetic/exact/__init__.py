"""Exact solutions at e = 1: the Gibbs measure, and the cloud that breathes."""
