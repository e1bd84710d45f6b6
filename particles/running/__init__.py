"""The execution of a run: replicas, threads, checkpoints, one result."""
