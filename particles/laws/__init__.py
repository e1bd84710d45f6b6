"""Collision laws: how a drift with collisions is computed. Each law has its own file."""
