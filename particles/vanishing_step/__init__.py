"""The limit of a vanishing time step, from coupled runs at several steps."""
