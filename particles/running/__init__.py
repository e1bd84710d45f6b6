"""Carrying out a run: replicas, threads, checkpoints, one result."""
