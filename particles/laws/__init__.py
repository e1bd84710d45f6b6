"""Collision laws: what a drift of the rods with collisions does, one law a file."""
