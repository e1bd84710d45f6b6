"""Chains simulated and solved side by side, with their pictures: at e = 1, at other e, in time."""
